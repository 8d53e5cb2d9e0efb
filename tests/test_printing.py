"""What `print` shows of a solution is what the terminal does, and nothing is found out twice for it."""

from collections import Counter
from io import BytesIO, TextIOWrapper

import numpy as np
import pytest
from planted import noisy, planted_task
from planted_guide import (
    ARM,
    ROBOT,
    TIMING,
    make_design,
)

from synth.cli.terminal import as_shown
from synth.export import solution_to_json, write_files
from synth.guide import markers, solution_text
from synth.synthesis import (
    Design,
    Solution,
    Status,
    solve,
    verify,
)
from synth.synthesis.solution import solution as solution_module
from synth.synthesis.wanted import judging, ways
from synth.task import PointTarget, Task


def test_many_targets_are_summed_up():
    task, design = make_design(ARM, [[1.0, 2.0]] * 14, np.outer(np.arange(14) - 7, [2e-2, 0, 0]), 1e-3)
    text = str(Solution(task, Status.BEST_EFFORT, "x", (), 0, (design, design), 1, TIMING))
    assert "of 14 targets are within tolerance; the 10 worst:" in text
    assert "2 distinct shapes" in text
    assert len(text.splitlines()) < 20


IMPOSSIBLE = Task("too far", ROBOT, (PointTarget("far", [4.0, 0.0, 0.5]),))
SOLVED = {
    Status.FOUND: planted_task(5, 2)[0],
    Status.BEST_EFFORT: noisy(5, 8),
    Status.PROVEN_IMPOSSIBLE: IMPOSSIBLE,
}


@pytest.mark.parametrize("status", SOLVED, ids=lambda status: status.value)
def test_print_shows_what_the_terminal_does(status):
    solution = solve(SOLVED[status], alternatives=0)
    assert solution.status is status
    told = str(solution).splitlines()
    shown = as_shown(solution_text(solution), TextIOWrapper(BytesIO(), encoding="utf-8")).splitlines()
    assert shown[: len(told)] == told
    steps = shown[len(told) :]
    assert steps[:1] == [""] if solution.found else not steps
    assert told[0].startswith(f"{'✓' if solution.found else '✗'} {solution.task.name}: {status.sentence}")
    assert told[-1].startswith("• seed 0, ")
    assert len(repr(solution)) < 80
    assert status.value in repr(solution)


def test_ways_targets_and_guide_are_made_once_however_often_they_are_told(monkeypatch, tmp_path):
    calls = Counter()

    def count(module, name):
        function = getattr(module, name)
        monkeypatch.setattr(
            module, name, lambda *args, **options: calls.update([name]) or function(*args, **options)
        )

    for module, name in (
        (ways, "routed"),
        (judging, "hand_forgiveness"),
        (markers, "hold_posture"),
        (markers, "shape_tolerance"),
        (solution_module, "target_results"),
    ):
        count(module, name)
    task, arm = planted_task(77, 3)  # of no other test: what was made before would not be made at all
    design = Design(arm, verify(task, arm))
    solution = Solution(task, Status.FOUND, Status.FOUND.sentence, (), 0, (design,), 1, TIMING)
    str(solution)
    solution_text(solution, alternatives=True)
    solution_to_json(solution)
    write_files(solution, tmp_path)
    assert solution.targets is solution.targets
    assert calls == dict.fromkeys(calls, 1)
    assert len(calls) == 5
