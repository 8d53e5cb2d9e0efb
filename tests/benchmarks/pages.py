"""Looks at `guide.html` in a real browser: `python tests/benchmarks/pages.py [DIR]`, from the project's root.

Solves worked problems, opens their pages wide, narrow, dark and on paper, moves the arm, points at the
workspace, and leaves the pictures in DIR. It fails where a script complains, where the network is asked for
anything, or where a value that is shown is not that of the kinematics.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from browser import browser

from synth import load_task, solve
from synth.export import write_page

if TYPE_CHECKING:
    from browser import Browser

    from synth.synthesis import Solution

ROOT = Path(__file__).parents[2]
PROBLEMS = (
    "two-crates",
    "four-targets",
    "through-the-window",
    "along-a-pipe",
    "out-of-reach",
    "wall-mounted",
)
WIDE, NARROW = (1500, 900), (390, 844)
NUMBERS = re.compile(r"-?\d+\.\d+")


def numbers(text: str) -> list[float]:
    """Return the numbers with decimals in a text."""
    return [float(number) for number in NUMBERS.findall(text)]


def check_sliders(tab: Browser, solution: Solution) -> float:
    """Move both joints and return by how much P5 as told is off, mm."""
    worst = 0.0
    for share in (0.1, 0.5, 0.9):
        tab.evaluate(
            f"""document.querySelectorAll('input[type=range]').forEach((slider) => {{
              slider.value = +slider.min + {share} * (slider.max - slider.min);
              slider.dispatchEvent(new Event('input'));
            }})"""
        )
        joints = [low + share * (high - low) for low, high in solution.robot.joint_bounds.T]
        told = numbers(tab.evaluate("document.querySelector('output.small').textContent"))
        worst = max(worst, float(np.abs(told - 1e3 * solution.robot.forward_kinematics(*joints)).max()))
    return worst


def check_pointing(tab: Browser, solution: Solution) -> int:
    """Point at many places; what is told of the workspace there must be on it. Return how often it was."""
    found = 0
    for x in range(150, 900, 50):
        for y in range(150, 750, 75):
            tab.point("mouseMoved", x, y)
            told = tab.evaluate("document.querySelector('#hover.shown')?.innerText ?? ''")
            if not told.startswith("Workspace"):
                continue
            found += 1
            *place, first, second = numbers(told)
            reached = 1e3 * solution.robot.forward_kinematics(np.radians(first), np.radians(second))
            assert np.abs(reached - place).max() < 3.0, told  # joints are told in tenths of a degree
    return found


def look(tab: Browser, solution: Solution, name: str, into: Path) -> dict[str, Any]:
    """Look at the page of a solution in all ways; leave pictures."""
    began = time.perf_counter()
    (page,) = write_page(solution, into / name)
    took = time.perf_counter() - began
    record: dict[str, Any] = {"kilobytes": page.stat().st_size / 1e3, "written_s": took}
    url = page.resolve().as_uri()
    for kind, size, dark in (("wide", WIDE, False), ("dark", WIDE, True), ("narrow", NARROW, False)):
        tab.show(url, *size, dark=dark, pixels=2.0 if kind == "narrow" else 1.0)
        (into / f"{name}-{kind}.png").write_bytes(tab.picture())
    tab.show(url, *WIDE)
    (into / f"{name}-paper.pdf").write_bytes(tab.paper())
    record["off_mm"] = check_sliders(tab, solution)
    record["pointed_at_workspace"] = check_pointing(tab, solution)
    assert record["off_mm"] < 0.06  # a tenth of a millimetre is told
    assert record["pointed_at_workspace"] > 5
    shapes = tab.evaluate("document.querySelectorAll('.pick').length")
    for shape in range(shapes):  # each once, the last one left
        tab.evaluate(f"document.querySelectorAll('.pick')[{shape}].click()")
    tab.evaluate("document.querySelectorAll('#layers button, #views button').forEach((each) => each.click())")
    tab.evaluate("document.querySelectorAll('.play').forEach((each) => each.click())")
    record["frame_ms"] = tab.evaluate(
        """new Promise((done) => { let count = 0; const start = performance.now();
        const step = (now) => (++count < 30 ? requestAnimationFrame(step) : done((now - start) / count));
        requestAnimationFrame(step); })"""
    )
    (into / f"{name}-layers.png").write_bytes(tab.picture())
    return record


def main() -> None:
    """Look at all pages and print what was found."""
    into = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="pages-"))
    into.mkdir(parents=True, exist_ok=True)
    with browser() as tab:
        for name in PROBLEMS:
            solution = solve(load_task(ROOT / "problems" / name / "task.yaml"))
            print(name, json.dumps(look(tab, solution, name, into)), flush=True)
            assert not tab.complaints, tab.complaints
            assert all(url.startswith("file://") for url in tab.requests), tab.requests
    print(f"no complaints, no requests; pictures in {into}")


if __name__ == "__main__":
    main()
