"""Motive (OptiTrack), by NatNet over UDP: frames come by unicast or multicast, as Motive says.

Whoever asks has to go on asking, or Motive sends no more; and names may change at any time. So all questions
are asked again and again.
"""

from __future__ import annotations

import select
import socket
import struct
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING

from synth.errors import SynthError
from synth.live.streams import natnet_packets as natnet
from synth.live.streams.stream import ASKED_EVERY, LOOK, Seen, Stream

if TYPE_CHECKING:
    from collections.abc import Generator

    from synth.live.streams.natnet_packets import Names, Server

_PORT = 1510  # of Motive, where it is asked
_LARGEST = 65536  # bytes of a datagram
_UNIT = "UnitsToMillimeters"  # the question how many millimetres one of the stream's units is
_FLOAT = struct.Struct("<f")
_METRE = 1000.0  # mm, what Motive sends unless it says something else
_UNITS = 0.01, 1e5  # mm, between which an answer is one


class MotiveStream(Stream):
    """Motive at an address; see `Stream`."""

    system, usual_port = "Motive", _PORT

    def frames(self) -> Generator[Seen | None]:
        """Yield frames as they come; see `Stream`."""
        with ExitStack() as opened:
            connection = _Connection(self._server, opened)
            asked, seen = -ASKED_EVERY, time.monotonic()
            while True:
                now = time.monotonic()
                if now - asked >= ASKED_EVERY:
                    connection.ask()
                    asked = now
                frame = connection.next_frame()
                seen = now if frame and frame.points else seen
                if now - seen > self._patience:
                    raise SynthError(connection.lacks)
                yield frame


class _Connection:
    """What Motive said so far, and the sockets where it says more, which are closed with others."""

    def __init__(self, server: tuple[str, int], opened: ExitStack) -> None:
        self._server = socket.gethostbyname(server[0]), server[1]
        self._opened = opened
        self._local = _local_address(self._server)
        self._asking = opened.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        self._asking.bind((self._local, 0))
        opened.callback(self._send, natnet.DISCONNECT)
        self._listening = [self._asking]
        self._who: Server | None = None
        self._names: Names | None = None
        self._unit = _METRE
        self._frames = 0

    @property
    def lacks(self) -> str:
        """What is wrong with it, if no marker was seen."""
        if self._who is None:
            return "no answer: does it stream, on the interface with this address?"
        if not self._frames:
            return f"{self._who.application} sends no frame: is it live, or does it play a take?"
        return "no marker with a name is seen: does it stream Labeled Markers and Asset Markers?"

    def ask(self) -> None:
        """Ask for all that may have changed, which also keeps the frames coming."""
        for message in (natnet.KEEP_ALIVE if self._who else natnet.CONNECT, natnet.REQUEST_NAMES):
            self._send(message)
        self._send(natnet.REQUEST, _UNIT)

    def _send(self, message: int, text: str = "") -> None:
        self._asking.sendto(natnet.packet(message, text), self._server)

    def next_frame(self) -> Seen | None:
        """Return a frame, or nothing if none comes in a tenth of a second.

        Raises:
            SynthError: What came is not NatNet 3 or 4.
        """
        for heard in select.select(self._listening, [], [], LOOK)[0]:
            data, sender = heard.recvfrom(_LARGEST)
            if heard is not self._asking or sender[0] == self._server[0]:
                return self._taken(*natnet.opened(data))
        return None

    def _taken(self, message: int, content: bytes) -> Seen | None:
        """Return the frame in a packet, or take what else it says."""
        if message == natnet.SERVER_INFO:
            self._meet(natnet.server_in(content))
        elif message == natnet.RESPONSE and len(content) == _FLOAT.size:
            (unit,) = _FLOAT.unpack(content)
            self._unit = (
                unit if _UNITS[0] < unit < _UNITS[1] else _METRE
            )  # no number: it knows no such question
        elif message == natnet.NAMES and self._who:
            self._names = natnet.names_in(content, self._who.version)
        elif message == natnet.FRAME and self._who and self._names:
            self._frames += 1
            metre = _METRE / self._unit
            points = natnet.points_in(content, self._who.version, self._names)
            scaled = {name: (x / metre, y / metre, z / metre) for name, (x, y, z) in points.items()}
            return Seen(self._names.all, scaled)
        return None

    def _meet(self, who: Server) -> None:
        """Take who sends, and listen where its frames come."""
        if who.version[0] not in {3, 4}:
            version = ".".join(map(str, who.version))
            raise SynthError(f"{who.application} speaks NatNet {version}, and only 3 and 4 are understood")
        if who.group and self._who is None:
            group, port = who.group
            heard = self._opened.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            heard.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # others on this machine listen, too
            heard.bind(("", port))
            joined = socket.inet_aton(group) + socket.inet_aton(self._local)
            heard.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, joined)
            self._listening.append(heard)
        self._who = who


def _local_address(server: tuple[str, int]) -> str:
    """Return the address of this machine from which a server is reached."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect(server)
        return str(probe.getsockname()[0])
