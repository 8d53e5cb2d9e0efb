"""The map of a sweep: from where how many of twenty jobs can be done."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from sweep_of_bases import counts, jobs

INK = "#222222"
STEP = 200.0  # mm, of the grid
MARKERS = {"belt": ("o", "at the belt"), "shelf": ("s", "in the shelf"), "camera": ("^", "before the camera")}
LIGHTER_THAN = 8  # jobs: below it numbers are white on dark


def sweep_picture() -> Figure:
    """Draw how many jobs can be done from each place, seen from above, and where their targets are."""
    table, count = counts(), len(jobs())
    x, y = (np.unique([1e3 * place[axis] for place in table]).round(6) for axis in (0, 1))
    done = np.array([[table[1e-3 * a, 1e-3 * b] for a in x] for b in y])
    figure = Figure(figsize=(7.5, 6.4))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.09, 0.09, 0.76, 0.89))
    edges = [np.append(each - 0.5 * STEP, each[-1] + 0.5 * STEP) for each in (x, y)]
    shown = axes.pcolormesh(
        *edges, done, cmap="gray", vmin=-4, vmax=count + 2, edgecolors="white", linewidth=1.0
    )
    for row, b in enumerate(y):
        for column, a in enumerate(x):
            number = done[row, column]
            colour = "white" if number < LIGHTER_THAN else INK
            best = {"fontweight": "bold"} if number == done.max() else {}
            axes.text(
                a - 70, b - 70, str(number), fontsize=10, color=colour, ha="center", va="center", **best
            )
    for name, (marker, words) in MARKERS.items():
        points = 1e3 * np.array(
            [target.position[:2] for job in jobs() for target in job.targets if target.name == name]
        )
        axes.plot(*points.T, marker, color="#d55e00", markeredgecolor="white", markersize=7, label=words)
    axes.set(
        xlabel="x of P1 in the cell, mm",
        ylabel="y of P1 in the cell, mm",
        xlim=edges[0][[0, -1]],
        ylim=edges[1][[0, -1]],
    )
    axes.set_aspect("equal")
    axes.legend(loc="lower left", fontsize=9, framealpha=1.0)
    bar = figure.colorbar(
        shown, cax=figure.add_axes((0.88, 0.09, 0.025, 0.89)), boundaries=np.arange(-0.5, count + 1)
    )
    bar.set_ticks(range(0, count + 1, 5))
    bar.set_label("jobs of twenty that can be done")
    return figure
