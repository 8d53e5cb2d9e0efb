"""Triangles from OBJ files: of all that these may hold, the lines of corners and of faces.

Read here and not by trimesh, which puts the numbers of lines of differing length into the columns of others
and passes indented lines over, so that faces get the corners of others.
"""

from __future__ import annotations

import codecs
import itertools
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from synth.errors import InputError, Mistake
from synth.surfaces.mesh_faults import NOT_CONVEX, OVERLAPPING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from synth.arrays import FloatArray

_LINES_AT_ONCE = 100_000
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


class ObjBody(NamedTuple):
    """What an OBJ file holds.

    Attributes:
        vertices: The corners, shape (n, 3).
        faces: Which are those of each triangle, shape (m, 3); larger faces are fans about their first.
    """

    vertices: FloatArray
    faces: NDArray[np.int64]


def read_obj(content: bytes, path: Path, see_the_time: Callable[[], None]) -> ObjBody:
    """Return the corners and faces of an OBJ file.

    Args:
        content: What the file holds.
        path: The file.
        see_the_time: Called before each step that takes long; what it raises passes through.

    Raises:
        InputError: A line of a corner or a face is wrong, or faces that are not convex are divided wrongly.
    """
    text = content.decode("utf-16" if content.startswith(_UTF_16) else "utf-8-sig", errors="replace")
    vertices: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    owners: list[int] = []  # the line of the face that each is of
    # A line that ends in a backslash goes on, and is counted with its next one.
    lines = text.replace("\\\r\n", " ").replace("\\\n", " ").splitlines()
    for number, line in enumerate(lines, 1):
        if number % _LINES_AT_ONCE == 0:
            see_the_time()
        words = line.split("#", 1)[0].split()
        try:
            if words and words[0] == "v":
                vertices.append(_corner(words[1:4]))
            elif len(words) > 3 and words[0] == "f":
                first, *others = (_index(word, len(vertices)) for word in words[1:])
                triangles += ((first, second, third) for second, third in itertools.pairwise(others))
                owners += [number] * (len(others) - 1)
        except ValueError as error:
            raise InputError([Mistake(str(error), str(path), number)]) from None
    points, faces = np.array(vertices).reshape(-1, 3), np.array(triangles, dtype=np.int64).reshape(-1, 3)
    if faces.max(initial=-1) >= len(points):
        told = f"a face has the corner {faces.max() + 1}, but there are {len(points)}"
        raise InputError([Mistake(told, str(path), owners[int(faces.max(axis=1).argmax())])])
    see_the_time()
    if line_of_face := _divided_wrongly(points[faces], np.array(owners)):
        raise InputError([Mistake(NOT_CONVEX, str(path), line_of_face)])
    return ObjBody(points, faces)


def _divided_wrongly(corners: FloatArray, owners: NDArray[np.int64]) -> int:
    """Return the line of a face whose fan has a triangle upside down, the largest of them, or 0.

    Args:
        corners: Of the triangles, shape (m, 3, 3).
        owners: The line of the face that each is of, in their order, shape (m,).
    """
    if not len(owners):
        return 0
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    starts = np.flatnonzero(np.diff(owners, prepend=0))
    whole = np.repeat(np.add.reduceat(crossed, starts), np.diff(starts, append=len(owners)), axis=0)
    doubled = np.linalg.norm(crossed, axis=1)
    wrong = np.where(np.einsum("ni,ni->n", crossed, whole) < 0.0, doubled, 0.0)
    return int(owners[wrong.argmax()]) if wrong.sum() > OVERLAPPING * doubled.sum() else 0


def _corner(words: list[str]) -> list[float]:
    if len(words) < 3 or any("_" in word for word in words):
        raise ValueError("a corner must have three numbers")
    try:
        return [float(word) for word in words]
    except ValueError:
        raise ValueError("a corner must have three numbers") from None


def _index(word: str, corners: int) -> int:
    """Return the place of a corner, told from the first as 1, 2, or from the last one above as -1, -2."""
    told = word.split("/", 1)[0]
    if not (told.lstrip("-").isdecimal() and told.isascii() and len(told) < 12):
        raise ValueError("a face must have whole numbers of corners, as 1 or 1/2/3")
    place = int(told)
    if place == 0 or -place > corners:
        raise ValueError(f"a face has the corner {place}, but there are {corners} above")
    return place - 1 if place > 0 else corners + place
