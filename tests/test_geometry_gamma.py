"""Laws of the workspace surface: the quartic, its derivation, and the distance to it."""

import subprocess
import sys

import numpy as np
import pytest
import sympy
from hypothesis import assume, given
from numpy.testing import assert_allclose
from strategies import COPLANAR, FAMILIES, HARDWARE, LONG, angles, arms, end_effector, make_arm, points

from synth.errors import GeometryError
from synth.geometry import (
    ArmDistances,
    SweptCircle,
    WorkspaceSurface,
    cayley_menger,
    cayley_menger_bideterminant,
    derivation,
    distance_polynomials,
    gamma_determinant,
)
from synth.geometry._gamma_polynomials import workspace_polynomials

ALL_ARMS = [make_arm(family, baselines=b) for family in FAMILIES for b in (HARDWARE, LONG)]
every_arm = pytest.mark.parametrize(
    "arm", ALL_ARMS, ids=[f"{family}, {b}" for family in FAMILIES for b in ("hardware", "long")]
)
ANYWHERE = np.random.default_rng(1).uniform(-1.0, 1.0, (40, 3))
# D of five points within a metre of each other, as in test_geometry_distances.
ROUNDING = 1e-14


def surface(arm):
    return WorkspaceSurface.from_squared_distances(arm.distances)


def factor(arm):
    """The scale s12 s34 sin^2(alpha) / 4 = -q0 of Gamma, m^4."""
    return 0.25 * (arm.d12 * arm.d34 * np.sin(arm.alpha)) ** 2


class TestDerivation:
    def test_is_not_needed_to_use_the_polynomials(self):
        code = "import sys, synth.geometry; sys.exit(bool({'sympy', 'scipy', 'casadi'} & set(sys.modules)))"
        assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0  # our own text

    def test_polynomials_equal_the_bordered_determinant(self):
        q, c = workspace_polynomials(*sympy.symbols(derivation.ARGUMENTS))
        s12, s15, s25 = sympy.symbols("s12 s15 s25")
        determinant = derivation.bordered_determinant()
        in_distances = c[0] + c[1] * s15 + c[2] * s25 + c[3] * s15**2 + c[4] * s15 * s25 + c[5] * s25**2
        assert sympy.expand(in_distances - determinant) == 0
        # x^2 + y^2 = s15 - z^2 and d12 z = (s15 + s12 - s25) / 2 put Gamma into distances.
        height = (s15 + s12 - s25) / 2
        z2 = height**2 / s12
        quartic = q[0] * s15**2 + q[1] * height * s15 + q[2] * (s15 - z2) + q[3] * z2 + q[4] * height + q[5]
        assert sympy.expand(quartic - determinant) == 0

    def test_the_committed_module_is_what_the_derivation_writes(self):
        assert derivation.OUTPUT.read_text(encoding="utf-8") == derivation.source(derivation.derive())


class TestQuartic:
    @given(arms(), points(8))
    def test_equals_the_determinant_everywhere(self, arm, p):
        assert_allclose(surface(arm).value(p), gamma_determinant(arm.distances, p), rtol=0, atol=ROUNDING)

    @given(arms(), points(8))
    def test_is_a_quadratic_in_the_distances_from_axis_1(self, arm, p):
        s15, s25 = np.sum(p**2, axis=1), np.sum((p - [0, 0, arm.d12]) ** 2, axis=1)
        monomials = np.array([np.ones(8), s15, s25, s15**2, s15 * s25, s25**2])
        assert_allclose(
            distance_polynomials(arm.distances) @ monomials, surface(arm).value(p), rtol=0, atol=ROUNDING
        )

    @given(arms(), angles(), angles())
    def test_vanishes_where_forward_kinematics_leads(self, arm, theta1, theta2):
        # Over 58 mm and 49 mm the terms cancel to a 1e4th of the distances they are made of.
        p5 = end_effector(arm.circle, theta1, theta2)
        size = 1.0 + np.sum(p5**2) ** 2
        assert abs(surface(arm).value(p5)) < 1e-15 * size
        if arm.family != "coincident":  # there all terms are rounding
            assert surface(arm).residual(p5) < 1e-10

    @given(arms())
    def test_leading_coefficient_is_the_angle_of_the_axes(self, arm):
        # bk = d12 d34 cos(alpha) is a difference of four distances, each rounded at 1e-16.
        assert_allclose(surface(arm).q[0], -factor(arm), rtol=1e-12, atol=1e-16)

    @every_arm
    def test_gradient_is_that_of_finite_differences(self, arm):
        # Central differences of a quartic err by its third derivative times step^2 / 6.
        step = 1e-4
        shifts = step * np.eye(3)
        value = surface(arm).value
        differences = (value(ANYWHERE[:, None] + shifts) - value(ANYWHERE[:, None] - shifts)) / (2 * step)
        scale = np.max(np.abs(differences)) + 1e-12
        assert_allclose(surface(arm).gradient(ANYWHERE) / scale, differences / scale, rtol=0, atol=1e-6)

    @given(arms())
    def test_has_the_form_of_the_invariants(self, arm):
        assume(arm.family not in {"parallel", "coincident"})
        a, z0, radius = arm.a, arm.z0, arm.circle.radius
        k = a**2 + arm.h**2 + radius**2
        n, z = np.sum(ANYWHERE**2, axis=1), ANYWHERE[:, 2]
        square = (n - 2 * z0 * z + z0**2 - k) ** 2
        tilted = 4 * (a / np.sin(arm.alpha)) ** 2 * (z - z0 - arm.h * np.cos(arm.alpha)) ** 2
        expected = square + tilted - 4 * a**2 * radius**2
        q0 = surface(arm).q[0]
        assert_allclose(surface(arm).value(ANYWHERE) / q0, expected, rtol=1e-9, atol=1e-8)

    @given(arms())
    def test_swept_circle_gives_the_same_coefficients(self, arm):
        q = arm.circle.surface(arm.d12, arm.d34).q
        assert_allclose(surface(arm).q, q, rtol=1e-9, atol=1e-14)

    def test_residual_has_no_scale(self):
        arm = make_arm("skew")
        twice = ArmDistances(*(4.0 * s for s in arm.distances))
        assert_allclose(
            WorkspaceSurface.from_squared_distances(twice).residual(2 * ANYWHERE),
            surface(arm).residual(ANYWHERE),
        )
        assert np.all(surface(arm).residual(ANYWHERE) > 1e-6)

    def test_coincident_base_points_are_refused(self):
        with pytest.raises(GeometryError, match="P1 and P2 coincide"):
            WorkspaceSurface.from_squared_distances(ArmDistances(0, 1, 1, 1, 1, 1, 1, 1))


class TestPerfectSquares:
    @given(arms(families=["at P1", "at P2", "meeting"]))
    def test_axes_that_meet_give_a_sphere_twice(self, arm):
        sphere = np.sum((ANYWHERE - [0, 0, arm.z0]) ** 2, axis=1) - arm.h**2 - arm.circle.radius**2
        assert_allclose(surface(arm).value(ANYWHERE), -factor(arm) * sphere**2, rtol=0, atol=ROUNDING)

    @given(arms(families=["parallel"]))
    def test_parallel_axes_give_a_plane_twice(self, arm):
        (x, y, height), scale = arm.circle.centre, (arm.d12 * arm.d34) ** 2
        plane = (x**2 + y**2) * (ANYWHERE[:, 2] - height) ** 2
        assert_allclose(surface(arm).value(ANYWHERE), -scale * plane, rtol=0, atol=ROUNDING)

    @given(arms(families=["coincident"]))
    def test_coincident_axes_give_nothing(self, arm):
        assert_allclose(surface(arm).value(ANYWHERE), 0, rtol=0, atol=ROUNDING)

    @given(arms(), points(1))
    def test_the_reason_is_an_identity_of_determinants(self, arm, p):
        s = arm.distances.matrix(np.sum(p[0] ** 2), np.sum((p[0] - [0, 0, arm.d12]) ** 2))
        d123, d1234, d1235 = (cayley_menger(s[np.ix_(i, i)]) for i in ([0, 1, 2], [0, 1, 2, 3], [0, 1, 2, 4]))
        mixed = cayley_menger_bideterminant(s, [0, 1, 2, 3], [0, 1, 2, 4])
        assert_allclose(d123 * cayley_menger(s), d1234 * d1235 - mixed**2, rtol=0, atol=ROUNDING)


class TestDistance:
    @given(arms(), angles())
    def test_is_zero_where_forward_kinematics_leads(self, arm, theta1):
        p5 = end_effector(arm.circle, theta1, np.linspace(-np.pi, np.pi, 60))
        assert np.all(arm.circle.distance(p5) < 1e-14)

    @every_arm
    def test_is_that_of_the_nearest_of_many_poses(self, arm):
        poses = end_effector(arm.circle, 0.0, np.linspace(-np.pi, np.pi, 20_001))
        profile = np.stack([np.hypot(poses[:, 0], poses[:, 1]), poses[:, 2]], axis=-1)
        meridian = np.stack([np.hypot(ANYWHERE[:, 0], ANYWHERE[:, 1]), ANYWHERE[:, 2]], axis=-1)
        nearest = np.min(np.linalg.norm(meridian[:, None] - profile, axis=-1), axis=1)
        found = arm.circle.distance(ANYWHERE)
        assert np.all(found <= nearest + 1e-15)
        # Poses are 2 pi R / 20000 = 0.14 mm apart: at a distance d they err by up to 0.07^2 / (2 d).
        assert_allclose(found, nearest, rtol=0, atol=7e-5)

    @every_arm
    def test_is_the_height_above_the_surface_where_gamma_is_none(self, arm):
        height = 1e-4
        on, above = lift(arm.circle, np.array([0.5, 1.2, 1.9, 2.6]), height)
        assert_allclose(arm.circle.distance(above), height, rtol=1e-6)

        if arm.family == "coincident":
            return
        gamma = surface(arm)
        first_order = np.abs(gamma.value(above)) / np.linalg.norm(gamma.gradient(above), axis=-1)
        share = 0.5 if arm.family in COPLANAR else 1.0
        assert_allclose(first_order, share * height, rtol=0.01)
        left_on_it = np.linalg.norm(gamma.gradient(on), axis=-1) / np.linalg.norm(
            gamma.gradient(above), axis=-1
        )
        assert_allclose(left_on_it, 0.0 if arm.family in COPLANAR else 1.0, rtol=0, atol=0.01)

    def test_knows_the_rim_where_gamma_goes_on(self):
        # Axis 2 is tilted by 0.5 rad at P1 and the arm across it: the zone reaches up to z = R sin 0.5.
        circle = SweptCircle(np.zeros(3), np.array([np.sin(0.5), 0, np.cos(0.5)]), 0.5)
        pole = np.array([0, 0, 0.5])
        assert_allclose(circle.surface(0.5, 0.5).value(pole), 0, rtol=0, atol=1e-16)
        assert_allclose(circle.distance(pole), 2 * 0.5 * np.sin((np.pi / 2 - 0.5) / 2))

    def test_coincident_axes_leave_a_circle(self):
        circle = SweptCircle(np.array([0, 0, 0.3]), np.array([0, 0, 1.0]), 0.5)
        assert_allclose(
            circle.distance([[0.3, 0.4, 0.3], [0, 0, 0.3], [0.8, 0, 0.7]]), [0, 0.5, 0.5], rtol=0, atol=1e-15
        )

    @pytest.mark.parametrize("gap", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
    def test_is_zero_round_the_sharp_turn_beside_axis_1(self, gap):
        # The circle passes axis 1 at the distance `gap`: its profile comes in, turns and leaves at once.
        axis, inwards = np.array([0.0, 0.6, 0.8]), np.array([-1.0, 0.0, 0.0])
        circle = SweptCircle(np.array([gap, 0.0, 0.2]) - 0.4 * inwards, axis, 0.4)
        turn = np.outer(np.geomspace(1e-12, 3.0, 60), [1, -1]).ravel()[:, None]
        across = np.cos(turn) * inwards + np.sin(turn) * np.cross(axis, inwards)
        assert np.all(circle.distance(circle.centre + circle.radius * across) < 1e-14)

    def test_is_not_fooled_by_nearly_meeting_axes(self):
        # Two sheets 0.4 um apart: between them |gradient of Gamma| is next to nothing.
        arm = make_arm("skew", a=2e-7)
        on, _ = lift(arm.circle, np.linspace(0.3, 2.8, 30), 0.0)
        middle = (
            on * (np.hypot(arm.h, arm.circle.radius) / np.linalg.norm(on - [0, 0, arm.z0], axis=-1))[:, None]
        )
        assert np.all(arm.circle.distance(middle) < 1e-6)


def lift(circle, theta2, height):
    """Return points of the surface, and the points so high above it along its normal."""
    on, ahead, behind = (end_effector(circle, 0.0, theta2 + step) for step in (0.0, 1e-6, -1e-6))
    along = ahead - behind
    round_axis_1 = np.cross([0, 0, 1], on)
    normal = np.cross(along, round_axis_1)
    coincident = np.linalg.norm(normal, axis=-1) < 1e-9 * np.linalg.norm(round_axis_1, axis=-1)
    normal[coincident] = [0, 0, 1]
    return on, on + height * normal / np.linalg.norm(normal, axis=-1, keepdims=True)
