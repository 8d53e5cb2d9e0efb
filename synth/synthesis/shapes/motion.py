"""How a step of the unknowns moves the ends of links and the circles of P5: for many at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.robot import ArcChains
from synth.synthesis.shapes.columns import ARCS, CURVATURES, D35, D45, LENGTH

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.robot import Robot

_LEAST_RADIUS = 1e-3  # m; with P3, P4, P5 in line the radius has no derivative


def motion_of_arm(robot: Robot, unknowns: FloatArray, d35: FloatArray, d45: FloatArray) -> FloatArray:
    """Return how links' ends and the circles of P5 move, shape (N, 6 or 8, 9 or 11).

    Args:
        robot: The hardware.
        unknowns: As in `Shapes`, shape (N, 9 or more).
        d35: Distances, shape (N,), m.
        d45: Likewise.

    Returns:
        Rows: the shift of the end; its turn, as a rotation vector; where the rigid link is free, the changes
        of the circle's offset along axis 2 and of its radius.
    """
    link, root = robot.link, np.sqrt(ARCS)
    share = root * (unknowns[:, LENGTH] / link.length.middle - 1.0)
    ends = ArcChains(link, ARCS).ends(np.column_stack([unknowns[:, CURVATURES], share]))
    motion = np.concatenate([link.min_bend_radius * ends.d_position, ends.rotation], axis=1)
    motion[:, :, -1] *= root / link.length.middle
    if robot.rigid_link.is_fixed:
        return motion
    offset, radius = robot.end_effector_circle(d35, d45)
    radius = np.maximum(radius, _LEAST_RADIUS)
    along = (offset + robot.tip_offset) / robot.d34
    by_d35 = np.stack([d35 / robot.d34, d35 * (1.0 - along) / radius], axis=-1)
    by_d45 = np.stack([-d45 / robot.d34, d45 * along / radius], axis=-1)
    whole = np.zeros((len(motion), 8, motion.shape[2] + 2))
    whole[:, :6, : LENGTH + 1], whole[:, 6:, D35], whole[:, 6:, D45] = motion, by_d35, by_d45
    return whole
