"""Whether measured points are those of a robot, which keeps some of their distances in every shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from synth.robot import Robot

_MOUNTING = 3e-3  # m
_SCALE = 0.01  # of the distance


def off_the_hardware(measured: Mapping[str, float], robot: Robot, error: float = 0.0) -> dict[str, str]:
    """Return which measured distances of points of the robot's hardware are not those of the hardware.

    A marker of motion capture is off by 0.46 mm on average (Clark and Rojas 2020), so the distance of two is
    off by 0.4 mm (one sigma); and it sits on the axis as well as somebody mounted it. 3 mm and 1 % of the
    distance leave room for that, and are less than the slips that matter: another hole, another robot, a
    marker taken for another.

    Args:
        measured: Distances by their names (d12, d34, d35, d45; others are passed over), m.
        robot: The hardware.
        error: What the measured numbers may be off by beside that, m.

    Returns:
        A sentence for each that is wrong, by its name.
    """
    links = robot.possible_rigid_links
    known = {
        "d12": (robot.d12, robot.d12),
        "d34": (robot.d34, robot.d34),
        "d35": (min(link.d35.lower for link in links), max(link.d35.upper for link in links)),
        "d45": (min(link.d45.lower for link in links), max(link.d45.upper for link in links)),
    }
    wrong = {}
    for name, (low, high) in known.items():
        if name not in measured:
            continue
        allowed = _MOUNTING + _SCALE * high + error
        if not low - allowed <= measured[name] <= high + allowed:
            there = f"{1e3 * low:.1f}" if low == high else f"{1e3 * low:.1f} to {1e3 * high:.1f}"
            wrong[name] = (
                f"P{name[1]} and P{name[2]} are {1e3 * measured[name]:.1f} mm apart; "
                f"on this robot they are {there} mm apart"
            )
    return wrong
