"""The judge of random tasks with surfaces and paths: true answers have no fault, false claims have one."""

import copy
import re
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent / "benchmarks"))

from fuzz_covered import faults_of_sampled_text, judge_sampled
from fuzz_lines import Told
from fuzz_sampled import drawn
from oracle import OracleArm

from synth.export import solution_to_json
from synth.guide import solution_text
from synth.synthesis import solve

_NUMBERS = {"mesh": 5, "scan": 6, "path": 5}  # of random tasks that are met


@cache
def answered(family):
    fuzz = drawn(_NUMBERS[family], family)
    task = fuzz.read()
    solution = solve(task, alternatives=0)
    return fuzz, task, solution_to_json(solution), solution_text(solution)


@pytest.mark.parametrize("family", _NUMBERS)
def test_a_true_answer_has_no_fault(family):
    fuzz, task, content, text = answered(family)
    assert fuzz.kind == "planted"
    assert content["status"] == "found"
    assert judge_sampled(fuzz, task, content, text) == []


def share_stretched(content):
    content["surfaces"][0]["share"] += 0.2


def path_left(content):
    joints = np.array(content["paths"][0]["joints"])
    joints[len(joints) // 2] += 0.2
    content["paths"][0]["joints"] = joints


def path_cut_short(content):
    for key in ("joints", "points", "lengths", "times"):
        content["paths"][0][key] = content["paths"][0][key] and content["paths"][0][key][:20]


def stray_flattered(content):
    content["paths"][0]["largest"] *= 0.1


def joint_moved(content):
    content["targets"][0]["joints"][0] += 0.05


def arc_bent(content):
    content["link"]["arcs"][0]["curvature"][0] += 0.5


@pytest.mark.parametrize(
    ("family", "plant", "kind"),
    [
        ("mesh", share_stretched, "misstated"),
        ("scan", share_stretched, "misstated"),
        ("path", path_left, "false found"),
        ("path", path_cut_short, "false found"),
        ("path", stray_flattered, "false found"),
        ("path", joint_moved, "misstated"),
        ("scan", arc_bent, "false found"),
    ],
)
def test_a_false_claim_that_is_planted_is_found(family, plant, kind):
    fuzz, task, content, text = answered(family)
    false = copy.deepcopy(content)
    plant(false)
    assert kind in {fault.kind for fault in judge_sampled(fuzz, task, false, text)}


@pytest.mark.parametrize("family", _NUMBERS)
def test_numbers_of_what_is_covered_and_followed_are_read(family):
    _, task, content, text = answered(family)
    part = task.asking_for(task.table[: len(content["targets"])])
    told = Told(part, content, OracleArm.stated(task, content))
    line = next(line for line in text.split("\n")[2:] if line.startswith("✓ "))
    numbers = list(re.finditer(r"(?<![\w.-])\d+\.?\d*(?= mm (?:RMS|for|at most)| deg)", line))
    assert len(numbers) >= 3
    for found in numbers:
        changed = f"{float(found[0]) + 0.5:.{len(found[0].partition('.')[2])}f}"
        false = text.replace(line, line[: found.start()] + changed + line[found.end() :])
        assert "untrue" in {fault.kind for fault in faults_of_sampled_text(told, content, false)}, line
