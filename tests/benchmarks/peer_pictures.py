"""The pictures of `peers.py`: time over the number of planted targets, success on noisy tasks over time."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

from colours import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, RED, WALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from peer_report import Outcome, Report

PICTURES = Path(__file__).parents[2] / "docs" / "pictures"
_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, RED, WALL, GREY)
_MARKERS, _DASHES = "sD^v<>P", ("-", "--", "-.", ":")


def _look(report: Report, name: str) -> dict[str, object]:
    """Return how the line of a method looks, alike in both pictures: grey tells it by its marker."""
    if name == report.ours:
        return {"color": INK, "linewidth": 2.5, "marker": "o", "linestyle": "-"}
    peers = [other for other in report.methods if other not in report.kin]
    if name not in peers:
        number = list(report.kin).index(name)
        return {
            "color": INK,
            "linewidth": 1.2,
            "marker": "*X"[number % 2],
            "linestyle": _DASHES[1 + number % 2],
        }
    number = peers.index(name)
    return {
        "color": _COLOURS[number % len(_COLOURS)],
        "linewidth": 1.2,
        "marker": _MARKERS[number % len(_MARKERS)],
        "linestyle": _DASHES[number % len(_DASHES)],
    }


def planted_picture(report: Report) -> Figure:
    """Draw the median time against the number of planted targets, where at least half reach them."""
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    axes = figure.add_subplot()
    counts = sorted({outcome.kind for outcome in report.planted})
    for name in report.methods:
        times = [np.median([o.results[name].time for o in report.planted if o.kind == n]) for n in counts]
        seen = np.where(np.isfinite(times), times, np.nan)
        axes.loglog(counts, seen, label=name.strip("`"), **_look(report, name))
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.minorticks_off()
    axes.set_xlabel("planted targets")
    axes.set_ylabel("median time until all are within 1 mm, s")
    axes.grid(alpha=0.3)
    figure.legend(loc="outside right upper", fontsize=8, frameon=False)
    return figure


def success(outcomes: list[Outcome], part: str, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return when a method has equalled the goal on one task more, s, and on which share by then."""
    times = np.sort([getattr(outcome, part)[name].time for outcome in outcomes])
    reached = times[np.isfinite(times)]
    return reached, np.arange(1, len(reached) + 1) / len(outcomes)


def noisy_picture(report: Report) -> Figure:
    """Draw on which share of the noisy tasks each method has equalled `synth` by which time."""
    figure = Figure(figsize=(7.5, 6.2), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True)
    shown = [name for name in report.methods if name == report.ours or name not in report.kin]
    for axes, part, title in zip(
        panels,
        ("results", "untold"),
        ("told the goal, and stopped when it is reached", "not told, each run to its own end"),
        strict=True,
    ):
        for name in shown:
            _staircase(
                axes, *success(report.noisy, part, name), report.budget, name.strip("`"), _look(report, name)
            )
        axes.set_title(title, fontsize=10, loc="left")
        axes.set_ylabel("noisy tasks equalled")
        axes.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
        axes.set_ylim(-0.04, 1.04)
        axes.grid(alpha=0.3)
    panels[0].set_xscale("log")
    panels[1].set_xlabel("time, s")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize=8, frameon=False
    )
    return figure


def _staircase(
    axes: Axes, times: np.ndarray, shares: np.ndarray, last: float, label: str, look: dict
) -> None:
    """Draw a share that grows by steps, from nothing, and stays until the last moment."""
    end = max(last, *times, 0.0)
    axes.step(
        [*times, end], [*shares, shares[-1] if len(shares) else 0.0],
        where="post", label=label, markersize=4, markevery=slice(0, max(len(times), 1)), **look,
    )  # fmt: skip


def draw(report: Report) -> None:
    """Store the pictures where the page shows them."""
    for name, picture in (("peers", planted_picture), ("peers-noisy", noisy_picture)):
        with mpl.rc_context({"svg.hashsalt": "synth"}):
            FigureCanvasSVG(picture(report)).print_svg(PICTURES / f"{name}.svg", metadata={"Date": None})
