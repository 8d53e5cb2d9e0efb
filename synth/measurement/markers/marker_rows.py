"""Rows of a file of measured points, CSV or one JSON object a line: cells by column, with their lines."""

from __future__ import annotations

import csv
import difflib
import json
from typing import Any

from synth.errors import InputError, Mistake
from synth.measurement.captures import MISTAKES_AT_MOST

UNITS = {"mm": 1000.0, "m": 1.0}  # to divide by
_COLUMNS = {
    "marker": "P1 to P5; A1:150 and A2:-50.5 on the axes, E:-60 at the link's end, L050 on the link, in mm",
    **{f"{axis}_{unit}": f"{axis} in the base frame, {unit}" for unit in UNITS for axis in "xyz"},
    "joint1_deg": "where joint 1 stood, degrees; absent: the angle to hold of the solution",
    "joint2_deg": "where joint 2 stood, degrees; absent: 180",
    "frame": "number of the frame; the mean of a marker's frames counts",
}


Row = tuple[int, dict[str, object]]


def row_schema() -> dict[str, Any]:
    """Return the JSON Schema of a row: a line of JSON, or of a CSV file with these columns."""
    cells = {
        name: {"type": "string"} if name == "marker" else {"type": ["number", "string", "null"]}
        for name in _COLUMNS
    }
    return {
        "title": "Row",
        "type": "object",
        "properties": {name: {**cell, "description": _COLUMNS[name]} for name, cell in cells.items()},
        "oneOf": [{"required": [f"{axis}_{unit}" for axis in "xyz"]} for unit in UNITS],
        "additionalProperties": False,
    }


def json_rows(text: str, file: str, *, named: bool = True) -> list[Row]:
    """Return the rows of JSON objects, one on each line; `named` says whether each names its marker."""
    rows: list[Row] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        try:
            row = json.loads(line)
        except (ValueError, RecursionError):
            raise InputError([Mistake("is no JSON object on one line", file, number)]) from None
        if not isinstance(row, dict):
            raise InputError(
                [Mistake("must be a JSON object with the keys marker, x_mm, y_mm, z_mm", file, number)]
            )
        _check_columns(list(row), file, number, named=named)
        rows.append((number, row))
    return rows


def csv_rows(text: str, file: str, *, named: bool = True) -> list[Row]:
    """Return the rows of a CSV file with a header; `named` says whether each names its marker."""
    lines = csv.reader(text.splitlines())
    try:
        table = [
            (lines.line_num, [cell.strip() for cell in cells])
            for cells in lines
            if any(map(str.strip, cells))
        ]
    except csv.Error as error:
        raise InputError([Mistake(f"is no CSV: {error}", file, lines.line_num)]) from None
    if not table:
        raise InputError([Mistake("holds no markers", file)])
    first, header = table[0][0], [cell.lower() for cell in table[0][1]]
    if not any(cell in _COLUMNS for cell in header):
        example = "marker,x_mm,y_mm,z_mm" if named else "x_mm,y_mm,z_mm"
        raise InputError(
            [
                Mistake(
                    f"must begin with a header such as {example}: in which unit are these numbers?",
                    file,
                    first,
                )
            ]
        )
    _check_columns(header, file, first, named=named)
    mistakes = [
        Mistake(f"has {len(cells)} cells, and the header {len(header)}", file, number)
        for number, cells in table[1:]
        if len(cells) != len(header)
    ]
    if mistakes:
        raise InputError(mistakes[:MISTAKES_AT_MOST])
    return [(number, dict(zip(header, cells, strict=True))) for number, cells in table[1:]]


def _check_columns(names: list[str], file: str, line: int, *, named: bool) -> None:
    mistakes = []
    for name in dict.fromkeys(names):
        if name not in _COLUMNS:
            near = difflib.get_close_matches(name, _COLUMNS, 1, 0.5)
            hint = f"; did you mean {near[0]}?" if near else f"; there are {', '.join(_COLUMNS)}"
            mistakes.append(Mistake(f"unknown column{hint}", file, line, name[:40]))
        elif names.count(name) > 1:
            mistakes.append(Mistake("is there twice", file, line, name))
    units = [unit for unit in UNITS if any(f"{axis}_{unit}" in names for axis in "xyz")]
    if not mistakes and len(units) != 1:
        mistakes.append(
            Mistake("must have x, y and z in one unit: x_mm,y_mm,z_mm or x_m,y_m,z_m", file, line)
        )
    elif not mistakes and not all(f"{axis}_{units[0]}" in names for axis in "xyz"):
        mistakes.append(Mistake(f"must have all of x_{units[0]}, y_{units[0]} and z_{units[0]}", file, line))
    if named and "marker" not in names:
        mistakes.append(Mistake("must name the marker", file, line, "marker"))
    if mistakes:
        raise InputError(mistakes)
