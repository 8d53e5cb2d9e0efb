"""What a stream of a tracking system is, whoever sends it, and the bytes that all of them are made of."""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from synth.errors import SynthError

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

Point = tuple[float, float, float]
PATIENCE = 3.0  # s, without a frame, after which a stream counts as lost
ASKED_EVERY = 0.5  # s, between questions that also keep a connection alive
LOOK = 0.1  # s, that is waited for something to come, so that closing is noticed
_LARGEST_PORT = 65535


class Seen(NamedTuple):
    """A frame.

    Attributes:
        names: All that the system has names for, seen or not.
        points: Where markers were seen, by their names, m, in the frame of the system.
    """

    names: tuple[str, ...]
    points: Mapping[str, Point]


class Stream(ABC):
    """A tracking system at an address, which sends frames.

    Args:
        address: Its host, and maybe the port where it is asked, the system's usual one unless told.
        patience: Time without a frame after which it counts as lost, s.

    Attributes:
        name: What and where it is, for the mistakes.

    Raises:
        SynthError: The address is none.
    """

    system: ClassVar[str]
    usual_port: ClassVar[int]

    def __init__(self, address: str, patience: float = PATIENCE) -> None:
        self._server = address_of(address, self.usual_port)
        self._patience = patience
        self.name = f"{self.system} at {self._server[0]}:{self._server[1]}"

    @abstractmethod
    def frames(self) -> Generator[Seen | None]:
        """Connect, and yield frames as they come, None in each tenth of a second in which none comes.

        Raises:
            SynthError: There is no such system, it speaks something else, or it sends no more.
            OSError: It cannot be reached.
        """


def address_of(text: str, port: int) -> tuple[str, int]:
    """Return host and port of an address such as "192.168.1.5" or "192.168.1.5:1510".

    Args:
        text: The address.
        port: The port where it names none.

    Raises:
        SynthError: It is none.
    """
    host, colon, word = text.strip().rpartition(":") if ":" in text else (text.strip(), "", "")
    number = int(word) if word.isascii() and word.isdigit() else 0
    try:
        host.encode("idna")  # as the network does it
    except UnicodeError:
        host = ""
    if not host or ":" in host or (colon and not 0 < number <= _LARGEST_PORT):
        raise SynthError(f"{text!r} is no address: it must be a host, or a host and a port, such as {port}")
    return host, number or port


class Bytes:
    """Reads what stands in a packet, little end first, from the beginning to the end.

    Args:
        data: The packet.
        at: Where to begin.
    """

    def __init__(self, data: bytes, at: int = 0) -> None:
        self._data, self.at = data, at

    def take(self, layout: struct.Struct) -> tuple[float, ...]:
        """Return the next numbers.

        Raises:
            SynthError: The packet ends before.
        """
        start = self.at
        self.skip(layout.size)
        return layout.unpack_from(self._data, start)

    def number(self) -> int:
        """Return the next integer of four bytes."""
        return int(self.take(_NUMBER)[0])

    def count(self) -> int:
        """Return how many of something follow.

        Raises:
            SynthError: The packet cannot hold so many.
        """
        number = self.number()
        if not 0 <= number <= len(self._data):
            raise SynthError("a packet says that it holds more than it does")
        return number

    def points(self, count: int) -> list[Point]:
        """Return the next points."""
        return [(x, y, z) for x, y, z in (self.take(_POINT) for _ in range(count))]

    def text(self) -> str:
        """Return the next text, which a zero ends."""
        end = self._data.find(b"\0", self.at)
        start, self.at = self.at, end + 1
        if end < 0:
            raise SynthError("a packet ends within a name")
        return self._data[start:end].decode("utf-8", "replace")

    def skip(self, count: int) -> None:
        """Pass over some bytes."""
        self.at += count
        if count < 0 or self.at > len(self._data):
            raise SynthError("a packet is shorter than it says")


_NUMBER, _POINT = struct.Struct("<i"), struct.Struct("<3f")
