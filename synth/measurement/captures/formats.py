"""Which kind of capture a file is: chosen by how it begins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.measurement.captures.motive import begins_as_motive, motive_capture
from synth.measurement.captures.motive_frames import begins_as_motive_frames, motive_frames_capture
from synth.measurement.captures.qtm import begins_as_qtm, qtm_capture
from synth.measurement.captures.trc import begins_as_trc, trc_capture

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.measurement.captures.capture import Capture

_READERS: tuple[tuple[Callable[[str], bool], Callable[[str, str], Capture]], ...] = (
    (begins_as_motive, motive_capture),
    (begins_as_motive_frames, motive_frames_capture),
    (begins_as_trc, trc_capture),
    (begins_as_qtm, qtm_capture),
)


def is_capture(text: str) -> bool:
    """Whether a text begins as the export of a tracking system does."""
    return _reader(text) is not None


def capture_in(text: str, file: str) -> Capture | None:
    """Read a capture.

    Args:
        text: The file.
        file: Its name, for the mistakes.

    Returns:
        The capture, or None if the file begins as none does.

    Raises:
        InputError: It is a capture that cannot be read.
    """
    reader = _reader(text)
    return None if reader is None else reader(text, file)


def _reader(text: str) -> Callable[[str, str], Capture] | None:
    line = text.lstrip("\r\n\t ")[:100_000].partition("\n")[0].partition("\r")[0]
    return next((reader for begins, reader in _READERS if begins(line)), None)
