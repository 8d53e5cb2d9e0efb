"""From end poses to links and back: planted poses are found, impossible ones proven, both never."""

import numpy as np
import pytest
from planted import ROBOT
from planted_poses import (
    bent,
    hopeless_pose,
    keeps_the_limits,
    missed_by,
    planted_poses,
    pose_of,
    random_link,
)

from synth.robot import (
    Interval,
    LinkShape,
    MalleableLink,
    link_to_pose,
    links_to_poses,
    pose_miss,
    why_no_link,
)
from synth.robot.arc_chains import ArcChains

AT_ZERO = Interval.fixed(0.0)
LINK = ROBOT.link
UP, ACROSS = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


@pytest.mark.parametrize("seed", range(3))
def test_planted_poses_are_found_with_joint_1_anywhere(seed):
    rng = np.random.default_rng(seed)
    link = LINK if seed == 0 else random_link(rng)
    positions, axes = planted_poses(link, 24, rng)
    for shape, position, axis in zip(links_to_poses(link, positions, axes), positions, axes, strict=True):
        assert shape is not None
        assert max(missed_by(shape, position, axis)) < 1e-8
        assert keeps_the_limits(link, shape)
        assert len(shape.lengths) >= 3


def test_planted_poses_are_found_in_the_frame_that_the_link_starts_in():
    positions, axes = planted_poses(LINK, 24, np.random.default_rng(3))
    for shape, position, axis in zip(
        links_to_poses(LINK, positions, axes, theta1=AT_ZERO), positions, axes, strict=True
    ):
        end, direction = pose_of(shape)
        assert np.linalg.norm(end - position) < 1e-8
        assert np.linalg.norm(direction - axis) < 1e-8
        assert keeps_the_limits(LINK, shape)


def test_joint_1_stays_within_its_limits():
    positions, axes = planted_poses(LINK, 12, np.random.default_rng(4))
    limits = ROBOT.joint_limits.base
    shapes = links_to_poses(LINK, positions, axes, theta1=limits)
    assert sum(shape is not None for shape in shapes) >= 11
    for shape, position, axis in zip(shapes, positions, axes, strict=True):
        if shape is not None:
            miss = pose_miss(shape, position, axis, theta1=limits)
            assert limits.contains(miss.theta1)
            assert max(miss.position, miss.axis) < 1e-8


def test_a_straight_link_is_the_gentlest_and_is_found():
    shape = link_to_pose(LINK, 0.6 * UP, ACROSS)
    assert shape.bending_energy < 1e-6
    assert shape.length == pytest.approx(0.6, abs=1e-6)


def test_the_gentlest_link_is_gentler_than_the_planted_one():
    rng = np.random.default_rng(5)
    planted = [bent(LINK, rng) for _ in range(12)]
    poses = [pose_of(shape) for shape in planted]
    found = links_to_poses(LINK, *(np.array(part) for part in zip(*poses, strict=True)), theta1=AT_ZERO)
    for shape, other in zip(found, planted, strict=True):
        assert shape.bending_energy < other.bending_energy


def test_least_energy_is_a_minimum_among_links_of_the_same_pose():
    # Chains of the same arcs that have the pose, nearby: none is gentler.
    rng = np.random.default_rng(6)
    position, axis = pose_of(bent(LINK, rng))
    best = link_to_pose(LINK, position, axis, theta1=AT_ZERO)
    for _ in range(4):
        change = rng.normal(scale=0.3, size=best.curvatures.shape)
        start = LinkShape(best.curvatures + change, best.lengths)
        other = link_to_pose(LINK, position, axis, theta1=AT_ZERO, current=start)
        assert other.bending_energy >= best.bending_energy * (1.0 - 1e-5)


def change_between(shape, other):
    """Return the mean square of r (k - k') along the centreline plus that of the length's relative change."""
    share = (np.arange(720) + 0.5) / 720
    k, k_other = (
        one.curvatures[np.searchsorted(np.cumsum(one.lengths) / one.length, share)] for one in (shape, other)
    )
    bend = LINK.min_bend_radius**2 * np.mean(np.sum((k - k_other) ** 2, axis=1))
    return bend + ((shape.length - other.length) / LINK.length.middle) ** 2


def test_the_nearest_link_changes_less_than_the_gentlest_and_no_more_than_any_planted_one():
    rng, compared = np.random.default_rng(7), 0
    for _ in range(4):
        current = ArcChains(LINK, 12).shape(ArcChains(LINK, 12).random(1, rng, 3)[0])
        k = current.curvatures + rng.normal(scale=0.4, size=current.curvatures.shape)
        k *= np.minimum(LINK.max_curvature / np.linalg.norm(k, axis=1), 1.0)[:, None]
        planted = LinkShape(k, current.lengths)
        if not keeps_the_limits(LINK, planted):
            continue
        position, axis = pose_of(planted)
        gentlest = link_to_pose(LINK, position, axis, theta1=AT_ZERO)
        nearest = link_to_pose(LINK, position, axis, theta1=AT_ZERO, current=current)
        assert change_between(nearest, current) < change_between(gentlest, current)
        assert change_between(nearest, current) < change_between(planted, current)
        compared += 1
    assert compared >= 2


def test_a_link_that_has_the_pose_stays_as_it_is():
    current = bent(LINK, np.random.default_rng(8))
    assert link_to_pose(LINK, *pose_of(current), current=current) is current


def test_the_same_seed_gives_the_same_link():
    pose = pose_of(bent(LINK, np.random.default_rng(9)))
    first, again = (link_to_pose(LINK, *pose, seed=1) for _ in range(2))
    assert np.array_equal(first.curvatures, again.curvatures)


def test_no_pose_is_both_found_and_impossible():
    rng = np.random.default_rng(10)
    for link in (LINK, random_link(rng)):
        poses = [hopeless_pose(link, rng) for _ in range(5)]
        shapes = links_to_poses(link, *(np.array(part) for part in zip(*poses, strict=True)))
        reasons = [why_no_link(link, *pose) for pose in poses]
        assert sum(map(bool, reasons)) >= 2
        assert not any(shape and reason for shape, reason in zip(shapes, reasons, strict=True))


@pytest.mark.parametrize("seed", range(5))
def test_no_pose_that_a_link_takes_is_called_impossible(seed):
    rng = np.random.default_rng([11, seed])
    link = LINK if seed == 0 else random_link(rng)
    for position, axis in zip(*planted_poses(link, 30, rng), strict=True):
        assert not why_no_link(link, position, axis)


@pytest.mark.parametrize("turn", [1.5, 3.0, 4.9])
def test_no_pose_of_an_extremal_link_is_called_impossible(turn):
    # Bent to the limit all along in a plane, or with a straight: the ends of the conditions themselves.
    radius = 0.1
    link = MalleableLink(Interval.fixed(turn * radius), radius)
    for pieces in ([1.0], [1.0, 0.0], [0.0, 1.0], [1.0, -1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]):
        k = np.column_stack([pieces, np.zeros(len(pieces))]) / radius
        position, axis = pose_of(LinkShape(k, np.full(len(pieces), turn * radius / len(pieces))))
        assert not why_no_link(link, position, axis)
        assert not why_no_link(link, position, np.array([0.0, 1.0, 0.0]))  # across the plane


def test_a_link_that_cannot_turn_enough_says_how_far_it_would_have_to():
    link = MalleableLink(Interval(0.5, 0.6), 0.1, 0.0, np.radians(60.0))
    reason = why_no_link(link, [0.2, 0.0, 0.4], UP)
    assert reason == "the link would have to turn more than 90.0 deg; 60.0 deg is its limit"
    assert link_to_pose(link, [0.2, 0.0, 0.4], UP) is None


def test_a_link_that_cannot_bend_on_says_so_where_the_position_asks_for_more_than_the_direction():
    # Back to its own height across the start: half a turn and more, though axis 2 asks for no turn.
    link = MalleableLink(Interval(0.5, 0.6), 0.1, 0.0, np.radians(80.0))
    reason = why_no_link(link, [0.35, 0.0, 0.1], [0.0, 1.0, 0.0])
    assert "the link would have to turn more than" in reason
    assert "80.0 deg is its limit" in reason


def test_a_link_that_is_too_short_says_how_long_it_would_have_to_be():
    # Straight up and then a quarter turn in the tightest bend, for axis 2 along z and the end r beside the
    # axis: L = h + (pi/2 - 1) r. At least that long is needed; less is proven too little.
    radius, height = 0.1, 0.5
    needed = height + (0.5 * np.pi - 1.0) * radius
    short = MalleableLink(Interval(0.3, needed - 2e-3), radius)
    reason = why_no_link(short, [radius, 0.0, height], UP)
    assert "the link would have to be more than" in reason
    said = float(reason.split("more than ")[1].split(" mm")[0])
    # Rounded down, to as many digits as it takes to tell it from what the link is.
    assert 1e3 * (needed - 2e-3) - 1e-6 <= said <= 1e3 * needed
    enough = MalleableLink(Interval(0.3, needed + 1e-3), radius)
    assert not why_no_link(enough, [radius, 0.0, height], UP)
    assert link_to_pose(enough, [radius, 0.0, height], UP) is not None


def test_a_position_out_of_reach_says_by_how_much():
    assert "300.0 mm away" in why_no_link(LINK, 1.0 * UP, ACROSS)


def test_ends_and_their_derivatives_are_those_of_the_shapes():
    chains, rng = ArcChains(LINK, 6), np.random.default_rng(12)
    x = chains.random(8, rng)
    x[0, :4], x[1] = 0.0, 1e-3 * x[1]  # straight arcs, and nearly straight ones
    ends, step = chains.ends(x), 1e-6
    for row in range(len(x)):
        frame, position = chains.shape(x[row]).end_frame()
        assert np.allclose(LINK.min_bend_radius * ends.position[row], position, rtol=0, atol=1e-12)
        assert np.allclose(ends.frame[row], frame, rtol=0, atol=1e-12)
    for i, direction in enumerate(step * np.eye(x.shape[1])):
        ahead, behind = chains.ends(x + direction), chains.ends(x - direction)
        slope = (ahead.position - behind.position) / (2.0 * step)
        assert np.allclose(slope, ends.d_position[..., i], rtol=0, atol=1e-8)
        turning = (ahead.frame - behind.frame) / (2.0 * step)
        turned = np.cross(ends.rotation[..., None, i], ends.frame, axis=1)
        assert np.allclose(turning, turned, rtol=0, atol=1e-8)


@pytest.mark.parametrize("bend", [1.5, np.inf])
def test_the_projection_into_the_limits_is_orthogonal_and_its_derivative_right(bend):
    link = MalleableLink(Interval(0.4, 0.6), 0.1, 0.0, bend)
    chains, rng = ArcChains(link, 5), np.random.default_rng(13)
    length = np.full(40, 5.0)
    x = rng.normal(scale=1.5, size=(40, 11))
    near, projection = chains.projected(x, length)
    others = chains.projected(rng.normal(size=(40, 11)), length)[0]
    assert np.max(np.sum((x - near) * (others - near), axis=1)) < 1e-8
    jacobian, step = np.broadcast_to(np.eye(11), (40, 11, 11)), 1e-7
    slopes = [(chains.projected(x + step * e, length)[0] - near) / step for e in np.eye(11)]
    assert np.median(np.abs(np.stack(slopes, axis=-1) - projection.between(jacobian))) < 1e-6
    assert np.abs(np.stack(slopes, axis=-1) - projection.between(jacobian)).max() < 1e-4
