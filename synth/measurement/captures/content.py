"""What is in a file of markers: a capture, or text, in the encodings that tracking software writes."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING

from synth.errors import InputError, Mistake
from synth.measurement.captures.c3d_file import begins_as_c3d, c3d_capture
from synth.measurement.captures.formats import capture_in, is_capture
from synth.measurement.captures.ros_bag import bag_capture, is_bag

if TYPE_CHECKING:
    from pathlib import Path

    from synth.measurement.captures.capture import Capture

_MAX_BYTES = 50_000_000
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def content_of(path: Path, file: str) -> Capture | str:
    """Read a file of markers.

    Args:
        path: The file.
        file: Its name, for the mistakes.

    Returns:
        The capture in it, or its text if it begins as none does.

    Raises:
        InputError: It cannot be read, is no text, or a capture that cannot be read.
    """
    if is_bag(path):
        return bag_capture(path, file)
    content = _bytes_of(path, file)
    if begins_as_c3d(content):
        return c3d_capture(content, file)
    text = _text_of(content, file)
    return capture_in(text, file) or text


def _text_of(content: bytes, file: str) -> str:
    """Return the text of a file, or refuse what is none.

    UTF-8 and, with a byte-order mark, UTF-16. Captures, whose other names may be in any language, are also
    read as Latin-1: names of markers of this arm and numbers are the same there.
    """
    try:
        text = content.decode("utf-16" if content.startswith(_UTF_16) else "utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
        if not is_capture(text):
            raise InputError([Mistake("is not a text file in UTF-8", file)]) from None
    if "\0" in text:
        raise InputError([Mistake("is not a text file: it holds the character NUL", file)])
    return text


def _bytes_of(path: Path, file: str) -> bytes:
    try:
        with path.open("rb") as stream:
            content = stream.read(_MAX_BYTES + 1)
    except FileNotFoundError:
        raise InputError([Mistake("there is no such file", file)]) from None
    except (OSError, ValueError) as error:
        raise InputError(
            [Mistake(f"cannot be read: {getattr(error, 'strerror', None) or error}", file)]
        ) from None
    if len(content) > _MAX_BYTES:
        raise InputError([Mistake(f"is larger than {_MAX_BYTES // 1_000_000} MB", file)])
    return content
