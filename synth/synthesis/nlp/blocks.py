"""The unknowns and the constraints of a program, each group with its bounds, in the order of their making.

That order is the order of the solver's vectors x and g; the groups of unknowns have names, and nothing else
need know where they stand.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray


class _Blocks:
    """Groups of expressions, each stacked column by column."""

    def __init__(self) -> None:
        self._expressions: list[ca.SX] = []
        self._lower: list[FloatArray] = []
        self._upper: list[FloatArray] = []

    def _add(self, expression: ca.SX, lower: float, upper: float) -> None:
        count = expression.numel()
        self._expressions.append(ca.vec(expression))
        self._lower.append(np.full(count, lower))
        self._upper.append(np.full(count, upper))

    @property
    def vector(self) -> ca.SX:
        """All of them in one column."""
        return ca.vertcat(*self._expressions)

    @property
    def lower(self) -> FloatArray:
        """Lower bounds of `vector`."""
        return np.concatenate(self._lower)

    @property
    def upper(self) -> FloatArray:
        """Upper bounds of `vector`."""
        return np.concatenate(self._upper)


class Unknowns(_Blocks):
    """What the solver chooses."""

    def __init__(self) -> None:
        super().__init__()
        self._shapes: dict[str, tuple[int, int]] = {}

    def new(self, name: str, shape: tuple[int, int], lower: float, upper: float) -> ca.SX:
        """Return a matrix of new unknowns, all within the same bounds."""
        symbol = ca.SX.sym(name, *shape)
        self._shapes[name] = shape
        self._add(symbol, lower, upper)
        return symbol

    def vector_of(self, values: Mapping[str, ArrayLike]) -> FloatArray:
        """Return values of all unknowns in the order of `vector`.

        Args:
            values: For the name of each group an array of its shape; a column may be of one axis.

        Raises:
            KeyError: A group has no value.
        """
        parts = [
            np.reshape(np.asarray(values[name], dtype=np.float64), shape).ravel(order="F")
            for name, shape in self._shapes.items()
        ]
        return np.concatenate(parts)

    def by_name(self, vector: FloatArray) -> dict[str, FloatArray]:
        """Return the values of each group in its shape, from those of `vector`."""
        ends = np.cumsum([rows * columns for rows, columns in self._shapes.values()])
        parts = zip(self._shapes.items(), np.split(vector, ends[:-1]), strict=True)
        return {name: part.reshape(shape, order="F") for (name, shape), part in parts}


class Constraints(_Blocks):
    """What must hold."""

    def between(self, expression: ca.SX, lower: float, upper: float) -> None:
        """Ask that each element of an expression is within bounds, one of which may be infinite."""
        self._add(expression, lower, upper)

    def zero(self, expression: ca.SX) -> None:
        """Ask that each element of an expression vanishes."""
        self._add(expression, 0.0, 0.0)
