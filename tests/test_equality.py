"""Frozen values, all that the package has, compare and hash by what they hold."""

import copy
import dataclasses

import numpy as np
import pytest
from recorded_values import frozen_dataclasses, recorded_values

CLASSES = sorted(frozen_dataclasses(), key=lambda cls: (cls.__qualname__, cls.__module__))


@pytest.fixture(scope="module")
def values(tmp_path_factory):
    return recorded_values(tmp_path_factory.mktemp("values"))


def test_there_is_a_value_of_each_frozen_dataclass(values):
    assert [cls for cls in CLASSES if cls not in values] == []


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__qualname__)
def test_a_copy_is_equal_and_has_the_same_hash(values, cls):
    value = values[cls]
    again = copy.deepcopy(value)
    assert again == value
    assert hash(again) == hash(value)


def test_another_number_in_an_array_makes_another_value(values):
    changed = 0
    for value in values.values():
        for field in dataclasses.fields(value):
            held = getattr(value, field.name)
            if field.compare and isinstance(held, np.ndarray) and held.size and held.dtype.kind == "f":
                other, numbers = copy.deepcopy(value), held.copy()
                numbers.flat[-1] = 0.125 if not np.isfinite(held.flat[-1]) else held.flat[-1] + 0.125
                object.__setattr__(other, field.name, numbers)
                assert other != value
                changed += 1
    assert changed > 100
