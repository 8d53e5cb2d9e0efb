import numpy as np
import pytest
from oracle import distance_from_solid

from synth.geometry import Box, Capsule, Sphere, rotation_of

RNG = np.random.default_rng(5)
SOLIDS = [
    *(Box(RNG.uniform(-1, 1, 3), RNG.uniform(0.05, 1, 3), RNG.uniform(-4, 4)) for _ in range(6)),
    *(Capsule(RNG.uniform(-1, 1, (2, 3)), RNG.uniform(0.05, 0.5)) for _ in range(4)),
    Sphere(RNG.uniform(-1, 1, 3), 0.4),
]
POINTS = RNG.uniform(-2, 2, (4000, 3))


@pytest.fixture(params=SOLIDS, ids=lambda solid: type(solid).__name__)
def solid(request):
    return request.param


def test_distance_is_the_textbook_one(solid):
    assert solid.distance(POINTS) == pytest.approx(distance_from_solid(solid, POINTS), abs=1e-12)


def test_outward_is_the_gradient_of_the_distance(solid):
    step = 1e-6
    slopes = [
        (solid.distance(POINTS + step * e) - solid.distance(POINTS - step * e)) / (2 * step)
        for e in np.eye(3)
    ]
    off = np.linalg.norm(np.stack(slopes, axis=-1) - solid.outward(POINTS), axis=1)
    assert np.quantile(off, 0.99) < 1e-5  # but for the few points beside a crease


def test_a_step_along_the_gradient_leads_to_the_surface(solid):
    outside = POINTS[solid.distance(POINTS) > 0]
    surface = outside - solid.distance(outside)[:, None] * solid.outward(outside)
    assert solid.distance(surface) == pytest.approx(0, abs=1e-12)


def test_support_leaves_the_whole_solid_on_one_side_and_touches_it(solid):
    directions = RNG.normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    support = solid.support(directions)
    # From far away along n, the nearest point of the solid is where it is supported.
    inside = POINTS[solid.distance(POINTS) <= 0]
    assert ((inside @ directions.T) <= support + 1e-12).all()
    assert solid.distance(50 * directions) == pytest.approx(50 - support, rel=0.1)
    outside = POINTS[solid.distance(POINTS) > 1e-3]
    normal = solid.outward(outside)
    apart = np.einsum("ij,ij->i", normal, outside) - solid.support(normal)
    assert apart == pytest.approx(solid.distance(outside), abs=1e-12)


def test_seen_from_another_frame_nothing_moves(solid):
    position = np.array([0.3, -0.2, 0.5])
    turned = rotation_of(0.0, 0.0, 0.7) @ rotation_of(0.9, -0.4, 0.0)
    there = (POINTS - position) @ turned
    assert solid.seen_from(position, turned).distance(there) == pytest.approx(
        solid.distance(POINTS), abs=1e-12
    )


def test_on_the_axis_of_a_capsule_outward_is_across_it():
    capsule = Capsule(np.array([[0.0, 0, 0], [1.0, 1, 0]]), 0.2)
    outward = capsule.outward(np.array([[0.5, 0.5, 0.0]]))[0]
    assert np.linalg.norm(outward) == pytest.approx(1)
    assert outward @ [1, 1, 0] == pytest.approx(0)
    assert np.linalg.norm(Sphere([0, 0, 0], 1.0).outward(np.zeros((1, 3)))[0]) == pytest.approx(1)
