"""How a text comes to a terminal: signs that it can show, and colour where there is one and it is wanted."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from synth.sentences import BULLET, FOUND, MISSED

if TYPE_CHECKING:
    from typing import TextIO

_COLOURS = {FOUND: "green", MISSED: "red"}
_PLAIN = {FOUND: "+", MISSED: "x", BULLET: "*", "±": "+-"}


def as_shown(text: str, stream: TextIO | None) -> str:
    """Return a text as a stream takes it.

    Signs that its encoding lacks give way to ASCII. Colour comes only on a terminal, and not if the
    environment has a NO_COLOR that is not empty (https://no-color.org).

    Args:
        text: Lines, of which those of a target and the headline begin with a sign.
        stream: Where they go; None if it was closed before the program began.
    """
    if stream is None:
        return text
    coloured = stream.isatty() and not os.environ.get("NO_COLOR")
    lines = (_coloured(line) if coloured else line for line in text.split("\n"))
    shown = "\n".join(lines)
    for sign, plain in _PLAIN.items():
        if not _encodable(sign, stream.encoding):
            shown = shown.replace(sign, plain)
    return shown


def _coloured(line: str) -> str:
    colour = _COLOURS.get(line[:1])
    return line if colour is None else click.style(line[:1], fg=colour, bold=True) + line[1:]


def _encodable(sign: str, encoding: str | None) -> bool:
    try:
        sign.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
