"""The text of a file of markers, in the encodings that tracking software writes."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING

from synth.errors import InputError, Mistake
from synth.measurement.captures.formats import is_capture

if TYPE_CHECKING:
    from pathlib import Path

_MAX_BYTES = 50_000_000
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def text_of(path: Path, file: str) -> str:
    """Return the text of a file, or refuse what is none.

    UTF-8 and, with a byte-order mark, UTF-16. Captures, whose unknown names may be in any language, are also
    read as Latin-1: names of markers of this arm and numbers are the same there.
    """
    content = _bytes_of(path, file)
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
