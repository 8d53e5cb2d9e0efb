"""Robot descriptions: where they put an arm, read with the standard library alone."""

import json
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from robot_files import (
    Urdf,
    about,
    arms,
    exported_arm,
    matrix,
    mjcf,
    numbers,
    random_joints,
)

from synth.export.planners.inertia import inertia_of
from synth.export.planners.pieces import tube_pieces

ARMS = arms()
exported = pytest.fixture(scope="module", params=ARMS)(exported_arm)


def test_the_end_of_the_urdf_is_where_the_arm_says(exported):
    arm, folder = exported
    urdf, joints = Urdf(folder / "robot.urdf"), random_joints(arm)
    reached = [urdf.poses(each)["tool0"][:3, 3] for each in joints]
    np.testing.assert_allclose(reached, arm.forward_kinematics(*joints.T), atol=1e-9)


def test_frames_stand_as_told(exported):
    arm, folder = exported
    urdf = Urdf(folder / "robot.urdf")
    joints = random_joints(arm, 1)[0]
    poses = urdf.poses(joints)
    np.testing.assert_allclose(poses["base_link"][:3, 3], arm.base.position, atol=1e-12)
    turn = arm.base.rotation @ about(2, joints[0])
    p3, p4 = arm.axis_points[2:]
    np.testing.assert_allclose(poses["rigid_link"][:3, 0], turn @ (p4 - p3) / arm.robot.d34, atol=1e-9)
    np.testing.assert_allclose(poses["tool0"][:3, 0], poses["rigid_link"][:3, 0], atol=1e-12)
    end, tool = poses["rigid_link"][:3, 3], poses["tool0"]
    across = tool[:3, 3] - end - ((tool[:3, 3] - end) @ tool[:3, 0]) * tool[:3, 0]
    np.testing.assert_allclose(across / np.linalg.norm(across), tool[:3, 2], atol=1e-9)


def test_limits_are_complete_and_every_body_has_an_inertia(exported):
    arm, folder = exported
    root = Urdf(folder / "robot.urdf").root
    bounds = arm.joint_bounds
    for number, name in enumerate(("joint1", "joint2")):
        limit = next(j for j in root.findall("joint") if j.get("name") == name).find("limit").attrib
        assert (float(limit["lower"]), float(limit["upper"])) == tuple(bounds[:, number])
        assert float(limit["effort"]) > 0.0
        assert float(limit["velocity"]) == pytest.approx(25 * 2 * np.pi / 60)
    for link in root.findall("link"):
        if link.get("name") == "world":
            continue
        inertia = {key: float(value) for key, value in link.find("inertial/inertia").attrib.items()}
        x, y, z = (inertia[key] for key in ("ixx", "iyy", "izz"))
        off = [[x, inertia["ixy"], inertia["ixz"]], [0, y, inertia["iyz"]], [0, 0, z]]
        least, middle, most = np.linalg.eigvalsh(np.array(off).T)
        assert least > 0.0
        assert most <= least + middle + 1e-15
        assert float(link.find("inertial/mass").get("value")) > 0.0


def test_the_inertia_is_that_of_a_cloud_of_points():
    arm = ARMS["a quarter turn"]
    chain = tube_pieces(arm.shape, arm.base_joint[1], 0.025)
    inertia = inertia_of(chain, 1000.0)
    rng, points = np.random.default_rng(0), []
    for start, end in zip(chain.knees[:-1], chain.knees[1:], strict=True):
        along = (end - start) / np.linalg.norm(end - start)
        side = np.cross(along, [0.0, 1.0, 0.0])
        radius, angle = chain.radius * np.sqrt(rng.uniform(size=20_000)), rng.uniform(0, 2 * np.pi, 20_000)
        disc = radius[:, None] * (
            np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * np.cross(along, side)
        )
        points.append(start + rng.uniform(size=(20_000, 1)) * (end - start) + disc)
    points = np.concatenate(points)
    np.testing.assert_allclose(inertia.centre, points.mean(axis=0), atol=2e-3)
    off = points - points.mean(axis=0)
    moments = np.mean(np.sum(off**2, axis=1)) * np.eye(3) - off.T @ off / len(off)
    np.testing.assert_allclose(inertia.moments / inertia.mass, moments, atol=3e-4)


def mjcf_sites(folder, joints):
    """Return where the sites of a MJCF model are at joint angles, by their names."""
    sites, angles = {}, dict(zip(("joint1", "joint2"), joints, strict=True))

    def walk(body, pose):
        for joint in body.findall("joint"):
            turn = np.eye(4)
            axis = numbers(joint.get("axis"))
            turn[:3, :3] = about(int(np.argmax(axis)), angles[joint.get("name")])
            pose = pose @ turn
        for site in body.findall("site"):
            sites[site.get("name")] = (pose @ matrix(site))[:3, 3]
        for inner in body.findall("body"):
            walk(inner, pose @ matrix(inner))

    walk(mjcf(folder).find("worldbody"), np.eye(4))
    return sites


def test_the_sites_of_the_mjcf_are_the_points_of_the_arm(exported):
    arm, folder = exported
    joints = random_joints(arm, 200)
    sites = [mjcf_sites(folder, each) for each in joints]
    np.testing.assert_allclose([s["P5"] for s in sites], arm.forward_kinematics(*joints.T), atol=1e-9)
    for site, (theta1, _) in zip(sites[:20], joints, strict=False):
        marked = np.array([site[name] for name in ("P1", "P2", "P3", "P4")])
        np.testing.assert_allclose(marked, arm.base.to_task(arm.axis_points @ about(2, theta1).T), atol=1e-9)


def test_targets_are_sites_states_and_keys(exported):
    arm, folder = exported
    names = ["pick", "place_it", "place_it__2", "_3rd"]
    srdf = ET.parse(folder / "robot.srdf").getroot()
    states = {state.get("name"): state for state in srdf.findall("group_state")}
    assert list(states) == names
    keys = {key.get("name"): numbers(key.get("qpos")) for key in mjcf(folder).findall("keyframe/key")}
    sites = mjcf_sites(folder, [0.0, 0.0])
    for name in names:
        joints = [float(joint.get("value")) for joint in states[name].findall("joint")]
        np.testing.assert_allclose(arm.forward_kinematics(*joints), sites[f"target_{name}"], atol=1e-9)
        np.testing.assert_array_equal(keys[name], joints)
    pairs = [(each.get("link1"), each.get("link2")) for each in srdf.findall("disable_collisions")]
    assert ("malleable_link", "rigid_link") in pairs
    chain = srdf.find("group/chain").attrib
    assert chain == {"base_link": "base_link", "tip_link": "tool0"}


def test_the_dh_parameters_lead_to_the_end_effector(exported):
    arm, folder = exported
    content = json.loads((folder / "dh.json").read_text())
    joints = random_joints(arm, 200)
    for each in joints:
        pose = np.eye(4)
        for angle, row in zip(each, content["joints"], strict=True):
            step = np.eye(4)
            step[:3, :3] = about(2, angle + row["offset"])
            moved, tilted = np.eye(4), np.eye(4)
            moved[:3, 3] = [row["a"], 0.0, row["d"]]
            tilted[:3, :3] = about(0, row["alpha"])
            pose = pose @ step @ moved @ tilted
        base = arm.base.to_task(pose[:3, 3])
        np.testing.assert_allclose(base, arm.forward_kinematics(*each), atol=1e-9)
    assert content["convention"].startswith("standard Denavit-Hartenberg")
