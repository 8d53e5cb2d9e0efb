"""What values may be: the checks that frozen values make of their own fields, and their sentences.

A value refuses what it cannot mean as soon as it is made, with every mistake at once, so nothing behind a
constructor meets NaN, a negative length or a wrong shape. Files are checked by their schema first, which
knows lines and units; it takes its sentences and its rules for words, names and triangles from here.
"""

from __future__ import annotations

import math
from enum import Enum
from numbers import Real
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from synth.errors import InputError, Mistake
from synth.names import did_you_mean

if TYPE_CHECKING:
    from synth.arrays import FloatArray

# m, rad or 1/m. Wide, so that only slips are caught, and what overflows when it is squared; files allow a
# tenth, which leaves the search room to relax a limit.
LARGEST = 1e7
SMALLEST = 1e-18  # of what others are divided by: tolerances and weights
LONGEST_NAME = 100

_E = TypeVar("_E", bound=Enum)


class Checks:
    """Checks the fields of one frozen value, puts the checked ones in place, and collects the mistakes.

    A field is written back as what it means: a float, a read-only array, an enumeration's member.

    Args:
        value: The value, from its `__post_init__`; None to check what is no field.
    """

    def __init__(self, value: object = None) -> None:
        self._value = value
        self._mistakes: list[Mistake] = []

    def report(self, key: str, message: str) -> None:
        """Note a mistake in a field."""
        self._mistakes.append(Mistake(message, key=key))

    def found_in(self, key: str) -> bool:
        """Whether a mistake was found in a field."""
        return any(mistake.key == key for mistake in self._mistakes)

    def put(self, key: str, content: object) -> None:
        """Put a field in place."""
        object.__setattr__(self._value, key, content)

    def number(
        self, key: str, *, least: float = -LARGEST, most: float = LARGEST, above: float = -math.inf
    ) -> None:
        """Check a field that is a number, with bounds as in `wrong_number`."""
        given = getattr(self._value, key)
        # The fast way first: values are made by the thousand while a task is solved.
        if type(given) is float and least <= given <= most and given > above:
            return
        if wrong := wrong_number(given, least=least, most=most, above=above):
            self.report(key, wrong)
        else:
            self.put(key, float(given))

    def array(
        self,
        key: str,
        shape: tuple[int | None, ...],
        *,
        least: float = -LARGEST,
        above: float = -math.inf,
        rows: str = "",
    ) -> bool:
        """Check a field that is an array of numbers, and make it read-only.

        Args:
            key: The field; it may hold whatever numpy reads as an array of numbers.
            shape: Its shape; None for a length that is free.
            least: Least value of each number.
            above: What each number must exceed.
            rows: What a row is called in a mistake, such as `targets[{}].position`, if not by the field.

        Returns:
            Whether it is right.
        """
        array = numbers_in(given := getattr(self._value, key))
        if array is None:
            self.report(key, f"must be {_shape_words(shape)}, but is {described(given)}")
            return False
        if array.ndim != len(shape) or any(
            want not in {None, have} for want, have in zip(shape, array.shape, strict=True)
        ):
            self.report(key, f"must be {_shape_words(shape)}, but has the shape {array.shape}")
            return False
        array.setflags(write=False)
        self.put(key, array)
        # Both comparisons are false for NaN. The least and the largest number tell of all.
        if array.size == 0 or (
            max(least, -LARGEST) <= array.min() and array.max() <= LARGEST and array.min() > above
        ):
            return True
        wrong = np.argwhere(~((array >= least) & (np.abs(array) <= LARGEST) & (array > above)))
        for place in wrong[:10]:
            row, *column = place.tolist()
            name = rows.format(row) if rows else f"{key}[{row}]"
            sentence = wrong_number(float(array[tuple(place)]), least=least, above=above)
            self.report(name + "".join(f"[{index}]" for index in column), sentence)
        return False

    def name(self, key: str) -> None:
        """Check a field that names something: one line of text."""
        if wrong := wrong_name(getattr(self._value, key)):
            self.report(key, wrong)

    def word(self, key: str, kind: type[_E]) -> None:
        """Check a field that is a member of an enumeration, or its word without regard to case."""
        given = getattr(self._value, key)
        if isinstance(given, kind):
            return
        words = [str(member.value) for member in kind]
        if isinstance(given, str) and given.lower() in words:
            self.put(key, kind(given.lower()))
            return
        known = f"{', '.join(map(repr, words[:-1]))} or {words[-1]!r}"
        self.report(key, f"must be {known}, but is {described(given)}{did_you_mean(given, words)}")

    def is_a(self, key: str, kind: type | tuple[type, ...]) -> bool:
        """Check of what type a field is."""
        if wrong := wrong_type(getattr(self._value, key), kind):
            self.report(key, wrong)
        return not wrong

    def refuse(self) -> None:
        """Raise all mistakes as one error, if there are any.

        Raises:
            InputError: There are.
        """
        if self._mistakes:
            raise InputError(self._mistakes)


def numbers_in(given: Any) -> FloatArray | None:
    """Return a float copy of what is an array of numbers; None if it is not one."""
    try:
        array = np.asarray(given)
        if array.dtype.kind in "iuf":
            return np.array(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):  # ragged, or of what is no number
        pass
    return None


def wrong_number(
    value: object, *, least: float = -LARGEST, most: float = LARGEST, above: float = -math.inf
) -> str:
    """Return what is wrong with a number, or nothing.

    Args:
        value: What was given for it.
        least: The least that it may be.
        most: The most that it may be.
        above: What it must exceed.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        return f"must be a number, but is {described(value)}"
    try:
        number = float(value)
    except OverflowError:
        return f"must be a finite number, but is {described(value)}"
    if not math.isfinite(number) and not (most == math.inf == number):
        return f"must be a finite number, but is {number!r}"
    if number <= above:
        return f"must be greater than {above:g}, but is {number:g}"
    if number < least:
        wanted = "greater than 0" if number <= 0.0 < least else f"at least {least:g}"
        return f"must be {wanted}, but is {number:g}"
    return f"must be at most {most:g}, but is {number:g}" if number > most else ""


def wrong_name(value: object) -> str:
    """Return what is wrong with a name, or nothing."""
    if not isinstance(value, str):
        return f"must be text, but is {described(value)}"
    if not (value.strip() and len(value) <= LONGEST_NAME and value.isprintable()):
        return f"must be one line of 1 to {LONGEST_NAME} printable characters"
    return ""


def wrong_type(value: object, kind: type | tuple[type, ...]) -> str:
    """Return what is wrong with a value that is not of a type, or nothing."""
    if isinstance(value, kind):
        return ""
    kinds = kind if isinstance(kind, tuple) else (kind,)
    wanted = " or ".join("None" if each is type(None) else f"{_article(each)}" for each in kinds)
    return f"must be {wanted}, but is {described(value)}"


def refuse_unless(key: str, value: object, kind: type) -> None:
    """Refuse an argument that is not of its type.

    Raises:
        InputError: It is not.
    """
    if not isinstance(value, kind):
        raise InputError([Mistake(wrong_type(value, kind), key=key)])


def _article(kind: type) -> str:
    return f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}"


def described(value: object) -> str:
    """Name a value in a sentence."""
    if value is None:
        return "empty (null)"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return "a number too large" if isinstance(value, int) and abs(value) > 10**300 else repr(value)
    if isinstance(value, str):
        return f"the text {value[:40]!r}"
    if isinstance(value, dict | list):
        return "a mapping" if isinstance(value, dict) else "a list"
    return _article(type(value))


def _shape_words(shape: tuple[int | None, ...]) -> str:
    match shape:
        case (int(count),):
            return f"{count} numbers"
        case (None,):
            return "a list of numbers"
        case (None, int(count)):
            return f"rows of {count} numbers"
        case _:
            return " x ".join(map(str, shape)) + " numbers"
