"""The array type of the project, read-only copies for frozen values, and how such values compare."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from math import isnan
from typing import TYPE_CHECKING, Any, Generic, TypeVar, dataclass_transform

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
_T = TypeVar("_T")
_Given_contra = TypeVar("_Given_contra", contravariant=True)
_Held_co = TypeVar("_Held_co", covariant=True)
_HASHED = 16  # numbers or entries that enter a hash


class Given(Generic[_Given_contra, _Held_co]):
    """The type of a field that is given as one type and held as another, which `__post_init__` makes of it.

    It stands in annotations only, for type checkers: to them it is a descriptor, and a constructor takes
    what a descriptor can be set to. So lists and numbers are taken where arrays and intervals are held.
    """

    if TYPE_CHECKING:

        def __get__(self, value: object, owner: type | None = None, /) -> _Held_co: ...
        def __set__(self, value: object, given: _Given_contra, /) -> None: ...


GivenArray = Given[ArrayLike, FloatArray]
GivenArrayOrNone = Given[ArrayLike | None, FloatArray | None]


def given(**how: Any) -> Any:
    """Return a field with a default, declared as `Given`: as `field`, of whatever type."""
    return field(**how)


def unlike_all_before(unlike: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return which of some things differ from all that were kept before them, in order.

    Args:
        unlike: Whether two of them differ, shape (n, n).
    """
    kept: list[int] = []
    for index in range(len(unlike)):
        if unlike[index, kept].all():
            kept.append(index)
    return np.array(kept, dtype=np.intp)


def frozen(values: ArrayLike) -> FloatArray:
    """Return a read-only float copy, so that a frozen dataclass is frozen all the way down."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(field, given))
def frozen_value(cls: type[_T]) -> type[_T]:
    """Make a class that may hold arrays a frozen dataclass that is compared by value."""
    return compared_by_value(dataclass(frozen=True, eq=False)(cls))


def compared_by_value(cls: type[_T]) -> type[_T]:
    """Give a frozen dataclass that holds arrays, declared with `eq=False`, equality and a hash by value.

    Two values are equal if they are of one class and their fields are: arrays if they have the same shape
    and numbers, NaN being equal to itself. The generated equality raises for arrays.
    """

    def equal(self: object, other: object) -> Any:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return self is other or all(
            _equal(getattr(self, each.name), getattr(other, each.name))
            for each in fields(self)  # type: ignore[arg-type]  # a dataclass
            if each.compare
        )

    def hashed(self: object) -> int:
        names = [each.name for each in fields(self) if each.compare]  # type: ignore[arg-type]
        return hash((cls, *(_key(getattr(self, name)) for name in names)))

    cls.__eq__ = equal  # type: ignore[method-assign]
    cls.__hash__ = hashed  # type: ignore[method-assign]
    return cls


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=one.dtype.kind == "f"))
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return False
    if isinstance(one, tuple | list) and one.__class__ is other.__class__:
        return len(one) == len(other) and all(map(_equal, one, other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_equal(value, other[key]) for key, value in one.items())
    return bool(one == other) or (_is_nan(one) and _is_nan(other))


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and isnan(value)


def _key(value: Any) -> Any:
    """Return what can be hashed and is equal for equal values; of an array a few numbers will do."""
    if isinstance(value, np.ndarray):
        few = value.ravel()[:_HASHED].tolist()  # without NaN, whose hash is that of an object
        return value.shape, tuple(None if isnan(number) else number for number in few)
    if isinstance(value, tuple | list):
        return tuple(map(_key, value[:_HASHED]))
    if isinstance(value, Mapping):
        return frozenset(value)
    return None if _is_nan(value) else value
