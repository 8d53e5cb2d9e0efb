"""The check of a link in words: what to do, which joints to take, what to expect."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.guide.loop.checking import Verdict
from synth.rounding import Unit, rounded_down, rounded_up
from synth.sentences import bulleted, headed

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.guide.loop.checking import Check, Correction
    from synth.guide.loop.settings import Settings
    from synth.measurement import ArmFit

_BAR = 0.150  # m, from the link's end along axis 2, where a tilt is told as a way
_LEAST_WAY = 0.5e-3  # m; a hand cannot do less
_LEAST_SETTING = 0.05e-3  # m
_MOST_TARGETS = 20
_AXES = (("towards +x", "towards -x"), ("towards +y", "towards -y"), ("up", "down"))


def check_text(
    check: Check, settings: Settings | None = None, rejected: tuple[tuple[str, str], ...] = ()
) -> str:
    """Return a check as a headline and a few bullets.

    Args:
        check: The check.
        settings: What to set after locking, or None.
        rejected: Markers that were left out, each with the reason.

    Returns:
        Lines without a line break at the end.
    """
    headline = f"{check.task.name}: {headline_sentence(check)}"
    bullets = [f"{name} is left out: {why}" for name, why in rejected]
    bullets += _what_to_do(check)
    bullets += _target_lines(check)
    bullets += axis_sentences(check.fit)
    if settings is not None:
        bullets += settings_sentences(settings)
    return headed(headline, map(bulleted, bullets))


def _what_to_do(check: Check) -> list[str]:
    """Return the correction and what it brings; where joint 2 has no zero, what to show first, and why."""
    fit, correction = check.fit, check.correction
    brings = ""
    if correction is not None:
        brings = (
            f"a practised hand has a largest miss of {_mm_up(correction.outlook.expected_worst)} mm on "
            f"average; now it is {_mm_up(check.stiffened.expected_worst)} mm"
        )
    if not fit.shows_roll:
        unshown = (
            "the zero of joint 2 is not shown: P5 must be seen, or a marker such as E:-60; without it "
            "nothing is locked"
        )
        return [f"{unshown}, and even after the best correction {brings}" if brings else unshown]
    return [] if correction is None else [correction_sentence(correction, fit), f"after that {brings}"]


def headline_sentence(check: Check) -> str:
    """Return what to do and why, as a sentence."""
    chance, asked = _percent_down(check.probability), f"{100.0 * check.confidence:.3g} %"
    if check.verdict is Verdict.LOCK:
        return f"lock it: every target is within its tolerance with a chance of {chance} at least"
    if check.verdict is Verdict.CORRECT:
        return (
            f"not yet: the chance that every target is within its tolerance is {chance}, and {asked} is asked"
        )
    if check.verdict is Verdict.BEST_POSSIBLE:
        return (
            f"leave it as it is: another try would hardly be better. The chance that every target is "
            "within its tolerance is "
            f"{chance}, and {asked} is asked"
        )
    return Verdict.UNUSABLE.sentence


def correction_sentence(correction: Correction, fit: ArmFit) -> str:
    """Return a correction in a person's words: where the link's end goes, and how axis 2 is tilted."""
    shift = way_words(correction.move, _LEAST_WAY)
    parts = [f"move the link's end {shift}" if shift else "leave the link's end where it is"]
    axis = fit.arm.axis
    angle = float(np.linalg.norm(correction.rotate))
    ends = _BAR * (correction.aim.axis - axis)
    tilt = way_words(ends, _LEAST_WAY)
    if tilt:
        parts.append(
            f"tilt axis 2 by {math.degrees(angle):.1f} deg about it, so that a point {1e3 * _BAR:.0f} mm "
            "from the link's end towards P4 "
            f"goes {tilt} more than the end"
        )
    return "; ".join(parts)


def way_words(way: FloatArray, least: float) -> str:
    """Return a displacement in words, such as "8.0 mm down and 3.1 mm towards +x"; empty if there is none.

    Args:
        way: In the base frame, shape (3,), m.
        least: A part below this is not worth a word, m.
    """
    order = np.argsort(-np.abs(way), kind="stable")
    words = [
        f"{1e3 * abs(way[k]):.1f} mm {_AXES[k][0 if way[k] > 0.0 else 1]}"
        for k in order
        if abs(way[k]) >= least
    ]
    return " and ".join(words) if len(words) < 3 else f"{words[0]}, {words[1]} and {words[2]}"


def axis_sentences(fit: ArmFit) -> list[str]:
    """Return where axis 2 is and how sure that is, and what would make it surer."""
    u = fit.arm.axis
    elevation = math.degrees(math.asin(float(np.clip(u[2], -1.0, 1.0))))
    heading = math.degrees(math.atan2(u[1], u[0])) % 360.0
    side = "above" if elevation >= 0.0 else "below"
    spread = (
        f"{_mm_up(fit.point_sigma)} mm across it at the link's end, "
        f"{rounded_up(fit.direction_sigma, Unit.DEG, 2)} deg of its direction"
    )
    points = f"axis 2 points {abs(elevation):.1f} deg {side} horizontal, heading {heading:.1f} deg"
    sentences = [f"{points}; standard deviation {spread}"]
    if fit.direction_sigma > 0.003:
        sentences.append(
            "the direction of axis 2 decides: a bar with markers such as A2:-150 and A2:150 shows it "
            "five times better"
        )
    if math.sqrt(fit.covariance[3, 3] + fit.covariance[4, 4]) > 0.003:
        sentences.append(
            "axis 1 is shown badly: find it once by turning joint 1 (--base-calibrated), or put a marker "
            "such as A1:300 on it"
        )
    return sentences


def settings_sentences(settings: Settings) -> list[str]:
    """Return what to set after locking, in words."""
    base = way_words(settings.base, _LEAST_SETTING)
    along = f"{1e3 * abs(settings.along):.2f} mm towards {'P4' if settings.along >= 0.0 else 'P3'}"
    radius = (
        f"{1e3 * abs(settings.radius):.2f} mm {'farther from' if settings.radius >= 0.0 else 'nearer to'}"
    )
    distances = f"d35 = {1e3 * settings.d35:.2f} mm, d45 = {1e3 * settings.d45:.2f} mm"
    worst = f"the largest miss is then {_mm_up(settings.outlook.expected_worst)} mm on average"
    return [
        f"after locking, move the base {base}" if base else "after locking, leave the base where it is",
        f"set P5 {along} along axis 2 and {radius} it: {distances}; {worst}",
    ]


def _target_lines(check: Check) -> list[str]:
    now = check.now
    lines = [
        f"{target.name}: joint 1 {math.degrees(joints[0]):.2f} deg, joint 2 {math.degrees(joints[1]):.2f} "
        f"deg; miss {_mm_up(expected)} mm "
        f"on average, below {_mm_up(most)} mm in 19 of 20 cases; tolerance {1e3 * target.tolerance:g} mm, "
        f"chance {_percent_down(chance)}"
        for target, joints, expected, most, chance in zip(
            check.task.targets, now.joints, now.expected, now.miss_95, now.probability_within, strict=True
        )
    ]
    more = len(lines) - _MOST_TARGETS
    return [*lines[:_MOST_TARGETS], f"and {more} more targets"] if more > 0 else lines


def _mm_up(value: float) -> str:
    return rounded_up(value)


def _percent_down(chance: float) -> str:
    """Return a chance in percent, rounded down; of samples 100 % proves nothing."""
    return f"{min(int(rounded_down(chance, Unit.PERCENT, 0)), 99)} %"
