"""Points from PCD files, the format of the Point Cloud Library and of many scanners.

Read here and not by pypcd4, which refuses files of version .5 (samples of that library itself) and numbers
with more than one space between, and makes room for whatever number of points and fields a header claims.
The format: https://pointclouds.org/documentation/tutorials/pcd_file_format.html
"""

from __future__ import annotations

import itertools
import math
import struct
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from synth.errors import InputError, Mistake
from synth.surfaces.content import MAX_BYTES, content_of, finite_points

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from synth.arrays import FloatArray

_COLUMNS = ("x", "y", "z")
_HEADER_LINES = 100  # more than any has with its remarks: what has no DATA line by then is no PCD file
_TYPES = {*("F4", "F8"), *(f"{sign}{size}" for sign in "IU" for size in (1, 2, 4, 8))}


class _Field(NamedTuple):
    """A column of the table: its name, its numpy type, and how many numbers it holds of each point."""

    name: str
    type: str
    numbers: int

    @property
    def size(self) -> int:
        """How many bytes it has of each point."""
        return int(self.type[1:]) * self.numbers


class _Header(NamedTuple):
    """What a PCD file says of itself: its fields in order, its number of points, how they are coded."""

    fields: list[_Field]
    points: int
    coding: str

    @property
    def row(self) -> int:
        """How many bytes stand for a point."""
        return sum(field.size for field in self.fields)

    def before(self, name: str) -> list[_Field]:
        """Return the fields that stand before that of a name."""
        return list(itertools.takewhile(lambda field: field.name != name, self.fields))

    def type_of(self, name: str) -> np.dtype[np.generic]:
        """Return how the numbers of a field are coded, least byte first."""
        return np.dtype("<" + next(field.type for field in self.fields if field.name == name).lower())


def read_pcd(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the points of a PCD file: ASCII, binary or binary_compressed.

    Organised scans have a row for each pixel; pixels without a return, not a number in x, y or z, are
    passed over.

    Args:
        path: The file.
        see_the_time: Called before each step that takes long; what it raises passes through.

    Returns:
        The points, shape (n, 3), in the unit of the file.

    Raises:
        InputError: The file cannot be read, is not as its header says, or holds no points.
    """
    content = content_of(path)
    see_the_time()
    try:
        header, data = _parted(content)
        with np.errstate(invalid="ignore"):  # of what is no number in its coding
            points = _CODINGS[header.coding](header, data) if header.points else np.empty((0, 3))
    except ValueError as error:
        raise InputError([Mistake(f"is no PCD file that can be read: {error}", str(path))]) from None
    see_the_time()
    return finite_points(points, path)


def _parted(content: bytes) -> tuple[_Header, bytes]:
    """Return the header of a file, and what stands behind it."""
    said: dict[str, list[str]] = {}
    rest = content
    for _ in range(_HEADER_LINES):
        line, _, rest = rest.partition(b"\n")
        words = line.decode("ascii", errors="replace").split("#", 1)[0].split()
        if words:
            said[words[0].upper()] = words[1:]
        if "DATA" in said:
            return _header(said), rest
    raise ValueError("its header has no DATA line")


def _header(said: dict[str, list[str]]) -> _Header:
    names = said.get("FIELDS", said.get("COLUMNS", []))
    columns = {"SIZE": ["4"], "TYPE": ["F"], "COUNT": ["1"]}
    for key, usual in columns.items():
        columns[key] = said.get(key, usual * len(names))
        if len(columns[key]) != len(names):
            raise ValueError(f"{key} speaks of {len(columns[key])} fields, FIELDS of {len(names)}")
    types = [letter + size for letter, size in zip(columns["TYPE"], columns["SIZE"], strict=True)]
    if unknown := [kind for kind in types if kind not in _TYPES]:
        raise ValueError(f"TYPE and SIZE of a field are {unknown[0][:20]!r}, not such as F4 or U1")
    fields = [_Field(*each) for each in zip(names, types, map(_number, columns["COUNT"]), strict=True)]
    for name in _COLUMNS:
        if [field.numbers for field in fields if field.name == name] != [1]:
            raise ValueError(f"its header must have one field {name}, of one number")
    coding = " ".join(said["DATA"]).lower()
    if coding not in _CODINGS:
        raise ValueError(f"DATA is {coding[:20]!r}, not one of {', '.join(_CODINGS)}")
    return _Header(fields, _count(said), coding)


def _count(said: dict[str, list[str]]) -> int:
    """Return how many points there should be, which most headers say twice."""
    sides = [_number(*said.get(side, ["1"])) for side in ("WIDTH", "HEIGHT")]
    points = _number(*said["POINTS"]) if "POINTS" in said else math.prod(sides)
    if "WIDTH" in said and math.prod(sides) != points:
        raise ValueError(f"WIDTH times HEIGHT is {math.prod(sides)}, POINTS is {points}")
    return points


def _number(*words: str) -> int:
    if len(words) != 1 or not (words[0].isascii() and words[0].isdigit() and len(words[0]) < 12):
        raise ValueError(f"its header says {' '.join(words)[:20]!r} where a whole number is expected")
    return int(words[0])


def _from_text(header: _Header, data: bytes) -> FloatArray:
    lines = [line for line in data.decode("ascii", errors="replace").splitlines() if line.strip()]
    if len(lines) != header.points:
        raise ValueError(f"its header says {header.points} points, but {len(lines)} lines follow")
    wanted = sum(field.numbers for field in header.fields)
    if any(len(line.split()) != wanted for line in lines):
        raise ValueError(f"a line does not hold {wanted} numbers, as its header says")
    places = [sum(field.numbers for field in header.before(name)) for name in _COLUMNS]
    return np.loadtxt(lines, usecols=places, ndmin=2, comments=None)


def _from_rows(header: _Header, data: bytes) -> FloatArray:
    wanted = header.points * header.row
    # The library itself has filled files up with zeros to the end of a page; others end them with a new line.
    if len(data) < wanted or len(data[wanted:].strip(b"\0")) >= header.row:
        raise ValueError(
            f"its header says {header.points} points of {header.row} bytes, but {len(data)} bytes follow"
        )
    kinds = [header.type_of(name) for name in _COLUMNS]
    offsets = [sum(field.size for field in header.before(name)) for name in _COLUMNS]
    row = np.dtype({"names": _COLUMNS, "formats": kinds, "offsets": offsets, "itemsize": header.row})
    table = np.frombuffer(data, row, count=header.points)
    return np.column_stack([table[name].astype(np.float64) for name in _COLUMNS])


def _from_packed_columns(header: _Header, data: bytes) -> FloatArray:
    """Read fields that stand one behind the other, each of all points, and are compressed together."""
    if len(data) < 8:
        raise ValueError("it ends behind its header")
    packed, unpacked = struct.unpack("<II", data[:8])
    wanted = header.points * header.row
    if unpacked != wanted or wanted > MAX_BYTES or packed > len(data) - 8:
        raise ValueError(
            f"its header says {header.points} points of {header.row} bytes, but {len(data)} bytes follow, "
            f"which should be {packed} compressed and {unpacked} when unpacked"
        )
    table = unpack_lzf(data[8 : 8 + packed], unpacked)
    starts = [sum(field.size for field in header.before(name)) * header.points for name in _COLUMNS]
    columns = [
        np.frombuffer(table, header.type_of(name), count=header.points, offset=start).astype(np.float64)
        for name, start in zip(_COLUMNS, starts, strict=True)
    ]
    return np.column_stack(columns)


def unpack_lzf(packed: bytes, size: int) -> bytearray:
    """Return what LZF packed: runs of bytes as they stand, and runs that repeat what came before.

    Args:
        packed: The packed bytes.
        size: How many bytes they were; no more are made.

    Raises:
        ValueError: The bytes were not packed so, or were of another number.
    """
    made, at, end = bytearray(), 0, len(packed)
    while at < end and len(made) <= size:
        control = packed[at]
        if control < 32:
            made += packed[at + 1 : at + control + 2]
            at += control + 2
            continue
        longer = control >= 224  # the length goes on in a byte of its own
        if at + 1 + longer >= end:
            break
        length = (control >> 5) + 2 + (packed[at + 1] if longer else 0)
        back = ((control & 31) << 8) + packed[at + 1 + longer] + 1
        if back > len(made):
            break
        run = made[len(made) - back : len(made) - back + length]
        made += run if back >= length else (run * (length // back + 1))[:length]
        at += 2 + longer
    if at != end or len(made) != size:
        raise ValueError("its compressed part is damaged")
    return made


_CODINGS = {"ascii": _from_text, "binary": _from_rows, "binary_compressed": _from_packed_columns}
