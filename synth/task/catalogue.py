"""From a catalogue of rigid links in a file, in its unit, to its values; every mistake at its own key."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.errors import InputError, Mistake
from synth.names import given_twice
from synth.robot import Interval, RigidLink, RigidLinkChoices, no_triangle
from synth.task.entry_types import default_name
from synth.task.robot_schema import CatalogueEntry, LengthsEntry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.task.robot_schema import RigidLinkEntry

_KIND = "rigid link"


@dataclass(frozen=True)
class _Item:
    """A rigid link as it stands in a file, in its unit, and the key under which it stands."""

    key: str
    name: str
    d35: float
    d45: float
    diameter: float | None


def to_rigid_links(read: RigidLinkEntry | CatalogueEntry, d34: float, per_metre: float) -> RigidLinkChoices:
    """Return the rigid links of which one is to be chosen.

    Args:
        read: What stands under `rigid_link`: a list of rigid links, or lists of d35 and of d45.
        d34: Distance of P3 and P4, in the unit of the file.
        per_metre: How many of these units a metre has.

    Raises:
        InputError: The lists do not match, a rigid link closes no triangle, or one stands there twice.
    """
    items = _listed(read) if isinstance(read, CatalogueEntry) else _in_pairs(read)
    _refuse_if_any([*_open_triangles(items, d34), *_given_twice(items)])
    return RigidLinkChoices(
        [item.name for item in items],
        [
            RigidLink(
                Interval.fixed(item.d35 / per_metre),
                Interval.fixed(item.d45 / per_metre),
                (item.diameter or 0.0) / per_metre,
            )
            for item in items
        ],
    )


def _listed(read: CatalogueEntry) -> list[_Item]:
    return [
        _Item(
            f"rigid_link.one_of[{index}]",
            item.name or default_name(_KIND, index),
            item.d35,
            item.d45,
            item.diameter or read.diameter,
        )
        for index, item in enumerate(read.one_of)
    ]


def _in_pairs(read: RigidLinkEntry) -> list[_Item]:
    """Return the rigid links of two lists of lengths."""
    d35, d45 = read.d35, read.d45
    if not isinstance(d35, LengthsEntry):
        raise _not_listed("d35", d35, "d45")
    if not isinstance(d45, LengthsEntry):
        raise _not_listed("d45", d45, "d35")
    first, second = len(d35.one_of), len(d45.one_of)
    if first != second:
        wrong = (
            f"must hold as many lengths as that of d35, as each goes with the d35 in the same place: "
            f"{first}, but holds {second}"
        )
        raise InputError([Mistake(wrong, key="rigid_link.d45.one_of")])
    return [
        _Item(f"rigid_link.d35.one_of[{index}]", default_name(_KIND, index), *lengths, read.diameter)
        for index, lengths in enumerate(zip(d35.one_of, d45.one_of, strict=True))
    ]


def _not_listed(key: str, value: float | list[float], other: str) -> InputError:
    """Return the mistake of a length, or a range of it, beside a list of the other one."""
    told = f"[{value[0]:g}, {value[1]:g}]" if isinstance(value, list) else f"{value:g}"
    wrong = f"must be {{one_of: [...]}}, each for the {other} in the same place, but is {told}"
    return InputError([Mistake(wrong, key=f"rigid_link.{key}")])


def _open_triangles(items: Sequence[_Item], d34: float) -> list[Mistake]:
    """Return a mistake for each rigid link whose P3, P4 and P5 cannot be so far apart."""
    wrong = ((item.key, no_triangle(d34, (item.d35,) * 2, (item.d45,) * 2)) for item in items)
    return [Mistake(sentence, key=key) for key, sentence in wrong if sentence]


def _given_twice(items: Sequence[_Item]) -> list[Mistake]:
    """Return a mistake for each name and each pair of lengths that stood before."""
    names, lengths = [item.name for item in items], [f"{item.d35!r} {item.d45!r}" for item in items]
    return [
        *(
            Mistake(
                f"{names[index][:40]!r} is the name of {items[first].key} already",
                key=f"{items[index].key}.name",
            )
            for index, first in given_twice(names)
        ),
        *(
            Mistake(f"has the same d35 and d45 as {items[first].key}", key=items[index].key)
            for index, first in given_twice(lengths)
        ),
    ]


def _refuse_if_any(mistakes: Sequence[Mistake]) -> None:
    if mistakes:
        raise InputError(mistakes)
