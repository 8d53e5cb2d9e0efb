"""Categories against their meaning: how axis 2 lies to P1, P2 and axis 1."""

import math

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose
from strategies import arms

from synth.geometry import Category, CategoryDistances, Invariants, classify

OF_FAMILY = {
    "skew": Category.GENERAL,
    "mirror": Category.GENERAL,
    "parallel": Category.SCARA,
    "at P1": Category.SPHERICAL,
    "at P2": Category.PUMA,
    "coincident": Category.SPHERICAL,
}


def distances_of(arm):
    return CategoryDistances.from_invariants(Invariants.from_circle(arm.circle), arm.d12)


@given(arms())
def test_distances_are_those_from_the_axis(arm):
    p1, p2, p3, _ = arm.axis_points
    u = arm.circle.axis
    found = distances_of(arm)
    assert_allclose(found.spherical, np.linalg.norm(np.cross(p3 - p1, u)), rtol=0, atol=1e-14)
    assert_allclose(found.puma, np.linalg.norm(np.cross(p3 - p2, u)), rtol=0, atol=1e-14)
    # arccos is flat at parallel axes, hence the root of the rounding.
    assert_allclose(found.scara, math.acos(min(abs(u[2]), 1.0)), rtol=0, atol=2e-8)


@given(arms(families=list(OF_FAMILY)))
def test_each_family_has_its_category(arm):
    assert classify(distances_of(arm)) is OF_FAMILY[arm.family]


def test_tolerances_decide_and_ties_have_an_order():
    far = CategoryDistances(puma=0.1, scara=0.5, spherical=0.1)
    assert classify(far) is Category.GENERAL
    assert classify(far, angle_tolerance=0.5) is Category.SCARA
    assert classify(far, length_tolerance=0.1) is Category.SPHERICAL
    assert classify(CategoryDistances(0.0, 0.0, 0.0)) is Category.SPHERICAL
    assert classify(CategoryDistances(0.0, 0.0, 0.1)) is Category.PUMA
    # The conventions: 1 mm and 0.1 deg.
    assert classify(CategoryDistances(0.00101, math.radians(0.101), 0.00101)) is Category.GENERAL
    assert classify(CategoryDistances(0.00101, math.radians(0.099), 0.00101)) is Category.SCARA
    assert classify(CategoryDistances(0.00099, math.radians(0.101), 0.00101)) is Category.PUMA


def test_the_sentence():
    distances = CategoryDistances(puma=0.0031, scara=math.radians(12.4), spherical=0.0402)
    assert (
        distances.describe() == "general; 3.1 mm from PUMA-like, 12.4 deg from SCARA, 40.2 mm from spherical"
    )
    distances = CategoryDistances(puma=0.00311, scara=math.radians(12.4), spherical=0.0402)
    assert distances.describe(length_tolerance=0.004) == (
        "PUMA-like to 3.2 mm; 12.4 deg from SCARA, 40.2 mm from spherical"
    )


@pytest.mark.parametrize("category", Category)
def test_values_are_those_of_the_files_and_each_has_a_sentence(category):
    assert category.value == category.name.lower()
    assert Category(category.value) is category
    assert category.sentence.endswith(".")
