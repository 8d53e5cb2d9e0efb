"""What checks told of the hand, from their files, and the file of a hand that was learned."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from synth.errors import InputError, Mistake
from synth.files import read_file
from synth.measurement.hand.hand import Hand
from synth.measurement.hand.learning import Deed, HandError
from synth.measurement.markers import rotation_matrix
from synth.task import as_path, validate

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable

    from synth.arrays import FloatArray
    from synth.files import Document

HAND_SCHEMA = "synth.hand/1"
CHECK_SCHEMA = "synth.check/1"
_Three = Annotated[list[float], Field(min_length=3, max_length=3)]
_Six = Annotated[list[float], Field(min_length=6, max_length=6)]
_Square = Annotated[float, Field(ge=0.0)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore", strict=True, allow_inf_nan=False)


class _Axis(_Part):
    point: _Three
    direction: _Three


class _Measured(_Part):
    axis2: _Axis | None = None


class _Move(_Part):
    move: _Three
    rotate: _Three


class _HandErrorPart(_Part):
    deed: Literal["placed", "corrected", "stiffened"]
    asked: _Six
    error: _Six
    noise: Annotated[list[_Square], Field(min_length=2, max_length=2)]


class _CheckFile(_Part):
    schema_: Literal["synth.check/1"] = Field(alias="schema")
    measured: _Measured
    correction: _Move | None = None
    hand: _HandErrorPart | None = None


class _Error(_Part):
    shift: _Square
    turn: _Square


class _HandFile(_Part):
    schema_: Literal["synth.hand/1"] = Field(alias="schema")
    placement: _Error
    share: _Square
    floor: _Error
    drift: _Error


def load_hand(path: str | os.PathLike[str]) -> Hand:
    """Read the hand that `synth learn` wrote.

    Raises:
        InputError: The file cannot be read, or holds no hand.
    """
    document = read_file(as_path(path))
    file = validate(document, _HandFile)
    if file is None:
        raise document.error()
    placement, floor, drift = ((e.shift, e.turn) for e in (file.placement, file.floor, file.drift))
    return Hand(placement, file.share, floor, drift)


def aim_of_check(path: str | os.PathLike[str]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return where a check said that the link's end should go.

    Returns:
        The end, shape (3,), m, the direction of axis 2, shape (3,), and the displacement, shift and rotation
        vector, shape (6,), m and rad; zero if nothing was to be corrected.

    Raises:
        InputError: The file cannot be read, or is no check of an arm that was seen.
    """
    file = _check_in(read_file(as_path(path)))
    if file.measured.axis2 is None:
        raise InputError([Mistake("is a check whose measurement was not believed", str(path))])
    asked = file.correction
    move = np.zeros(6) if asked is None else np.array([*asked.move, *asked.rotate])
    end, axis = np.array(file.measured.axis2.point), np.array(file.measured.axis2.direction)
    return end + move[:3], rotation_matrix(move[3:]) @ axis, move


def errors_of_checks(paths: Iterable[str | os.PathLike[str]]) -> list[HandError]:
    """Read what checks told of the hand.

    Args:
        paths: Files of checks, or folders: then all `.json` files in them that are checks.

    Raises:
        InputError: A file cannot be read, or a file named is no check.
    """
    documents: list[Document] = []
    for path in map(as_path, paths):
        if path.is_dir():
            documents += filter(_is_check, map(read_file, sorted(path.rglob("*.json"))))
        else:
            documents.append(read_file(path))
    parts = [part for each in documents if (part := _check_in(each).hand) is not None]
    return [
        HandError(Deed(part.deed), np.array(part.asked), np.array(part.error), np.array(part.noise))
        for part in parts
    ]


def _is_check(document: Document) -> bool:
    return isinstance(document.value, dict) and document.value.get("schema") == CHECK_SCHEMA


def _check_in(document: Document) -> _CheckFile:
    file = validate(document, _CheckFile)
    if file is None:
        raise document.error()
    return file
