"""The independent check: plain numpy and forward kinematics, through no expression of the solver.

Only this module may say that a target is reached or that a shape respects the limits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, compared_by_value, frozen
from synth.checks import refuse_unless
from synth.robot import Arm, ArmBody
from synth.rounding import Unit, rounded_up, told_apart
from synth.task import Task, Topology

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.geometry import Solid
    from synth.robot import BasePose, Interval

# What rounding may do: a micrometre, a microradian.
_LENGTH_SLACK = 1e-6
_ANGLE_SLACK = 1e-6
_TOGETHER = 2000  # joint angles whose clearances are looked at together


@dataclass(frozen=True)
class Violation:
    """A limit that a shape breaks.

    Attributes:
        limit: Name of the limit.
        amount: By how much, in the unit that the sentence names.
        sentence: What is wrong, for the user.
    """

    limit: str
    amount: float
    sentence: str


@compared_by_value
@dataclass(frozen=True, eq=False)
class Verification:
    """What a shape really does for a task.

    Attributes:
        joints: Best joint angles (theta1, theta2) for each target, shape (n, 2), rad.
        reached: P5 at these angles in the task frame, shape (n, 3), m.
        misses: Distance of P5 from each target, shape (n,), m.
        within_tolerance: Whether each target is reached, shape (n,).
        gamma_residuals: |Gamma(P5)| over the sum of its terms' magnitudes, shape (n,): that P5 lies
            on the published surface, too; about 1e-12.
        clearances: How far the arm at least keeps from the obstacles at each target, shape (n,), m;
            no more than 0.1 m is looked for, and without obstacles it is infinite.
        violations: Limits that the shape breaks; empty for a shape that the hardware can take.
    """

    joints: FloatArray
    reached: FloatArray
    misses: FloatArray
    within_tolerance: tuple[bool, ...]
    gamma_residuals: FloatArray
    clearances: FloatArray
    violations: tuple[Violation, ...]

    @property
    def possible(self) -> bool:
        """Whether the hardware can take the shape."""
        return not self.violations

    @property
    def found(self) -> bool:
        """Whether the shape is possible and reaches every target within its tolerance."""
        return self.possible and all(self.within_tolerance)


def verify(task: Task, arm: Arm, joints: FloatArray | None = None, *, keep: bool = False) -> Verification:
    """Check a shape against a task.

    Everything is seen from the base of the arm, and from nowhere else; an arm that stands elsewhere than
    the task says breaks a limit by that alone.

    Args:
        task: The task.
        arm: The robot in the shape.
        joints: Joint angles to consider beside the closest ones and the branches of the inverse
            kinematics, shape (n, 2), rad: at the closest point the arm may be in the way of something.
        keep: Whether the arm shall stand at these angles wherever they reach the target within its
            tolerance, and clear of everything, though others come nearer.

    Returns:
        The misses by forward kinematics and every limit that is broken.
    """
    refuse_unless("task", task, Task)
    refuse_unless("arm", arm, Arm)
    targets = task.table.positions
    closest, _ = arm.closest_joints(targets)
    branches = arm.inverse_kinematics(targets)
    given = [] if joints is None else [joints]
    candidates = np.stack([closest, *given, *np.moveaxis(branches.joints, -2, 0)])
    points = arm.forward_kinematics(candidates[..., 0], candidates[..., 1])
    misses = np.linalg.norm(points - targets, axis=-1)
    misses[-2:][np.isinf(branches.miss.T)] = np.inf  # beyond the joint limits, or no branch at all
    floor = -math.inf if task.floor is None else task.floor
    sunk = arm.base.to_base(points)[..., 2] - ArmBody(arm).rod_radius < floor - _LENGTH_SLACK
    misses = np.where(sunk, np.inf, misses)
    if joints is not None and keep:
        misses[1][misses[1] <= task.tolerances] = -1.0  # before all others
    # The nearest candidate is mostly the one; the others are looked at where it is in the way of something.
    each, best = np.arange(len(targets)), np.argmin(misses, axis=0)
    room = _Room.of(task, arm, candidates[best, each])
    stuck = np.flatnonzero(~(room.least >= -_LENGTH_SLACK))
    if len(stuck):
        room_of_all = _Room.of(task, arm, candidates[:, stuck])
        blocked = room_of_all.least < -_LENGTH_SLACK
        best[stuck] = np.argmin(np.where(blocked, np.inf, misses[:, stuck]), axis=0)
        room = room.replaced(stuck, room_of_all.chosen(best[stuck]))
    chosen = best, each
    reached, blocked = points[chosen], sunk[chosen] | ~(room.least >= -_LENGTH_SLACK)
    misses = np.linalg.norm(reached - targets, axis=-1)
    within = (misses <= task.tolerances) & ~blocked
    return Verification(
        joints=frozen(candidates[chosen]),
        reached=frozen(reached),
        misses=frozen(misses),
        within_tolerance=tuple(bool(value) for value in within),
        gamma_residuals=frozen(arm.surface.residual(arm.base.to_base(reached))),
        clearances=frozen(room.from_obstacles.min(axis=(-2, -1), initial=math.inf)),
        violations=(
            *_base_violations(task.base, arm.base),
            *_length_violations(arm),
            *_bend_violations(arm),
            *_joint_violations(arm, candidates[chosen]),
            *_floor_violations(task, arm, arm.base.to_base(reached)[:, 2]),
            *_topology_violations(task, arm),
            *_obstacle_violations(task, room),
            *_self_violations(task, room),
        ),
    )


@compared_by_value
@dataclass(frozen=True, eq=False)
class _Room:
    """What the arm keeps clear of, as lower bounds of distances, m; see `ArmBody`.

    Attributes:
        from_obstacles: Of tube and rod from each of the m obstacles, shape (..., n, m, 2).
        rod_from_tube: Of the rigid link from the malleable one, shape (..., n).
        tube_from_itself: Of the malleable link from itself and from the base.
    """

    from_obstacles: FloatArray
    rod_from_tube: FloatArray
    tube_from_itself: float

    @classmethod
    def of(cls, task: Task, arm: Arm, candidates: FloatArray) -> _Room:
        """Return the room about an arm at joint angles, shape (..., n, 2), rad."""
        body, solids, shape = ArmBody(arm), seen_by(task, arm), candidates.shape[:-1]
        joints = candidates.reshape(-1, 2)
        parts = np.split(joints, range(_TOGETHER, len(joints), _TOGETHER))
        from_obstacles = np.concatenate([body.from_obstacles(part, solids) for part in parts])
        rod_from_tube = np.concatenate([body.rod_from_tube(part[:, 1]) for part in parts])
        return cls(
            from_obstacles.reshape(*shape, len(solids), 2),
            rod_from_tube.reshape(shape),
            body.tube_from_itself(),
        )

    @property
    def least(self) -> FloatArray:
        """What joint angles can change, the least of it, shape (..., n), m."""
        from_obstacles = self.from_obstacles.min(axis=(-2, -1), initial=math.inf)
        return np.asarray(np.minimum(from_obstacles, self.rod_from_tube))

    def chosen(self, best: NDArray[np.intp]) -> _Room:
        """Return the room at one candidate for each target, shape (n,)."""
        index = best, np.arange(len(best))
        return _Room(self.from_obstacles[index], self.rod_from_tube[index], self.tube_from_itself)

    def replaced(self, some: NDArray[np.intp], other: _Room) -> _Room:
        """Return the room with that of some targets replaced."""
        from_obstacles, rod_from_tube = self.from_obstacles.copy(), self.rod_from_tube.copy()
        from_obstacles[some], rod_from_tube[some] = other.from_obstacles, other.rod_from_tube
        return _Room(from_obstacles, rod_from_tube, self.tube_from_itself)


def seen_by(task: Task, arm: Arm) -> tuple[Solid, ...]:
    """Return the obstacles of a task in the base frame of an arm, wherever that stands."""
    return tuple(obstacle.solid.seen_from(arm.base.position, arm.base.yaw) for obstacle in task.obstacles)


def clear_of_everything(task: Task, arm: Arm, joints: FloatArray) -> NDArray[np.bool_]:
    """Return whether an arm at joint angles, shape (n, 2), rad, keeps clear of obstacles and of itself."""
    return np.asarray(_Room.of(task, arm, joints).least >= -_LENGTH_SLACK)


def _exceeds(limit: str, value: float, bound: float, slack: float, sentence: str) -> list[Violation]:
    """Return a violation if `value` is above `bound`; NaN violates everything."""
    if value <= bound + slack:
        return []
    return [Violation(limit, value - bound, sentence)]


def _outside(interval: Interval, values: FloatArray | float) -> float:
    """Return how far the worst of the values is outside the interval; negative for all inside."""
    return float(np.max(np.maximum(interval.lower - values, values - interval.upper), initial=-math.inf))


def _base_violations(asked: BasePose, stands: BasePose) -> list[Violation]:
    moved = float(np.linalg.norm(stands.position - asked.position))
    turned = abs(math.remainder(stands.yaw - asked.yaw, 2.0 * math.pi))
    return [
        *_exceeds(
            "base: position", moved, 0.0, _LENGTH_SLACK,
            f"the arm stands {1e3 * moved:.4g} mm from where the task puts it",
        ),
        *_exceeds(
            "base: yaw", turned, 0.0, _ANGLE_SLACK,
            f"the arm stands turned by {math.degrees(turned):.4g} deg from how the task puts it",
        ),
    ]  # fmt: skip


def _length_violations(arm: Arm) -> list[Violation]:
    robot, violations = arm.robot, []
    for name, interval, value in (
        ("link", robot.link.length, arm.shape.length),
        ("d35", robot.rigid_link.d35, arm.d35),
        ("d45", robot.rigid_link.d45, arm.d45),
    ):
        violations += _exceeds(
            f"length: {name}", _outside(interval, value), 0.0, _LENGTH_SLACK,
            _of_its_limits(f"the length of {name} would have to be", value, interval),
        )  # fmt: skip
    return violations


def _of_its_limits(would: str, value: float, interval: Interval) -> str:
    limit = interval.upper if value > interval.upper else interval.lower
    told, bound = told_apart(value, limit, digits=2)
    return f"{would} {told} mm; {bound} mm is its {'upper' if value > limit else 'lower'} limit"


def _bend_violations(arm: Arm) -> list[Violation]:
    link, shape = arm.robot.link, arm.shape
    return [
        *_exceeds(
            "min_bend_radius", link.min_bend_radius, shape.min_bend_radius, _LENGTH_SLACK,
            "the link would need a bend radius of {} mm; {} mm is its limit".format(
                *told_apart(shape.min_bend_radius, link.min_bend_radius)),
        ),
        *_exceeds(
            "max_total_bend", shape.total_bend, link.max_total_bend, _ANGLE_SLACK,
            "the link would have to bend by {} deg in all; {} deg is its limit".format(
                *told_apart(shape.total_bend, link.max_total_bend, Unit.DEG)),
        ),
    ]  # fmt: skip


def _joint_violations(arm: Arm, joints: FloatArray) -> list[Violation]:
    limits = arm.robot.joint_limits
    violations = []
    for name, interval, angles in (
        ("base joint", limits.base, joints[:, 0]),
        ("second joint", limits.second, joints[:, 1]),
    ):
        worst = _outside(interval, angles)
        violations += _exceeds(
            name, worst, 0.0, _ANGLE_SLACK,
            f"the {name} would have to turn {rounded_up(worst, Unit.DEG, 2)} deg beyond its limit",
        )  # fmt: skip
    return violations


def _floor_violations(task: Task, arm: Arm, end_effector: FloatArray) -> list[Violation]:
    if task.floor is None:
        return []
    body = ArmBody(arm)
    heights = {
        "link": body.lowest(),
        "second joint": float(arm.axis_points[2:, 2].min()),
        "end effector": float(np.min(end_effector, initial=math.inf)) - body.rod_radius,
    }
    violations = []
    for part, height in heights.items():
        depth = task.floor - height
        violations += _exceeds(
            f"floor: {part}", depth, 0.0, _LENGTH_SLACK,
            f"the {part} would be {rounded_up(depth, digits=2)} mm below the floor",
        )  # fmt: skip
    return violations


def _topology_violations(task: Task, arm: Arm) -> list[Violation]:
    """Check the category asked for: axes that meet to 1e-6 m, or are parallel to 1e-6 rad."""
    off = arm.category_distances
    match task.topology:
        case Topology.SPHERICAL:
            amount, slack = off.spherical, _LENGTH_SLACK
        case Topology.PUMA:
            amount, slack = off.puma, _LENGTH_SLACK
        case Topology.SCARA:
            amount, slack = off.scara, _ANGLE_SLACK
        case Topology.GENERAL:
            amount, slack = float(arm.category.value != "general"), 0.0
        case Topology.ANY:
            return []
    return _exceeds(
        "topology", amount, 0.0, slack, f"the shape is not {task.topology.value}, which the task asks for"
    )


def _obstacle_violations(task: Task, room: _Room) -> list[Violation]:
    """Check that tube and rod keep clear of the obstacles at each target: one violation for each."""
    violations = []
    least = room.from_obstacles.min(axis=(-2, -1), initial=math.inf)
    for index in np.flatnonzero(~(least >= -_LENGTH_SLACK)).tolist():
        clearances = room.from_obstacles[index]
        worst, part = np.unravel_index(np.argmin(clearances), clearances.shape)
        obstacle, depth = task.obstacles[worst].name, -float(clearances[worst, part])
        violations += _exceeds(
            f"obstacle: {obstacle}", depth, 0.0, _LENGTH_SLACK,
            f"at {task.targets[index].name} the {('malleable', 'rigid')[part]} link would be "
            f"{rounded_up(depth, digits=2)} mm inside {obstacle}",
        )  # fmt: skip
    return violations


def _self_violations(task: Task, room: _Room) -> list[Violation]:
    violations = _exceeds(
        "itself", -room.tube_from_itself, 0.0, _LENGTH_SLACK,
        f"the malleable link would be {rounded_up(-room.tube_from_itself, digits=2)} mm inside itself "
        "or the base",
    )  # fmt: skip
    for index in np.flatnonzero(~(room.rod_from_tube >= -_LENGTH_SLACK)).tolist():
        name, depth = task.targets[index].name, -float(room.rod_from_tube[index])
        violations += _exceeds(
            "itself", depth, 0.0, _LENGTH_SLACK,
            f"at {name} the rigid link would be {rounded_up(depth, digits=2)} mm inside the malleable one",
        )  # fmt: skip
    return violations
