"""The room about an arm, and where it has any: at the joint angles nearest to each target that are clear.

It is a part of the independent check: plain numpy, through no expression of the solver.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import frozen_value
from synth.robot import Arm, ArmBody, clear_of_obstacles, clear_of_tube, tube_clear_of_itself
from synth.synthesis.check.approaches import points_elsewhere

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Solid
    from synth.task import Task

LENGTH_SLACK = 1e-6  # what rounding may do, m
_LAST = 1e3  # m, on top of misses: joint angles that point elsewhere than asked come last
_TOGETHER = 2000  # joint angles whose clearances are looked at together
# Of more joint angles than that the ranges of joint 2 that they lie in are looked at first.
_RANGES = 500
_CLEARLY = 1e-3  # m; in a range in which the arm is clear of itself by this nothing else is looked at


def chosen_joints(
    task: Task, arm: Arm, given: FloatArray | None, *, keep: bool
) -> tuple[FloatArray, NDArray[np.bool_], Clearances]:
    """Return the joint angles at which an arm is nearest to each target, of those where it is clear.

    Args:
        task: The task.
        arm: The robot in a shape.
        given: Joint angles to consider, too, shape (n, 2), rad.
        keep: Whether these come first wherever they reach the target within its tolerance.

    Returns:
        The angles, shape (n, 2), rad; at which targets none keeps the end effector above the floor, shape
        (n,); and the room about the arm there.
    """
    targets = task.table.positions
    if keep and given is not None and _reaching(task, arm, given):
        room = Clearances.of(task, arm, given)
        if room.clear.all():  # as mostly, and then nothing else is asked for
            return given, np.zeros(len(targets), dtype=np.bool_), room
    closest, _ = arm.closest_joints(targets)
    candidates = np.stack([closest] if given is None else [closest, given])
    elsewhere = _LAST * points_elsewhere(task, arm, candidates)
    misses = _misses(task, arm, candidates, targets) + elsewhere
    if given is not None and keep:
        misses[1][misses[1] <= task.tolerances] = -1.0  # before all others
    best, each = np.argmin(misses, axis=0), np.arange(len(targets))
    chosen, sunk = candidates[best, each], np.isinf(misses[best, each])
    # The nearest one mostly does; the branches of the inverse kinematics are looked at where it does not.
    room = Clearances.of(task, arm, chosen)
    stuck = np.flatnonzero(sunk | ~room.clear | elsewhere.all(axis=0))
    if len(stuck):
        branches = arm.inverse_kinematics(targets[stuck])
        others = np.moveaxis(branches.joints, -2, 0)
        off = _misses(task, arm, others, targets[stuck])
        off += _LAST * points_elsewhere(task, arm, others, stuck)
        off[np.isinf(branches.miss.T)] = np.inf  # beyond the joint limits, or no branch at all
        candidates, misses = (
            np.concatenate(pair) for pair in ((candidates[:, stuck], others), (misses[:, stuck], off))
        )
        clear = clear_of_everything(task, arm, candidates)
        best, each = np.argmin(np.where(clear, misses, np.inf), axis=0), np.arange(len(stuck))
        chosen[stuck], sunk[stuck] = candidates[best, each], np.isinf(misses[best, each])
        room = Clearances.of(task, arm, chosen)
    return chosen, sunk, room


def _reaching(task: Task, arm: Arm, joints: FloatArray) -> bool:
    """Return whether all targets are within tolerance at joint angles, shape (n, 2), rad, and pointed at."""
    near = _misses(task, arm, joints, task.table.positions) <= task.tolerances
    return bool((near & ~points_elsewhere(task, arm, joints)).all())


def _misses(task: Task, arm: Arm, candidates: FloatArray, targets: FloatArray) -> FloatArray:
    """Return the misses at joint angles of shape (k, n, 2), shape (k, n), m; infinite below the floor."""
    points = arm.forward_kinematics(candidates[..., 0], candidates[..., 1])
    floor = task.lowest_from(arm.base)
    sunk = arm.base.to_base(points)[..., 2] - ArmBody(arm).rod_radius < floor - LENGTH_SLACK
    return np.where(sunk, np.inf, np.linalg.norm(points - targets, axis=-1))


def _rod_from_tube(body: ArmBody, theta2: FloatArray) -> FloatArray:
    """Return how far the rod keeps from the tube, shape (n,), m: lower bounds, less close ones if many."""
    if len(theta2) <= _TOGETHER:
        return clear_of_tube(body, theta2)
    edges = np.linspace(theta2.min(), theta2.max(), _RANGES + 1)
    of_ranges = clear_of_tube(body, edges[:-1], edges[1:], enough=_CLEARLY)
    bounds = of_ranges[np.clip(np.searchsorted(edges, theta2, side="right") - 1, 0, _RANGES - 1)]
    close = np.flatnonzero(~(bounds >= 0.0))
    for part in np.split(close, range(_TOGETHER, len(close), _TOGETHER)):
        bounds[part] = clear_of_tube(body, theta2[part])
    return bounds


@frozen_value
class Clearances:
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
    def of(cls, task: Task, arm: Arm, candidates: FloatArray) -> Clearances:
        """Return the room about an arm at joint angles, shape (..., n, 2), rad."""
        body, solids, shape = ArmBody(arm), seen_by(task, arm), candidates.shape[:-1]
        joints = candidates.reshape(-1, 2)
        parts = np.split(joints, range(_TOGETHER, len(joints), _TOGETHER))
        from_obstacles = np.concatenate([clear_of_obstacles(body, part, solids) for part in parts])
        rod_from_tube = _rod_from_tube(body, joints[:, 1])
        return cls(
            from_obstacles.reshape(*shape, len(solids), 2),
            rod_from_tube.reshape(shape),
            tube_clear_of_itself(body),
        )

    @property
    def least(self) -> FloatArray:
        """What joint angles can change, the least of it, shape (..., n), m."""
        from_obstacles = self.from_obstacles.min(axis=(-2, -1), initial=math.inf)
        return np.asarray(np.minimum(from_obstacles, self.rod_from_tube))

    @property
    def clear(self) -> NDArray[np.bool_]:
        """Whether the arm keeps clear of obstacles and of itself, but for rounding, shape (..., n)."""
        return np.asarray(self.least >= -LENGTH_SLACK)


def seen_by(task: Task, arm: Arm) -> tuple[Solid, ...]:
    """Return what a task wants the arm to keep clear of in the base frame of an arm, wherever that stands."""
    return task.solids_from(arm.base)


def clear_of_everything(task: Task, arm: Arm, joints: FloatArray) -> NDArray[np.bool_]:
    """Return whether an arm at joint angles, shape (..., 2), rad, keeps clear of obstacles and of itself.

    How clear it is, or how deep in something, is not looked for: that takes many times as long.
    """
    body, solids, flat = ArmBody(arm), seen_by(task, arm), joints.reshape(-1, 2)
    parts = np.split(flat, range(_TOGETHER, len(flat), _TOGETHER))
    # A way that ends where it starts is one of which nobody asks how deep it is in something.
    clear = [clear_of_obstacles(body, part, solids, end=part, enough=0.0) >= -LENGTH_SLACK for part in parts]
    of_itself = _rod_from_tube(body, flat[:, 1]) >= -LENGTH_SLACK
    return (np.concatenate(clear).all(axis=(1, 2)) & of_itself).reshape(joints.shape[:-1])
