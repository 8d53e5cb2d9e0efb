"""Where frames come from: lines of JSON, datagrams, or a recording at its own pace."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.errors import InputError, in_a_line
from synth.measurement import readings_of_lines

if TYPE_CHECKING:
    import socket
    from collections.abc import Iterable, Sequence

    from synth.live.feed import Feed
    from synth.measurement import Readings
    from synth.robot import Robot

RECORDED_RATE = 100.0  # frames a second of a recording at speed 1
_LARGEST = 65536  # bytes of a datagram


def feed_lines(feed: Feed, lines: Iterable[str], robot: Robot, joint1: float) -> None:
    """Feed lines as they come, each one JSON object as in a file of markers; wrong ones are told of.

    Args:
        feed: Where to.
        lines: The lines, from stdin say.
        robot: The hardware.
        joint1: The angle of joint 1 where a line does not say it, rad.
    """
    for line in lines:
        if feed.closed:
            return
        if line.strip():
            _feed_text(feed, line, robot, joint1)
    feed.publish("source", {"message": "the stream has ended"})


def feed_udp(feed: Feed, receiver: socket.socket, robot: Robot, joint1: float) -> None:
    """Feed datagrams, each one such line or several, until the feed is closed.

    Args:
        feed: Where to.
        receiver: A socket with a timeout, so that closing is noticed.
        robot: The hardware.
        joint1: The angle of joint 1 where a line does not say it, rad.
    """
    while not feed.closed:
        try:
            data = receiver.recv(_LARGEST)
        except TimeoutError:
            continue
        except OSError:  # closed from outside
            return
        _feed_text(feed, data.decode("utf-8", "replace"), robot, joint1)


def _feed_text(feed: Feed, text: str, robot: Robot, joint1: float) -> None:
    try:
        feed.saw(readings_of_lines(text, robot, joint1, "the stream"))
    except InputError as error:
        feed.publish("source", {"message": in_a_line(error)})


def feed_recording(feed: Feed, frames: Sequence[Readings], speed: float) -> None:
    """Feed the frames of a recording at a multiple of its pace.

    Args:
        feed: Where to.
        frames: The frames.
        speed: 1 for a hundred frames a second.
    """
    for frame in frames:
        if feed.closed:
            return
        feed.saw(frame)
        feed.wait(1.0 / (RECORDED_RATE * speed))
    feed.publish("source", {"message": "the recording has ended"})
