"""What a person wants of a shape: ways, margins, forgiveness of the hand, calm; and shapes that have it."""

from synth.synthesis.wanted.design import Design
from synth.synthesis.wanted.displaced import Displacements, displaced, rotations
from synth.synthesis.wanted.figures import Figures
from synth.synthesis.wanted.forgiveness import Forgiveness
from synth.synthesis.wanted.judging import judged, ways_and_forgiveness
from synth.synthesis.wanted.margins import Margins
from synth.synthesis.wanted.motion import Motion
from synth.synthesis.wanted.ranking import (
    best_of,
    has_all_ways,
    leaves_no_wish,
    may_be_met,
    objective,
    preferred_designs,
)
from synth.synthesis.wanted.wanted_shapes import wished
from synth.synthesis.wanted.ways import MOST_MOTIONS, motions

__all__ = [
    "MOST_MOTIONS",
    "Design",
    "Displacements",
    "Figures",
    "Forgiveness",
    "Margins",
    "Motion",
    "best_of",
    "displaced",
    "has_all_ways",
    "judged",
    "leaves_no_wish",
    "may_be_met",
    "motions",
    "objective",
    "preferred_designs",
    "rotations",
    "ways_and_forgiveness",
    "wished",
]
