"""Where frames come from: lines of JSON, datagrams, a tracking system, or a recording at its own pace."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING

from synth.errors import InputError, SynthError, in_a_line
from synth.measurement import readings_of_lines, readings_of_points, streamed_markers

if TYPE_CHECKING:
    import socket
    from collections.abc import Iterable, Sequence

    from synth.live.feed import Feed
    from synth.live.streams import Stream
    from synth.measurement import Readings
    from synth.robot import Robot

RECORDED_RATE = 100.0  # frames a second of a recording at speed 1
_LARGEST = 65536  # bytes of a datagram
_AGAIN = 0.5  # s, after which a stream that was lost or refused is tried again


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


def feed_stream(feed: Feed, stream: Stream, robot: Robot, joint1: float) -> None:
    """Feed what a tracking system sends, until the feed is closed; what fails is told, and tried again.

    Args:
        feed: Where to.
        stream: What sends.
        robot: The hardware.
        joint1: The angle of joint 1, rad.
    """
    while not feed.closed:
        try:
            _feed_frames(feed, stream, robot, joint1)
        except (SynthError, OSError) as error:
            why = error.strerror or error if isinstance(error, OSError) else in_a_line(error)
            feed.publish("source", {"message": f"{stream.name}: {why}; trying again"})
        feed.wait(_AGAIN)


def _feed_frames(feed: Feed, stream: Stream, robot: Robot, joint1: float) -> None:
    """Feed frames until the feed is closed, or there is something wrong with them."""
    names, markers, told = None, {}, False
    with closing(stream.frames()) as frames:
        for frame in frames:
            if feed.closed:
                return
            if frame is None:
                continue
            if frame.names != names:
                names, markers = frame.names, streamed_markers(frame.names, robot)
            readings = readings_of_points(frame.points, markers, joint1)
            if readings is None:
                continue
            feed.saw(readings)
            if not told:
                feed.publish("source", {"message": f"from {stream.name}"})
                told = True


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
