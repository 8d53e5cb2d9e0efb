"""From the ways between targets to joint angles over time."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.arrays import FloatArray, GivenArray, frozen, frozen_value
from synth.checks import refuse_unless, wrong_number
from synth.errors import InputError, Mistake, SynthError
from synth.synthesis import MOST_MOTIONS, Solution, motions
from synth.trajectories.along_path import differences, timed
from synth.trajectories.profile import Profile

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

JOINTS = ("joint1", "joint2")


@frozen_value
class Trajectory:
    """Joint angles over time. Between two rows the motion is straight in the joint angles.

    Attributes:
        times: Since the start, rising, shape (n,), s.
        positions: Angles (theta1, theta2), shape (n, 2), rad.
        velocities: Their rates, shape (n, 2), rad/s.
        accelerations: The rates of these, shape (n, 2), rad/s^2; where they jump, those that follow.
        stops: When each target is reached, by its name, s.
    """

    times: GivenArray
    positions: GivenArray
    velocities: GivenArray
    accelerations: GivenArray
    stops: Mapping[str, float]

    def __post_init__(self) -> None:
        for name in ("times", "positions", "velocities", "accelerations"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def duration(self) -> float:
        """How long it takes, s."""
        return float(self.times[-1])

    def at(self, time: ArrayLike) -> FloatArray:
        """Return angles between the rows, straight from one to the next, shape (..., 2), rad.

        Args:
            time: Time since the start, shape (...), s.
        """
        since = np.asarray(time, dtype=np.float64)
        return np.stack([np.interp(since, self.times, column) for column in self.positions.T], axis=-1)

    def to_csv(self) -> str:
        """Return it as CSV: time_s, then angle, velocity and acceleration of each joint."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        units = {"rad": self.positions, "rad_s": self.velocities, "rad_s2": self.accelerations}
        writer.writerow(["time_s", *(f"{joint}_{unit}" for unit in units for joint in JOINTS)])
        for time, *rows in zip(
            self.times.tolist(), *(table.tolist() for table in units.values()), strict=True
        ):
            writer.writerow([repr(time), *(repr(value) for row in rows for value in row)])
        return text.getvalue()

    def to_json(self) -> dict[str, Any]:
        """Return it as plain data with the names of ROS trajectory_msgs/JointTrajectory."""
        rows = zip(self.times, self.positions, self.velocities, self.accelerations, strict=True)
        return {
            "joint_names": list(JOINTS),
            "points": [
                {
                    "positions": position.tolist(),
                    "velocities": velocity.tolist(),
                    "accelerations": acceleration.tolist(),
                    "time_from_start": _stamp(float(time)),
                }
                for time, position, velocity, acceleration in rows
            ],
        }


def trajectory(
    solution: Solution,
    *,
    speed: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    pause: float = 0.0,
    period: float = 0.01,
) -> Trajectory:
    """Return a motion of the best shape through all targets, in the order of the task, or along its path.

    It follows the ways of the solution, which are within the joint limits and clear of everything, and
    rests where they turn; so it is clear all along. A path is followed from rest to rest, no faster than it
    asks for.

    Args:
        solution: A solution whose best shape has all ways.
        speed: Largest speed of both joints or of each, shape () or (2,), rad/s; the robot's by default.
        acceleration: Largest acceleration, likewise, rad/s^2.
        pause: How long to rest at each target, s.
        period: Largest time between rows, s.

    Returns:
        The trajectory, from the first target to the last.

    Raises:
        InputError: An argument is wrong.
        NotFoundError: There is no shape.
        SynthError: A way is missing, or there is more than one path: then no motion is known to be clear.
    """
    speeds, rates = _limits(solution, pause, period, speed, acceleration)
    design = solution.best
    if solution.task.paths:
        return _along(solution, speeds, rates, period)
    ways = motions(solution.task, design)
    for way in ways:
        if not way.found:
            raise SynthError(way.describe())
    names = solution.task.table.names
    first = ways[0].joints[0] if ways else design.verification.joints[0]
    tables = [_rest(first, 0.0, pause)]
    stops, now = {names[0]: 0.0}, pause
    for way, name in zip(ways, names[1:], strict=True):
        for start, end in pairwise(way.joints):
            profile = Profile.fastest(start, end, speeds, rates)
            tables.append(_sampled(profile, now, period))
            now += profile.duration
        stops[name] = now
        tables.append(_rest(way.joints[-1], now, pause))
        now += pause
    return _joined(tables, stops)


def has_trajectory(solution: Solution) -> bool:
    """Whether a motion is known to be clear: along one path, or through all of not too many targets."""
    task, design = solution.task, solution.best
    if not task.paths:
        few = len(task.targets) <= MOST_MOTIONS  # of more nobody looked for ways
        return few and all(way.found for way in motions(task, design))
    told = design.verification.followed
    return len(told) == 1 and told[0].met and not task.is_of_its_own.any() and not task.surfaces


def _along(solution: Solution, speeds: FloatArray, rates: FloatArray, period: float) -> Trajectory:
    """Return a motion along the one path of a task."""
    if not has_trajectory(solution):
        raise SynthError("a trajectory is known along one path that is followed, and nothing beside it")
    (path,) = solution.best.verification.followed
    wanted = math.inf if path.speed is None else path.speed
    knots = timed(path.joints, path.lengths, wanted, speeds, rates)
    between, accelerations = differences(path.joints, knots)
    velocities = np.vstack([np.zeros(2), 0.5 * (between[1:] + between[:-1]), np.zeros(2)])
    parts = np.ceil(np.diff(knots) / period).astype(int)
    number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    inside = np.repeat(knots[:-1], parts) + number * np.repeat(np.diff(knots) / parts, parts)
    times = np.append(inside, knots[-1])
    columns = np.column_stack([path.joints, velocities, accelerations]).T
    rows = np.stack([np.interp(times, knots, column) for column in columns], axis=-1)
    stops = {f"{path.name}, start": 0.0, f"{path.name}, end": float(times[-1])}
    return Trajectory(times, rows[:, :2], rows[:, 2:4], rows[:, 4:], stops)


def _limits(
    solution: Solution,
    pause: float,
    period: float,
    speed: ArrayLike | None,
    acceleration: ArrayLike | None,
) -> tuple[FloatArray, FloatArray]:
    """Check all arguments; return the largest speeds and accelerations of the joints, each of shape (2,)."""
    refuse_unless("solution", solution, Solution)
    own, mistakes = solution.task.robot.joint_rates, []
    try:
        own = replace(
            own,
            speeds=own.speeds if speed is None else speed,
            accelerations=own.accelerations if acceleration is None else acceleration,
        )
    except InputError as error:
        names = {"speeds": "speed", "accelerations": "acceleration"}
        for mistake in error.mistakes:
            field, *index = mistake.key.partition("[")
            mistakes.append(Mistake(mistake.message, key="".join([names[field], *index])))
    for key, value, bounds in (("pause", pause, {"least": 0.0}), ("period", period, {"above": 0.0})):
        if wrong := wrong_number(value, **bounds):
            mistakes.append(Mistake(wrong, key=key))
    if mistakes:
        raise InputError(mistakes)
    return own.speeds, own.accelerations


def _rest(joints: FloatArray, since: float, pause: float) -> FloatArray:
    """Return rows of a rest: time, angles, velocities, accelerations, shape (k, 7)."""
    times = np.array([since, since + pause])[: 2 if pause > 0.0 else 1]
    return np.column_stack([times, np.tile(joints, (len(times), 1)), np.zeros((len(times), 4))])


def _sampled(profile: Profile, since: float, period: float) -> FloatArray:
    """Return rows of a motion, with those at which its acceleration changes, shape (k, 7)."""
    knots = np.array([0.0, profile.ramp, profile.duration - profile.ramp, profile.duration])
    count = max(2, math.ceil(profile.duration / period) + 1)
    times = np.unique(np.concatenate([np.linspace(0.0, profile.duration, count), knots]))
    return np.column_stack([since + times, *profile.at(times)])


def _joined(tables: Sequence[FloatArray], stops: Mapping[str, float]) -> Trajectory:
    """Return rows one after the other, those at one time once: the later ones."""
    rows = np.concatenate(tables)
    kept = np.append(np.diff(rows[:, 0]) > 1e-9, True)
    rows = rows[kept]
    return Trajectory(rows[:, 0], rows[:, 1:3], rows[:, 3:5], rows[:, 5:7], dict(stops))


def _stamp(time: float) -> dict[str, int]:
    """Return a time as ROS has it, in whole seconds and nanoseconds."""
    seconds, nanoseconds = divmod(round(1e9 * time), 1_000_000_000)
    return {"sec": seconds, "nanosec": nanoseconds}
