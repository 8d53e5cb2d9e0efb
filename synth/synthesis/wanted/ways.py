"""How the arm gets from each target to the next: within its joint limits, clear of everything.

A way is straight in the two joint angles, or a few straight pieces where something is in between. That
each piece is clear is certain, by the bounds of `ArmBody`; that there is no way is not.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from synth.checks import refuse_unless
from synth.robot import turned
from synth.synthesis.check import Surroundings, cheapest_chain, joints_reaching
from synth.synthesis.wanted.design import Design
from synth.synthesis.wanted.margins import joint_shortfalls
from synth.synthesis.wanted.motion import Motion, travel_of
from synth.synthesis.wanted.shortest_path import shortest_path
from synth.task import Task
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot import Arm, ArmBody

MOST_MOTIONS = 50  # of more targets nobody asks for the ways between them

# The search for a way around: angles on a grid, samples of tube and rod, and the clearances to keep at these,
# m, one after the other.
_GRID = (91, 64)
_SAMPLES = 24
_MARGINS = (0.02, 0.008, 0.003)
_STEP = 0.02  # rad, between postures that are looked at when a way is straightened
_NO_WAY = 1e6  # rad of travel that a missing way is worth: more than any ways
_CRAMPED = 1e3  # rad, likewise a posture with no margin of a joint: less than a way


def motions(task: Task, design: Design) -> tuple[Motion, ...]:
    """Return how the arm gets from each target to the next, in the order of the task.

    Where a target is reached at several joint angles, those are taken that keep off the limits of the joints
    and shorten the ways altogether.

    Args:
        task: The task.
        design: The arm.

    Returns:
        One motion less than there are targets.
    """
    refuse_unless("task", task, Task)
    refuse_unless("design", design, Design)
    return design.ways or routed(task, design)[0]


def routed(
    task: Task, design: Design, is_up: Callable[[], bool] = never
) -> tuple[tuple[Motion, ...], FloatArray]:
    """Return the ways as `motions` does, and the joint angles that they take at each target, (n, 2), rad.

    Args:
        task: The task.
        design: The arm.
        is_up: Asked often whether to look for no more ways around obstacles.
    """
    postures = joints_reaching(task, design.arm, design.verification)
    ways = _WaysAround(task, design.arm, is_up).ways(postures)
    cramped = [_CRAMPED * joint_shortfalls(task.robot, joints) for joints in postures]
    steps = [
        np.array([[_cost(some[here, there]) for there in range(len(costs))] for here in range(count)]) + costs
        for some, costs, count in zip(ways, cramped[1:], map(len, postures), strict=False)
    ]
    chosen = cheapest_chain(cramped[0], steps).taken
    names = [target.name for target in task.targets]
    found = (ways[step][pair] for step, pair in enumerate(itertools.pairwise(chosen)))
    motions = tuple(Motion(*pair, way) for pair, way in zip(itertools.pairwise(names), found, strict=True))
    return motions, np.array([joints[index] for joints, index in zip(postures, chosen, strict=True)])


def _cost(way: FloatArray) -> float:
    """Return the travel on a way, rad; where there is none, more than any."""
    return travel_of(way) if len(way) else _NO_WAY


class _WaysAround(Surroundings):
    """The ways of an arm between postures, straight or around what is in between."""

    def __init__(self, task: Task, arm: Arm, is_up: Callable[[], bool]) -> None:
        super().__init__(task, arm)
        self._is_up = is_up

    def ways(self, postures: Sequence[FloatArray]) -> list[dict[tuple[int, int], FloatArray]]:
        """Return for each target but the last a way from each of its postures to each of the next target's.

        Args:
            postures: Joint angles at each target, shape (k, 2), rad.
        """
        steps = [
            list(itertools.product(range(len(here)), range(len(there))))
            for here, there in itertools.pairwise(postures)
        ]
        if not steps:
            return []
        start = np.array([postures[step][i] for step, pairs in enumerate(steps) for i, _ in pairs])
        end = np.array([postures[step + 1][j] for step, pairs in enumerate(steps) for _, j in pairs])
        straight = iter(zip(self.clear(start, end), start, end, strict=True))
        ways = []
        for pairs in steps:
            some = {pair: next(straight) for pair in pairs}
            ways.append({pair: np.stack([a, b])[: 2 if clear else 0] for pair, (clear, a, b) in some.items()})
            if not any(len(way) for way in ways[-1].values()):
                self._go_around(ways[-1], some)
        return ways

    def _go_around(
        self,
        ways: dict[tuple[int, int], FloatArray],
        some: dict[tuple[int, int], tuple[np.bool_, FloatArray, FloatArray]],
    ) -> None:
        """Put the first way around what is in between in the place of one that is not clear."""
        # The arm's own clearance and that of the floor depend on joint 2 alone, and every way passes all
        # angles between its ends: without obstacles, where the straight way is closed, all are.
        for pair, (_, start, end) in some.items() if self.solids else ():
            ways[pair] = self._way_around(start, end)
            if len(ways[pair]):
                break

    def _way_around(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Return a way through the grid, straightened, or none."""
        first, second = self.limits.base, self.limits.second
        theta1 = np.linspace(first.lower, first.upper, _GRID[0])
        theta2 = np.linspace(second.lower, second.upper, _GRID[1])
        grid = np.stack(np.meshgrid(theta1, theta2, indexing="ij"), axis=-1)
        sampled = self._sampled_clearance(theta1[:, None], theta2[None])
        for margin in _MARGINS:
            nodes = shortest_path(sampled > margin, _node(grid, start), _node(grid, end))
            if nodes is None:
                continue
            corners = np.array([start, *(grid[node] for node in nodes), end])
            way = self._straightened(corners, margin, lambda steps: _between(sampled, grid, steps))
            if self.clear(way[:-1], way[1:]).all():
                return way
        return np.empty((0, 2))

    def _straightened(
        self, way: FloatArray, margin: float, told: Callable[[FloatArray], FloatArray]
    ) -> FloatArray:
        """Return the way with as few corners as samples allow.

        Args:
            way: Its corners, shape (m, 2), rad.
            margin: What to keep from everything, m.
            told: About what is known of clearances at joint angles, (k, 2): it rules out most pieces.
        """
        kept, here = [way[0]], 0
        while here < len(way) - 1:
            for there in range(len(way) - 1, here, -1):
                count = 2 + int(np.abs(way[there] - way[here]).max() / _STEP)
                steps = way[here] + np.linspace(0.0, 1.0, count)[:, None] * (way[there] - way[here])
                # At the targets themselves it may be narrower.
                if there == here + 1 or (
                    (told(steps) > 0.0).all() and (self._sampled_clearance(*steps.T) > 0.5 * margin).all()
                ):
                    break
            kept.append(way[there])
            here = there
        return np.array(kept)

    def _sampled_clearance(self, theta1: FloatArray, theta2: FloatArray) -> FloatArray:
        """Return about how far tube and rod keep from everything, by samples, m.

        The tube moves with joint 1 alone, and what the rod keeps from tube and floor depends on joint 2
        alone: on a grid of angles, shapes (k, 1) and (1, l), these are asked for few angles.

        Args:
            theta1: Angles of joint 1, rad.
            theta2: Angles of joint 2, rad; both broadcast.
        """
        body = self.body
        share = np.linspace(0.0, 1.0, _SAMPLES)
        tube = body.tube(body.tube_radius + share * (body.arm.shape.length - body.tube_radius))
        joint = min(body.arm.robot.link.diameter, body.rod_length)
        rod = body.rod(joint + share * (body.rod_length - joint), theta2[..., None])
        apart = np.linalg.norm(rod[..., None, :] - tube[_before_the_joint(body, share)], axis=-1)
        least = apart.min(axis=(-2, -1)) - body.tube_radius - body.rod_radius
        least = np.minimum(least, rod[..., 2].min(axis=-1) - body.rod_radius - self.floor)
        tube, rod = turned(tube, theta1[..., None]), turned(rod, theta1[..., None])
        for solid in self.solids:
            if self._is_up():
                shape = np.broadcast_shapes(theta1.shape, theta2.shape)
                return np.full(shape, -np.inf)  # nothing is known to be clear
            from_tube = solid.distance(tube).min(axis=-1) - body.tube_radius
            least = np.minimum(
                least, np.minimum(from_tube, solid.distance(rod).min(axis=-1) - body.rod_radius)
            )
        return np.asarray(least)


def _before_the_joint(body: ArmBody, share: FloatArray) -> NDArray[np.intp]:
    """Return which samples of the tube are farther than a diameter from the joint, one at least."""
    clear = share * body.arm.shape.length <= body.arm.shape.length - body.arm.robot.link.diameter
    return np.flatnonzero(clear)


def _between(values: FloatArray, grid: FloatArray, joints: FloatArray) -> FloatArray:
    """Return values on a grid of joint angles, (k, l), at angles between its nodes, (m, 2), linearly."""
    spacing = grid[1, 1] - grid[0, 0]
    at = (joints - grid[0, 0]) / np.where(spacing > 0.0, spacing, 1.0)
    low = np.clip(at.astype(np.intp), 0, np.subtract(values.shape, 2))
    (i, j), (x, y) = low.T, (at - low).T
    one = (1.0 - y) * values[i, j] + y * values[i, j + 1]
    other = (1.0 - y) * values[i + 1, j] + y * values[i + 1, j + 1]
    return np.asarray((1.0 - x) * one + x * other)


def _node(grid: FloatArray, joints: FloatArray) -> tuple[int, int]:
    nearest = np.unravel_index(np.argmin(np.abs(grid - joints).max(axis=-1)), grid.shape[:2])
    return int(nearest[0]), int(nearest[1])
