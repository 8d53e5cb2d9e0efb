"""Many shapes of one robot at once, as arrays: what screening and refinement work on."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.robot import (
    ArcChains,
    Arm,
    BasePose,
    Kinematics,
    LinkShape,
    chain_end,
    chain_points,
    random_curvatures,
)
from synth.synthesis.shapes.bases import Bases
from synth.synthesis.shapes.circles import ARM_LENGTH
from synth.synthesis.shapes.columns import ARCS, BASE, CURVATURES, D35, D45, LENGTH
from synth.synthesis.shapes.limits import free_directions, free_lengths, into_limits
from synth.synthesis.shapes.motion import motion_of_arm

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.robot import BaseRange, Robot

_EQUAL = 1e-12  # of the whole length: by so little arcs of one length may differ


@frozen_value
class Shapes:
    """Shapes of a robot, each a row of unknowns; leading axes "..." are free.

    Attributes:
        robot: The hardware.
        unknowns: Shape (..., 9), with two more where the rigid link is free and six more where the base is:
            the curvatures (kx, ky) of the ARCS equal arcs in units of the largest one, the length, m; d35 and
            d45, m; and the rows of `Bases`.
        places: Where the base may stand, if it is free.
    """

    robot: Robot
    unknowns: FloatArray
    places: BaseRange | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "unknowns", frozen(self.unknowns))

    @classmethod
    def sample(cls, robot: Robot, size: int, rng: np.random.Generator) -> Shapes:
        """Draw shapes within the limits: curvatures uniform in their disc, lengths in their intervals.

        Args:
            robot: The hardware.
            size: How many.
            rng: Source of randomness.
        """
        curvatures = random_curvatures(size, ARCS, rng)
        lengths = [rng.uniform(each.lower, each.upper, size) for each in free_lengths(robot)]
        unknowns = np.column_stack([curvatures.reshape(size, -1), *lengths])
        return cls(robot, into_limits(robot, unknowns, None))

    def at_places(self, places: BaseRange, rng: np.random.Generator) -> Shapes:
        """Return the shapes, each with the base at a random one of its places."""
        rows = places.sample(len(self.length), rng)
        return Shapes(self.robot, np.concatenate([self.unknowns, rows], axis=-1), places)

    @classmethod
    def of(cls, arm: Arm) -> Shapes:
        """Return the one shape of an arm, which is of ARCS equal arcs."""
        curvatures = (arm.shape.curvatures * arm.robot.link.min_bend_radius).ravel()
        rigid = () if arm.robot.rigid_link.is_fixed else (arm.d35, arm.d45)
        return cls(arm.robot, np.array([[*curvatures, arm.shape.length, *rigid]]))

    @property
    def curvatures(self) -> FloatArray:
        """Curvatures of the arcs, shape (..., ARCS, 2), 1/m."""
        scaled = self.unknowns[..., CURVATURES].reshape(*self.unknowns.shape[:-1], ARCS, 2)
        return np.asarray(scaled * self.robot.link.max_curvature)

    @property
    def length(self) -> FloatArray:
        """Length of the link, shape (...), m."""
        return self.unknowns[..., LENGTH]

    @property
    def rigid_links(self) -> tuple[FloatArray, FloatArray]:
        """Distances d35 and d45, shape (...), m."""
        rigid = self.robot.rigid_link
        if rigid.is_fixed:
            return np.full(self.length.shape, rigid.d35.lower), np.full(self.length.shape, rigid.d45.lower)
        return self.unknowns[..., D35], self.unknowns[..., D45]

    @cached_property
    def bases(self) -> Bases:
        """Where the bases stand, if that is free."""
        return Bases(self.unknowns[..., BASE])

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

    @property
    def poses(self) -> FloatArray:
        """Where the links end and how axis 2 points there, by ARM_LENGTH as long, shape (..., 6), m."""
        return np.concatenate([self.end[1], ARM_LENGTH * self.end[0][..., 0]], axis=-1)

    @cached_property
    def motion(self) -> FloatArray:
        """How the unknowns move the link's end and the circle of P5, shape (N, 6 or 8, unknowns).

        Rows: the shift of the end; its turn, as a rotation vector; where the rigid link is free, the
        changes of the circle's offset along axis 2 and of its radius; where the base is free, its shift and
        its turn, in its own frame. For one leading axis.
        """
        arm = motion_of_arm(self.robot, self.unknowns, *self.rigid_links)
        return arm if self.places is None else self.bases.motion_beside(arm)

    @cached_property
    def centreline(self) -> FloatArray:
        """Points of the centrelines in the base frame, four on each arc, shape (..., 4 ARCS, 3), m."""
        curvatures = np.repeat(self.curvatures, 4, axis=-2)
        lengths = np.repeat(self.length[..., None] / (4 * ARCS), 4 * ARCS, axis=-1)
        return np.asarray(chain_points(curvatures, lengths) + np.array([0.0, 0.0, self.robot.d12]))

    @cached_property
    def kinematics(self) -> Kinematics:
        """The two joints of all shapes."""
        frame, position = self.end
        offset, radius = self.robot.end_effector_circle(*self.rigid_links)
        return Kinematics(frame, position + offset[..., None] * frame[..., 0], radius)

    def take(self, chosen: NDArray[np.intp] | NDArray[np.bool_] | slice) -> Shapes:
        """Return some of the shapes."""
        return replace(self, unknowns=self.unknowns[chosen])

    @staticmethod
    def joined(parts: Sequence[Shapes]) -> Shapes:
        """Return the shapes of all parts, of one robot at least, in order."""
        return replace(parts[0], unknowns=np.concatenate([part.unknowns for part in parts]))

    def varied(self, sizes: Sequence[float], lengths: float, rng: np.random.Generator) -> Shapes:
        """Return the shapes bent at random by a little or more, within the limits.

        Args:
            sizes: Of the bends, in units of the largest curvature; each shape gets one of them.
            lengths: By how much lengths change beside that, m; and the numbers of the base, m and rad.
            rng: Source of randomness.
        """
        size = np.tile(rng.choice(sizes, (len(self.unknowns), 1)), self.unknowns.shape[1])
        size[:, LENGTH:] *= lengths
        return self.moved(size * rng.normal(size=size.shape))

    def moved(self, by: FloatArray) -> Shapes:
        """Return the shapes after steps of their unknowns, brought into the limits."""
        return replace(self, unknowns=into_limits(self.robot, self.unknowns + by, self.places))

    def free_directions(self, slope: FloatArray) -> FloatArray:
        """Return projections onto the directions in which shapes may move; see `free_directions`."""
        return free_directions(self.robot, self.unknowns, self.places, slope)

    def where(self, mine: NDArray[np.bool_], other: Shapes) -> Shapes:
        """Return these shapes where a mask, shape (N,), says so, and others elsewhere."""
        return _where(mine, self, other)

    def arm(self, index: int, base: BasePose) -> Arm:
        """Return one shape as a robot that stands at `base`, or where it says itself."""
        shape = LinkShape(self.curvatures[index], np.full(ARCS, self.length[index] / ARCS))
        d35, d45 = self.rigid_links
        if self.places is not None:
            base = self.places.pose(self.bases.rows[index])
        return Arm(self.robot, shape, float(d35[index]), float(d45[index]), base)


def _where(mine: NDArray[np.bool_], one: Shapes, other: Shapes) -> Shapes:
    """Return one's shapes or the other's, with their ends where both have them: none is computed again."""
    both = replace(one, unknowns=np.where(mine[:, None], one.unknowns, other.unknowns))
    if "end" in vars(one) and "end" in vars(other):
        (frame, place), (frame_there, place_there) = one.end, other.end
        frames = np.where(mine[:, None, None], frame, frame_there)
        vars(both)["end"] = frames, np.where(mine[:, None], place, place_there)
    return both


def in_equal_arcs(arm: Arm) -> Arm:
    """Return an arm whose link is of ARCS equal arcs: the same, or the one nearest to it in its curvature."""
    lengths = arm.shape.lengths
    if len(lengths) == ARCS and np.ptp(lengths) <= _EQUAL * arm.shape.length:
        return arm
    chains = ArcChains(arm.robot.link, ARCS)
    return replace(arm, shape=chains.shape(chains.into_limits(chains.row(arm.shape)[None])[0]))
