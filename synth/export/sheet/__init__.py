"""The sheet that the operator holds: guide.pdf."""

from synth.export.sheet.robot_drawing import draw_robot
from synth.export.sheet.sheet import draw_sheet
from synth.export.sheet.views import AXIS, GHOST, LINK, TARGET

__all__ = ["AXIS", "GHOST", "LINK", "TARGET", "draw_robot", "draw_sheet"]
