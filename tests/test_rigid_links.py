"""A catalogue of rigid links: searched through, told first, held in solution files, and proven as a whole."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from planted import ROBOT, noisy
from planted_rigid_links import CATALOGUE, NAMES, RANGE, free_rigid_link, planted_rigid_link
from planted_surfaces import as_task, patch

import synth
from synth.export import solution_to_json
from synth.guide import instructions, make_guide
from synth.robot import BaseChoices, BasePose, BaseRange, Interval, RigidLink, RigidLinkChoices
from synth.surfaces import Scan, Surface
from synth.synthesis import Bound, Status, proving
from synth.synthesis.whole import for_all, leading
from synth.task import PointTarget, Task


@pytest.fixture(scope="module")
def solved():
    task, name = planted_rigid_link(1)
    return task, name, synth.solve(task)


@pytest.mark.parametrize("seed", range(2, 4))
def test_the_right_one_of_six_is_chosen(seed):
    task, name = planted_rigid_link(seed)
    arm = synth.solve(task).robot
    assert task.robot.name_of_rigid_link(arm.d35, arm.d45) == name


def test_what_does_only_the_part_that_is_searched_with_is_not_chosen(monkeypatch):
    """One 2 mm too long reaches forty points of a scan by least squares, not all: the planted does.

    Led to less of the worst miss it reaches them all, too, so that is left out here.
    """
    monkeypatch.setattr(for_all, "may_be_met", lambda *_: False)
    monkeypatch.setattr(leading, "may_be_met", lambda *_: False)
    arm, (low, high) = patch(2)
    joints = np.random.default_rng(2).uniform(low, high, (2000, 2))
    scan = Surface("scan", Scan(arm.forward_kinematics(joints[:, 0], joints[:, 1])), tolerance=4.2e-6)
    links = [RigidLink(arm.d35 + 2e-3, arm.d45 + 2e-3), RigidLink(arm.d35, arm.d45)]
    robot = replace(ROBOT, rigid_link=links[0], rigid_links=RigidLinkChoices(("long", "right"), links))
    solution = synth.solve(replace(as_task("scan", scan), robot=robot), alternatives=0)
    assert solution.found
    assert solution.robot.d35 == arm.d35
    assert solution.notes == (
        "with long each of the 40 targets that were looked at first is reached, but not all that is asked",
    )


def test_the_right_one_is_told_first_with_what_the_others_do(solved):
    task, name, solution = solved
    assert solution.found
    assert solution.task == replace(
        task, robot=replace(task.robot, rigid_link=solution.robot.robot.rigid_link)
    )
    content = solution_to_json(solution)
    assert content["rigid_link"]["name"] == name
    assert [each["rigid_link"]["name"] for each in content["alternatives"]] == [name] * len(
        solution.designs[1:]
    )
    first = instructions(make_guide(solution.task, solution.best))[0]
    assert first.startswith(
        f"Of the rigid links take {name}: d35 = {1e3 * solution.robot.d35:.1f} mm and d45"
    )
    assert first in synth.guide.solution_text(solution)
    others = [each for each in NAMES if each != name]
    assert [note.split(" misses by ")[0] for note in solution.notes] == [
        f"with {each} the best shape found" for each in others
    ]


def test_a_solution_file_holds_the_catalogue(solved, tmp_path):
    *_, solution = solved
    synth.write_files(solution, tmp_path)
    loaded = synth.load_solution(tmp_path / "solution.json")
    assert loaded == solution
    assert loaded.task.robot.rigid_links == CATALOGUE
    schema = str(synth.solution_schema())
    assert "the catalogue" in schema
    assert "one_of" in str(synth.robot_schema())


def test_what_was_chosen_for_another_task_is_chosen_anew(solved):
    """A solution's task has the whole catalogue still, so that it can be solved again."""
    task, name, solution = solved
    wrong = next(link for other, link in zip(NAMES, CATALOGUE.links, strict=True) if other != name)
    again = replace(solution.task, robot=replace(task.robot, rigid_link=wrong))
    arm = synth.solve(again, alternatives=0).robot
    assert task.robot.name_of_rigid_link(arm.d35, arm.d45) == name


def test_with_several_places_every_pair_is_looked_at():
    task, name = planted_rigid_link(1)
    base = BasePose([0.3, -0.2, 0.1], yaw=1.0)
    targets = [replace(each, position=base.to_task(each.position)) for each in task.targets]
    places = BaseChoices(["bench", "shelf"], [BasePose(), base])
    few = RigidLinkChoices(NAMES[2:5], CATALOGUE.links[2:5])
    there = replace(task, targets=targets, places=places, robot=replace(ROBOT, rigid_links=few))
    solution = synth.solve(there)
    assert solution.found
    content = solution_to_json(solution)
    assert (content["rigid_link"]["name"], content["guide"]["base"]["name"]) == (name, "shelf")
    assert len(solution.notes) == 5
    assert any(note.startswith("with C at bench ") for note in solution.notes)


def test_with_a_base_that_is_free_each_rigid_link_has_a_place_of_its_own():
    task, _ = planted_rigid_link(2)
    few = RigidLinkChoices(NAMES[1:3], CATALOGUE.links[1:3])
    places = BaseRange(Interval(-0.05, 0.05), Interval(-0.05, 0.05))
    solution = synth.solve(replace(task, places=places, robot=replace(ROBOT, rigid_links=few)))
    assert solution.found
    assert places.contains(solution.robot.base)
    assert len(solution.notes) == 1


def test_nothing_is_said_of_what_there_was_no_time_for():
    task, _ = planted_rigid_link(0)
    solution = synth.solve(task, time_limit=0.0)
    assert "with F nothing was looked for: the time was up" in solution.notes


def with_rigid_links(task: Task, *names: str) -> Task:
    links = [CATALOGUE.links[NAMES.index(name)] for name in names]
    return replace(task, robot=replace(ROBOT, rigid_links=RigidLinkChoices(names, links)))


class TestProof:
    def test_what_no_rigid_link_can_do_is_proven_only_if_each_is(self):
        """The link ends at most 758 mm over P1, and the rigid links reach 320 to 547 mm from there."""
        up = Task("up", ROBOT, [PointTarget("up", [0.0, 0.0, 1.2])])
        assert synth.solve(with_rigid_links(up, "A", "B")).status is Status.PROVEN_IMPOSSIBLE
        solution = synth.solve(with_rigid_links(up, "A", "F", "B"))
        assert solution.found
        assert solution.robot.d35 == CATALOGUE.links[-1].d35.lower

    @pytest.mark.parametrize("lower", [(5e-3, 4e-3, 3e-3), (5e-3, 1e-4, 3e-3)])
    def test_the_bound_is_the_least_of_those_of_each(self, monkeypatch, lower):
        """With stand-ins for the proofs, each of which knows its rigid link."""
        bounds, asked = dict(zip(("A", "B", "C"), lower, strict=True)), []

        class Proof:
            def __init__(self, task, *_):
                rigid = task.robot.rigid_link
                self.name = CATALOGUE.name_of(rigid.d35.lower, rigid.d45.lower)

            def search(self):
                return 7e-3

            def bound(self, known):
                asked.append((self.name, known))
                return Bound(bounds[self.name], min(known, 6e-3), 0.5e-3, 1)

        monkeypatch.setattr(proving, "Certifier", Proof)
        solution = synth.solve(with_rigid_links(noisy(0, 6, noise=0.03), "A", "B", "C"), prove=True)
        assert not solution.found
        assert sorted(name for name, _ in asked) == ["A", "B", "C"]
        assert [known for _, known in asked] == [7e-3, 6e-3, 6e-3]
        assert asked[-1][0] == CATALOGUE.name_of(solution.robot.d35, solution.robot.d45)
        assert solution.bound.lower_bound == min(lower)
        proven = min(lower) > 0.5e-3
        assert (solution.status is Status.PROVEN_IMPOSSIBLE) == proven
        assert ("every shape misses some target by at least 3.000 mm" in solution.message) == proven

    def test_of_a_base_in_ranges_it_is_said_what_the_proof_is_of(self, monkeypatch):
        proof = SimpleNamespace(search=lambda: 7e-3, bound=lambda _: Bound(5e-3, 6e-3, 0.5e-3, 1))
        monkeypatch.setattr(proving, "Certifier", lambda *_: proof)
        solution = synth.solve(noisy(0, places=BaseRange(Interval(0.0, 0.1))), prove=True, alternatives=0)
        assert solution.status is Status.BEST_EFFORT
        assert "what is proven holds where the base was found to stand" in solution.notes

    def test_a_catalogue_is_proven_as_a_whole(self):
        solution = synth.solve(
            with_rigid_links(noisy(0, 6, noise=0.03), "A", "D"), prove=True, alternatives=0
        )
        assert solution.status is Status.PROVEN_IMPOSSIBLE
        assert CATALOGUE.name_of(solution.robot.d35, solution.robot.d45) == "D"
        assert solution.notes[0] == "what is shown is the shape with D"
        assert 0.0 < solution.bound.gap <= 1e-4 + 1e-12
        assert solution.bound.lower_bound > 8e-3

    @pytest.mark.parametrize(("seed", "none"), [(2, True), (1, False)])
    def test_algebra_speaks_of_all_rigid_links(self, seed, none):
        """Through one set of four targets passes no arm with A or B, through the other one with B."""
        solution = synth.solve(with_rigid_links(noisy(seed, 4, noise=0.1), "A", "B"), alternatives=0)
        assert ("no arm with any of the rigid links passes" in solution.message) == none
        assert ("by algebra" in solution.message) == none


def test_of_ranges_it_is_said_that_nothing_is_proven(monkeypatch):
    monkeypatch.setattr(proving, "Certifier", None)  # nobody looks for a proof
    free = replace(ROBOT, rigid_link=RigidLink([0.44, 0.47], [0.44, 0.47]))
    solution = synth.solve(replace(noisy(0, 8, noise=0.03), robot=free), prove=True, alternatives=0)
    assert solution.status is Status.BEST_EFFORT
    assert solution.bound is None
    assert "nothing was proven: a rigid link in ranges is not bounded" in str(solution)


@pytest.mark.parametrize("seed", range(2))
def test_a_rigid_link_in_ranges_is_found(seed):
    task = free_rigid_link(seed)
    solution = synth.solve(task, alternatives=0)
    assert solution.found
    assert RANGE.contains(solution.robot.d35)
    assert make_guide(solution.task, solution.best).rigid_link == ""
