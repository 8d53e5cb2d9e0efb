"""Numbers that cannot be right: found from the other numbers of the same measurement."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from synth.measurement.distances.relaxation import consistent_interval

if TYPE_CHECKING:
    from synth.measurement.distances.measured import MeasuredDistances

_ROUNDING = 1e-9  # m
_DECIMALS = (0.1, 10.0)


@dataclass(frozen=True)
class Suspect:
    """A distance that alone could be what is wrong.

    Attributes:
        name: Such as "d25".
        value: As it was given, m.
        lower: Least value that fits the other distances, m.
        upper: Largest value that fits them, m.
        reading: The value with its decimal point moved by one place, m, if that fits; else None.
        reading_bound: Largest error of that reading, m: its digits are as many as before.
    """

    name: str
    value: float
    lower: float
    upper: float
    reading: float | None = None
    reading_bound: float = 0.0


@dataclass(frozen=True)
class Misprint:
    """A number among the distances is impossible.

    Attributes:
        reasons: Triangles that cannot close, a sentence for each.
        suspects: The distances that alone could be wrong: one, if it can be told; none, if one wrong
            number is not enough to explain it.
    """

    reasons: tuple[str, ...]
    suspects: tuple[Suspect, ...]

    @property
    def named(self) -> Suspect | None:
        """The distance that is wrong, if it can be told which."""
        return self.suspects[0] if len(self.suspects) == 1 else None


def find_misprint(distances: MeasuredDistances) -> Misprint | None:
    """Return what is wrong with distances of which one is impossible, or None.

    Points that were all seen at once have distances that close every triangle, however badly a pose
    agrees with a robot: a triangle that stays open even with all its bounds used up tells of a number
    that nothing measured. The number at fault is one that all such triangles share and that was
    measured; of several, those without which the others fit together (see `consistent_interval`).

    Args:
        distances: What was measured.

    Returns:
        None if every triangle closes within the bounds.

    Raises:
        SolverError: If the convex solver gives no answer.
    """
    triangles = _open_triangles(distances)
    if not triangles:
        return None
    shared = set.intersection(*(set(names) for names in triangles))
    measured = zip(distances.names, distances.is_known, strict=True)
    intervals = {
        name: consistent_interval(distances, name) for name, known in measured if name in shared and not known
    }
    if any(intervals.values()):
        intervals = {name: interval for name, interval in intervals.items() if interval is not None}
    return Misprint(
        reasons=tuple(_sentence(distances, names) for names in triangles),
        suspects=tuple(
            _suspect(distances, name, interval or _triangle_interval(distances, name))
            for name, interval in intervals.items()
        ),
    )


def _open_triangles(distances: MeasuredDistances) -> list[tuple[str, str, str]]:
    """Return the triangles that cannot close, the longest side of each first."""
    bounds = {
        name: (lower, upper)
        for name, lower, upper in zip(distances.names, distances.lower, distances.upper, strict=True)
    }
    found: list[tuple[str, str, str]] = []
    for i, j, k in combinations(range(1, distances.count + 1), 3):
        sides = (f"d{i}{j}", f"d{i}{k}", f"d{j}{k}")
        if not all(side in bounds for side in sides):
            continue
        longest, first, second = sorted(sides, key=lambda side: -bounds[side][0])
        if bounds[longest][0] > bounds[first][1] + bounds[second][1] + _ROUNDING:
            found.append((longest, min(first, second), max(first, second)))
    return found


def _sentence(distances: MeasuredDistances, names: tuple[str, str, str]) -> str:
    longest, first, second = (f"{name} = {1e3 * distances[name]:.6g} mm" for name in names)
    return f"{longest} is longer than {first} and {second} together"


def _suspect(distances: MeasuredDistances, name: str, interval: tuple[float, float]) -> Suspect:
    """Return a distance as a suspect, with what it may have been."""
    k = distances.names.index(name)
    value, bound = float(distances.values[k]), float(distances.upper[k] - distances.values[k])
    for factor in _DECIMALS:
        if interval[0] - factor * bound <= factor * value <= interval[1] + factor * bound:
            return Suspect(name, value, *interval, factor * value, factor * bound)
    return Suspect(name, value, *interval)


def _triangle_interval(distances: MeasuredDistances, name: str) -> tuple[float, float]:
    """Return between which values a distance closes its triangles, if the other two sides are right."""
    i, j = name[1], name[2]
    sides = [
        (distances[first], distances[second])
        for k in map(str, range(1, distances.count + 1))
        if {first := _side(i, k), second := _side(j, k)} <= set(distances.names)
    ]
    return max(abs(a - b) for a, b in sides), min(a + b for a, b in sides)


def _side(i: str, j: str) -> str:
    return f"d{min(i, j)}{max(i, j)}"
