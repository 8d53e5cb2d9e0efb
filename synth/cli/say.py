"""Printing that never fails: what a stream cannot take is replaced, and one that is gone is left alone."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import TextIO

# What stands for characters that a terminal may lack; a question mark for all others.
_SUBSTITUTES = str.maketrans({"•": "*", "…": "...", "°": " deg", "θ": "theta", "Γ": "Gamma", "–": "-"})


def say(text: str, *, on_stderr: bool = False) -> bool:
    """Print a text and a line break.

    Args:
        text: The text, of any characters.
        on_stderr: Whether it is talk, not the answer.

    Returns:
        Whether it was delivered, or nobody is there to read it. False if the device broke down or is full.
    """
    stream = sys.stderr if on_stderr else sys.stdout
    if stream is None:  # closed before the program began
        return True
    try:
        stream.write(_printable(text, stream) + "\n")
        stream.flush()
    except (OSError, ValueError) as error:  # ValueError: a stream that was closed since
        _leave(stream)
        return not isinstance(error, OSError) or isinstance(error, BrokenPipeError)
    return True


def _printable(text: str, stream: TextIO) -> str:
    """Return a text with what a stream cannot encode replaced."""
    encoding = stream.encoding or "utf-8"
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        text = "".join(one if _encodes(one, encoding) else one.translate(_SUBSTITUTES) for one in text)
        return text.encode(encoding, "replace").decode(encoding)
    return text


def _encodes(character: str, encoding: str) -> bool:
    try:
        character.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def _leave(stream: TextIO) -> None:
    """Send what is still to be written nowhere: the interpreter would fail on it as it ends."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        stream.flush()
    except (OSError, ValueError):
        return
