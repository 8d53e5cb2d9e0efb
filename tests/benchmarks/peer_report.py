"""The tables of `peers.py` and what follows from them, on the screen and in docs."""

from __future__ import annotations

import math
import os
import platform
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from argparse import Namespace

    from peer_race import Result

PAGE = Path(__file__).parents[2] / "docs" / "peers.md"
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
        kin: `synth` itself, in its forms, which are no peers; and each in the words of a sentence.
        no_arms: Peers whose answers are no arms, and do not count as the fastest.
        budget: Time after which a method was stopped, s.
    """

    outcomes: list[Outcome]
    least: dict[int, float]
    ours: str
    kin: dict[str, str]
    no_arms: frozenset[str]
    budget: float

    @property
    def methods(self) -> list[str]:
        return list(self.outcomes[0].results)

    @property
    def peers(self) -> list[str]:
        return [name for name in self.methods if name not in self.no_arms and name not in self.kin]

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
                *markdown_table(_TOLD, [self._told(name) for name in self.methods]),
                "\nNot told, each run to its own end, noisy tasks only:\n",
                *markdown_table(_UNTOLD, [self._untold(name) for name in self.methods]),
                "",
                *(f"- {line}" for line in self._findings()),
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

    def _findings(self) -> list[str]:
        """Return how `synth` stands to the fastest peer of each task, to all peers, and to the least miss."""
        lines = [f"planted: {self._fastest(self.planted, 'results')}."]
        for title, part in (("told the goal", "results"), ("not told", "untold")):
            lines.append(f"noisy, {title}: {self._fastest(self.noisy, part)}; {self._equal(part)}.")
        over = self.over(self.ours)
        lines.append(
            f"noisy: {self.ours} is at most {_percent(max(over))} over the least RMS miss known; "
            f"{sum(value <= 1e-3 for value in over)} of {len(over)} tasks are within 0.1 %."
        )
        return lines

    def _fastest(self, outcomes: list[Outcome], part: str) -> str:
        """Say how long the fastest peer of each task takes beside each form of `synth`."""
        fastest = [min(getattr(o, part)[peer].time for peer in self.peers) for o in outcomes]
        if not math.isfinite(np.median(fastest)):
            return "on most tasks no peer equals it"
        beside = []
        for name, words in self.kin.items():
            if name == self.ours or any(o.results[name] != o.results[self.ours] for o in outcomes):
                ratio = np.median(np.divide(fastest, [o.results[name].seconds for o in outcomes]))
                beside.append(f"{ratio:.2g} times as long as {words}")
        *first, last = beside
        listed = f"{', '.join(first)} and {last}"
        return f"the fastest peer of each task takes {listed} (medians of {len(outcomes)} tasks)"

    def _equal(self, part: str) -> str:
        """Say which peers equal `synth` on all noisy tasks, and how their times compare."""
        whole = f"{self.ours} on all {len(self.noisy)} tasks"
        equal = []
        for name in self.peers:
            if all(getattr(o, part)[name].reached for o in self.noisy):
                ratio = self._figures(self.noisy, name, part)[-1]
                equal.append(f"{name} in {ratio} times its time")
        if not equal:
            most = max(sum(getattr(o, part)[name].reached for o in self.noisy) for name in self.peers)
            return f"no peer equals {whole}, the best of them on {most}"
        verb = "equals" if len(equal) == 1 else "equal"
        return f"{len(equal)} of {len(self.peers)} peers {verb} {whole}: {', '.join(equal)} (median)"


def markdown_table(head: list[str], rows: list[list[str]]) -> list[str]:
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
    rounded = round(100.0 * fraction, 2) + 0.0  # no minus before a zero
    return f"{rounded:.2f} %" if fraction < 10.0 else "over 1000 %"


def write(report: Report, arguments: Namespace) -> None:
    """Store the tables on the page."""
    machine = (
        f"{arguments.tasks} tasks of each kind, {arguments.budget:g} s for each method and task, "
        f"{arguments.clock} time; {_machine()}, {arguments.workers} task at a time."
    )
    _replace("peers.py", f"{machine}\n\n{report.text()}")


def write_bounds(table: str, seconds: float) -> None:
    """Store the table of bounds on the page."""
    stopped = f"Stopped after {seconds:g} s of processor time (SCIP: of its user time), on one thread"
    _replace("peers.py --bounds", f"{stopped}; {_machine()}.\n\n{table}")


def _machine() -> str:
    return (
        f"{platform.python_implementation()} {platform.python_version()} on {platform.machine()}, "
        f"{os.cpu_count()} cores"
    )


def _replace(command: str, text: str) -> None:
    """Replace what a command wrote on the page, between its mark and the next end."""
    begin, end = f"<!-- written by tests/benchmarks/{command} -->", "<!-- end -->"
    pattern = f"{re.escape(begin)}.*?{re.escape(end)}"
    page = re.sub(pattern, lambda _: f"{begin}\n\n{text}\n\n{end}", PAGE.read_text(), flags=re.DOTALL)
    PAGE.write_text(page)
