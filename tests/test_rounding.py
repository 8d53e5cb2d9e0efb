"""Laws of numbers in sentences: on the safe side, by less than the last digit, with the digits asked for."""

import math
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.cli.session import progress_sentence
from synth.errors import GeometryError
from synth.geometry import realise
from synth.robot import PRESETS, Arm, LinkShape
from synth.rounding import Unit, at_least, at_most, rounded_down, rounded_up, told_apart
from synth.synthesis import verify
from synth.task import PointTarget, Task
from synth.watch import Progress

values = st.one_of(st.just(0.0), st.floats(1e-9, 1e4), st.floats(-1e4, -1e-9))
UNITS = {Unit.MM: Decimal(1000), Unit.PERCENT: Decimal(100)}


@given(values, st.sampled_from(list(UNITS)), st.integers(0, 4))
def test_what_is_said_is_true_and_sharp(value, unit, digits):
    exact, last = Decimal(repr(value)) * UNITS[unit], Decimal(1).scaleb(-digits)
    down, up = Decimal(rounded_down(value, unit, digits)), Decimal(rounded_up(value, unit, digits))
    assert exact - last < down <= exact <= up < exact + last
    assert max(len(rounded_up(value, unit, digits).partition(".")[2]), 0) == digits


@given(values, st.integers(0, 4))
def test_angles_are_told_in_degrees(value, digits):
    degrees, last = math.degrees(value), 10.0**-digits
    slack = 1e-12 * abs(degrees)
    assert degrees - last - slack < float(rounded_down(value, Unit.DEG, digits)) <= degrees + slack
    assert degrees - slack <= float(rounded_up(value, Unit.DEG, digits)) < degrees + last + slack


def test_the_bound_that_was_stated_too_high():
    assert at_least(0.274585) == "at least 274.5 mm"
    assert at_most(0.456912) == "at most 457.0 mm"


@pytest.mark.parametrize(
    ("length", "words"), [(0.0003, "0.3"), (0.0007, "0.7"), (0.002, "2.0"), (-1e-9, "-0.1")]
)
def test_a_number_of_the_file_is_that_number(length, words):
    assert rounded_down(length) == words


def test_zero_has_no_sign_and_infinity_is_no_crash():
    assert rounded_up(-1e-9) == rounded_down(-0.0) == "0.0"
    assert rounded_down(math.inf) == "inf"


@pytest.mark.parametrize(
    ("value", "limit", "told"),
    [
        (0.700004, 0.7, ("700.004", "700.000")),
        (0.71, 0.7, ("710.0", "700.0")),
        (0.1099999, 0.11, ("109.9999", "110.0000")),
        (0.09612, 0.11, ("96.2", "110.0")),
        (0.70006, 0.70004, ("700.06", "700.04")),
    ],
)
def test_what_breaks_a_limit_never_looks_like_it(value, limit, told):
    assert told_apart(value, limit) == told


@given(st.floats(1e-3, 10.0), st.floats(1e-7, 1.0), st.sampled_from([-1.0, 1.0]))
def test_no_more_is_said_of_a_broken_limit_than_is_true(limit, by, sign):
    value = limit + sign * by
    shown, bound = map(Decimal, told_apart(value, limit))
    assert (shown > bound) == (value > limit)
    assert abs(shown - bound) <= abs(Decimal(repr(value)) - Decimal(repr(limit))) * 1000


def test_progress_on_a_terminal_is_on_the_safe_side():
    """A miss rounded up, a bound rounded down; 12.3451 and 12.3449 say the nearest the other way."""
    said = progress_sentence(Progress(worst_miss=0.0123451, lower_bound=0.0123449, phase="proving"))
    assert said == "proving, best shape misses by at most 12.346 mm, every shape by at least 12.344 mm"


def test_a_shape_that_breaks_a_limit_by_little_is_not_said_to_keep_it():
    task = Task("one", PRESETS["malleable-2dof"], (PointTarget("p", [0.4, 0.3, 0.3]),))
    link = LinkShape([[0.0, 0.0]], [0.700004])
    check = verify(task, Arm(task.robot, link, 0.455, 0.46))
    (length,) = (each.sentence for each in check.violations if each.limit == "length: link")
    assert length == "the length of link would have to be 700.004 mm; 700.000 mm is its upper limit"


def test_a_depth_below_the_floor_is_never_told_as_none():
    """What is 0.001 mm below the floor is below it: 0.00 mm would say that it is not."""
    robot = PRESETS["malleable-2dof"]
    arm = Arm(robot, LinkShape([[0.0, 0.0]], [0.6]), 0.455, 0.46)
    floor = float(arm.axis_points[2:, 2].min()) + 1e-6
    check = verify(Task("one", robot, (PointTarget("p", [-0.3, 0.0, 0.9]),), floor=floor), arm)
    (sunk,) = (each.sentence for each in check.violations if each.limit == "floor: second joint")
    assert sunk == "the second joint would be 0.01 mm below the floor"


def test_distances_that_no_triangle_has_are_told_with_the_digits_that_show_it():
    with pytest.raises(GeometryError, match=r"d13 = 2\.00000001 m is longer than d12 \+ d23 = 2 m"):
        realise(np.array([[0, 1, 2.00000001], [1, 0, 1], [2.00000001, 1, 0]]) ** 2)


def test_lengths_beyond_all_measure_are_no_crash():
    assert rounded_up(1e300, digits=2).endswith(".00")
    assert told_apart(1e30, 0.11)[1] == "110.0"
