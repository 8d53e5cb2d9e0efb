"""The rigid link from the second joint to the end effector: given, in ranges, or one of a catalogue."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.checks import Checks, wrong_name, wrong_type
from synth.names import given_twice
from synth.robot.hardware.interval import GivenInterval, check_lengths
from synth.rounding import written_apart

if TYPE_CHECKING:
    from collections.abc import Sequence

_FLAT = 1e-9  # of d34: a triangle that is flat but for rounding is one
_SAME = 1e-6  # m; rigid links whose d35 and d45 differ by no more are one


@frozen_value
class RigidLink:
    """The link from the second joint to the end effector, as distances to the axis points.

    Attributes:
        d35: Distance from P3 to the end effector P5, m; an interval is chosen by the synthesis.
        d45: Distance from P4 to P5, m; likewise.
        diameter: Its outer diameter, m, where it may touch obstacles or the malleable link.
    """

    d35: GivenInterval
    d45: GivenInterval
    diameter: float = 0.0

    def __post_init__(self) -> None:
        checks = Checks(self)
        check_lengths(checks, self, "d35")
        check_lengths(checks, self, "d45")
        checks.number("diameter", least=0.0)
        checks.refuse()

    @property
    def is_fixed(self) -> bool:
        """Whether the rigid link is given and not to be designed."""
        return self.d35.is_fixed and self.d45.is_fixed


@frozen_value
class RigidLinkChoices:
    """A catalogue of rigid links, each of given lengths, of which the synthesis chooses one.

    Attributes:
        names: What each is called.
        links: The rigid links.
    """

    names: Sequence[str]
    links: Sequence[RigidLink]

    def __post_init__(self) -> None:
        checks = Checks(self)
        checks.put("names", tuple(self.names))
        checks.put("links", tuple(self.links))
        if not self.links or len(self.names) != len(self.links):
            checks.report("links", "must be as many as the names, and one at least")
        for index, link in enumerate(self.links):
            if wrong := wrong_type(link, RigidLink):
                checks.report(f"links[{index}]", wrong)
            elif not link.is_fixed:
                checks.report(f"links[{index}]", "must have one length each for d35 and d45, not a range")
        for index, name in enumerate(self.names):
            if wrong := wrong_name(name):
                checks.report(f"names[{index}]", wrong)
        checks.refuse()
        for index, first in given_twice(list(self.names)):
            checks.report(f"names[{index}]", f"{self.names[index]!r} is the name of names[{first}] already")
        checks.refuse()
        for index, link in enumerate(self.links):
            like = self._place_of(link.d35.lower, link.d45.lower)
            if like != index:
                checks.report(f"links[{index}]", f"has the same d35 and d45 as links[{like}]")
        checks.refuse()

    def name_of(self, d35: float, d45: float) -> str | None:
        """Return what the one of these lengths, m, is called, or None if none of them has them."""
        place = self._place_of(d35, d45)
        return None if place is None else self.names[place]

    def _place_of(self, d35: float, d45: float) -> int | None:
        for place, link in enumerate(self.links):
            if link.d35.contains(d35, _SAME) and link.d45.contains(d45, _SAME):
                return place
        return None


def no_triangle(d34: float, d35: tuple[float, float], d45: tuple[float, float]) -> str:
    """Return why no triangle P3 P4 P5 has sides in these ranges, in any unit of length, or nothing.

    Args:
        d34: Distance of P3 and P4.
        d35: Least and largest distance of P3 and P5.
        d45: Least and largest distance of P4 and P5.
    """
    slack, longest = _FLAT * d34, d35[1] + d45[1]
    if longest < d34 - slack:
        most, needed = written_apart(longest, d34)
        return f"no triangle P3 P4 P5: d35 + d45 is at most {most}, less than d34 = {needed}"
    for longer, shorter, gap in (("d35", "d45", d35[0] - d45[1]), ("d45", "d35", d45[0] - d35[1])):
        if gap > d34 + slack:
            least, allowed = written_apart(gap, d34)
            return (
                f"no triangle P3 P4 P5: {longer} exceeds {shorter} by at least {least}, "
                f"more than d34 = {allowed}"
            )
    return ""
