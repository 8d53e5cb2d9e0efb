"""As arms come close to a special case, surface and zone come close to its own."""

from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose
from strategies import LONG, end_effector, make_arm

from synth.geometry import CategoryDistances, Invariants, SweptCircle, WorkspaceSurface


class Approach(NamedTuple):
    """A special arm, general arms near it, and what its reduced surface is."""

    category: str
    family: str
    offset: float  # puts P3 on P1, or P4 on P2

    @property
    def limit(self):
        return make_arm(self.family, baselines=LONG | {"offset": self.offset})

    def arm(self, step):
        """The circle moved and its axis tilted by about `step`, in no special direction."""
        circle = self.limit.circle
        return SweptCircle(
            circle.centre + step * np.array([0.6, -0.7, 0.4]),
            circle.axis + step * np.array([0.5, 0.3, 0.8]),
            circle.radius,
        )

    def reduced(self, p):
        """Height of points over the sphere or plane, in the paper's distances."""
        distances = self.limit.distances
        if self.category == "spherical":
            return np.linalg.norm(p, axis=-1) - np.sqrt(distances.s35)
        if self.category == "puma":
            return np.linalg.norm(p - [0, 0, self.limit.d12], axis=-1) - np.sqrt(distances.s45)
        return p[..., 2] - self.limit.circle.centre[2]

    def square(self, p):
        """The limit of Gamma / -(s12 s34 / 4): that of the test of each special case."""
        if self.category == "scara":
            return 4.0 * np.sum(self.limit.circle.centre[:2] ** 2) * self.reduced(p) ** 2
        s35_or_s45 = {"spherical": self.limit.distances.s35, "puma": self.limit.distances.s45}[self.category]
        height = self.reduced(p)
        sphere = height * (height + 2.0 * np.sqrt(s35_or_s45))
        return np.sin(self.limit.alpha) ** 2 * sphere**2

    def gamma(self, circle, p):
        """Gamma / -(s12 s34 / 4) of an arm, by way of its distances."""
        limit = self.limit
        distances = circle.squared_distances(limit.d12, limit.d34, limit.offset)
        value = WorkspaceSurface.from_squared_distances(distances).value(p)
        return value / (-0.25 * distances.s12 * distances.s34)

    def distance(self, circle):
        """How far the arm is from the category, m or rad."""
        found = CategoryDistances.from_invariants(Invariants.from_circle(circle), self.limit.d12)
        return getattr(found, self.category)


H = 0.3  # of make_arm: from the common normal to the centre
APPROACHES = [
    Approach("spherical", "at P1", H),
    Approach("puma", "at P2", LONG["d34"] + H),
    Approach("scara", "parallel", 0.25),
]
STEPS = 10.0 ** -np.arange(2.0, 6.0)
ANYWHERE = np.random.default_rng(5).uniform(-1.0, 1.0, (60, 3))
every_category = pytest.mark.parametrize("approach", APPROACHES, ids=lambda approach: approach.category)


def assert_order(order, errors, distances):
    """Errors are in the limit a constant times the distance to this power, and the constant is not 0."""
    constants = np.array(errors) / np.array(distances) ** order
    assert_allclose(constants[1:-1], constants[-1], rtol=0.02)
    assert 0.01 < constants[-1] < 100.0


@every_category
class TestLimits:
    def test_the_marked_points_stand_where_the_paper_has_them(self, approach):
        p1, p2, p3, p4 = approach.limit.axis_points
        if approach.category == "spherical":
            assert_allclose(p3, p1, rtol=0, atol=1e-15)
        if approach.category == "puma":
            assert_allclose(p4, p2, rtol=0, atol=1e-15)
        assert approach.distance(approach.limit.circle) < 1e-15

    def test_gamma_of_the_special_arm_is_the_square(self, approach):
        found = approach.gamma(approach.limit.circle, ANYWHERE)
        assert_allclose(found, approach.square(ANYWHERE), rtol=0, atol=1e-13)

    def test_gamma_tends_to_the_square_linearly(self, approach):
        arms = [approach.arm(step) for step in STEPS]
        errors = [np.max(np.abs(approach.gamma(a, ANYWHERE) - approach.square(ANYWHERE))) for a in arms]
        assert_order(1, errors, [approach.distance(arm) for arm in arms])

    def test_the_workspace_tends_to_the_sphere_or_plane_linearly(self, approach):
        arms = [approach.arm(step) for step in STEPS]
        poses = np.linspace(-np.pi, np.pi, 400)
        errors = [np.max(np.abs(approach.reduced(end_effector(arm, 0.0, poses)))) for arm in arms]
        assert_order(1, errors, [approach.distance(arm) for arm in arms])

    def test_the_special_workspace_is_found_beside_that_of_the_general_arm(self, approach):
        arms = [approach.arm(step) for step in STEPS]
        zone = end_effector(approach.limit.circle, 0.0, np.linspace(-np.pi, np.pi, 24))
        assert_order(
            1, [np.max(arm.distance(zone)) for arm in arms], [approach.distance(arm) for arm in arms]
        )


@pytest.mark.parametrize("approach", APPROACHES[:2], ids=lambda approach: approach.category)
def test_gamma_hides_a_gap_of_the_axes_by_its_square(approach):
    # The distance of the axes alone enters Gamma squared, and the surface still linearly: it is the root.
    limit = approach.limit
    normal = np.cross([0.0, 0.0, 1.0], limit.circle.axis)
    normal /= np.linalg.norm(normal)
    arms = [
        SweptCircle(limit.circle.centre + step * normal, limit.circle.axis, limit.circle.radius)
        for step in STEPS
    ]
    assert_allclose([approach.distance(arm) for arm in arms], STEPS, rtol=1e-8)
    errors = [np.max(np.abs(approach.gamma(arm, ANYWHERE) - approach.square(ANYWHERE))) for arm in arms]
    assert_order(2, errors[:-1], STEPS[:-1])
    poses = np.linspace(-np.pi, np.pi, 400)
    heights = [np.max(np.abs(approach.reduced(end_effector(arm, 0.0, poses)))) for arm in arms]
    assert_order(1, heights, STEPS)
