"""The hand of one person, learned from checks of what that person bent.

Each check of a link that was placed, corrected or stiffened shows by how much the hand, or the link as it
stiffened, was off. The mean squares of these errors, less what the camera adds, replace those supposed, which
count as so many observations: a few checks change little, many decide.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.measurement.hand.hand import Hand
from synth.measurement.markers import rotation_between

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.measurement.markers import ArmFit

SUPPOSED_COUNT = 5  # observations that what is supposed of a hand counts as
_USUAL_CORRECTION = (10e-3, math.radians(4.0))  # m and rad, where the supposed share is taken for seen


class Deed(Enum):
    """What was done to the link before it was measured."""

    PLACED = "placed"
    CORRECTED = "corrected"
    STIFFENED = "stiffened"


@frozen_value
class HandError:
    """How far from where it should have been a link's end was found.

    Attributes:
        deed: What had been done.
        asked: The displacement asked for, shift and rotation vector, shape (6,), m and rad; 0 unless the link
            was corrected.
        error: Where the end is found, less where it should be: shift and tilt of axis 2, shape (6,), m and
            rad.
        noise: Mean square that the camera adds to shift and tilt, shape (2,), m^2 and rad^2.
    """

    deed: Deed
    asked: FloatArray
    error: FloatArray
    noise: FloatArray

    def __post_init__(self) -> None:
        for name in ("asked", "error", "noise"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def squares(self) -> FloatArray:
        """Squared shift, and squared rotation about any axis, less the camera's part, shape (2,), m^2, rad^2.

        The roll about axis 2 is not seen, since joint 2 takes it up: two of three directions show the tilt.
        """
        shift, tilt = np.sum(self.error.reshape(2, 3) ** 2, axis=1) - self.noise
        return np.array([shift, 1.5 * tilt])


def hand_error(fit: ArmFit, deed: Deed, end: FloatArray, axis: FloatArray, asked: FloatArray) -> HandError:
    """Return how far a link's end, as measured, is from where it should be.

    Args:
        fit: The arm that was measured.
        deed: What had been done.
        end: Where the link's end should be, shape (3,), m, in the frame of the measurement.
        axis: Where axis 2 should point, a unit vector, shape (3,).
        asked: The displacement asked for, shape (6,), m and rad.
    """
    off = np.concatenate([fit.arm.end - end, rotation_between(axis, fit.arm.axis)])
    measured = 1 if deed is Deed.PLACED else 2  # the aim itself was, too
    noise = measured * np.array([3.0 * fit.point_sigma**2, 2.0 * fit.direction_sigma**2])
    return HandError(deed, asked, off, noise)


def learned_hand(errors: Sequence[HandError], supposed: Hand | None = None) -> Hand:
    """Return the hand that explains errors.

    Args:
        errors: How far off it was, of one person.
        supposed: What is supposed of any hand; the published one unless told.
    """
    supposed = supposed or Hand()
    of = {deed: [each for each in errors if each.deed is deed] for deed in Deed}
    share, floor = _of_corrections(of[Deed.CORRECTED], supposed)
    return Hand(
        placement=_mean(of[Deed.PLACED], supposed.placement),
        share=share,
        floor=floor,
        drift=_mean(of[Deed.STIFFENED], supposed.drift),
    )


def _mean(errors: Sequence[HandError], supposed: tuple[float, float]) -> tuple[float, float]:
    """Return root mean squares of errors and of what is supposed, m and rad."""
    total = SUPPOSED_COUNT * np.square(supposed) + sum((each.squares for each in errors), np.zeros(2))
    shift, turn = np.sqrt(np.maximum(total, 0.0) / (SUPPOSED_COUNT + len(errors)))
    return float(shift), float(turn)


def _of_corrections(errors: Sequence[HandError], supposed: Hand) -> tuple[float, tuple[float, float]]:
    """Return the share and the floor of corrections, m and rad: squares are floor^2 + (share * asked)^2."""
    from scipy.optimize import nnls  # type: ignore[import-untyped]  # noqa: PLC0415

    usual = np.repeat(_USUAL_CORRECTION, 3) / math.sqrt(3.0)
    as_supposed = np.square(supposed.correction_rms(usual))
    floor_alone = np.square(supposed.floor)
    # Half of what is supposed was seen after usual corrections, half after very small ones.
    rows = [(usual, as_supposed), (np.zeros(6), floor_alone)] * SUPPOSED_COUNT
    weights = [0.5] * len(rows) + [1.0] * len(errors)
    rows += [(each.asked, each.squares) for each in errors]
    system, values = [], []
    for weight, (asked, squares) in zip(weights, rows, strict=True):
        for kind in (0, 1):
            unit = math.sqrt(weight) / float(as_supposed[kind])
            by = float(np.sum(asked.reshape(2, 3)[kind] ** 2))
            system.append([unit * (kind == 0), unit * (kind == 1), unit * by])
            values.append(unit * float(squares[kind]))
    (shift, turn, share), _ = nnls(np.array(system), np.array(values))
    return math.sqrt(share), (math.sqrt(shift), math.sqrt(turn))
