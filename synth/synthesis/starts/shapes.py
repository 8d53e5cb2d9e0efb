"""Many shapes of one robot at once, as arrays: what screening and refinement work on."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.robot import ArcChains, Arm, BasePose, Kinematics, LinkShape, chain_end, chain_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.robot import Interval, Robot

_AT_LIMIT = 1e-9
_EQUAL, _TINY = 1e-12, 1e-300  # the first of the whole length
_LEAST_RADIUS = 1e-3  # m; with P3, P4, P5 in line the radius has no derivative
ARM_LENGTH = 0.5  # m; an axis 1 rad off puts P5 about this far off
ARCS = 4  # equal arcs of a link: eight curvatures and a length for the five numbers of an end pose
# The columns of the unknowns; d35 and d45 are there where the rigid link is free.
CURVATURES, LENGTH, _D35, _D45 = slice(0, 2 * ARCS), 2 * ARCS, 2 * ARCS + 1, 2 * ARCS + 2


@frozen_value
class Shapes:
    """Shapes of a robot, each a row of unknowns; leading axes "..." are free.

    Attributes:
        robot: The hardware.
        unknowns: Shape (..., 9), or (..., 11) where the rigid link is free: the curvatures (kx, ky)
            of the ARCS equal arcs in units of the largest one, the length, m, and d35 and d45, m.
    """

    robot: Robot
    unknowns: FloatArray

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
        bend = np.sqrt(rng.uniform(size=(size, ARCS)))
        direction = rng.uniform(0.0, 2.0 * np.pi, (size, ARCS))
        curvatures = np.stack([bend * np.cos(direction), bend * np.sin(direction)], axis=-1)
        lengths = [rng.uniform(each.lower, each.upper, size) for each in _lengths(robot)]
        return cls(robot, into_limits(robot, np.column_stack([curvatures.reshape(size, -1), *lengths])))

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
        return self.unknowns[..., _D35], self.unknowns[..., _D45]

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
        changes of the circle's offset along axis 2 and of its radius. For one leading axis.
        """
        robot, link, root = self.robot, self.robot.link, np.sqrt(ARCS)
        share = root * (self.length / link.length.middle - 1.0)
        ends = ArcChains(link, ARCS).ends(np.column_stack([self.unknowns[:, CURVATURES], share]))
        motion = np.concatenate([link.min_bend_radius * ends.d_position, ends.rotation], axis=1)
        motion[:, :, -1] *= root / link.length.middle
        if robot.rigid_link.is_fixed:
            return motion
        d35, d45 = self.rigid_links
        offset, radius = robot.end_effector_circle(d35, d45)
        radius = np.maximum(radius, _LEAST_RADIUS)
        along = (offset + robot.tip_offset) / robot.d34
        by_d35 = np.stack([d35 / robot.d34, d35 * (1.0 - along) / radius], axis=-1)
        by_d45 = np.stack([-d45 / robot.d34, d45 * along / radius], axis=-1)
        whole = np.zeros((len(motion), 8, motion.shape[2] + 2))
        whole[:, :6, : LENGTH + 1], whole[:, 6:, _D35], whole[:, 6:, _D45] = motion, by_d35, by_d45
        return whole

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
        return Shapes(self.robot, self.unknowns[chosen])

    @classmethod
    def joined(cls, parts: Sequence[Shapes]) -> Shapes:
        """Return the shapes of all parts, of one robot at least, in order."""
        return cls(parts[0].robot, np.concatenate([part.unknowns for part in parts]))

    def varied(self, sizes: Sequence[float], lengths: float, rng: np.random.Generator) -> Shapes:
        """Return the shapes bent at random by a little or more, within the limits.

        Args:
            sizes: Of the bends, in units of the largest curvature; each shape gets one of them.
            lengths: By how much lengths change beside that, m.
            rng: Source of randomness.
        """
        size = rng.choice(sizes, (len(self.unknowns), 1)) * np.ones(self.unknowns.shape)
        size[:, LENGTH:] *= lengths
        return Shapes(self.robot, into_limits(self.robot, self.unknowns + size * rng.normal(size=size.shape)))

    def where(self, mine: NDArray[np.bool_], other: Shapes) -> Shapes:
        """Return these shapes where a mask, shape (N,), says so, and others elsewhere."""
        return Shapes(self.robot, np.where(mine[:, None], self.unknowns, other.unknowns))

    def arm(self, index: int, base: BasePose) -> Arm:
        """Return one shape as a robot that stands at `base`."""
        shape = LinkShape(self.curvatures[index], np.full(ARCS, self.length[index] / ARCS))
        d35, d45 = self.rigid_links
        return Arm(self.robot, shape, float(d35[index]), float(d45[index]), base)


def in_equal_arcs(arm: Arm) -> Arm:
    """Return an arm whose link is of ARCS equal arcs: the same, or the one nearest to it in its curvature."""
    lengths = arm.shape.lengths
    if len(lengths) == ARCS and np.ptp(lengths) <= _EQUAL * arm.shape.length:
        return arm
    chains = ArcChains(arm.robot.link, ARCS)
    return replace(arm, shape=chains.shape(chains.into_limits(chains.row(arm.shape)[None])[0]))


def into_limits(robot: Robot, unknowns: FloatArray) -> FloatArray:
    """Return unknowns moved into the limits of the hardware: lengths, bend radius, total bend.

    Args:
        robot: The hardware.
        unknowns: As in `Shapes`, shape (..., 9) or (..., 11).
    """
    unknowns = np.array(unknowns)
    link, rigid = robot.link, robot.rigid_link
    unknowns[..., LENGTH] = np.clip(unknowns[..., LENGTH], link.length.lower, link.length.upper)
    curvatures = unknowns[..., CURVATURES].reshape(*unknowns.shape[:-1], ARCS, 2)
    bends = np.linalg.norm(curvatures, axis=-1)
    shrink = 1.0 / np.maximum(bends, 1.0)
    total = np.sum(bends * shrink, axis=-1) * unknowns[..., LENGTH] * link.max_curvature / ARCS
    shrink = shrink / np.maximum(total / max(link.max_total_bend, 1e-12), 1.0)[..., None]
    unknowns[..., CURVATURES] = (curvatures * shrink[..., None]).reshape(*unknowns.shape[:-1], 2 * ARCS)
    if not rigid.is_fixed:
        # P3, P4, P5 must make a triangle: |d35 - d34| <= d45 <= d35 + d34.
        d35 = np.clip(unknowns[..., _D35], rigid.d35.lower, rigid.d35.upper)
        d35 = np.clip(d35, rigid.d45.lower - robot.d34, rigid.d45.upper + robot.d34)
        d45 = np.clip(unknowns[..., _D45], np.abs(d35 - robot.d34), d35 + robot.d34)
        unknowns[..., _D35], unknowns[..., _D45] = d35, np.clip(d45, rigid.d45.lower, rigid.d45.upper)
    return unknowns


def free_directions(shapes: Shapes, slope: FloatArray) -> FloatArray:
    """Return projections onto the directions in which shapes may move, shape (N, unknowns, unknowns).

    A limit that is reached, and beyond which a slope leads, takes away its normal.

    Args:
        shapes: Shapes within their limits, of shape (N,).
        slope: Slopes of what is to become less, shape (N, unknowns).
    """
    robot, x, count = shapes.robot, shapes.unknowns, len(slope)
    free = np.tile(np.eye(x.shape[1]), (count, 1, 1))
    curvatures = x[:, CURVATURES].reshape(count, ARCS, 2)
    bends = np.linalg.norm(curvatures, axis=-1)
    bent = curvatures / np.maximum(bends, _TINY)[..., None]
    tighter = np.einsum("nai,nai->na", slope[:, CURVATURES].reshape(count, ARCS, 2), bent) < 0.0
    tightest = tighter & (bends >= 1.0 - _AT_LIMIT)
    for arc in range(ARCS):
        mine = slice(2 * arc, 2 * arc + 2)
        normal = bent[:, arc] * tightest[:, arc, None]
        free[:, mine, mine] -= normal[:, :, None] * normal[:, None, :]
    for unknown, interval in enumerate(_lengths(robot), start=LENGTH):
        shorter, longer = slope[:, unknown] > 0.0, slope[:, unknown] < 0.0
        shortest = x[:, unknown] <= interval.lower + _AT_LIMIT
        longest = x[:, unknown] >= interval.upper - _AT_LIMIT
        free[:, unknown, unknown] -= (shorter & shortest) | (longer & longest)
    total = bends.sum(axis=1)
    normal = np.zeros(x.shape)
    normal[:, CURVATURES] = (bent * shapes.length[:, None, None]).reshape(count, -1)
    normal[:, LENGTH] = total
    normal = (free @ normal[..., None])[..., 0]
    squared = np.einsum("ni,ni->n", normal, normal)
    most = robot.link.max_total_bend * ARCS / robot.link.max_curvature
    held = (total * shapes.length >= most - _AT_LIMIT) & (squared > _AT_LIMIT)
    held &= np.einsum("ni,ni->n", slope, normal) < 0.0  # it would bend more
    free -= (held / np.maximum(squared, _TINY))[:, None, None] * normal[:, :, None] * normal[:, None, :]
    return free


def _lengths(robot: Robot) -> list[Interval]:
    """Return the limits of the unknowns that are lengths, m."""
    rigid = robot.rigid_link
    return [robot.link.length] if rigid.is_fixed else [robot.link.length, rigid.d35, rigid.d45]
