"""What tracking systems send over a network: Motive by NatNet, QTM by its real-time protocol."""

from synth.live.streams.natnet import MotiveStream
from synth.live.streams.qtm import QtmStream
from synth.live.streams.stream import Seen, Stream

__all__ = ["MotiveStream", "QtmStream", "Seen", "Stream"]
