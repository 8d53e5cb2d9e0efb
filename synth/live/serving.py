"""The live guide as a whole: a source of frames, the checks, and the page, until it is ended."""

from __future__ import annotations

import socket
import threading
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from synth.errors import SynthError
from synth.export import live_page
from synth.live.checker import Checker, CheckSettings
from synth.live.feed import Feed
from synth.live.server import ADDRESS, page_server
from synth.live.sources import feed_lines, feed_recording, feed_stream, feed_udp
from synth.live.streams import Stream
from synth.measurement import load_hand, recorded_frames

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from synth.synthesis import Solution

_LOOK = 0.1  # s, between looks at whether it is ended


@dataclass(frozen=True)
class Recording:
    """A recording as a source.

    Attributes:
        file: Any file that `synth check` reads.
        speed: 1 for a hundred frames a second.
    """

    file: Path
    speed: float


@contextmanager
def served_live(
    solution: Solution,
    source: Recording | Stream | int | Iterable[str] | None,
    port: int,
    *,
    corrections_left: int,
    marker_error: float,
    base_calibrated: bool,
    confidence: float,
    stiff: bool,
    hand: Path | None,
) -> Iterator[str]:
    """Serve the page of a solution while the block lasts.

    Args:
        solution: What the link is bent to: the first shape is wanted, the others will do.
        source: Where frames come from: a recording, a stream, the port of datagrams, lines, or nothing.
        port: Where the page is; 0 for any free port.
        corrections_left: How many corrections the operator is still willing to make.
        marker_error: Mean 3D error of a marker, m.
        base_calibrated: Whether axis 1 is the z axis of the frame, found by turning joint 1.
        confidence: Chance that all targets are within tolerance from which on the link is locked.
        stiff: Whether the link is stiff already.
        hand: The file of the hand that bends it; None: as published.

    Yields:
        The address of the page.

    Raises:
        SynthError: The task is not met, a port is taken, or a file cannot be read.
    """
    if not solution.found:
        raise SynthError(f"there is nothing to bend the link to: {solution.message}")
    bent_by = None if hand is None else load_hand(hand)
    settings = CheckSettings(corrections_left, marker_error, base_calibrated, confidence, stiff, bent_by)
    feed, checker = Feed(), Checker(solution, settings)
    with ExitStack() as opened:
        feeding = _feeding(feed, checker, solution, source, opened)
        server = opened.enter_context(page_server(live_page(solution), feed, port))
        opened.callback(server.shutdown)
        opened.callback(feed.close)  # first: whoever waits for something goes
        for work in (partial(server.serve_forever, _LOOK), partial(checker.run, feed), feeding):
            threading.Thread(target=work, daemon=True).start()
        yield f"http://{ADDRESS}:{server.server_port}/"


def _feeding(
    feed: Feed,
    checker: Checker,
    solution: Solution,
    source: Recording | Stream | int | Iterable[str] | None,
    opened: ExitStack,
) -> Callable[[], None]:
    """Return what feeds the frames, once it is known that it can."""
    robot, joint1 = solution.task.robot, checker.joint1
    if isinstance(source, Recording):
        return partial(feed_recording, feed, recorded_frames(source.file, robot, joint1), source.speed)
    if isinstance(source, Stream):
        return partial(feed_stream, feed, source, robot, joint1)
    if not isinstance(source, int):
        return partial(feed_lines, feed, source or (), robot, joint1)
    receiver = opened.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    try:
        receiver.bind((ADDRESS, source))
    except OSError as error:
        raise SynthError(f"cannot listen on port {source}: {error.strerror or error}") from error
    receiver.settimeout(_LOOK)
    return partial(feed_udp, feed, receiver, robot, joint1)
