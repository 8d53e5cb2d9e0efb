"""The guide while the link is bent: markers as they come, what to do now, and the page that shows it."""

from synth.live.serving import Recording, served_live
from synth.live.streams import MotiveStream, QtmStream

__all__ = ["MotiveStream", "QtmStream", "Recording", "served_live"]
