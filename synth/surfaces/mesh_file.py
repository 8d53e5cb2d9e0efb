"""Triangles and points from files of other programs, by trimesh, which is imported on use."""

from __future__ import annotations

import io
import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.errors import InputError, Mistake

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from synth.arrays import FloatArray

LARGEST = 1e6  # of a number in a file, either way
MAX_BYTES = 200_000_000  # of a file, and of what it holds packed
MESHES = {".stl": "stl", ".ply": "ply", ".obj": "obj"}
_MISSING = "needs trimesh to be read, which is not installed: pip install 'malleable-synth[meshes]'"


def read_corners(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the triangles of a STL, PLY or OBJ file, of all its bodies together.

    Args:
        path: The file.
        see_the_time: Called before each step that takes long; what it raises passes through.

    Returns:
        Corners of the triangles that have an area, shape (m, 3, 3), in the unit of the file.

    Raises:
        InputError: The file cannot be read, or holds no triangles.
    """
    if path.suffix.lower() not in MESHES:
        wanted = f"is no file of triangles by its name, which ends in none of {', '.join(MESHES)}"
        raise InputError([Mistake(wanted, str(path))])
    loaded = load(path, see_the_time)
    try:
        corners = np.concatenate(
            [np.asarray(mesh.vertices, dtype=np.float64)[mesh.faces] for mesh in loaded if _has_faces(mesh)]
        )
    except (ValueError, IndexError, TypeError):
        corners = np.empty((0, 3, 3))
    corners = corners[np.isfinite(corners).all(axis=(1, 2))]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners = corners[np.linalg.norm(sides, axis=1) > 0.0]
    if not len(corners):
        has_points = any(len(getattr(mesh, "vertices", ())) for mesh in loaded)
        instead = "; of points alone a surface is told as points: FILE" if has_points else ""
        raise InputError([Mistake(f"holds no triangle{instead}", str(path))])
    _refuse_too_large(corners, path)
    return np.asarray(corners, dtype=np.float64)


def read_vertices(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the points of a PLY file; those with a coordinate that is not a number are passed over.

    Args:
        path: The file.
        see_the_time: As for `read_corners`.

    Returns:
        The points, shape (n, 3), in the unit of the file.

    Raises:
        InputError: The file cannot be read, or holds no points.
    """
    vertices = [
        np.asarray(each.vertices, dtype=np.float64).reshape(-1, 3)
        for each in load(path, see_the_time)
        if hasattr(each, "vertices")
    ]
    return finite_points(np.concatenate(vertices) if vertices else np.empty((0, 3)), path)


def finite_points(points: FloatArray, path: Path) -> FloatArray:
    """Return the points of a file without those that have a coordinate that is not a number.

    Args:
        points: The points, shape (n, 3).
        path: The file.

    Raises:
        InputError: There are none, or one is too far away.
    """
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        raise InputError([Mistake("holds no points", str(path))])
    _refuse_too_large(points, path)
    return points


def load(path: Path, see_the_time: Callable[[], None]) -> list[Any]:
    """Return the bodies that trimesh finds in a file, whatever is wrong with it told as a mistake."""
    content = content_of(path)
    see_the_time()
    try:
        import trimesh  # noqa: PLC0415 - heavy, and not of everybody's installation
    except ImportError:
        raise InputError([Mistake(_MISSING, str(path))]) from None
    kind = MESHES[path.suffix.lower()]
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            loaded = trimesh.load_scene(io.BytesIO(content), file_type=kind, process=False).dump()
    except Exception as error:  # noqa: BLE001 - a damaged file breaks trimesh in any way
        reason = f"{type(error).__name__} in trimesh"
        raise InputError(
            [Mistake(f"is no {kind.upper()} file that can be read ({reason})", str(path))]
        ) from None
    see_the_time()
    return list(loaded) if isinstance(loaded, list | tuple) else [loaded]


def content_of(path: Path) -> bytes:
    """Return what a file holds.

    Raises:
        InputError: It cannot be read, or is too large.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise InputError([Mistake("there is no such file", str(path))]) from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise InputError([Mistake(f"cannot be read: {reason}", str(path))]) from None
    if len(content) > MAX_BYTES:
        raise InputError([Mistake(f"is larger than {MAX_BYTES // 1_000_000} MB", str(path))])
    return content


def _has_faces(mesh: Any) -> bool:
    return bool(len(getattr(mesh, "faces", ())))


def _refuse_too_large(numbers: FloatArray, path: Path) -> None:
    largest = float(np.abs(numbers).max(initial=0.0))
    if largest > LARGEST:
        told = f"{largest:g}" if math.isfinite(largest) else "infinite"
        wanted = f"{LARGEST:g} is the largest; a survey's must be moved to where the robot is"
        raise InputError([Mistake(f"holds the coordinate {told}: {wanted}", str(path))])
