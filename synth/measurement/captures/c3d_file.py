"""C3D files, by the package c3d, which is imported on use."""

from __future__ import annotations

import io
import warnings
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.errors import InputError, Mistake
from synth.measurement.captures.capture import Capture, Track, metre_in

if TYPE_CHECKING:
    from synth.arrays import FloatArray

_MARK, _BLOCK = 0x50, 512  # the second byte of every C3D file; its length in bytes is one of blocks
_MISSING = "is a C3D file, which needs c3d to be read: pip install 'malleable-synth[captures]'"
_LEAST_BYTES = 8  # of a point in a frame: four integers of two bytes


def begins_as_c3d(content: bytes) -> bool:
    """Whether a file begins as C3D does, and no text."""
    return len(content) >= _BLOCK and content[1] == _MARK and 0 in content[:_BLOCK]


def c3d_capture(content: bytes, file: str) -> Capture:
    """Read a C3D file.

    Args:
        content: The file.
        file: Its name, for the mistakes.

    Raises:
        InputError: c3d is not installed, or the file is damaged, or does not say its unit of length.
    """
    try:
        import c3d  # noqa: PLC0415 - not of everybody's installation
    except ImportError:
        raise InputError([Mistake(_MISSING, file)]) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            names, unit, points = _read(c3d.Reader(io.BytesIO(content)), len(content))
    except Exception as error:  # noqa: BLE001 - a damaged file breaks c3d in any way
        reason = f"is a C3D file that cannot be read: {type(error).__name__} in c3d"
        raise InputError([Mistake(reason, file)]) from None
    metre = metre_in(unit, file, None)
    tracks = tuple(Track(name, 3 * k) for k, name in enumerate(names) if name)
    rows = tuple(
        (number, list(row)) for number, row in enumerate(points.reshape(len(points), -1).tolist(), 1)
    )
    return Capture(tracks, rows, metre)


def _read(reader: Any, size: int) -> tuple[list[str], str, FloatArray]:
    """Return names, the unit, and points, shape (frames, names, 3), not a number where nothing was seen.

    No more frames are read than fit into the file, whatever its header says.
    """
    used = int(reader.point_used)
    names = [label.strip() for label in reader.point_labels][:used]
    units = reader.get("POINT:UNITS")
    at_most = size // (_LEAST_BYTES * max(used, 1)) + 1
    frames = [np.array(points[: len(names)]) for _, points, _ in islice(reader.read_frames(), at_most)]
    table = np.array(frames, dtype=np.float64).reshape(len(frames), len(names), -1)
    if not table.size:
        return [], "" if units is None else units.string_value, np.empty((0, 0, 3))
    seen = table[:, :, 3:4] >= 0.0  # the residual; negative where the point was not seen
    return names, "" if units is None else units.string_value, np.where(seen, table[:, :, :3], np.nan)
