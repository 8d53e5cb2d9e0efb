"""End poses with a known answer: links bent at random, their ends; and poses meant to be out of their reach.

The links have three to six arcs of unequal length, which the equal arcs of the search can only imitate.
"""

from dataclasses import replace

import numpy as np
from planted import ROBOT

from synth.robot import Interval, LinkReach, LinkShape, MalleableLink


def random_link(rng):
    """Return hardware of another size: of fixed length or not, with a limit of the total bend or not."""
    radius = rng.uniform(0.05, 0.2)
    lower = radius * rng.uniform(1.5, 6.5)
    upper = lower * rng.choice([1.0, rng.uniform(1.0, 1.4)])
    most = rng.choice([np.inf, upper / radius * rng.uniform(0.4, 1.0)])
    return MalleableLink(Interval(lower, upper), radius, 0.0, float(most))


def links(count, rng):
    """Return the preset's link and random ones, in turn."""
    return [ROBOT.link if i % 2 == 0 else random_link(rng) for i in range(count)]


def bent(link, rng, *, at_limits=False):
    """Return a link of three to six unequal arcs; at its limits, most are bent as far as they can be."""
    arcs, limits = int(rng.integers(3, 7)), link.length
    length = rng.uniform(limits.lower, limits.upper)
    bends = np.sqrt(rng.uniform(size=arcs))
    if at_limits:
        length = rng.choice([limits.lower, length, limits.upper])
        bends = np.where(rng.uniform(size=arcs) < 0.7, 1.0, bends)
    shares = rng.uniform(0.5, 1.5, arcs)
    lengths = length * shares / shares.sum()
    total = float(bends @ lengths) / link.min_bend_radius
    bends *= min(link.max_total_bend / total, 1.0) * link.max_curvature
    turns = rng.uniform(0.0, 2.0 * np.pi, arcs)
    return LinkShape(bends[:, None] * np.column_stack([np.cos(turns), np.sin(turns)]), lengths)


def pose_of(shape):
    """Return the end's position and axis 2 at joint 1 = 0."""
    frame, position = shape.end_frame()
    return position, frame[:, 0]


def planted_poses(link, count, rng):
    """Return poses that a link has, every other one at its limits: positions and axes, shape (count, 3)."""
    poses = [pose_of(bent(link, rng, at_limits=i % 2 == 1)) for i in range(count)]
    return tuple(np.array(part) for part in zip(*poses, strict=True))


def stiff_link(rng):
    """Return hardware that bends little in all."""
    return replace(random_link(rng), max_total_bend=rng.uniform(0.4, 1.5))


def hopeless_pose(link, rng):
    """Return a pose that is likely out of reach: too far, too near, or at the rim with an awkward axis 2."""
    direction, axis = rng.normal(size=3), rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    kind = rng.integers(8)
    if kind == 0:
        return link.length.upper * rng.uniform(1.0, 1.3) * direction, axis
    if kind == 1:
        return link.length.lower * rng.uniform(0.0, 0.15) * direction, axis
    reach = LinkReach(link)
    positions = reach.sample(20, seed=int(rng.integers(2**31)))
    position = positions[np.argmin(reach.margin(positions))]
    along = np.array([0.0, 0.0, 1.0]) if kind < 5 else position / np.linalg.norm(position)
    return position, along + 0.2 * axis


def keeps_the_limits(link, shape):
    """Whether the hardware can take a shape."""
    return (
        link.length.contains(shape.length, 1e-12)
        and shape.bends.max() <= link.max_curvature
        and shape.total_bend <= link.max_total_bend
    )


def missed_by(shape, position, axis):
    """Return how far a shape's end is from a pose, in m and rad, whatever joint 1 does.

    Written out on its own: of two vectors that turn about z together, what counts is how far each is from
    the axis, how high, and the angle between their horizontal parts.
    """
    p, u = pose_of(shape)
    target = np.asarray(position), np.asarray(axis)
    flat = [(complex(*a[:2]), complex(*b[:2])) for a, b in ((p, target[0]), (u, target[1]))]
    turn = np.angle(sum(b * a.conjugate() for a, b in flat))
    (p_flat, p_wanted), (u_flat, u_wanted) = flat
    spin = np.exp(1j * turn)
    off = np.hypot(abs(spin * p_flat - p_wanted), p[2] - target[0][2])
    return float(off), float(np.hypot(abs(spin * u_flat - u_wanted), u[2] - target[1][2]))
