"""Points from a CSV, XYZ, PLY, OBJ or PCD file: a scanned surface, of up to some millions of them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import InputError, Mistake
from synth.surfaces.content import LARGEST, MOVED, content_of
from synth.surfaces.mesh_file import read_vertices
from synth.surfaces.pcd_file import read_pcd

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from synth.arrays import FloatArray

_COLUMNS = ["x", "y", "z"]
_MISTAKES_AT_MOST = 10  # named one by one; of a file of another kind every line is wrong
_NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
_QUOTED_AT_MOST = 20  # characters of a cell


def read_points(path: Path, see_the_time: Callable[[], None] = lambda: None) -> FloatArray:
    """Read the points of a CSV file, one a line: x, y and z, under a header of these names or none.

    In a file whose name ends in `.xyz` spaces stand between, `#` begins a remark, and what follows the third
    number does not count. Of `.ply` and `.obj` files the vertices are the points; of these and of `.pcd`
    files those count that are numbers.

    Args:
        path: The file; empty lines are passed over.
        see_the_time: Called before each step that takes long; what it raises passes through.

    Returns:
        The points as they stand, shape (n, 3), in the unit of the file.

    Raises:
        InputError: The file cannot be read or is wrong; with the first ten mistakes and their lines.
    """
    if reader := {".ply": read_vertices, ".obj": read_vertices, ".pcd": read_pcd}.get(path.suffix.lower()):
        return reader(path, see_the_time)
    try:
        lines = content_of(path).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise InputError([Mistake("is not a text file in UTF-8", str(path))]) from None
    if path.suffix.lower() == ".xyz":  # columns with spaces between, and maybe colours behind the first three
        lines = [",".join(line.split("#", 1)[0].split()[:3]) for line in lines]
    see_the_time()
    first = next((number for number, line in enumerate(lines) if line.strip()), None)
    start = first + 1 if first is not None and _is_header(lines[first]) else 0
    rows = [line for line in lines[start:] if line.strip()]
    see_the_time()
    try:
        # The fast way; whatever is wrong is looked for line by line, by the same notion of a number.
        points = np.loadtxt(rows, delimiter=",", ndmin=2, comments=None) if rows else None
    except ValueError:
        points = None
    if points is None or points.shape[1] != 3 or not np.all(np.abs(points) <= LARGEST):
        raise InputError(_mistakes(lines, start, path))
    return points


def _is_header(line: str) -> bool:
    return [cell.strip().lower() for cell in line.split(",")] == _COLUMNS


def _mistakes(lines: list[str], start: int, path: Path) -> list[Mistake]:
    """Return what is wrong with lines of points, each with its line.

    Cells are quoted only of a file that is called a table: whatever else was named by mistake may hold what
    should not stand in a log.
    """
    mistakes: list[Mistake] = []
    file, quotes = str(path), path.suffix.lower() == ".csv"
    for number, line in enumerate(lines[start:], start + 1):
        if len(mistakes) == _MISTAKES_AT_MOST:
            return [*mistakes, Mistake("has more such lines; the first ones are named", file)]
        if line.strip() and (wrong := _wrong(line, quotes=quotes)):
            mistakes.append(Mistake(wrong, file, number))
    return mistakes or [Mistake("holds no points", file)]


def _wrong(line: str, *, quotes: bool) -> str:
    """Return what is wrong with a line, or nothing."""
    cells = [cell.strip() for cell in line.split(",")]
    if len(cells) != 3:
        return f"must hold three numbers with commas between, x,y,z, but holds {len(cells)} between commas"
    for name, cell in zip(_COLUMNS, cells, strict=True):
        what = f"is {cell[:_QUOTED_AT_MOST]!r}" if quotes else "is something else"
        if cell.lower().lstrip("+-") in {"nan", "inf", "infinity"}:
            return f"{name} must be a finite number, but {what}"
        if not _NUMBER.fullmatch(cell):
            return f"{name} must be a number such as -12.5 or 3e-2, but {what}"
        if not abs(float(cell)) <= LARGEST:
            return f"{name} must be a finite number, at most {LARGEST:g} either way, but {what}; {MOVED}"
    return ""
