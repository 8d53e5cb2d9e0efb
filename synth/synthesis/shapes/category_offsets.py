"""How far shapes are from the category that a task asks for, and how that changes: for many at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.shapes.circles import ARM_LENGTH
from synth.task import Topology

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.synthesis.shapes.shapes import Shapes
    from synth.task import Task


def category_offsets(task: Task, shapes: Shapes) -> FloatArray:
    """Return how far shapes are from the category asked for, shape (..., 2 or 0), m."""
    frame, position = shapes.end
    match task.topology:
        case Topology.SCARA:
            return np.asarray(ARM_LENGTH * frame[..., :2, 0])
        case Topology.SPHERICAL | Topology.PUMA:
            from_point = position - _meeting_point(task)
            return np.asarray(np.einsum("...i,...ij->...j", from_point, frame[..., 1:]))
        case Topology.ANY | Topology.GENERAL:
            return np.zeros((*position.shape[:-1], 0))


def category_slopes(task: Task, shapes: Shapes) -> FloatArray:
    """Return the derivatives of `category_offsets` by the motion of the link's end, shape (N, 2 or 0, 6)."""
    frame, position = shapes.end
    match task.topology:
        case Topology.SCARA:
            # Where the end turns by w, u changes by w x u.
            turned = ARM_LENGTH * np.cross(frame[:, None, :, 0], np.eye(3)[:2])
            return np.concatenate([np.zeros_like(turned), turned], axis=-1)
        case Topology.SPHERICAL | Topology.PUMA:
            across = np.swapaxes(frame[..., 1:], -1, -2)
            turned = np.cross(across, (position - _meeting_point(task))[:, None])
            return np.concatenate([across, turned], axis=-1)
        case Topology.ANY | Topology.GENERAL:
            return np.zeros((len(position), 0, 6))


def _meeting_point(task: Task) -> FloatArray:
    """Return where the axes meet in the category asked for, m."""
    return np.array([0.0, 0.0, 0.0 if task.topology is Topology.SPHERICAL else task.robot.d12])
