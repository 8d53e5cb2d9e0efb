"""The hand that bends the link: how far off it places the link's end, and how well it corrects."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from synth.arrays import FloatArray


@dataclass(frozen=True)
class Hand:
    """Errors of a hand, as root mean squares of 3D vectors: of position, m, and of rotation, rad.

    The placement is published (9.64 +- 2.06 mm with holographic guidance). The others are suppositions,
    stated here so that they can be measured and replaced.

    Attributes:
        placement: Error of a first placement.
        share: Error of a correction as a share of the correction itself.
        floor: Error that every correction has, however small.
        drift: How far the link moves while it stiffens.
    """

    placement: tuple[float, float] = (9.86e-3, math.radians(4.18))
    share: float = 0.4
    floor: tuple[float, float] = (2.5e-3, math.radians(0.85))
    drift: tuple[float, float] = (1.5e-3, math.radians(0.3))

    def correction_rms(self, by: FloatArray) -> tuple[float, float]:
        """Return the error of a correction, m and rad.

        Args:
            by: Shift and rotation vector of the link's end, shape (6,), m and rad.
        """
        shift, turn = float(np.linalg.norm(by[:3])), float(np.linalg.norm(by[3:]))
        return math.hypot(self.share * shift, self.floor[0]), math.hypot(self.share * turn, self.floor[1])


def random_errors(rms: tuple[float, float], count: int, rng: np.random.Generator) -> FloatArray:
    """Return errors of the pose of the link's end in any direction, shape (count, 6), m and rad."""
    scale = np.repeat(np.asarray(rms) / math.sqrt(3.0), 3)
    return np.asarray(rng.normal(size=(count, 6)) * scale)
