"""Whether an arm follows a path in one go, and how far it strays at most: a bound, not another sample.

Between two joint angles the joints turn evenly while the path goes on, t from 0 to 1. What P5 is off where it
should be is e(t) = P(t) - p(t), and by the error of linear interpolation, of e and then of its second
derivative,

    |e| <= max |e_i| + max |e''_i| / 8 + max |P''''| / 64,    |P''''| <= rho a^4 + R ((a + b)^4 - a^4),

the maxima of e_i and e''_i over both ends; the path has no fourth derivative. a and b are how far the joints
turn, rho is the largest distance from axis 1 on the way, R the radius of P5's circle about axis 2. A jump
from one branch of the inverse kinematics to another strays by far, and so is none of the ways.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen
from synth.synthesis.check.chain import Chain, cheapest_chain
from synth.synthesis.check.followed import Followed
from synth.synthesis.check.surroundings import Surroundings
from synth.synthesis.check.target_results import joints_reaching
from synth.synthesis.check.verification import verify_targets
from synth.task import TargetTable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.paths import Path
    from synth.robot import Arm
    from synth.task import Task
    from synth.watch import Watch

_FINER = 4  # times as many joint angles, where what lies between them matters still
_CLOSE = 1.05  # the bound over what is seen: then it is good enough
_MOST = 8_000  # joint angles along a path
_TURN = 2.0 * math.pi


def followed(task: Task, arm: Arm, path: Path, watch: Watch) -> Followed:
    """Return how a shape follows a path.

    Args:
        task: The task, for its obstacles and floor.
        arm: The robot in the shape.
        path: The path.
        watch: When it is up, nothing finer is looked at.
    """
    count = len(path.samples)
    while True:
        track = _Track(task, arm, path, path.parameters(count))
        told = track.told()
        good = told.met and told.largest <= _CLOSE * told.seen
        count *= _FINER
        if good or count > _MOST or watch.is_up():
            return told


class _Track:
    """A path in intervals, with every posture that the arm may have at the points between them.

    Args:
        task: The task.
        arm: The robot in a shape.
        path: The path.
        u: Parameters of the points, those of the waypoints among them, shape (n,), m.
    """

    def __init__(self, task: Task, arm: Arm, path: Path, u: FloatArray) -> None:
        self._task, self._arm, self._path, self._u = task, arm, path, u
        self._points = path.at(u)
        self._postures = self._all_postures()

    def _all_postures(self) -> list[FloatArray]:
        """Return the joint angles at which each point is reached, clear of everything; maybe none."""
        count = len(self._points)
        names = tuple(map(str, range(count)))
        table = TargetTable(names, self._points, np.full(count, self._path.tolerance), np.ones(count))
        part = self._task.asking_for(table)
        check = verify_targets(part, self._arm)
        reached = joints_reaching(part, self._arm, check)
        postures = [
            self._with_whole_turns(joints) if within else np.empty((0, 2))
            for joints, within in zip(reached, check.within_tolerance, strict=True)
        ]
        if self._path.closed:  # there the joints are as at the start, to the last digit
            postures[-1] = postures[0]
        return postures

    def _with_whole_turns(self, joints: FloatArray) -> FloatArray:
        """Return joint angles, and the same a turn farther where the limits have room for that."""
        turns = np.array(list(itertools.product((0.0, -_TURN, _TURN), repeat=2)))
        every = (joints[None] + turns[:, None]).reshape(-1, 2)
        within: FloatArray = every[self._arm.robot.joint_limits.contain(every)]
        return within

    def told(self) -> Followed:
        """Return the best way along the path: the one on which the joints turn least."""
        sizes = [len(each) for each in self._postures]
        pairs = [
            np.array(list(itertools.product(range(a), range(b))), dtype=int).reshape(-1, 2)
            for a, b in itertools.pairwise(sizes)
        ]
        interval = np.repeat(np.arange(len(pairs)), [len(each) for each in pairs])
        if not len(interval) or not sizes[0]:
            return self._broken(0, self._postures[0])
        firsts, lasts = (
            np.concatenate([self._postures[i + k][each[:, k]] for i, each in enumerate(pairs)])
            for k in (0, 1)
        )
        bounds, seen = self._strays(interval, firsts, lasts)
        open_ = bounds <= self._path.tolerance
        some = np.flatnonzero(open_)
        if len(some):
            open_[some] = Surroundings(self._task, self._arm).clear(firsts[some], lasts[some])
        cost = np.where(open_, np.abs(lasts - firsts).max(axis=-1), np.inf)
        costs = np.split(cost, np.cumsum([len(each) for each in pairs])[:-1])
        steps = [each.reshape(a, b) for each, (a, b) in zip(costs, itertools.pairwise(sizes), strict=True)]
        chain = self._least_turning(steps)
        if not chain.taken:
            return self._broken(chain.passed, self._postures[chain.passed][chain.reached])
        taken = chain.taken
        ends = np.append(0, np.cumsum([len(each) for each in pairs]))
        chosen = np.array([ends[i] + taken[i] * sizes[i + 1] + taken[i + 1] for i in range(len(pairs))])
        return Followed(
            name=self._path.name,
            tolerance=self._path.tolerance,
            joints=frozen(np.vstack([firsts[chosen], lasts[chosen[-1:]]])),
            points=frozen(self._points),
            lengths=frozen(self._path.lengths(self._u)),
            largest=float(bounds[chosen].max()),
            seen=float(seen[chosen].max()),
            breaks=frozen(np.empty((0, 3))),
            jump=frozen(np.empty((0, 2))),
            speed=self._path.speed,
        )

    def _least_turning(self, steps: Sequence[FloatArray]) -> Chain:
        """Return the chain on which the joints turn least; of a closed path one that ends as it begins."""
        if not self._path.closed:
            return cheapest_chain(np.zeros(len(steps[0])), steps)
        each = np.where(np.eye(len(steps[0]), dtype=np.bool_), 0.0, np.inf)
        chains = [cheapest_chain(alone, [*steps[:-1], steps[-1] + alone]) for alone in each]
        return min(chains, key=lambda chain: (chain.cost, -chain.passed))

    def _broken(self, interval: int, before: FloatArray) -> Followed:
        """Return that the path is not followed past an interval, at whose start the arm has some postures."""
        return Followed(
            name=self._path.name,
            tolerance=self._path.tolerance,
            joints=frozen(np.empty((0, 2))),
            points=frozen(np.empty((0, 3))),
            lengths=frozen(np.empty(0)),
            largest=math.inf,
            seen=0.0,
            breaks=frozen(self._points[interval : interval + 2]),
            jump=frozen(_least_jump(before, self._postures[interval + 1])),
            speed=self._path.speed,
        )

    def _strays(
        self, interval: NDArray[np.intp], firsts: FloatArray, lasts: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return how far P5 strays at most as the joints turn within intervals, and how far it does, m.

        Args:
            interval: Which interval of the path, shape (m,).
            firsts: Joint angles at its start, shape (m, 2), rad.
            lasts: Joint angles at its end, shape (m, 2), rad.
        """
        to_base = self._arm.base.to_base
        starts, ends = (to_base(self._points[interval + k]) for k in (0, 1))
        halfway = to_base(self._path.at(0.5 * (self._u[:-1] + self._u[1:])))[interval]
        steps = np.diff(self._u)[interval, None, None]
        bends = (self._path.second_derivatives(self._u) @ self._arm.base.rotation)[interval] * steps**2
        turned = lasts - firsts
        kinematics = self._arm.kinematics
        off, off_bend = [], []
        for joints, points, bend in ((firsts, starts, bends[:, 0]), (lasts, ends, bends[:, 1])):
            reached = kinematics.forward(joints[:, 0], joints[:, 1])
            off.append(np.linalg.norm(reached - points, axis=-1))
            off_bend.append(np.linalg.norm(_second_derivative(self._arm, joints, turned) - bend, axis=-1))
        a, b = np.abs(turned).T
        radius = float(kinematics.radius)
        rho = np.maximum(np.hypot(*starts[:, :2].T) + off[0], np.hypot(*ends[:, :2].T) + off[1])
        rho = rho + 0.5 * radius * b  # half of the way from one of both
        fourth = rho * a**4 + radius * ((a + b) ** 4 - a**4)
        bounds = np.maximum(*off) + np.maximum(*off_bend) / 8.0 + fourth / 64.0
        middle = kinematics.forward(*(0.5 * (firsts + lasts)).T)
        seen = np.maximum(np.maximum(*off), np.linalg.norm(middle - halfway, axis=-1))
        return bounds, seen


def _second_derivative(arm: Arm, joints: FloatArray, turned: FloatArray) -> FloatArray:
    """Return the second derivative of P5 as the joints turn evenly, in the base frame, shape (m, 3), m.

    Args:
        arm: The robot in a shape.
        joints: Angles (theta1, theta2), shape (m, 2), rad.
        turned: By how much they turn from 0 to 1, shape (m, 2), rad.
    """
    kinematics = arm.kinematics
    reached = kinematics.forward(joints[:, 0], joints[:, 1])
    _, by_second = kinematics.velocities(joints, reached)
    # The tangent of a circle a quarter turn on is its own derivative.
    _, by_second_twice = kinematics.velocities(joints + [0.0, 0.5 * math.pi], reached)
    a, b = turned[:, :1], turned[:, 1:]
    across = np.array([-1.0, 1.0, 0.0])
    by_both = by_second[:, [1, 0, 2]] * across
    return np.asarray(-(a**2) * reached * [1.0, 1.0, 0.0] + 2.0 * a * b * by_both + b**2 * by_second_twice)


def _least_jump(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the two of some postures between which the joints turn least, shape (2, 2), rad, or none."""
    if not (len(before) and len(after)):
        return np.empty((0, 2))
    turn = np.abs(after[None] - before[:, None]).max(axis=-1)
    first, last = np.unravel_index(np.argmin(turn), turn.shape)
    return np.stack([before[first], after[last]])
