"""The judge of random tasks: it finds every number changed in what is told, and every false claim planted."""

import copy
import re
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent / "benchmarks"))

from fuzz_judge import arm_found, judge
from fuzz_lines import Told
from fuzz_proofs import faults_of_bound, faults_of_reasons
from fuzz_sentences import faults_of_lines
from fuzz_tasks import fuzz_task

from synth.export import solution_to_json
from synth.guide import solution_text
from synth.synthesis import solve
from synth.task import parse_task

_FOUND, _TOO_FAR, _IN_AN_OBSTACLE = 13, 67, 10  # numbers of random tasks


@pytest.fixture(scope="module")
def answer():
    fuzz = fuzz_task(_FOUND)
    task = parse_task(fuzz.content)
    solution = solve(task)
    return fuzz, task, solution_to_json(solution), solution_text(solution)


def changed(number: str) -> str:
    """Return a number that is larger in size by two of its last digit, as many characters long."""
    digits = len(number.partition(".")[2])
    larger = float(number) + (-2.0 if number.startswith("-") else 2.0) * 10.0**-digits
    return f"{larger:.{digits}f}"


def test_a_true_answer_has_no_fault(answer):
    fuzz, task, content, text = answer
    assert content["status"] == "found"
    assert judge(fuzz, task, content, text) == []


def test_every_number_of_the_text_that_is_changed_is_a_fault(answer):
    _, task, content, text = answer
    told = Told(task, content, arm_found(task, content))
    numbers = list(re.finditer(r"(?<![\w.])-?\d+\.?\d*", text))
    assert len(numbers) > 80
    unseen = [
        text[: found.end()].rpartition("\n")[2]
        for found in numbers
        if not list(faults_of_lines(told, text[: found.start()] + changed(found[0]) + text[found.end() :]))
    ]
    assert unseen == []


def test_a_line_that_nobody_knows_is_a_fault(answer):
    _, task, content, text = answer
    told = Told(task, content, arm_found(task, content))
    kinds = {fault.kind for fault in faults_of_lines(told, text + "\n• the arm will sing")}
    assert kinds == {"not judged"}


def joint_moved(content):
    content["targets"][0]["joints"][0] += 0.01


def arc_bent(content):
    content["link"]["arcs"][0]["curvature"][0] += 0.5


def tolerance_stretched(content):
    content["guide"]["tolerance"]["position"] *= 1.5


def tilt_stretched(content):
    content["guide"]["tolerance"]["direction"] *= 2.0


def hand_flattered(content):
    content["guide"]["forgiveness"]["expected_worst_miss"] *= 0.7


def way_through_a_limit(content):
    content["ways"][0]["joints"].insert(1, [100.0, 100.0])


def called_impossible(content):
    content["status"] = "proven_impossible"


@pytest.mark.parametrize(
    ("plant", "kind"),
    [
        (joint_moved, "false found"),
        (arc_bent, "false found"),
        (tolerance_stretched, "untrue"),
        (tilt_stretched, "untrue"),
        (hand_flattered, "untrue"),
        (way_through_a_limit, "way not clear"),
        (called_impossible, "false proof"),
    ],
)
def test_a_false_claim_that_is_planted_is_found(answer, plant, kind):
    fuzz, task, content, text = answer
    false = copy.deepcopy(content)
    plant(false)
    assert kind in {fault.kind for fault in judge(fuzz, task, false, text)}


_FAR = (
    "{target} is at least 9999.9 mm from wherever the malleable link can end, and the rigid link reaches at "
    "most 9000.0 mm from there: it misses by at least 999.9 mm"
)
_INSIDE = "the link starts at P2, at least 999.9 mm inside obstacle 1"


@pytest.mark.parametrize(
    ("number", "reason"),
    [(_TOO_FAR, _FAR), (_IN_AN_OBSTACLE, _INSIDE), (_TOO_FAR, "no arm is long enough")],
)
def test_a_false_proof_that_is_planted_is_found(number, reason):
    fuzz = fuzz_task(number)
    task = parse_task(fuzz.content)
    told = reason.format(target=task.table.names[0])
    content = {"status": "proven_impossible", "reasons": [told]}
    assert list(faults_of_reasons(fuzz, task, content))


def test_a_bound_above_what_was_planted_is_found(answer, monkeypatch):
    fuzz, task, content, _ = answer
    joints = np.array([target["joints"] for target in content["targets"]])
    arm = arm_found(task, content)
    assert faults_of_bound(fuzz, task, arm, joints, 0.2) == []

    class Above:
        lower_bound = 1e-4

    monkeypatch.setattr("fuzz_proofs.prove", lambda *_, **__: Above)
    assert {fault.kind for fault in faults_of_bound(fuzz, task, arm, joints, 0.2)} == {"false bound"}
