"""Many shapes of one robot at once, as arrays: what screening and refinement work on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.robot import Arm, BasePose, Kinematics, LinkShape, chain_end, chain_points

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.robot import Robot

ARCS = 4  # equal arcs of a link: eight curvatures and a length for the five numbers of an end pose


@dataclass(frozen=True, eq=False)
class Population:
    """Shapes of a robot, each a row of unknowns; leading axes "..." are free.

    Attributes:
        robot: The hardware.
        unknowns: Shape (..., 9), or (..., 11) where the rigid link is free: the curvatures (kx, ky)
            of the ARCS equal arcs in units of the largest curvature, the link's length, m, and the
            distances d35 and d45, m.
    """

    robot: Robot
    unknowns: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "unknowns", frozen(self.unknowns))

    @classmethod
    def sample(cls, robot: Robot, size: int, rng: np.random.Generator) -> Population:
        """Draw shapes within the limits: curvatures uniform in their disc, lengths in their intervals.

        Args:
            robot: The hardware.
            size: How many.
            rng: Source of randomness.
        """
        bend = np.sqrt(rng.uniform(size=(size, ARCS)))
        direction = rng.uniform(0.0, 2.0 * np.pi, (size, ARCS))
        curvatures = np.stack([bend * np.cos(direction), bend * np.sin(direction)], axis=-1)
        rigid = robot.rigid_link
        intervals = [robot.link.length] if rigid.is_fixed else [robot.link.length, rigid.d35, rigid.d45]
        lengths = [rng.uniform(interval.lower, interval.upper, size) for interval in intervals]
        unknowns = np.column_stack([curvatures.reshape(size, -1), *lengths])
        return cls(robot, into_limits(robot, unknowns))

    @classmethod
    def of(cls, arm: Arm) -> Population:
        """Return the one shape of an arm, which is of ARCS equal arcs."""
        curvatures = (arm.shape.curvatures * arm.robot.link.min_bend_radius).ravel()
        rigid = [] if arm.robot.rigid_link.is_fixed else [arm.d35, arm.d45]
        return cls(arm.robot, np.array([[*curvatures, arm.shape.length, *rigid]]))

    @property
    def curvatures(self) -> FloatArray:
        """Curvatures of the arcs, shape (..., ARCS, 2), 1/m."""
        scaled = self.unknowns[..., : 2 * ARCS].reshape(*self.unknowns.shape[:-1], ARCS, 2)
        return np.asarray(scaled * self.robot.link.max_curvature)

    @property
    def length(self) -> FloatArray:
        """Length of the link, shape (...), m."""
        return self.unknowns[..., 2 * ARCS]

    @property
    def rigid_links(self) -> tuple[FloatArray, FloatArray]:
        """Distances d35 and d45, shape (...), m."""
        rigid = self.robot.rigid_link
        if rigid.is_fixed:
            return np.full(self.length.shape, rigid.d35.lower), np.full(self.length.shape, rigid.d45.lower)
        return self.unknowns[..., -2], self.unknowns[..., -1]

    @property
    def bending(self) -> FloatArray:
        """Bending energy, the integral of curvature squared along the link, shape (...), 1/m."""
        return np.asarray(np.sum(self.curvatures**2, axis=(-2, -1)) * self.length / ARCS)

    @cached_property
    def end(self) -> tuple[FloatArray, FloatArray]:
        """The link's end in the base frame: rotation (..., 3, 3), columns u, v, t; position (..., 3), m."""
        lengths = np.repeat(self.length[..., None] / ARCS, ARCS, axis=-1)
        frame, position = chain_end(self.curvatures, lengths)
        return frame, position + np.array([0.0, 0.0, self.robot.d12])

    @cached_property
    def centreline(self) -> FloatArray:
        """Points of the centrelines in the base frame, four on each arc, shape (..., 4 ARCS, 3), m."""
        pieces = 4
        curvatures = np.repeat(self.curvatures, pieces, axis=-2)
        lengths = np.repeat(self.length[..., None] / (pieces * ARCS), pieces * ARCS, axis=-1)
        return np.asarray(chain_points(curvatures, lengths) + np.array([0.0, 0.0, self.robot.d12]))

    @cached_property
    def kinematics(self) -> Kinematics:
        """The two joints of all shapes."""
        frame, position = self.end
        offset, radius = self.robot.end_effector_circle(*self.rigid_links)
        return Kinematics(frame, position + offset[..., None] * frame[..., 0], radius)

    def take(self, chosen: NDArray[np.intp] | NDArray[np.bool_]) -> Population:
        """Return some of the shapes."""
        return Population(self.robot, self.unknowns[chosen])

    def arm(self, index: int, base: BasePose) -> Arm:
        """Return one shape as a robot that stands at `base`."""
        shape = LinkShape(self.curvatures[index], np.full(ARCS, self.length[index] / ARCS))
        d35, d45 = self.rigid_links
        return Arm(self.robot, shape, float(d35[index]), float(d45[index]), base)


def into_limits(robot: Robot, unknowns: FloatArray) -> FloatArray:
    """Return unknowns moved into the limits of the hardware: lengths, bend radius, total bend.

    Args:
        robot: The hardware.
        unknowns: As in `Population`, shape (..., 9) or (..., 11).
    """
    unknowns = np.array(unknowns)
    link, rigid = robot.link, robot.rigid_link
    unknowns[..., 2 * ARCS] = np.clip(unknowns[..., 2 * ARCS], link.length.lower, link.length.upper)
    curvatures = unknowns[..., : 2 * ARCS].reshape(*unknowns.shape[:-1], ARCS, 2)
    bends = np.linalg.norm(curvatures, axis=-1)
    shrink = 1.0 / np.maximum(bends, 1.0)
    total = np.sum(bends * shrink, axis=-1) * unknowns[..., 2 * ARCS] * link.max_curvature / ARCS
    shrink = shrink / np.maximum(total / max(link.max_total_bend, 1e-12), 1.0)[..., None]
    unknowns[..., : 2 * ARCS] = (curvatures * shrink[..., None]).reshape(*unknowns.shape[:-1], 2 * ARCS)
    if not rigid.is_fixed:
        # P3, P4, P5 must make a triangle: |d35 - d34| <= d45 <= d35 + d34.
        d35 = np.clip(unknowns[..., -2], rigid.d35.lower, rigid.d35.upper)
        d35 = np.clip(d35, rigid.d45.lower - robot.d34, rigid.d45.upper + robot.d34)
        d45 = np.clip(unknowns[..., -1], np.abs(d35 - robot.d34), d35 + robot.d34)
        unknowns[..., -2], unknowns[..., -1] = d35, np.clip(d45, rigid.d45.lower, rigid.d45.upper)
    return unknowns
