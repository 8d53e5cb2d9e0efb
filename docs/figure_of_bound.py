"""The picture of branch and bound: which ends of the link may still belong to a better shape, as the boxes get smaller."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from colours import BLUE, INK, ORANGE
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth import Solution, load_task, solve
from synth.robot import LinkReach
from synth.synthesis.bound import search
from synth.synthesis.bound.boxes import Boxes

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]
TASK = ROOT / "problems" / "three-on-the-axis" / "task.yaml"
FIRST, LAST = 300, 500  # open boxes: at least in the first picture, at most in the last
PIXEL = 5.0  # mm


@contextmanager
def watched() -> Iterator[list[Boxes]]:
    """Let the search work as ever, and keep the open boxes after each of its rounds."""
    kept: list[Boxes] = []

    class Kept(Boxes):
        @classmethod
        def joined(cls, parts: list[Boxes]) -> Boxes:
            kept.append(Boxes.joined(parts))
            return kept[-1]

    search.Boxes = Kept
    try:
        yield kept
    finally:
        search.Boxes = Boxes


def least_bounds(boxes: Boxes, rho: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Return the least bound of the boxes over each end of the link, shape (h, rho), m; NaN where none is open."""
    least = np.full((len(height), len(rho)), np.inf)
    for middle, half, bound in zip(boxes.middle, boxes.half, boxes.bound, strict=True):
        columns = slice(*np.searchsorted(rho, [middle[0] - half[0], middle[0] + half[0]]))
        rows = slice(*np.searchsorted(height, [middle[1] - half[1], middle[1] + half[1]]))
        least[rows, columns] = np.minimum(least[rows, columns], bound)
    return np.where(np.isfinite(least), least, np.nan)


def stages(kept: list[Boxes]) -> list[Boxes]:
    """Return the open boxes early in the search, when there are most of them, and shortly before its end."""
    most = max(range(len(kept)), key=lambda index: len(kept[index]))
    early = next(boxes for boxes in kept if len(boxes) >= FIRST)
    late = next(boxes for boxes in kept[most:] if len(boxes) <= LAST)
    return [early, kept[most], late]


def bound_picture() -> Figure:
    """Draw where the link of a better shape could still end, at three moments of a proof."""
    with watched() as kept:
        solution = solve(load_task(TASK), prove=True, alternatives=0)
    return drawn(solution, stages(kept))


def drawn(solution: Solution, moments: list[Boxes]) -> Figure:
    """Draw the least bound over each end of the link, of the boxes that are open at some moments."""
    robot = solution.task.robot
    rho, height = np.arange(0.0, 0.72, 1e-3 * PIXEL), np.arange(-0.1, 0.78, 1e-3 * PIXEL)
    best = 1e3 * min(design.verification.misses.max() for design in solution.designs)
    end = solution.robot.end_frame[1]
    figure = Figure(figsize=(9.6, 4.3))
    FigureCanvasAgg(figure)
    for index, boxes in enumerate(moments):
        axes = figure.add_axes((0.07 + 0.282 * index, 0.12, 0.268, 0.79))
        least = 1e3 * least_bounds(boxes, rho, height)
        shown = axes.pcolormesh(
            1e3 * rho, 1e3 * height, least, cmap="gray", vmin=-0.25 * best, vmax=1.3 * best
        )
        for number, curve in enumerate(LinkReach(robot.link).boundary(361)):
            line = 1e3 * (curve + [0.0, robot.d12])
            label = None if number else "limit of the reach of the link"
            axes.plot(*line.T, color=BLUE, linewidth=1.6, label=label)
        axes.plot(
            1e3 * np.hypot(*end[:2]),
            1e3 * end[2],
            "D",
            color=ORANGE,
            markeredgecolor="white",
            markersize=8,
            linestyle="none",
            label="end of the best link found",
        )
        axes.set_title(f"{len(boxes)} boxes are open", fontsize=10, color=INK)
        axes.set(xlim=(0, 715), ylim=(-100, 775), xlabel="distance from axis 1, ρ, mm")
        axes.set_aspect("equal")
        if index:
            axes.set_yticklabels([])
        else:
            axes.set_ylabel("height over P1, h, mm")
    axes.legend(loc="lower left", fontsize=8.5, framealpha=1.0)
    bar = figure.colorbar(
        shown,
        cax=figure.add_axes((0.925, 0.12, 0.016, 0.79), label="<colorbar>"),
        boundaries=np.linspace(0.0, best, 45),
    )
    bar.set_ticks(np.arange(0.0, best, 5.0))
    bar.set_label("least bound of the boxes, mm; white: none open")
    return figure
