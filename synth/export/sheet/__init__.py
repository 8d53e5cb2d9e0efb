"""The sheet that the operator holds: guide.pdf."""

from synth.export.sheet.sheet import draw_sheet
from synth.export.sheet.views import AXIS, GHOST, LINK, TARGET

__all__ = ["AXIS", "GHOST", "LINK", "TARGET", "draw_sheet"]
