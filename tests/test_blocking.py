"""What blocks a task is named, by how much, and what is named does release it."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from planted import noisy
from planted_blocked import blocked_task

from synth.export import solution_to_json
from synth.guide import solution_text
from synth.robot import PRESETS
from synth.synthesis import blocking, explain, help_told, solve, verify
from synth.synthesis.solve import follow
from synth.task import PointTarget, Task, load_task, parse_task
from synth.watch import Watch

PROBLEMS = Path(__file__).parents[1] / "problems"


@pytest.mark.parametrize(
    ("limit", "planted"), [("link length", 4e-3), ("joint 1", np.radians(3)), ("floor", 5e-3)]
)
def test_the_limit_that_is_too_tight_is_named_first(limit, planted):
    """No more is asked for than the planted arm needs; another arm may do with less."""
    task = blocked_task(limit, 1, lambda task: follow(task, (), starts=8).found)
    first = explain(follow(task, (), starts=8)).releases[0]
    assert first.limit == limit
    assert 0.0 < first.amount < 1.05 * planted
    assert verify(first.task, first.design.arm, first.design.verification.joints).found


def test_each_release_is_enough_and_the_base_is_told_last():
    solution = explain(solve(load_task(PROBLEMS / "out-of-reach/task.yaml")))
    assert [each.limit for each in solution.releases] == ["link length", "base"]
    for each in solution.releases:
        assert verify(each.task, each.design.arm, each.design.verification.joints).found
    longer, base = solution.releases
    # 1277.7 mm from P2 to the shelf, 1156.9 mm of robot, 1 mm of tolerance
    assert 0.1198 < longer.amount < 0.1250
    assert 0.1198 < base.amount < 0.1250
    assert "longer (up to" in longer.sentence
    assert base.task.base.position[2] > 0.1
    # What is told is the place that does, to the last digit.
    told = [float(each) for each in re.findall(r"\b[xyz] (-?\d+\.\d+)", base.sentence)]
    assert base.task.base.position == pytest.approx(1e-3 * np.array(told), abs=1e-12)


def test_nothing_blocks_what_was_found():
    solution = solve(load_task(PROBLEMS / "one-target/task.yaml"))
    assert explain(solution) is solution


def test_to_stop_keeps_what_is_known():
    solution = solve(load_task(PROBLEMS / "out-of-reach/task.yaml"))
    assert explain(solution, stop=lambda: True).releases == ()


class Ticks:
    """A clock that goes on by a second whenever it is looked at."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        self.now += 1.0
        return self.now


def test_a_time_limit_is_kept_and_it_is_said_how_far_the_search_got(monkeypatch):
    solution = solve(load_task(PROBLEMS / "out-of-reach/task.yaml"))
    searches = []

    def counted(*arguments, **options):
        searches.append(arguments)
        return follow(*arguments, **options)

    monkeypatch.setattr(blocking, "follow", counted)
    monkeypatch.setattr(blocking, "Watch", lambda limit, **options: Watch(limit, clock=Ticks(), **options))
    stopped = explain(solution, time_limit=5.0)
    assert len(searches) <= 5
    assert "was stopped early: 0 of" in stopped.notes[0]
    assert explain(solution, stop=lambda: True).notes


def test_each_limit_is_told_and_the_search_within_gives_signs_of_life():
    told = []

    def stop():
        return len(told) > 3

    explain(solve(load_task(PROBLEMS / "out-of-reach/task.yaml")), progress=told.append, stop=stop)
    assert told[0].phase == "relaxing: link length"
    assert [one.phase for one in told].count(told[0].phase) > 1


def six_targets_of_no_arm():
    """Targets on and about axis 1, which is no place for the section of any arm's workspace."""
    positions = [[r, 0.0, z] for r in (0.3, 0.45, 0.6) for z in (0.2, 0.45)] + [[0.45, 0.0, 0.325]]
    targets = tuple(PointTarget(f"t{i}", p, tolerance=1e-3) for i, p in enumerate(positions))
    return Task("grid", PRESETS["malleable-2dof"], targets)


def solved(task):
    """A solution that needs no long search: one start is enough to explain."""
    return follow(task, (), starts=1)


def test_where_no_limit_helps_it_says_so_and_how_near_any_surface_passes(monkeypatch):
    solution = solved(six_targets_of_no_arm())
    assert not solution.found
    # Each limit on its own is what other tests are about; here none helps.
    monkeypatch.setattr(blocking, "_released", lambda *_: None)
    monkeypatch.setattr(blocking, "base_moved", lambda *_, **__: None)
    explained = explain(solution)
    assert explained.releases == ()
    (note,) = explained.notes
    assert "neither one limit relaxed alone" in note
    assert "surface of revolution about axis 1" in note
    miss = float(re.search(r"misses none by more than (\d+\.\d\d) mm", note).group(1))
    assert 1.0 < miss < 200.0
    assert note in solution_text(explained)
    assert solution_to_json(explained)["notes"] == [note]
    # The sheet tells what was found out, and no longer to find it out.
    assert "--why" in help_told(solution)[1]
    assert note in help_told(explained)
    assert not any("--why" in each for each in help_told(explained))


def test_that_no_surface_passes_is_called_proven_only_where_algebra_proves_it(monkeypatch):
    solution = solved(six_targets_of_no_arm())
    monkeypatch.setattr(blocking, "_released", lambda *_: None)
    monkeypatch.setattr(blocking, "base_moved", lambda *_, **__: None)
    assert "none was found that passes through all the targets" in explain(solution).notes[0]
    monkeypatch.setattr(blocking, "exact_arms", lambda _: ())
    assert "by algebra none passes exactly through all the targets" in explain(solution).notes[0]


def test_where_no_shape_at_all_is_left_it_says_that_too(monkeypatch):
    solution = solved(six_targets_of_no_arm())
    monkeypatch.setattr(blocking, "_released", lambda *_: None)
    monkeypatch.setattr(blocking, "base_moved", lambda *_, **__: None)
    monkeypatch.setattr(blocking, "follow", lambda *_, **__: replace(solution, designs=()))
    assert explain(solution).notes[0].endswith("nor any shape at all with all limits relaxed together")


def test_where_several_limits_block_together_it_says_that(monkeypatch):
    task = load_task(PROBLEMS / "out-of-reach/task.yaml")
    monkeypatch.setattr(blocking, "_released", lambda *_: None)
    monkeypatch.setattr(blocking, "base_moved", lambda *_, **__: None)
    (note,) = explain(solved(task)).notes
    assert "with all limits relaxed together the task is met" in note


def test_nothing_is_begun_for_which_the_time_is_shorter_than_verifying_took():
    solution = solve(noisy(5), alternatives=0)
    slow = replace(solution, time=replace(solution.time, verifying=20.0))
    told = []
    explained = explain(slow, time_limit=19.0, progress=lambda progress: told.append(progress.phase))
    assert len(set(told)) <= 3  # the first limit, and what would come after all of them
    assert not explained.releases
    assert "stopped early: 0 of" in explained.notes[-1]


def test_where_the_base_would_have_to_stand_for_a_dome_is_told(monkeypatch):
    monkeypatch.setattr(blocking, "limits_of", lambda _: [])  # of these other tests tell
    dome = {
        "sphere": {"center": [150, 100, 0], "radius": 520},
        # So large that no other place does within the tolerance; of a small part there are some beside it.
        "region": [{"sphere": {"center": [410, 100, 450], "radius": 160}}],
    }
    task = parse_task(
        {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof", "floor": None, "surface": dome}
    )
    (release,) = explain(solve(task, alternatives=0, time_limit=3.0)).releases
    assert release.design.verification.found
    np.testing.assert_allclose(release.design.arm.base.position[:2], [0.15, 0.1], atol=5e-3)
    assert re.match(r"the base at \(1[45]\d\.\d, (9\d|10\d)\.\d, ", release.sentence)
