"""Packets of NatNet, versions 3 and 4: who sends, what the markers are called, and where they are.

From 4.1 on every section says how long it is. Before, what stands in front of the labelled markers has to be
read to be passed over.
"""

from __future__ import annotations

import struct
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from synth.errors import SynthError
from synth.live.streams.stream import Bytes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.live.streams.stream import Point

CONNECT, SERVER_INFO, REQUEST, RESPONSE, REQUEST_NAMES, NAMES, _, FRAME, _, DISCONNECT, KEEP_ALIVE = range(11)
_HEADER = struct.Struct("<HH")  # the message, and how many bytes follow
_VERSIONS = struct.Struct("<8B")  # of the program, and of NatNet
_CONNECTION = struct.Struct(
    "<QHB4B"
)  # ticks a second of a clock, port of the frames, whether by multicast, to whom
_LABELLED = struct.Struct("<i3ffHf")  # ID, position, size, flags, residual
_APPLICATION = 256  # bytes of a name
_POINT, _BODY = 12, 38  # bytes of a point, and of a rigid body in a frame
_OCCLUDED, _MEASURED, _BY_THE_MODEL = 1, 2, 4  # flags of a marker
_SIZED, _TURNED, _NAMED = (4, 1), (4, 2), (4, 0)  # the versions from which on sections and bodies hold more
_MARKER_SET, _RIGID_BODY, _SKELETON = range(3)  # what is described
_ALL = "all"  # the marker set that repeats all others

Version = tuple[int, int]


class Server(NamedTuple):
    """Who sends.

    Attributes:
        application: The program and its version.
        version: Of NatNet.
        group: Address and port of the multicast in which frames come; None if they come to whoever asked.
    """

    application: str
    version: Version
    group: tuple[str, int] | None


class Names(NamedTuple):
    """What the markers are called.

    Attributes:
        sets: Names in the order of each marker set.
        bodies: Names in the order of each rigid body, by its ID.
    """

    sets: dict[str, tuple[str, ...]]
    bodies: dict[int, tuple[str, ...]]

    @property
    def all(self) -> tuple[str, ...]:
        """All of them, each once."""
        return tuple(dict.fromkeys(chain(*self.sets.values(), *self.bodies.values())))


def packet(message: int, text: str = "") -> bytes:
    """Return a packet that asks for something."""
    content = text.encode() + b"\0"
    return _HEADER.pack(message, len(content)) + content


def opened(data: bytes) -> tuple[int, bytes]:
    """Return the message of a packet and its content; what is none is message -1."""
    if len(data) < _HEADER.size:
        return -1, b""
    message, size = _HEADER.unpack_from(data)
    return message, data[_HEADER.size : _HEADER.size + size]


def server_in(content: bytes) -> Server:
    """Return who sends.

    Raises:
        SynthError: The packet is shorter than that.
    """
    reader = Bytes(content, _APPLICATION)
    program, version = (numbers := reader.take(_VERSIONS))[:4], numbers[4:]
    name = content[:_APPLICATION].partition(b"\0")[0].decode("utf-8", "replace")
    group = None
    if len(content) >= reader.at + _CONNECTION.size:  # older ones do not say it
        _, port, by_multicast, *address = reader.take(_CONNECTION)
        group = (".".join(str(part) for part in address), int(port)) if by_multicast else None
    told = f"{name or 'a server'} {program[0]:.0f}.{program[1]:.0f}"
    return Server(told, (int(version[0]), int(version[1])), group)


def names_in(content: bytes, version: Version) -> Names:
    """Return what the markers are called; those of skeletons are in their marker sets.

    Raises:
        SynthError: The packet is not as this version has it.
    """
    reader = Bytes(content)
    sets: dict[str, tuple[str, ...]] = {}
    bodies: dict[int, tuple[str, tuple[str, ...]]] = {}
    for _ in range(reader.count()):
        kind = reader.number()
        end = reader.count() + reader.at if version >= _SIZED else None
        if kind == _MARKER_SET:
            name = reader.text()
            sets[name] = tuple(_full(name, reader.text()) for _ in range(reader.count()))
        elif kind == _RIGID_BODY:
            number, name, named = _body(reader, version)
            bodies[number] = name, named
        elif kind == _SKELETON and end is None:
            reader.text()
            reader.number()
            for _ in range(reader.count()):
                _body(reader, version)
        elif end is None:  # cameras and the like: no marker is described behind them
            break
        reader.at = reader.at if end is None else end
    sets.pop(_ALL, None)
    return Names(sets, {k: named or sets.get(name, ()) for k, (name, named) in bodies.items()})


def _body(reader: Bytes, version: Version) -> tuple[int, str, tuple[str, ...]]:
    """Return ID and name of a rigid body, and the names of its markers if it says them."""
    name, number = reader.text(), reader.number()
    reader.skip(4 + _POINT + (16 if version >= _TURNED else 0))  # its parent, and where it is to that
    count = reader.count()
    reader.skip(count * (_POINT + 4))  # where its markers are in it, and their active labels
    names = [reader.text() for _ in range(count)] if version >= _NAMED else []
    return number, name, tuple(_full(name, each) for each in names) if any(names) else ()


def _full(owner: str, name: str) -> str:
    """Return the name of a marker behind that of its set, where it stands in some versions already."""
    return f"{owner}:{name.removeprefix(f'{owner}:').removeprefix(f'{owner}_')}"


def points_in(content: bytes, version: Version, names: Names) -> dict[str, Point]:
    """Return where markers were measured, by their names.

    A marker set has a position for each of its markers, but fills in those that it did not see. Labelled
    markers say whether they were measured, but not of which set they are: what counts is a position in both.
    A labelled marker of a rigid body says by its ID which it is, from 1.

    Raises:
        SynthError: The packet is not as this version has it.
    """
    reader = Bytes(content)
    reader.number()  # of the frame
    count, _ = _section(reader, version)
    sets = {reader.text(): reader.points(reader.count()) for _ in range(count)}
    _pass(reader, version, _POINT)  # markers without a set
    _pass(reader, version, _BODY)
    _pass(reader, version, None)  # skeletons
    if version >= _SIZED:
        _pass(reader, version, None)  # assets
    measured = dict(_measured(reader, version))
    found = {
        name: point
        for owner, points in sets.items()
        for name, point in zip(names.sets.get(owner, ()), points, strict=False)
        if point in measured
    }
    for point, number in measured.items():
        of_body = names.bodies.get(number >> 16, ())
        if 0 < number & 0xFFFF <= len(of_body):
            found.setdefault(of_body[(number & 0xFFFF) - 1], point)
    return found


def _section(reader: Bytes, version: Version) -> tuple[int, int | None]:
    """Return how many of something follow, and where they end if that is said."""
    count = reader.count()
    return count, reader.count() + reader.at if version >= _SIZED else None


def _pass(reader: Bytes, version: Version, width: int | None) -> None:
    """Pass over a section, of so many bytes each, or of lists of rigid bodies behind an ID."""
    count, end = _section(reader, version)
    if end is not None:
        reader.at = end
    elif width is not None:
        reader.skip(count * width)
    else:
        for _ in range(count):
            reader.number()
            reader.skip(reader.count() * _BODY)


def _measured(reader: Bytes, version: Version) -> Iterator[tuple[Point, int]]:
    """Yield position and ID of the labelled markers that were seen, and not filled in."""
    count, end = _section(reader, version)
    if end is not None and end - reader.at != count * _LABELLED.size:
        raise SynthError(f"labelled markers of {(end - reader.at) // max(count, 1)} bytes are not known")
    for _ in range(count):
        number, x, y, z, _, flags, _ = reader.take(_LABELLED)
        filled = int(flags) & _BY_THE_MODEL and not int(flags) & _MEASURED
        if not int(flags) & _OCCLUDED and not filled:
            yield (x, y, z), int(number)
