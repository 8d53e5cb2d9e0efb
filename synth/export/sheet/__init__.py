"""The sheet that the operator holds: guide.pdf; and of its words those that the page has, too."""

from synth.export.sheet.robot_drawing import draw_robot
from synth.export.sheet.sheet import draw_sheet
from synth.export.sheet.target_table import listed_targets
from synth.export.sheet.told import headline_told, help_in_few, why_told
from synth.export.sheet.views import AXIS, GHOST, LINK, TARGET

__all__ = [
    "AXIS",
    "GHOST",
    "LINK",
    "TARGET",
    "draw_robot",
    "draw_sheet",
    "headline_told",
    "help_in_few",
    "listed_targets",
    "why_told",
]
