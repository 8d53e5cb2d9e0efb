"""Triangles and points from files of other programs: STL and PLY by trimesh, which is imported on use."""

from __future__ import annotations

import codecs
import io
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.errors import InputError, Mistake
from synth.surfaces.content import content_of, finite_points, refuse_too_far
from synth.surfaces.mesh_faults import divided_wrongly, is_binary_stl, ply_parts, too_short, without_corners
from synth.surfaces.obj_file import read_obj

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from synth.arrays import FloatArray

    Fault = Callable[[str, bytes, list[Any]], str]

MESHES = {".stl": "stl", ".ply": "ply", ".obj": "obj"}
_ASCII = bytes(range(128)) + b"?" * 128
_MISSING = "needs trimesh to be read, which is not installed: pip install 'malleable-synth[meshes]'"
_OTHER_LENGTH = (  # of a binary PLY file
    "its length is not what its header says: it ends too early, or its faces have differing numbers of "
    "corners, which is not read; write it as triangles"
)


def read_corners(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the triangles of a STL, PLY or OBJ file, of all its bodies together.

    Args:
        path: The file.
        see_the_time: Called before each step that takes long; what it raises passes through.

    Returns:
        Corners of the triangles that have an area, shape (m, 3, 3), in the unit of the file.

    Raises:
        InputError: The file cannot be read, holds no triangles, or what would be read is not what it means.
    """
    if path.suffix.lower() not in MESHES:
        wanted = f"is no file of triangles by its name, which ends in none of {', '.join(MESHES)}"
        raise InputError([Mistake(wanted, str(path))])
    bodies = load(path, see_the_time, without_corners, divided_wrongly)
    parts = [
        np.asarray(body.vertices, dtype=np.float64)[body.faces]
        for body in bodies
        if len(getattr(body, "faces", ()))
    ]
    corners = np.concatenate(parts) if parts else np.empty((0, 3, 3))
    if undefined := np.count_nonzero(~np.isfinite(corners).all(axis=(1, 2))):
        told = f"holds {undefined} triangles with a corner that is not a number, of {len(corners)}"
        raise InputError([Mistake(told, str(path))])
    refuse_too_far(corners, path)
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners = corners[np.linalg.norm(sides, axis=1) > 0.0]
    if not len(corners):
        has_points = any(len(getattr(body, "vertices", ())) for body in bodies)
        instead = "; of points alone a surface is told as points: FILE" if has_points else ""
        raise InputError([Mistake(f"holds no triangle that has an area{instead}", str(path))])
    return np.asarray(corners)


def read_vertices(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the points of a PLY or OBJ file; those with a coordinate that is not a number are passed over.

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


def load(path: Path, see_the_time: Callable[[], None], *faults: Fault) -> list[Any]:
    """Return the bodies in a file, whatever is wrong with it told as a mistake.

    Args:
        path: The file.
        see_the_time: As for `read_corners`.
        faults: What more may be wrong than that the file is too short.
    """
    content = content_of(path)
    see_the_time()
    if not content.strip():
        raise InputError([Mistake("is empty", str(path))])
    kind = MESHES[path.suffix.lower()]
    with np.errstate(all="ignore"):  # of numbers that are too large, which are refused later
        if kind == "obj":
            bodies: list[Any] = [read_obj(content, path, see_the_time)]
        else:
            bodies = _by_trimesh(kind, content, path)
        wrong = next(filter(None, (fault(kind, content, bodies) for fault in (too_short, *faults))), "")
    if wrong:
        raise InputError([Mistake(wrong, str(path))])
    see_the_time()
    return bodies


def _by_trimesh(kind: str, content: bytes, path: Path) -> list[Any]:
    try:
        import trimesh  # noqa: PLC0415 - heavy, and not of everybody's installation
    except ImportError:
        raise InputError([Mistake(_MISSING, str(path))]) from None
    talk = trimesh.util.log
    was_silent, talk.disabled = talk.disabled, True
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.filterwarnings("error", "string or file could not be read")  # else the rest is lost
            scene = trimesh.load_scene(
                io.BytesIO(_in_ascii(kind, content)),
                file_type=kind,
                process=False,
                skip_materials=True,  # pictures are not looked for
                fix_texture=False,  # corners stand as often as in the file
            )
            return list(scene.dump())
    except Exception as error:  # noqa: BLE001 - a damaged file breaks trimesh in any way
        reason = _OTHER_LENGTH if "unexpected length" in str(error) else f"{type(error).__name__} in trimesh"
        wrong = f"is no {kind.upper()} file that can be read ({reason})"
        raise InputError([Mistake(wrong, str(path))]) from None
    finally:
        talk.disabled = was_silent


def _in_ascii(kind: str, content: bytes) -> bytes:
    """Return a file with names and remarks in ASCII: where they are not, trimesh needs one library more."""
    content = content.removeprefix(codecs.BOM_UTF8)
    if kind == "stl":
        return content if is_binary_stl(content) else content.translate(_ASCII)
    header, rest = ply_parts(content)
    return header.translate(_ASCII) + (rest.translate(_ASCII) if b"format ascii" in header else rest)
