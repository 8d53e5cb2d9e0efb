"""The table and the plot of `peers.py`, on the screen and in docs."""

from __future__ import annotations

import math
import os
import platform
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from argparse import Namespace

    from peer_race import Result

DOCS = Path(__file__).parents[2] / "docs"
PAGE, PICTURE = DOCS / "peers.md", DOCS / "pictures" / "peers.svg"
_BEGIN, _END = "<!-- written by tests/benchmarks/peers.py -->", "<!-- end -->"
_NOISY = ["noisy: equalled", "RMS over the least known: median, worst", "time, s", "ratio"]
_TOLD = ["method", "planted: reached", "time, s", "ratio", *_NOISY]
_UNTOLD = ["method", *_NOISY]


@dataclass(frozen=True)
class Outcome:
    """What all methods reached on one task; kind: its number of planted targets, or 0 if noisy."""

    kind: int
    seed: int
    targets: int
    results: dict[str, Result]
    untold: dict[str, Result]  # the same on a noisy task, but run to their own ends


@dataclass(frozen=True)
class Report:
    """What all methods reached on all tasks.

    Attributes:
        outcomes: One for each task.
        least: The least RMS miss known of each noisy task, m.
        ours: The method that the others are compared with.
        no_peers: Methods that do not count as the fastest peer.
        budget: Time after which a method was stopped, s.
    """

    outcomes: list[Outcome]
    least: dict[int, float]
    ours: str
    no_peers: frozenset[str]
    budget: float

    @property
    def planted(self) -> list[Outcome]:
        return [outcome for outcome in self.outcomes if outcome.kind]

    @property
    def noisy(self) -> list[Outcome]:
        return [outcome for outcome in self.outcomes if not outcome.kind]

    def over(self, name: str, part: str = "results") -> list[float]:
        """Return by how much a method misses more than the least known, as fractions."""
        return [getattr(o, part)[name].rms / self.least[o.seed] - 1.0 for o in self.noisy]

    def text(self) -> str:
        """Return the tables in Markdown, which read well on the screen, too, and what follows from them."""
        return "\n".join(
            [
                "Told the goal, and stopped when it is reached:\n",
                *_table(_TOLD, [self._told(name) for name in self.outcomes[0].results]),
                "\nNot told, each run to its own end, noisy tasks only:\n",
                *_table(_UNTOLD, [self._untold(name) for name in self.outcomes[0].results]),
                "",
                *(f"- {line}" for line in self._aims()),
            ]
        )

    def _told(self, name: str) -> list[str]:
        planted, noisy = self._figures(self.planted, name), self._figures(self.noisy, name)
        return [name, *planted, noisy[0], _excess(self.over(name)), *noisy[1:]]

    def _untold(self, name: str) -> list[str]:
        reached, *time_and_ratio = self._figures(self.noisy, name, "untold")
        return [name, reached, _excess(self.over(name, "untold")), *time_and_ratio]

    def _figures(self, outcomes: list[Outcome], name: str, part: str = "results") -> tuple[str, str, str]:
        """Return in how many tasks a method reached the goal, its median time, and its median ratio."""
        results = [getattr(outcome, part)[name] for outcome in outcomes]
        times = [result.time if part == "results" else result.seconds for result in results]
        ours = [outcome.results[self.ours].seconds for outcome in outcomes]
        time, ratio = np.median(times), np.median(np.divide(times, ours))
        return (
            f"{sum(result.reached for result in results)} of {len(results)}",
            f"{time:.3g}" if math.isfinite(time) else f"> {self.budget:g}",
            f"{ratio:.3g}" if math.isfinite(ratio) else "-",
        )

    def _aims(self) -> list[str]:
        """Return how `synth` stands to the fastest peer of each task, and to the least miss."""
        lines = []
        for title, outcomes, part in (
            ("planted", self.planted, "results"),
            ("noisy, told the goal", self.noisy, "results"),
            ("noisy, not told", self.noisy, "untold"),
        ):
            ratios = [
                min(result.time for name, result in getattr(o, part).items() if name not in self.no_peers)
                / o.results[self.ours].seconds
                for o in outcomes
            ]
            lines.append(
                f"{title}: the fastest peer of each task takes {np.median(ratios):.2g} times as long as "
                f"{self.ours} for the same miss (median of {len(ratios)} tasks)."
            )
        over = self.over(self.ours)
        lines.append(
            f"noisy: {self.ours} is at most {_percent(max(over))} over the least RMS miss known; "
            f"{sum(value <= 1e-3 for value in over)} of {len(over)} tasks are within 0.1 %."
        )
        return lines

    def plot(self) -> Figure:
        """Draw the median time against the number of planted targets, where at least half reach them."""
        figure = Figure(figsize=(7.5, 4.4), layout="constrained")
        axes = figure.add_subplot()
        counts = sorted({outcome.kind for outcome in self.planted})
        for name, marker in zip(self.outcomes[0].results, "o.sD^v<>P*", strict=False):
            times = [np.median([o.results[name].time for o in self.planted if o.kind == n]) for n in counts]
            bold = {"linewidth": 2.5, "color": "black"} if name == self.ours else {"linewidth": 1.2}
            seen = np.where(np.isfinite(times), times, np.nan)
            axes.loglog(counts, seen, marker=marker, label=name.strip("`"), **bold)
        axes.set_xticks(counts, [str(count) for count in counts])
        axes.minorticks_off()
        axes.set_xlabel("planted targets")
        axes.set_ylabel("median time until all are within 1 mm, s")
        axes.grid(alpha=0.3)
        figure.legend(loc="outside right upper", fontsize=8, frameon=False)
        return figure


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    """Return the lines of a table in Markdown."""
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)) + " |"
        for line in (head, *rows)
    ]
    return [lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]]


def _excess(over: list[float]) -> str:
    return f"{_percent(float(np.median(over)))}, {_percent(max(over))}"


def _percent(fraction: float) -> str:
    if not math.isfinite(fraction):
        return "none found"
    return f"{100 * fraction:.2f} %" if fraction < 10.0 else "over 1000 %"


def write(report: Report, arguments: Namespace) -> None:
    """Store table and plot where docs show them."""
    PICTURE.parent.mkdir(exist_ok=True)
    with mpl.rc_context({"svg.hashsalt": "synth"}):
        FigureCanvasSVG(report.plot()).print_svg(PICTURE, metadata={"Date": None})
    machine = (
        f"{arguments.tasks} tasks of each kind, {arguments.budget:g} s for each method and task, "
        f"{arguments.clock} time; {platform.python_implementation()} {platform.python_version()} on "
        f"{platform.machine()}, {os.cpu_count()} cores, {arguments.workers} task at a time."
    )
    generated = f"{_BEGIN}\n\n{machine}\n\n{report.text()}\n\n{_END}"
    page, pattern = PAGE.read_text(), f"{re.escape(_BEGIN)}.*?{re.escape(_END)}"
    PAGE.write_text(re.sub(pattern, lambda _: generated, page, flags=re.DOTALL))
