"""What pydantic objects to, as sentences for the person who wrote the file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from synth.checks import described
from synth.files import KeyPath, Refused
from synth.names import did_you_mean, guesses
from synth.task.entry_types import MAPPING, ONE, ONE_OF, RANGE, TEXT

if TYPE_CHECKING:
    from collections.abc import Iterable

    from pydantic_core import ErrorDetails

    from synth.files import Document

_M = TypeVar("_M", bound=BaseModel)

_SENTENCES = {
    "float_type": "must be a number, but is {value}",
    "one_or_range": "must be a number or [low, high], but is {value}",
    "string_type": "must be text, but is {value}",
    "string_unicode": "must be text, but holds characters that no text can hold",
    "list_type": "must be a list, but is {value}",
    "model_type": "must be a mapping (key: value), but is {value}",
    "union_tag_not_found": "must be a preset's name, the path of a robot file, or a mapping, but is {value}",
    "literal_error": "must be {expected}, but is {value}",
    "enum": "must be {expected}, but is {value}",
    "finite_number": "must be a finite number, but is {value}",
    "greater_than": "must be greater than {gt:g}, but is {value}",
    "not_positive": "must be greater than 0, but is {value}",
    "greater_than_equal": "must be at least {ge:g}, but is {value}",
    "less_than_equal": "must be at most {le:g}, but is {value}",
    "too_short": "must be a list of {min_length} numbers, but has {actual_length}",
    "too_long": "must be a list of {max_length} numbers, but has {actual_length}",
    "value_error": "{error}",
}
_NUMBER_OR_CHOICE = "must be a number, [low, high] or {{one_of: [...]}}, but is {value}"
_SENTENCES_AT: dict[KeyPath, dict[str, str]] = {
    ("synth",): dict.fromkeys(
        ("int_type", "int_from_float", "greater_than_equal", "less_than_equal"),
        "must be 1, the only version of this format, but is {value}",
    ),
    ("targets",): {"too_short": "must hold one target at least, but is an empty list"},
    **{
        (kind,): {
            "too_short": f"must hold one {kind} at least, but is an empty list",
            "union_tag_not_found": "must be a mapping (key: value) or a list of them, but is {value}",
        }
        for kind in ("surface", "path")
    },
    **{
        (key,): dict.fromkeys(("too_short", "too_long", "one_or_range"), _NUMBER_OR_CHOICE)
        for key in ("d35", "d45")
    },
    ("one_of",): {"too_short": "must hold one rigid link at least, but is an empty list"},
    ("base", "choices"): {"too_short": "must hold one place at least, but is an empty list"},
}


def validate(document: Document, schema: type[_M]) -> _M | None:
    """Check a document against a model and report every mistake to the document.

    Returns:
        The model, or None where the document does not fit it.
    """
    try:
        return schema.model_validate(document.value)
    except ValidationError as error:
        details = [detail for detail in error.errors() if not isinstance(detail["input"], Refused)]
    spelt_wrong = set()
    for detail in details:
        if detail["type"] == "extra_forbidden":
            *parent, key = _path(detail)
            guess = guesses(key, _fields(schema, parent))
            spelt_wrong.add((*parent, *guess))
    for detail in details:
        path = _path(detail)
        if detail["type"] == "missing" and path in spelt_wrong:
            continue  # its misspelling is reported
        document.report(path, _sentence(detail, path, _fields(schema, path[:-1])))
    return None


def _path(detail: ErrorDetails) -> KeyPath:
    """Return where it is without the tags of unions; an unknown key, though, is as the user wrote it."""
    place = detail["loc"]
    inner = len(place) - (detail["type"] == "extra_forbidden")
    return (
        *(part for part in place[:inner] if part not in {ONE, RANGE, ONE_OF, TEXT, MAPPING}),
        *place[inner:],
    )


def _fields(schema: type[BaseModel], path: Iterable[str | int]) -> dict[str, Any]:
    """Return the fields of the models of which one stands at a path."""
    schemas = [schema]
    for part in path:
        inside = [each.model_fields[part].annotation for each in schemas if part in each.model_fields]
        schemas = [model for annotation in inside for model in _models_in(annotation)] or schemas
    return {field.alias or name: field for one in schemas for name, field in one.model_fields.items()}


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in _models_in(part)]


def _sentence(detail: ErrorDetails, path: KeyPath, siblings: dict[str, Any]) -> str:
    """Say what is wrong with the key or the value at a path."""
    kind, value = detail["type"], detail["input"]
    key = str(path[-1]) if path else ""
    if kind == "missing":
        return f"is missing ({siblings[key].description})"
    if kind == "extra_forbidden":
        if key in siblings:
            return "belongs to another way of saying this, and cannot stand beside the other keys here"
        known = did_you_mean(key, siblings) or f"; known are {', '.join(siblings)}"
        return f"is not a known key{known}"
    context = detail.get("ctx", {})
    if kind == "float_type" and detail["loc"][-1] == ONE:
        kind = "one_or_range"
    elif kind == "greater_than_equal" and context["ge"] > 0 >= value:
        kind = "not_positive"
    template = (_SENTENCES | _SENTENCES_AT.get(path[-1:], {}) | _SENTENCES_AT.get(path, {})).get(kind)
    if template is None:
        return detail["msg"]
    sentence = template.format(value=described(value), **context)
    return sentence + did_you_mean(value, re.findall(r"'(\w+)'", context.get("expected", "")))
