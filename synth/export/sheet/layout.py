"""How the drawings share the sheet: a third-angle projection, and the workspace in its free corner."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.export.sheet.labels import FONT_SIZE
from synth.export.sheet.page import HEIGHT, MARGIN, WIDTH
from synth.export.sheet.typesetting import shortened
from synth.export.sheet.views import FRONT, SIDE, TOP, about_axis_1, draw_section, draw_view, section

if TYPE_CHECKING:
    from synth.arrays import FloatArray
    from synth.export.sheet.page import Page
    from synth.export.sheet.scene import Scene
    from synth.synthesis import Solution

# Millimetres of paper.
_NAME = 35.0  # of an obstacle in the legend
_ROOM_FOR_A_NOTE = 50.0  # beside the title of the section
_TICKS = 10.0  # room for the numbers on an axis
_GAP_X = 15.0  # between views side by side: numbers and the name of an axis
_GAP_Y = 13.0  # likewise of views one above the other
_LEAST_VIEW = 0.42  # of the room in height, for a side of the square in the corner
_SCALES = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 10.0)


def draw(page: Page, solution: Solution, scene: Scene, top: float) -> None:
    """Draw the top view above the front view, the side view right of it, the section in the corner.

    Args:
        page: Where to draw.
        solution: What was found.
        scene: What is seen of it.
        top: How far down the page the drawings begin, mm.
    """
    room = np.array([WIDTH - 2 * MARGIN - _TICKS - _GAP_X + 5.0, HEIGHT - top - 18.0 - _GAP_Y])
    lowest, highest = scene.bounds
    size = highest - lowest
    least = _LEAST_VIEW * room[1]
    scale = _scale(size, room, least)
    depth = max(size[1] / scale, least)  # of y, on paper: the side view's width, the top view's height
    sizes = np.array([room[0] - depth, depth, room[1] - depth])
    # What the page has to spare goes to both sides, but in height to the top: below is the floor.
    start = 0.5 * (lowest + highest - scale * sizes)
    if scene.floor is not None:
        start[2] = lowest[2]
    limits = np.stack([start, start + scale * sizes])
    left, right = MARGIN + _TICKS - 4.0, MARGIN + _TICKS - 4.0 + sizes[0] + _GAP_X
    upper, lower = top, top + depth + _GAP_Y
    names = "xyz"
    for title, view, x, y in (
        ("Top", TOP, left, upper),
        ("Front", FRONT, left, lower),
        ("Side", SIDE, right, lower),
    ):
        across, up = view
        axes = page.axes(x, y, sizes[across], sizes[up], limits[:, view])
        page.text(x, y - 1.5, f"{title}: {names[across]} and {names[up]}, mm", 7.0, weight="bold")
        page.text(x + sizes[across], y - 1.5, f"1 : {scale:g}", 7.0, ha="right")
        draw_view(axes, scene, view, scale)
    if solution.designs:
        _section(page, solution, scene, (right, upper, depth))
    shape = "Outlined: link at the angle to hold. Dashed: arm at target 1. " if scene.hold is not None else ""
    if solution.designs and scene.hold is None:
        shape = "Dashed: the nearest shape found, at target 1; it misses, so do not bend the link to it. "
    axes_drawn = "axes of the joints" if scene.hold is not None else "axis of joint 1"
    obstacles = "Hatched crosswise: obstacles, not in the section. " if scene.obstacles else ""
    if scene.far_obstacles:
        names = ", ".join(shortened(name, _NAME, FONT_SIZE) for name in scene.far_obstacles)
        obstacles += f"Too far off to be drawn: {names}. "
    legend = f"{shape}{obstacles}Dash-dotted: {axes_drawn}. Dot: target reached; cross: missed." + (
        " Section: ρ is the distance from axis 1; solid within the limits of joint 2, dashed beyond."
        if solution.designs
        else ""
    )
    page.paragraph(MARGIN, HEIGHT - 9.0, legend, WIDTH - 2 * MARGIN, pitch=2.8, size=FONT_SIZE, most=3)


def _section(page: Page, solution: Solution, scene: Scene, square: tuple[float, float, float]) -> None:
    x, y, side = square
    limits = solution.robot.robot.joint_limits.base
    curve = section(solution.best, np.linspace(0.0, 2.0 * math.pi, 181))
    base = solution.robot.base
    shown = np.vstack([base.position, scene.targets / 1e3])
    points = np.vstack([curve, about_axis_1(base, shown)])
    lowest, highest = points.min(axis=0), points.max(axis=0)
    span = 1.16 * float((highest - lowest).max())
    corner = 0.5 * (lowest + highest - span)
    if scene.floor is not None and base.is_upright:
        corner[1] = lowest[1] - 0.08 * span
    axes = page.axes(x, y, side, side, np.stack([corner, corner + span]))
    height = "z" if base.is_upright else "along axis 1"
    page.text(x, y - 1.5, f"Section: ρ, {height}, mm", 7.0, weight="bold")
    turns = np.degrees([limits.lower, limits.upper])
    if side >= _ROOM_FOR_A_NOTE:
        page.text(x + side, y - 1.5, f"joint 1 {turns[0]:z.0f}° to {turns[1]:z.0f}°", 6.0, ha="right")
    draw_section(axes, scene, solution.best, span / side)


def _scale(size: FloatArray, room: FloatArray, corner: float) -> float:
    """Return the smallest round scale at which the views of a size, in mm, have room beside the corner."""
    x, y, z = size
    least = max(1e-3, (x + y) / room[0], (y + z) / room[1], x / (room[0] - corner), z / (room[1] - corner))
    power = 10.0 ** math.floor(math.log10(least))
    return float(next(power * step for step in _SCALES if power * step >= least))
