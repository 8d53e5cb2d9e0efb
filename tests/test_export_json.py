"""`solution.json` against the contract, read by a second implementation of its conventions."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from written import NOTHING, ROBOT, SOLUTION, make_solution, read_back

from synth.robot import (
    Arm,
    LinkShape,
)
from synth.synthesis import Design, showing, verify
from synth.task import PointTarget, Task

PAIRS = ["12", "13", "14", "23", "24", "34", "35", "45"]


def rotation(vector):
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * k @ k


def end_frame(content):
    """P2 and the link's end, by many small steps along each arc: nothing here is in closed form."""
    position, frame = np.array([0.0, 0.0, content["distances"]["12"]]), np.eye(3)
    for arc in content["link"]["arcs"]:
        (kx, ky), count = arc["curvature"], 2000
        step = arc["length"] / count
        half = rotation(0.5 * step * np.array([-ky, kx, 0.0]))
        for _ in range(count):
            position = position + step * (frame @ half)[:, 2]
            frame = frame @ half @ half
    return position, frame


def in_task(content, points):
    base = content["base"]
    return points @ rotation([0.0, 0.0, base["yaw"]]).T + base["position"]


def forward(content, tip_offset):
    """P5 of every target, from the arcs and the joint angles, as the interface describes it."""
    position, frame = end_frame(content)
    u, t = frame[:, 0], frame[:, 2]
    s, d34 = content["squared_distances"], content["distances"]["34"]
    along = (s["35"] - s["45"] + s["34"]) / (2.0 * d34)
    radius = math.sqrt(s["35"] - along**2)
    centre = position - tip_offset * u + along * u
    points = []
    for target in content["targets"]:
        theta1, theta2 = target["joints"]
        point = centre + radius * (-math.cos(theta2) * t - math.sin(theta2) * np.cross(u, t))
        points.append(rotation([0.0, 0.0, theta1]) @ point)
    return in_task(content, np.array(points))


@pytest.mark.parametrize("offset", [0.0, 1e-4, 5e-3])
def test_the_misses_follow_from_the_arcs_and_angles_alone(offset):
    content = read_back(make_solution(offset=offset))
    reached = forward(content, ROBOT.tip_offset)
    for target, point in zip(content["targets"], reached, strict=True):
        np.testing.assert_allclose(point, target["reached"], atol=1e-7)
        miss = np.linalg.norm(point - target["position"])
        assert miss == pytest.approx(target["miss"], abs=1e-7)
        assert target["within_tolerance"] == (target["miss"] <= target["tolerance"])
    assert content["status"] == ("found" if offset < 2e-3 else "best_effort")


def test_what_becomes_of_the_targets_is_found_out_once():
    solution = make_solution()
    assert solution.targets is solution.targets


def test_guide_distances_and_centreline_follow_from_the_arcs():
    content = read_back(SOLUTION)
    position, frame = end_frame(content)
    p3 = position - ROBOT.tip_offset * frame[:, 0]
    p4 = p3 + ROBOT.d34 * frame[:, 0]
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, ROBOT.d12], p3, p4])
    markers = np.array([content["guide"]["markers"][name] for name in ("P1", "P2", "P3", "P4")])
    joint1 = content["guide"]["hold"]["joint1"]
    assert ROBOT.joint_limits.base.contains(joint1)
    held = rotation([0.0, 0.0, joint1])
    np.testing.assert_allclose(markers, in_task(content, points @ held.T), atol=1e-7)
    for pair in PAIRS[:6]:
        i, j = (int(digit) - 1 for digit in pair)
        assert np.linalg.norm(markers[i] - markers[j]) == pytest.approx(content["distances"][pair])
        assert content["distances"][pair] ** 2 == pytest.approx(content["squared_distances"][pair])
    centreline = np.array(content["link"]["centreline"])
    np.testing.assert_allclose(
        centreline[[0, -1]], in_task(content, np.array([points[1], position])), atol=1e-7
    )
    steps = np.linalg.norm(np.diff(centreline, axis=0), axis=1)
    assert steps.max() <= 0.01
    assert steps.sum() == pytest.approx(content["link"]["length"], rel=1e-3)
    axis = content["guide"]["axis2"]
    np.testing.assert_allclose(axis["direction"], (markers[3] - markers[2]) / ROBOT.d34)
    elevation, heading = axis["elevation"], axis["heading"]
    level = math.cos(elevation)
    upwards = [level * math.cos(heading), level * math.sin(heading), math.sin(elevation)]
    np.testing.assert_allclose(axis["direction"], upwards, atol=1e-9)


def test_the_ways_lead_from_target_to_target():
    content = read_back(SOLUTION)
    assert [(way["from"], way["to"]) for way in content["ways"]] == [("t0", "t1"), ("t1", "t2")]
    for way, (start, end) in zip(content["ways"], pairwise(content["targets"]), strict=True):
        assert way["found"]
        assert way["joints"][0] in [start["joints"], *start["alternatives"]]
        assert way["joints"][-1] in [end["joints"], *end["alternatives"]]


def test_another_shape_is_written_on_request():
    both = make_solution()
    content = read_back(showing(replace(both, designs=both.designs), 2))
    assert content["shape"] == 2
    assert content["link"]["arcs"] == read_back(both)["alternatives"][0]["link"]["arcs"]
    assert [other["shape"] for other in content["alternatives"]] == [1]


def test_gamma_and_the_invariants_vanish_where_the_end_effector_is():
    content = read_back(SOLUTION)
    q, d12, inv = content["gamma"]["q"], content["distances"]["12"], content["invariants"]
    base = content["base"]
    reached = np.array([target["reached"] for target in content["targets"]]) - base["position"]
    x, y, z = (reached @ rotation([0.0, 0.0, base["yaw"]])).T
    n = x**2 + y**2 + z**2
    terms = [q[0] * n**2, q[1] * d12 * z * n, q[2] * (x**2 + y**2), q[3] * z**2, q[4] * d12 * z, q[5] + 0 * z]
    assert np.all(np.abs(sum(terms)) < 1e-10 * np.abs(terms).sum(axis=0))
    a, alpha, z0, h, radius = (inv[name] for name in ("a", "alpha", "z0", "h", "R"))
    zc, k = z0 + h * math.cos(alpha), a**2 + h**2 + radius**2
    form = (n - 2 * z0 * z + z0**2 - k) ** 2 + 4 * (a / math.sin(alpha)) ** 2 * (z - zc) ** 2
    np.testing.assert_allclose(form, 4 * a**2 * radius**2, atol=1e-10)


def test_the_fields_of_the_contract_are_there():
    content = read_back(SOLUTION)
    assert content["schema"] == "synth.solution/2"
    assert list(content["distances"]) == list(content["squared_distances"]) == PAIRS
    assert set(content["time"]) == {"total", "screening", "solving", "verifying", "proving"}
    assert (content["seed"], content["starts"], content["shape"]) == (7, 3, 1)
    assert content["category"] in {"general", "puma", "scara", "spherical"}
    assert set(content["category_distances"]) == {"puma", "scara", "spherical"}
    assert content["bound"] is None
    assert set(content["targets"][0]) == {
        "name", "position", "reached", "miss", "tolerance", "within_tolerance", "approach",
        "astray", "clearance", "joints", "alternatives",
    }  # fmt: skip
    assert set(content["guide"]["tolerance"]) >= {"position", "direction"}
    (other,) = content["alternatives"]
    assert set(other) == {
        "shape", "distances", "category", "base", "link", "rigid_link", "ways", "figures", "targets"
    }  # fmt: skip
    assert content["rigid_link"] == {"d35": 0.455, "d45": 0.460}
    assert other["shape"] == 2
    assert "centreline" not in other["link"]
    assert [target["name"] for target in other["targets"]] == ["t0", "t1", "t2"]


def test_other_postures_of_a_target_are_pairs_of_angles():
    """Straight up, the axes meet: targets have two postures, where the limits of the joints allow both."""
    arm = Arm(ROBOT, LinkShape([[0.0, 0.0]], [0.6]), 0.455, 0.460)
    target = PointTarget("t", arm.forward_kinematics(2.0, 2.5))
    task = Task("straight", ROBOT, (target,))
    design = Design(arm, verify(task, arm))
    content = read_back(replace(SOLUTION, task=task, designs=(design,)))
    (pair,) = content["targets"][0]["alternatives"]
    np.testing.assert_allclose(arm.forward_kinematics(*pair), target.position, atol=1e-6)
    assert content["link"]["min_bend_radius"] is None  # a straight link has an infinite one


def test_without_a_shape_the_targets_are_listed_and_the_rest_is_null():
    content = read_back(NOTHING)
    assert content["status"] == "failed"
    for field in (
        "distances", "squared_distances", "gamma", "invariants", "category", "category_distances", "base",
        "link", "guide", "bound",
    ):  # fmt: skip
        assert content[field] is None, field
    assert set(content) == set(read_back(SOLUTION))
    assert [target["name"] for target in content["targets"]] == ["t0", "t1", "t2"]
    assert all(target["miss"] is None and not target["within_tolerance"] for target in content["targets"])
    assert content["alternatives"] == []


def test_what_json_cannot_hold_is_null():
    task = replace(SOLUTION.task, robot=replace(ROBOT, link=replace(ROBOT.link, max_total_bend=math.inf)))
    assert read_back(replace(SOLUTION, task=task))["task"]["robot"]["link"]["max_total_bend"] is None


def test_a_task_that_is_not_met_has_no_tolerance_to_keep_and_no_ways():
    missed = read_back(make_solution(tolerance=1e-4, offset=0.02))
    assert missed["guide"]["tolerance"] is None
    assert missed["guide"]["forgiveness"] is None
    assert missed["ways"] == []
    met = read_back(SOLUTION)["guide"]
    assert 0.0 <= met["forgiveness"]["chance"] <= 1.0
    assert met["forgiveness"]["expected_worst_miss"] > 0.0
