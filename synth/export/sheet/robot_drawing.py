"""The drawing that says what P1 to P5, the axes, the joint angles and the distances are.

An arm of its own proportions stands for every robot: on 58 and 49 mm of its axes no label would have room.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.sheet.views import AXIS, GHOST, LINK
from synth.guide import MARKERS
from synth.robot import Arm, Interval, LinkShape, MalleableLink, RigidLink, Robot, turned

if TYPE_CHECKING:
    from collections.abc import Iterable

    from matplotlib.axes import Axes

    from synth.arrays import FloatArray

_THETA1, _THETA2 = math.radians(36.0), math.radians(128.0)
_AZIMUTH, _ELEVATION = math.radians(80.0), math.radians(22.0)  # of who looks at it
# What is seen, m: to the right and upwards.
_LEFT, _RIGHT, _BOTTOM, _TOP = -0.43, 0.84, -0.29, 0.98
_INK, _FILL = "#222222", "#CFE3F1"
_BEYOND = 0.17  # m, how far an axis is drawn beyond its points
_MARKER_SIDES = {"P1": (16, 0), "P2": (19, -8), "P3": (6, -13), "P4": (-14, 8)}  # points from marker to name


def _arm() -> Arm:
    """Return the arm that is drawn: its link ends pointing down, so that the axes are well apart."""
    robot = Robot(
        "robot",
        d12=0.22,
        link=MalleableLink(Interval.fixed(0.86), min_bend_radius=0.1, diameter=0.06),
        d34=0.28,
        tip_offset=0.11,
        rigid_link=RigidLink(Interval.fixed(0.42), Interval.fixed(0.45)),
    )
    shape = LinkShape(np.array([[0.2, 0.3], [0.1, 2.9], [0.0, 2.2]]), np.array([0.16, 0.36, 0.34]))
    return Arm(robot, shape, d35=0.42, d45=0.45)


@dataclass(frozen=True)
class _Paper:
    """What is drawn on: lines, arrows and labels, in proportion to the letters.

    Attributes:
        axes: Where it is drawn.
        size: Size of the letters, pt.
    """

    axes: Axes
    size: float

    def _line(self, points: Iterable[FloatArray] | FloatArray, **style: Any) -> None:
        style = {"color": _INK, "linewidth": 0.1 * self.size, "solid_capstyle": "butt", **style}
        self.axes.plot(*_seen(np.array(list(points))).T, **style)

    def _arrow(self, start: FloatArray, end: FloatArray, style: str = "-|>", colour: str = _INK) -> None:
        arrow = {"arrowstyle": f"{style},head_width=0.2,head_length=0.45", "color": colour, "shrinkA": 0.0}
        arrow |= {"shrinkB": 0.0, "linewidth": 0.09 * self.size, "mutation_scale": self.size}
        self.axes.annotate("", _on_paper(end), _on_paper(start), arrowprops=arrow)

    def _label(self, text: str, at: FloatArray, shift: tuple[float, float] = (0, 0), **style: Any) -> None:
        offset = (0.1 * self.size * shift[0], 0.1 * self.size * shift[1])
        style = {"ha": "center", "va": "center", "fontsize": self.size, "color": _INK, **style}
        self.axes.annotate(text, _on_paper(at), offset, textcoords="offset points", **style)


@dataclass(frozen=True)
class RobotDrawing(_Paper):
    """The drawing in the making.

    Attributes:
        whole: Whether distances, zeros and words are drawn too, not only points, axes and angles.
    """

    whole: bool

    @cached_property
    def _arm(self) -> Arm:
        return _arm()

    def draw(self) -> None:
        """Draw everything, what is behind first."""
        self.axes.set_axis_off()
        self.axes.set_aspect("equal")
        self.axes.set(xlim=(_LEFT, _RIGHT), ylim=(_BOTTOM, _TOP))
        self._second_joint()
        if self.whole:
            self._distances()
        self._links()
        self._axes_of_joints()
        self._first_joint()
        self._points()
        if self.whole:
            self._words()

    @cached_property
    def _joints(self) -> FloatArray:
        """P1 to P4 with joint 1 as drawn, shape (4, 3), m."""
        return turned(self._arm.axis_points, _THETA1)

    @cached_property
    def _link(self) -> FloatArray:
        return turned(self._arm.shape.centreline(0.01) + self._arm.base_joint[1], _THETA1)

    def _effector(self, theta2: Any, share: Any = 1.0) -> FloatArray:
        """Return P5 for angles of joint 2, or what is nearer to axis 2 by a share."""
        centre = turned(self._arm.circle.centre, _THETA1)
        return np.asarray(centre + share * (self._arm.forward_kinematics(_THETA1, theta2) - centre))

    def _second_joint(self) -> None:
        self._line(
            self._effector(np.linspace(0.0, 2.0 * math.pi, 181)), color=GHOST, linewidth=0.07 * self.size
        )
        self._line(self._effector(0.0, np.array([[0.0], [1.0]])), linestyle="--", linewidth=0.07 * self.size)
        angle = self._effector(np.linspace(0.0, _THETA2, 61), 0.84)
        self._line(angle[:-2])
        self._arrow(angle[-4], angle[-1])
        share, shift = (0.77, (2, 13)) if self.whole else (0.6, (-17, -5))  # inside the arc, or outside it
        self._label("θ2", self._effector(share * _THETA2, 0.84), shift, weight="bold")
        if self.whole:
            self._line(self._effector(math.pi, np.array([[0.0], [1.0]])), linestyle=":", color=GHOST)
            self._label("θ2 = 0°:\nfolded back", self._effector(0.0), (-36, 9))
            self._label("θ2 = 180°:\nstraight on", self._effector(math.pi), (40, -3))

    def _distances(self) -> None:
        p1, p2, p3, p4 = self._joints
        p5 = self._effector(_THETA2)
        # Where along the line each name stands: they cross one another.
        for start, end, name, share in (
            (p1, p3, "d13", 0.52), (p1, p4, "d14", 0.28), (p2, p3, "d23", 0.6), (p2, p4, "d24", 0.42),
            (p3, p5, "d35", 0.28), (p4, p5, "d45", 0.36),
        ):  # fmt: skip
            self._line([start, end], color=GHOST, linewidth=0.07 * self.size)
            box = {"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none"}
            self._label(name, start + share * (end - start), bbox=box, fontsize=0.92 * self.size)

    def _links(self) -> None:
        width = 72.0 * self._arm.robot.link.diameter * self._inches_per_metre
        for colour, wide in ((LINK, width + 0.12 * self.size), (_FILL, width)):
            self._line(self._link, color=colour, linewidth=wide)
        self._line([self._link[-1], self._effector(_THETA2)], color="#C9C9C9", linewidth=0.45 * width)

    @property
    def _inches_per_metre(self) -> float:
        figure = self.axes.get_figure(root=True)
        width, height = figure.get_size_inches() if figure is not None else (1.0, 1.0)
        box = self.axes.get_position()
        return float(min(box.width * width / (_RIGHT - _LEFT), box.height * height / (_TOP - _BOTTOM)))

    def _axes_of_joints(self) -> None:
        p1, p2, p3, p4 = self._joints
        for start, end, name, shift in (
            (p2, p1, "axis 1 (z)" if self.whole else "axis 1", (0, -8) if self.whole else (-8, -10)),
            (p4, p3, "axis 2", (12, -9)),
        ):
            beyond = _BEYOND * (end - start) / np.linalg.norm(end - start)
            self._line([start - beyond, end + beyond], color=AXIS, linestyle="-.", linewidth=0.13 * self.size)
            self._label(name, end + beyond, shift, color=AXIS, weight="bold")

    def _first_joint(self) -> None:
        origin = np.zeros(3)
        for index, name in enumerate("xy"):
            end = 0.36 * np.eye(3)[index]
            self._arrow(origin, end)
            self._label(name, end, ((-6, 1), (8, -2))[index])
        self._line(
            [origin, turned(np.array([0.36, 0.0, 0.0]), _THETA1)], linestyle="--", linewidth=0.07 * self.size
        )
        angle = turned(np.array([0.27, 0.0, 0.0]), np.linspace(0.0, _THETA1, 31))
        self._line(angle[:-2])
        self._arrow(angle[-4], angle[-1])
        at, shift = (angle[15], (-9, -4)) if self.whole else (angle[-1], (0, -9))
        self._label("θ1", at, shift, weight="bold")

    def _points(self) -> None:
        for name, point in zip(MARKERS, self._joints, strict=True):
            style = {"marker": "o", "markerfacecolor": "white", "color": AXIS, "markersize": 0.55 * self.size}
            self._line([point], **style)
            side = _MARKER_SIDES[name] if self.whole or name != "P4" else (2, -14)  # clear of the tube
            self._label(name, point, side, weight="bold")
        self._line([self._effector(_THETA2)], marker="o", color="black", markersize=0.65 * self.size)
        self._label("P5", self._effector(_THETA2), (6, -11), weight="bold")

    def _words(self) -> None:
        p1, p2, p3, p4 = self._joints
        up = np.array([0.0, 0.0, 1.0])
        left = turned(np.array([1.0, 0.0, 0.0]), _AZIMUTH - math.pi / 2.0)
        for start, end, aside, name, shift in (
            (p1, p2, 0.13 * left, "d12", (-14, 0)),
            (p3, p4, 0.2 * up, "d34", (-3, 8)),
            (p3, self._link[-1], 0.1 * up, "tip offset", (44, 7)),
        ):
            self._arrow(start + aside, end + aside, "<|-|>")
            for point in (start, end):
                self._line([point, point + 1.2 * aside], linewidth=0.05 * self.size, color=GHOST)
            self._label(name, 0.5 * (start + end) + aside, shift)
        self._label("malleable link", self._link[len(self._link) // 3], (-14, 4), color=LINK, ha="right")
        run, rise = _seen(self._effector(_THETA2) - self._link[-1])
        slope = math.degrees(math.atan2(rise, run))
        self._label("rigid link", 0.5 * (self._link[-1] + self._effector(_THETA2)), rotation=slope)


def _seen(points: FloatArray) -> FloatArray:
    """Return points as they are seen: to the right and upwards, shape (..., 2)."""
    sin, cos = math.sin(_AZIMUTH), math.cos(_AZIMUTH)
    low, high = math.sin(_ELEVATION), math.cos(_ELEVATION)
    return np.asarray(points @ np.array([[-sin, -low * cos], [cos, -low * sin], [0.0, high]]))


def _on_paper(point: FloatArray) -> tuple[float, float]:
    right, up = _seen(point).tolist()
    return right, up


def draw_robot(axes: Axes, size: float, *, whole: bool) -> None:
    """Draw the robot with its names.

    Args:
        axes: Where; it loses its frame.
        size: Size of the letters, pt.
        whole: Whether distances, zeros and words are drawn too, not only points, axes and angles.
    """
    RobotDrawing(axes, size, whole).draw()
