"""The hand that explains errors seen, of which some are supposed."""

import math

import numpy as np
import pytest

from synth.measurement.hand import Deed, Hand, HandError, learned_hand, random_errors

SKILLED = Hand(placement=(5e-3, 0.04), share=0.2, floor=(1e-3, 8e-3), drift=(3e-3, 0.01))


def seen(hand, count):
    """Return errors of a hand, without the roll that nobody sees."""
    rng = np.random.default_rng(0)

    def of(deed, rms, asked):
        error = random_errors(rms, 1, rng)[0] * [1, 1, 1, 1, 1, 0]
        return HandError(deed, asked, error, np.zeros(2))

    for _ in range(count):
        asked = random_errors((8e-3, math.radians(3.0)), 1, rng)[0]
        yield of(Deed.PLACED, hand.placement, np.zeros(6))
        yield of(Deed.CORRECTED, hand.correction_rms(asked), asked)
        yield of(Deed.STIFFENED, hand.drift, np.zeros(6))


def numbers(hand):
    return np.array([*hand.placement, hand.share, *hand.floor, *hand.drift])


def test_of_nothing_seen_the_supposed_hand_is_learned():
    np.testing.assert_allclose(numbers(learned_hand([])), numbers(Hand()))
    np.testing.assert_allclose(numbers(learned_hand([], SKILLED)), numbers(SKILLED))


def test_of_much_seen_the_true_hand_is_learned():
    learned = learned_hand(list(seen(SKILLED, 1000)))
    np.testing.assert_allclose(numbers(learned), numbers(SKILLED), rtol=0.15)


def test_of_a_little_something_between_is_learned():
    learned = learned_hand(list(seen(SKILLED, 5)))
    assert SKILLED.placement[0] < learned.placement[0] < Hand().placement[0]


def test_what_the_camera_adds_is_no_error_of_the_hand():
    error = np.array([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0])
    noise = np.array([1e-6, 0.0])
    learned = learned_hand([HandError(Deed.PLACED, np.zeros(6), error, noise)] * 5)
    assert learned.placement[0] == pytest.approx(Hand().placement[0] / math.sqrt(2.0))
