"""Laws of numbers in sentences: on the safe side, by less than the last digit, with the digits asked for."""

import math
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.rounding import Unit, at_least, at_most, rounded_down, rounded_up

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
