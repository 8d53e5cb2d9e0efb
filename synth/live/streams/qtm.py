"""QTM (Qualisys), by its real-time protocol over TCP: packets of size, type and content; millimetres."""

from __future__ import annotations

import socket
import struct
import time
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from synth.errors import SynthError
from synth.live.streams.stream import ASKED_EVERY, LOOK, Bytes, Seen, Stream

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

_PORT = 22223  # of QTM, where numbers come with their little end first
_VERSION = "Version 1.8"  # the first whose positions are as they still are; every later QTM speaks it, too
_NAMES = "GetParameters 3D"
_FRAMES = "StreamFrames Frequency:100 3D"  # a second at most: of more, a slow reader would get old ones
_HEADER = struct.Struct("<II")  # bytes of the packet, this header included, and its type
_DATA = struct.Struct("<qII")  # time, frame, components
_MARKERS = struct.Struct("<I2H")  # how many, and how many images were lost or late, per thousand
_NOTHING = -1, b""  # the packet that did not come
_ERROR, _COMMAND, _XML, _FRAME = range(4)  # types of packets
_LABELLED = 1  # the type of a component
_LARGEST = 10_000_000  # bytes of a packet that is one
_CHUNK = 65536  # bytes
_METRE = 1000.0  # mm


class QtmStream(Stream):
    """QTM at an address; see `Stream`."""

    system, usual_port = "QTM", _PORT

    def frames(self) -> Generator[Seen | None]:
        """Yield frames as they come; see `Stream`."""
        with socket.create_connection(self._server, self._patience) as link:
            link.settimeout(LOOK)
            _send(link, _VERSION)
            names: tuple[str, ...] | None = None
            asked = seen = time.monotonic()
            for kind, content in _packets(link):
                now, frame = time.monotonic(), None
                if kind == _ERROR or (kind == _COMMAND and b"NOT supported" in content):
                    raise SynthError(f"it says {_text(content)!r}")
                if kind == _COMMAND and content.startswith(b"Version set"):
                    _send(link, _NAMES, _FRAMES)
                elif kind == _XML:
                    names = _names(content)
                elif kind == _FRAME and names is not None:
                    frame = _seen(content, names)
                    seen = now if frame else seen
                if names is not None and now - asked >= ASKED_EVERY:  # they may change at any time
                    _send(link, _NAMES)
                    asked = now
                if now - seen > self._patience:
                    raise SynthError("no frame comes: does it measure, or run in real time from a file?")
                yield frame


def _send(link: socket.socket, *commands: str) -> None:
    for command in commands:
        content = command.encode() + b"\0"
        link.sendall(_HEADER.pack(_HEADER.size + len(content), _COMMAND) + content)


def _packets(link: socket.socket) -> Iterator[tuple[int, bytes]]:
    """Yield type and content of packets as they come, and one that is none while none comes."""
    data = b""
    while True:
        try:
            more = link.recv(_CHUNK)
        except TimeoutError:
            yield _NOTHING
            continue
        if not more:
            raise SynthError("it closed the connection")
        data += more
        while len(data) >= _HEADER.size:
            size, kind = _HEADER.unpack_from(data)
            if not _HEADER.size <= size <= _LARGEST:
                raise SynthError(
                    f"this is not QTM's real-time protocol, little end first, as on port {_PORT}"
                )
            if len(data) < size:
                break
            yield kind, data[_HEADER.size : size]
            data = data[size:]


def _text(content: bytes) -> str:
    return content.partition(b"\0")[0].decode("utf-8", "replace")


def _names(content: bytes) -> tuple[str, ...]:
    """Return the names of the labelled markers in the order of the frames."""
    try:
        labels = ET.fromstring(_text(content)).findall("The_3D/Label")  # noqa: S314 - of whom the user named
    except ET.ParseError as error:
        raise SynthError(f"it describes its markers by what is no XML: {error}") from error
    return tuple(label.findtext("Name", "").strip() for label in labels)


def _seen(content: bytes, names: tuple[str, ...]) -> Seen | None:
    """Return the labelled markers in a frame; nothing if there are others than are named, until they are.

    Raises:
        SynthError: The frame is not as the protocol has it.
    """
    reader = Bytes(content)
    for _ in range(int(reader.take(_DATA)[2])):
        start = reader.at
        size, kind = reader.take(_HEADER)
        if kind == _LABELLED:
            count = int(reader.take(_MARKERS)[0])
            if count != len(names):
                return None
            placed = zip(names, reader.points(count), strict=True)  # not a number, what was not seen
            return Seen(names, {name: (x / _METRE, y / _METRE, z / _METRE) for name, (x, y, z) in placed})
        reader.skip(start + int(size) - reader.at)
    return None
