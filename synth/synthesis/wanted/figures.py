"""The figures of a shape by which a person would choose: ways, margins, forgiveness, travel, bend."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synth.synthesis.wanted.forgiveness import Forgiveness
    from synth.synthesis.wanted.margins import Margins


@dataclass(frozen=True)
class Figures:
    """What a shape is like to work with.

    Attributes:
        ways_missing: From how many targets no way was found to the next one; 0 where nobody asks, because
            there are too many targets.
        margins: Distances from the limits, with the joint angles that the ways take.
        shortfall: What is missing of the margins that a shape should have, each as a share of it, summed.
        forgiveness: What the targets miss by after a hand placed the link.
        largest_swing: The most that a joint turns on the way from a target to the next, rad.
        travel: Of the joint that turns more, over all ways, rad.
        bend: Integral of curvature squared along the link, 1/m.
        change: Root mean square distance of the link from its present shape, m; None if the task names none.
    """

    ways_missing: int
    margins: Margins
    shortfall: float
    forgiveness: Forgiveness
    largest_swing: float
    travel: float
    bend: float
    change: float | None
