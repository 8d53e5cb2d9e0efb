"""What may collide holds tube, rod and column, and exceeds them by little, in each format."""

import numpy as np
import pytest
from robot_files import (
    Piece,
    Urdf,
    arms,
    exported_arm,
    mjcf,
    numbers,
    off_the_centreline,
    tube_surface,
)
from ruamel.yaml import YAML

ARMS = arms()
exported = pytest.fixture(scope="module", params=ARMS)(exported_arm)


EXCESS = 2e-3  # m, as the format's page says


def held(pieces, points):
    """Return how deep points are in the deepest of some pieces."""
    return np.max([piece.depth(points) for piece in pieces], axis=0)


def test_the_pieces_hold_the_tube_and_exceed_it_by_little(exported):
    arm, folder = exported
    rng = np.random.default_rng(3)
    pieces = Urdf(folder / "robot.urdf").pieces("malleable_link")
    assert held(pieces, tube_surface(arm, rng)).min() > -1e-7
    points = np.concatenate([piece.surface(rng, 40) for piece in pieces])
    assert (off_the_centreline(arm, points) - 0.5 * arm.robot.link.diameter).max() < EXCESS


def test_the_pieces_hold_rod_and_column_and_exceed_them_by_little(exported):
    arm, folder = exported
    urdf, rng = Urdf(folder / "robot.urdf"), np.random.default_rng(3)
    radius = 0.5 * arm.robot.rigid_link.diameter
    offset, circle = arm.robot.end_effector_circle(arm.d35, arm.d45)
    tip = np.array([float(offset), 0.0, -float(circle)])
    pieces = urdf.pieces("rigid_link")
    side = np.cross(tip, [0.0, 1.0, 0.0])
    side *= radius / np.linalg.norm(side)
    for across in (side, -side):
        assert held(pieces, np.linspace(0.0, 1.0, 200)[:, None] * tip + across).min() > -1e-12
    for piece in pieces:
        assert piece.radius <= radius + EXCESS
        for end in (piece.start, piece.end):
            np.testing.assert_allclose(np.cross(end, tip), 0.0, atol=1e-12)
    (column,) = urdf.pieces("base_link")
    np.testing.assert_allclose([column.start, column.end], [[0, 0, 0], [0, 0, arm.robot.d12]], atol=1e-12)
    assert 0.0 <= column.radius - 0.5 * arm.robot.link.diameter <= EXCESS
    assert len(column.surface(rng, 10)) == 10


def test_the_capsules_of_the_mjcf_hold_the_tube(exported):
    arm, folder = exported
    body = mjcf(folder).find("worldbody/body/body")
    assert body.get("name") == "malleable_link"
    ends = [(*np.split(numbers(g.get("fromto")), 2), float(g.get("size"))) for g in body.findall("geom")]
    pieces = [Piece(start, end, radius, capped=True) for start, end, radius in ends]
    rng = np.random.default_rng(3)
    assert held(pieces, tube_surface(arm, rng)).min() > -1e-7
    points = np.concatenate([piece.surface(rng, 60) for piece in pieces])
    assert (off_the_centreline(arm, points) - 0.5 * arm.robot.link.diameter).max() < EXCESS


def test_the_spheres_of_the_xrdf_hold_the_tube_and_the_rod(exported):
    arm, folder = exported
    content = YAML(typ="safe").load((folder / "robot.xrdf").read_text())
    assert (content["format"], content["format_version"]) == ("xrdf", 1.0)
    assert content["cspace"]["joint_names"] == ["joint1", "joint2"]
    assert content["tool_frames"] == ["tool0"]
    links = content["geometry"][content["collision"]["geometry"]]["spheres"]
    balls = {
        link: [Piece(np.array(s["center"]), np.array(s["center"]), s["radius"]) for s in spheres]
        for link, spheres in links.items()
    }
    rng = np.random.default_rng(3)
    assert held(balls["malleable_link"], tube_surface(arm, rng)).min() > -1e-7
    points = np.concatenate([ball.surface(rng, 40) for ball in balls["malleable_link"]])
    assert (off_the_centreline(arm, points) - 0.5 * arm.robot.link.diameter).max() < EXCESS
    offset, circle = arm.robot.end_effector_circle(arm.d35, arm.d45)
    tip = np.array([float(offset), 0.0, -float(circle)])
    radius, share = 0.5 * arm.robot.rigid_link.diameter, np.linspace(0.0, 1.0, 3000)[:, None]
    side = np.cross(tip, [0.0, 1.0, 0.0])
    side *= radius / np.linalg.norm(side)
    assert held(balls["rigid_link"], share * tip + side).min() > -1e-9
    assert all(ball.radius <= radius + EXCESS for ball in balls["rigid_link"])
