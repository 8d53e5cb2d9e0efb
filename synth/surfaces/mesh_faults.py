"""What is wrong with a file of triangles and goes unnoticed: it is cut off, or faces were divided wrongly."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray

_ELEMENT = re.compile(rb"^\s*element[ \t]+(\S+)[ \t]+([0-9]{1,12})\s*$", re.MULTILINE)
_END_OF_HEADER = re.compile(rb"^[ \t]*end_header[ \t]*\r?\n", re.MULTILINE)
_LAST_WORD = re.compile(rb"endsolid[^\r\n]*\s*\Z", re.IGNORECASE)
OVERLAPPING = 1e-3  # of the area: rounding and damage leave less
NOT_CONVEX = (
    "has faces that overlap themselves when divided into triangles, as those that are not convex do; "
    "write it as triangles"
)
_STRIPS = "holds triangles in strips, which are not read; write it with a list for each face"


def too_short(kind: str, content: bytes, bodies: Sequence[Any]) -> str:
    """Return in which way a file holds less than it says, or nothing.

    Args:
        kind: "stl", "ply" or "obj"; the last does not say what follows.
        content: What the file holds.
        bodies: What was read of it.
    """
    if kind == "stl":
        return _stl_too_short(content)
    return _ply_too_short(content, bodies) if kind == "ply" else ""


def is_binary_stl(content: bytes) -> bool:
    """Whether a file has the length that it would say as a binary one."""
    return len(content) == 84 + 50 * int.from_bytes(content[80:84], "little")


def ply_parts(content: bytes) -> tuple[bytes, bytes]:
    """Return the header of a PLY file, with the line that ends it, and what follows."""
    end = _END_OF_HEADER.search(content)
    return (content[: end.end()], content[end.end() :]) if end else (content, b"")


def _stl_too_short(content: bytes) -> str:
    if is_binary_stl(content) or _LAST_WORD.search(content[-300:]):
        return ""
    return "ends too early: no endsolid ends it, and it is no binary file of the length that its header says"


def _ply_too_short(content: bytes, bodies: Sequence[Any]) -> str:
    header, rest = ply_parts(content)
    said = _said(header)
    if b"tristrips" in said and not said.get(b"face"):
        return _STRIPS
    if b"format ascii" in header:
        lines = sum(bool(line.strip()) for line in rest.splitlines())
        if lines < sum(said.values()):
            return f"ends too early: its header says {sum(said.values())} lines, but {lines} follow"
    for name, read in ((b"vertex", "vertices"), (b"face", "faces")):
        number = sum(len(getattr(body, read, ())) for body in bodies)
        if number < said.get(name, 0):
            return f"holds {number} {read} that can be read, but its header says {said[name]}"
    return ""


def _said(header: bytes) -> dict[bytes, int]:
    """Return how many of each element a PLY file says that it holds."""
    return {name: int(number) for name, number in _ELEMENT.findall(header)}


def without_corners(kind: str, content: bytes, bodies: Sequence[Any]) -> str:  # noqa: ARG001 - one of several
    """Return that faces have corners that are not there, or nothing; as for `too_short`."""
    for body in bodies:
        faces = np.asarray(getattr(body, "faces", ()))
        shapes = (np.shape(body.vertices)[1:], faces.shape[1:]) if len(faces) else ((3,), (3,))
        if shapes != ((3,), (3,)) or faces.min(initial=0) < 0 or faces.max(initial=-1) >= len(body.vertices):
            return "has faces whose corners it does not hold"
    return ""


def divided_wrongly(kind: str, content: bytes, bodies: Sequence[Any]) -> str:
    """Return that faces of a PLY file were divided wrongly, or nothing; as for `too_short`."""
    meshes = [body for body in bodies if len(getattr(body, "faces", ()))]
    given = _said(ply_parts(content)[0]).get(b"face", 0)
    if kind != "ply" or sum(len(mesh.faces) for mesh in meshes) <= given:
        return ""
    shares = [overlapping(np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces)) for mesh in meshes]
    return NOT_CONVEX if max(shares) > OVERLAPPING else ""


def overlapping(vertices: FloatArray, faces: NDArray[np.integer[Any]]) -> float:
    """Return which share of a mesh lies on other triangles, as faces were divided into them.

    A fan divides a face that is not convex into triangles that overlap: of two that share an edge across the
    face one is upside down in the plane of the other.

    Args:
        vertices: The corners, shape (n, 3).
        faces: Which are those of each triangle, shape (m, 3).

    Returns:
        The area of the smaller triangle of each such pair, as a share of the area of all.
    """
    corners = vertices[faces]
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(crossed, axis=1)
    first, second = _across(faces, len(vertices))
    along = np.einsum("ni,ni->n", crossed[first], crossed[second])
    opposed = along < -(1.0 - 1e-9) * doubled[first] * doubled[second]
    smaller = np.minimum(doubled[first], doubled[second])[opposed]
    return float(smaller.sum() / max(doubled.sum(), np.finfo(float).tiny))


def _across(faces: NDArray[np.integer[Any]], vertices: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return pairs of triangles that division leaves side by side: a b c and c d a, or a b c and a c d."""
    ends = np.asarray(faces, dtype=np.int64)
    others = np.concatenate([ends[:, 2] * vertices + ends[:, 0], ends[:, 0] * vertices + ends[:, 1]])
    order = np.argsort(others, kind="stable")
    wanted = ends[:, 0] * vertices + ends[:, 2]
    match = order[np.minimum(np.searchsorted(others, wanted, sorter=order), len(others) - 1)]
    first = np.flatnonzero(others[match] == wanted)
    second = match[first] % len(ends)
    same = (np.sort(ends[first], axis=1) == np.sort(ends[second], axis=1)).all(axis=1)
    return first[~same], second[~same]
