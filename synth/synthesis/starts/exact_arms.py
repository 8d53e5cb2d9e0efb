"""Start points from algebra: shapes near the exact designs, where the targets fix finitely many."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from synth.geometry import arms_through_five, arms_through_four, is_generic
from synth.synthesis.shapes import ARM_LENGTH

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.geometry import Invariants
    from synth.synthesis.shapes import Shapes
    from synth.task import Task


def exact_arms(task: Task) -> tuple[Invariants, ...] | None:
    """Return all arms whose workspace passes exactly through the targets, whatever the link can do.

    Args:
        task: The task.

    Returns:
        The designs, none if there is no real one; None where the question has no finite answer: it takes
        four targets with the rigid link given, or five with a free one, in general position.
    """
    positions, rigid = task.positions_in_base, task.robot.rigid_link
    if len(positions) != (4 if rigid.is_fixed else 5) or not is_generic(positions):
        return None
    if not rigid.is_fixed:
        return arms_through_five(positions).of()
    _, radius = task.robot.end_effector_circle(rigid.d35.lower, rigid.d45.lower)
    return arms_through_four(positions, radius).of() if radius > 0.0 else None


def nearest_to_exact_arms(shapes: Shapes, designs: Sequence[Invariants], count: int) -> NDArray[np.intp]:
    """Return which shapes are nearest to exact designs, `count` for each way in which a design may lie.

    A design leaves open how it is turned about axis 1, which of two mirror images it is, and which way
    axis 2 points.

    Args:
        shapes: The shapes, of shape (N,).
        designs: The designs.
        count: How many shapes for each.
    """
    kinematics = shapes.kinematics
    poses = _pose_about_axis_1(kinematics.centre, kinematics.frame[..., 0])
    nearest = []
    for design, sense in product(designs, (1.0, -1.0)):
        for circle in (design.circle(1), design.circle(-1)):
            pose = _pose_about_axis_1(circle.centre, sense * circle.axis)
            off = np.linalg.norm(poses - pose, axis=-1) + np.abs(kinematics.radius - circle.radius)
            nearest.append(np.argsort(off, kind="stable")[:count])
    return np.unique(np.concatenate(nearest))


def _pose_about_axis_1(centre: FloatArray, axis: FloatArray) -> FloatArray:
    """Return centre and axis of circles, shape (..., 3), as rho, z and the axis seen from there, (..., 5)."""
    rho = np.hypot(centre[..., 0], centre[..., 1])
    outward = centre[..., :2] / np.maximum(rho, 1e-12)[..., None]
    radial = np.einsum("...i,...i", axis[..., :2], outward)
    tangential = outward[..., 0] * axis[..., 1] - outward[..., 1] * axis[..., 0]
    direction = ARM_LENGTH * np.stack([radial, tangential, axis[..., 2]], axis=-1)
    return np.concatenate([rho[..., None], centre[..., 2:], direction], axis=-1)
