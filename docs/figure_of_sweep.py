"""The map of a sweep: from where how many of twenty jobs can be done."""

from __future__ import annotations

import numpy as np
from colours import INK, ORANGE
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from sweep_of_bases import counts, jobs

STEP = 200.0  # mm, of the grid
MARKERS = {"belt": ("o", "at the belt"), "shelf": ("s", "in the shelf"), "camera": ("^", "before the camera")}
LIGHTER_THAN = 8  # jobs: below it numbers are white on dark


def sweep_picture() -> Figure:
    """Draw how many jobs can be done from each place, seen from above, and where their targets are."""
    table, count = counts(), len(jobs())
    x, y = (np.unique([1e3 * place[axis] for place in table]).round(6) for axis in (0, 1))
    done = np.array([[table[1e-3 * a, 1e-3 * b] for a in x] for b in y])
    figure = Figure(figsize=(7.5, 6.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.105, 0.08, 0.74, 0.84))
    edges = [np.append(each - 0.5 * STEP, each[-1] + 0.5 * STEP) for each in (x, y)]
    shown = axes.pcolormesh(
        *edges, done, cmap="gray", vmin=-4, vmax=count + 2, edgecolors="white", linewidth=1.0
    )
    seen = []
    for name, (marker, words) in MARKERS.items():
        points = 1e3 * np.array(
            [target.position[:2] for job in jobs() for target in job.targets if target.name == name]
        )
        axes.plot(*points.T, marker, color=ORANGE, markeredgecolor="white", markersize=7, label=words)
        seen.append(points)
    for row, column in np.ndindex(done.shape):
        number = int(done[row, column])
        place = freest_corner(np.array([x[column], y[row]]), np.concatenate(seen))
        style = {"color": "white" if number < LIGHTER_THAN else INK, "ha": "center", "va": "center"}
        weight = "bold" if number == done.max() else "normal"
        axes.text(*place, str(number), fontsize=10, fontweight=weight, **style)
    axes.set(
        xlabel="x of P1 in the cell, mm",
        ylabel="y of P1 in the cell, mm",
        xlim=(-670, 820),
        ylim=(-620, 820),
    )
    axes.set_aspect("equal")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=9, frameon=False)
    bar = figure.colorbar(
        shown,
        cax=figure.add_axes((0.875, 0.08, 0.025, 0.84), label="<colorbar>"),
        boundaries=np.arange(-0.5, count + 1),
    )
    bar.set_ticks(range(0, count + 1, 5))
    bar.set_label("jobs of twenty that can be done")
    return figure


def freest_corner(middle: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return near which corner of its cell a number is farthest from all points."""
    corners = middle + 0.35 * STEP * np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
    apart = np.linalg.norm(corners[:, None] - points, axis=-1).min(axis=1)
    return corners[np.argmax(np.minimum(apart, 60.0))]
