"""YAML 1.2 as plain values; the only file that knows the YAML library.

It reads the parser's events and nothing above them: aliases are never expanded, tags never construct
anything, and the depth is bounded before it costs recursion. The library's nodes would not be shorter: they
have lost the names of aliases, recurse through any depth (RecursionError at 2000), cannot be asked in between
whether the time is up, and take 1.2 times as long for 5000 targets.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    Event,
    MappingStartEvent,
    NodeEvent,
    ScalarEvent,
)
from ruamel.yaml.reader import ReaderError

from synth.errors import InputError, Mistake
from synth.files.document import MAX_DEPTH, REFUSED, Document, KeyPath
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

MAX_BYTES = 2_000_000  # some 25 000 targets, read in seconds

_ASKED_AFTER = 100  # items of a list, how late it is: they take some 50 ms
_FASTER = "; thousands of points are read much faster from a table: surface: {points: file.csv}"
# Plain scalars of the YAML 1.2 core schema: no sexagesimals, `yes` is a text, `1e-3` a number.
_VALUES: dict[str, bool | None] = {"null": None, "true": True, "false": False}
_WORDS = {form: value for word, value in _VALUES.items() for form in (word, word.title(), word.upper())}
_INTEGER = re.compile(r"[-+]?[0-9]{1,15}|0o[0-7]{1,15}|0x[0-9a-fA-F]{1,12}")  # longer ones are floats
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_PAIR = re.compile("[\ud800-\udbff][\udc00-\udfff]")
_NOT_FINITE = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")


def read_file(path: Path, is_up: Callable[[], bool] = never) -> Document:
    """Read a YAML file.

    Args:
        path: The file.
        is_up: Asked now and then whether the time for reading is up.

    Raises:
        InputError: There is no such file, it cannot be read, is too large, or is no YAML document.
            Milder mistakes wait in the document.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise _refusal(path, "there is no such file") from None
    except IsADirectoryError:
        raise _refusal(path, "is a directory, not a file") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise _refusal(path, f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if len(content) > MAX_BYTES:
        raise _refusal(path, f"is larger than {MAX_BYTES // 1_000_000} MB, too much for a task or robot file")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise _refusal(path, "is not a text file in UTF-8", line) from None
    return read_text(text, str(path), is_up)


def read_text(text: str, file: str | None = None, is_up: Callable[[], bool] = never) -> Document:
    """Read a YAML text.

    Args:
        text: The text.
        file: Name of its file, for mistakes.
        is_up: Asked now and then whether the time for reading is up.

    Raises:
        InputError: The text is no YAML document. Milder mistakes wait in the document.
    """
    document = Document(file, is_up)
    reader = _Reader(text, document)
    try:
        document.value = reader.document()
    except _NotYamlError as error:
        document.report((), str(error), error.line or reader.line)
        raise document.error() from None
    if document.value is None:
        document.report((), "is empty: a mapping (key: value) is expected", 1)
        raise document.error()
    return document


def _refusal(path: Path, message: str, line: int | None = None) -> InputError:
    return InputError([Mistake(message, str(path), line)])


class _NotYamlError(Exception):
    """What follows cannot be read; `line` is None where the parser does not tell it."""

    def __init__(self, message: str, line: int | None = None) -> None:
        super().__init__(message)
        self.line = line


def _nodes(text: str) -> Iterator[Event]:
    """Yield those events of the text that begin a value or end a collection."""
    try:
        for event in YAML(typ="safe", pure=True).parse(text):
            if isinstance(event, NodeEvent | CollectionEndEvent):
                yield event
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        what = ", ".join(part for part in (error.context, error.problem) if part)
        raise _NotYamlError(f"is not valid YAML: {what}", mark and mark.line + 1) from None
    except ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        character = ascii(text[error.position])
        raise _NotYamlError(f"is not a text file: it holds the character {character}", line) from None
    except Exception as error:  # noqa: BLE001 - whatever the parser trips over, the text is to blame
        raise _NotYamlError(f"is not valid YAML: {error}") from None


def _scalar(text: str) -> str | float | bool | None:
    """Return the value of a plain scalar."""
    if text in {"", "~"}:
        return None
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        digits, base = (text[2:], {"0o": 8, "0x": 16}[text[:2]]) if text[1:2] in {"o", "x"} else (text, 10)
        return int(digits, base)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _NOT_FINITE.fullmatch(text):
        return float(text.replace(".", ""))
    return text


def _joined(text: str) -> str:
    """Return a text with its surrogate pairs joined: so JSON escapes what is beyond 16 bits."""
    return _PAIR.sub(lambda pair: pair[0].encode("utf-16-le", "surrogatepass").decode("utf-16-le"), text)


class _Reader:
    """Turns the events of one document into plain values, keeping lines and mistakes."""

    def __init__(self, text: str, document: Document) -> None:
        self.line = 1
        self._events = _nodes(text)
        self._document = document

    def document(self) -> object:
        """Read the whole document; None if there is nothing in it."""
        event = next(self._events, None)
        value = None if event is None else self._value(event, ())
        if (event := next(self._events, None)) is not None:
            raise _NotYamlError("holds a second YAML document", event.start_mark.line + 1)
        return value

    def _value(self, event: Event, path: KeyPath, line: int = 0) -> object:
        """Read the value that begins with the event; `line` is that of its key, if it has one."""
        self.line = event.start_mark.line + 1
        self._document.place(path, line or self.line)
        self._check_depth(len(path))
        refusal = ""
        if isinstance(event, AliasEvent):
            refusal = f"aliases (*{event.anchor}) are not read: write the value itself"
        elif tag := getattr(event, "tag", None):
            refusal = f"tags ({str(tag)[:40]!r}) are not read: write the value alone"
        if refusal:
            self._document.report(path, refusal, self.line)
            self._skip(event)
            return REFUSED
        if isinstance(event, ScalarEvent):
            return _scalar(event.value) if event.implicit[0] else _joined(event.value)
        return self._mapping(path) if isinstance(event, MappingStartEvent) else self._list(path)

    def _list(self, path: KeyPath) -> list[object]:
        items: list[object] = []
        while not isinstance(event := next(self._events), CollectionEndEvent):
            items.append(self._value(event, (*path, len(items))))
            if len(items) % _ASKED_AFTER == 0:
                self._document.see_the_time(_FASTER)
        return items

    def _mapping(self, path: KeyPath) -> dict[str, object]:
        items: dict[str, object] = {}
        first_lines: dict[str, int] = {}
        while not isinstance(event := next(self._events), CollectionEndEvent):
            self.line = line = event.start_mark.line + 1
            key = self._key(event)
            if not isinstance(key, str):
                self._document.report(path, "keys must be texts", line)
            elif key == "<<":
                self._document.report((*path, key), "merge keys are not read: write the values out", line)
            elif key in items:
                again = f"is there twice: it stands in line {first_lines[key]} already"
                self._document.report((*path, key), again, line)
            else:
                first_lines[key] = line
                items[key] = self._value(next(self._events), (*path, key), line)
                continue
            self._skip(next(self._events))
        return items

    def _key(self, event: Event) -> object:
        self._skip(event)
        if not isinstance(event, ScalarEvent) or event.tag is not None:
            return REFUSED
        return _scalar(event.value) if event.implicit[0] else _joined(event.value)

    def _skip(self, event: Event) -> None:
        """Pass over the rest of the value that begins with the event."""
        depth = 0
        while True:
            depth += isinstance(event, CollectionStartEvent) - isinstance(event, CollectionEndEvent)
            self._check_depth(depth)
            if depth == 0:
                return
            event = next(self._events)

    def _check_depth(self, depth: int) -> None:
        """Stop where it grows too deep: the parser's time grows with the square of the depth."""
        if depth > MAX_DEPTH:
            raise _NotYamlError(f"is nested more than {MAX_DEPTH} levels deep")
