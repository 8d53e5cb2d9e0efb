"""Every worked task is solved with several seeds, and its facts are checked by the oracle.

The shapes that targets were planted with are checked in the same way, so that the source of a fact is no mere
claim.
"""

import re

import numpy as np
import pytest
from facts import (
    NAMES,
    PROBLEMS,
    Facts,
    broken_facts,
    directions_broken,
    facts_of,
    limits_broken,
    planted_arm_of,
    task_of,
)
from pydantic import ValidationError
from ruamel.yaml import YAML

import synth

SEEDS = range(3)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", NAMES)
def test_facts_hold(name, seed):
    task = task_of(name)
    assert not broken_facts(facts_of(name), task, synth.solve(task, seed=seed))


@pytest.mark.parametrize("name", [name for name in NAMES if facts_of(name).planted])
def test_planted_shape_is_what_its_facts_say(name):
    facts, task = facts_of(name), task_of(name)
    arm = planted_arm_of(task, facts.planted)
    if task.paths:
        points = task.paths[0].at(np.linspace(0.0, task.paths[0].ends[-1], 1000))
        joints = np.radians(facts.planted.waypoint_joints_deg)
        assert arm.misses(joints, task.paths[0].waypoints).max() < 1e-3  # rounded to millimetres
        assert arm.misses(arm.closest(points), points).max() <= facts.planted.within / 1e3
        assert not limits_broken(task, arm, joints)
        return
    if task.surfaces:
        (surface,) = task.surfaces
        joints = arm.closest(task.table.positions)
        near = arm.misses(joints, task.table.positions) <= facts.planted.within / 1e3
        assert near.mean() >= surface.coverage
        assert not limits_broken(task, arm, joints[near])
        return
    assert list(facts.planted.joints_deg) == [target.name for target in task.targets]
    joints = np.radians(list(facts.planted.joints_deg.values()))
    assert not limits_broken(task, arm, joints)
    assert not list(directions_broken(task, arm, joints))
    assert arm.misses(joints, task.table.positions).max() <= facts.planted.within / 1e3
    if facts.status == "found":
        assert facts.planted.within / 1e3 <= task.tolerances.min()


def test_facts_that_do_not_hold_are_named():
    facts, task = facts_of("one-target"), task_of("one-target")
    solution = synth.solve(task, alternatives=0)
    wrong = facts.model_copy(
        update={"status": "best_effort", "between": {"worst_miss": [7.0, 8.0], "circle_radius": [1.0, 2.0]}}
    )
    assert [told.split()[0] for told in broken_facts(wrong, task, solution)] == [
        "status",
        "worst_miss",
        "circle_radius",
    ]


def test_facts_that_are_misspelt_are_refused():
    content = YAML(typ="safe").load(PROBLEMS / "sphere" / "facts.yaml")
    for wrong in (
        {"catgory": "spherical"},
        {"between": {"worst": [0, 1]}},
        {"sphere": {"centre": [0, 0, 0], "radius": 700, "within": 5, "radious": 1}},
    ):
        with pytest.raises(ValidationError):
            Facts.model_validate(content | wrong)


def test_every_folder_has_its_files_and_its_row_in_the_index():
    rows = []
    for name in NAMES:
        task = (PROBLEMS / name / "task.yaml").read_text(encoding="utf-8")
        data = re.findall(r"(?:points|mesh|csv): ([\w.-]+)", task)
        files = sorted(path.name for path in (PROBLEMS / name).iterdir())
        assert files == sorted(["README.md", "facts.yaml", "task.yaml", *data])
        story = (PROBLEMS / name / "README.md").read_text(encoding="utf-8")
        assert f"synth solve problems/{name}/task.yaml" in story
        title = story.splitlines()[0].removeprefix("# ")
        rows.append(f"| [{name}]({name}/README.md) | {title} | {facts_of(name).status} |")
    index = (PROBLEMS / "README.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\| \[.*\|$", index, flags=re.MULTILINE)) == rows
