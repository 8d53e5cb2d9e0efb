"""Text on paper: how wide it is, where its lines break, and what stands for signs that no font has.

Only the outline fonts that are installed count. What none of them draws is written so that it can be read:
a letter by its sound, a picture by its name, any other sign by its number.
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.font_manager import FontEntry
    from matplotlib.ft2font import FT2Font

FAMILY = "DejaVu Sans"  # comes with matplotlib
_MM_PER_POINT = 25.4 / 72.0
_SIZE = 100.0  # pt, at which widths are measured
_SPARE = 1.025  # on a screen, whose dots are coarse, text comes out wider than on paper
_GAP = "..."
_MOST_READ = 300  # characters of a name, half of them at each end: no line has room for more
_REGULAR = (400, "normal", "regular", "book")
# Fonts of boxes, fonts of pictures made of pixels, and fonts whose signs stand at places of their own.
_UNUSABLE = re.compile(r"last ?resort|emoji|^cm[a-z]+\d|STIX(Non|Size)|Symbols|Display", re.IGNORECASE)
# Blanks at which no line is broken: a number stays with its name and its unit.
_KEPT = re.compile(r"(?<=\d) (?=(?:mm|deg|%|±))|(?<=±) |(?<=\bd\d\d) |(?<=joint) (?=\d)")
_BLANK = "\u00a0"


def width(text: str, size: float, *, bold: bool = False) -> float:
    """Return how wide a line is, mm, at a font size, pt."""
    return sum(_advance(each, bold) for each in text) * size * _MM_PER_POINT * _SPARE


def shortened(name: str, room: float, size: float, *, bold: bool = False) -> str:
    """Return a name in one line with its beginning and its end, since names mostly differ at one.

    Args:
        name: A name of any length; line breaks and runs of blanks count as one blank.
        room: How wide it may be, mm.
        size: Of the font, pt.
        bold: Whether it is set in bold.
    """
    line = legible(" ".join(name.split()))
    if len(line) <= _MOST_READ and width(line, size, bold=bold) <= room:
        return line
    for kept in range(min(len(line) - 1, _MOST_READ), 1, -1):
        tail = kept // 2
        cut = f"{line[: kept - tail].rstrip()}{_GAP}{line[len(line) - tail :].lstrip()}"
        if width(cut, size, bold=bold) <= room:
            return cut
    return _GAP


def wrapped(text: str, room: float, size: float, *, most: int | None = None, bold: bool = False) -> list[str]:
    """Return a text in lines no wider than `room`, mm; what goes beyond `most` lines gives way to "..."."""

    def fits(line: str) -> bool:
        return width(line, size, bold=bold) <= room

    lines = [""]
    for word in _KEPT.sub(_BLANK, legible(" ".join(text.split()))).split(" "):
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if fits(longer):
            lines[-1] = longer
            continue
        lines += [""] if lines[-1] else []
        for each in word:  # as a rule it fits as a whole
            lines += [] if fits(lines[-1] + each) else [""]
            lines[-1] += each
    if most is not None and len(lines) > most:
        last = lines[most - 1]
        while last and not fits(f"{last} {_GAP}"):
            last = last[:-1].rstrip()
        lines = [*lines[: most - 1], f"{last} {_GAP}"]
    return [line.replace(_BLANK, " ") for line in lines]


def families(text: str) -> list[str]:
    """Return the fonts that draw a text, the sheet's own first."""
    return list(dict.fromkeys([FAMILY, *(family for each in text if (family := _family(each)))]))


def legible(text: str) -> str:
    """Return a text without signs that no font draws."""
    return text if text.isascii() and text.isprintable() else "".join(map(_drawable, text))


@cache
def _drawable(sign: str) -> str:
    """Return a sign if a font draws it, or else what stands for it."""
    if _family(sign):
        return sign
    alike = [each for each in unicodedata.normalize("NFKD", sign) if not unicodedata.combining(each)]
    if unicodedata.category(sign) in ("Cf", "Mn", "Me", "Mc"):  # joins or marks others; nothing by itself
        return ""
    if alike and alike != [sign] and all(map(_family, alike)):
        return "".join(alike)
    name = unicodedata.name(sign, "")
    letter = re.search(r" (?:LETTER|SYLLABLE|CHARACTER)\b.*?(\w+)(?: WITH .*)?$", name)
    if letter:
        return letter[1].lower()
    if name and unicodedata.category(sign) == "So":
        return f"[{name.lower()}]"
    return f"\\u{ord(sign):04x}" if ord(sign) < 0x10000 else f"\\U{ord(sign):08x}"


@cache
def _family(sign: str) -> str:
    """Return the family that draws a sign: the sheet's own, or else the first one; empty if there is none."""
    if not sign.isprintable() and sign != _BLANK:
        return ""
    if sign.isascii() or _has(_own(bold=False), sign):
        return FAMILY
    return next((entry.name for entry in _others() if _has(entry.fname, sign)), "")


@cache
def _others() -> list[FontEntry]:
    """Return the other fonts that may be used, by name: the same on every run."""
    from matplotlib.font_manager import fontManager  # noqa: PLC0415 - only who prints a sheet pays for it

    return sorted(
        (
            entry
            for entry in fontManager.ttflist
            if entry.weight in _REGULAR and entry.style == "normal" and not _UNUSABLE.search(entry.name)
        ),
        key=lambda entry: (entry.name, entry.fname),
    )


@cache
def _own(*, bold: bool) -> str:
    from matplotlib.font_manager import FontProperties, findfont  # noqa: PLC0415 - as above

    return findfont(FontProperties(family=FAMILY, weight="bold" if bold else "normal"))


@cache
def _font(path: str) -> FT2Font | None:
    from matplotlib.ft2font import FT2Font  # noqa: PLC0415 - as above

    try:
        font = FT2Font(path)
        font.set_size(_SIZE, 72.0)
    except (OSError, RuntimeError):  # it is broken, or made of pixels of one size
        return None
    return font


def _has(path: str, sign: str) -> bool:
    font = _font(path)
    return font is not None and font.get_char_index(ord(sign)) != 0


@cache
def _advance(sign: str, bold: bool) -> float:
    """Return how far a sign moves on, in units of the font's size."""
    family, path = _family(sign), _own(bold=bold)
    if family not in (FAMILY, ""):
        path = next(entry.fname for entry in _others() if entry.name == family)
    font = _font(path)
    if font is None:
        return 1.0
    return float(font.load_char(ord(sign)).linearHoriAdvance) / 65536.0 / _SIZE
