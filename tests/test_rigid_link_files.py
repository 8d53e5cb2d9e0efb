"""A catalogue of rigid links as it stands in files, and as a value of a robot."""

from __future__ import annotations

from dataclasses import replace

import pytest
from planted import ROBOT
from planted_rigid_links import CATALOGUE

import synth
from synth.measurement import load_measurements
from synth.robot import RigidLink, RigidLinkChoices

ROBOT_TEXT = """
length_unit: mm
d12: 58
link: {{length: [550, 700], min_bend_radius: 110, diameter: 50}}
d34: 49
rigid_link: {}
"""
LISTS = "{d35: {one_of: [410, 455]}, d45: {one_of: [415, 460]}, diameter: 20}"
PAIRS = "{one_of: [{d35: 410, d45: 415}, {name: long, d35: 455, d45: 460, diameter: 10}], diameter: 20}"


def read(rigid_link: str, tmp_path) -> synth.Robot:
    (tmp_path / "robot.yaml").write_text(ROBOT_TEXT.format(rigid_link))
    return synth.load_robot(tmp_path / "robot.yaml")


class TestFile:
    def test_lists_of_lengths_are_read_in_pairs(self, tmp_path):
        robot = read(LISTS, tmp_path)
        assert robot.rigid_links == RigidLinkChoices(
            ["rigid link 1", "rigid link 2"],
            [RigidLink(0.410, 0.415, 0.02), RigidLink(0.455, 0.460, 0.02)],
        )
        assert robot.rigid_link == robot.rigid_links.links[0]

    def test_rigid_links_may_have_names_and_diameters(self, tmp_path):
        robot = read(PAIRS, tmp_path)
        assert robot.rigid_links.names == ("rigid link 1", "long")
        assert [link.diameter for link in robot.rigid_links.links] == [0.02, 0.01]

    def test_an_inline_robot_may_have_one(self):
        text = ROBOT_TEXT.format(LISTS).replace("\n", "\n  ").replace("  length_unit", "\n  length_unit")
        task = synth.parse_task(
            f"synth: 1\nlength_unit: cm\nrobot:{text}\ntargets: [{{position: [40, 10, 20]}}]"
        )
        assert task.robot.rigid_links.links[1].d35.lower == 0.455

    @pytest.mark.parametrize(
        ("rigid_link", "expected"),
        [
            (
                "{d35: {one_of: [410, 455, 500]}, d45: {one_of: [415, 460]}}",
                {"rigid_link.d45.one_of": "as many lengths as that of d35"},
            ),
            ("{d35: {one_of: [410]}, d45: [400, 450]}", {"rigid_link.d45": "but is [400, 450]"}),
            (
                "{d35: 410, d45: {one_of: [415]}}",
                {"rigid_link.d35": "must be {one_of: [...]}, each for the d45"},
            ),
            ("{one_of: []}", {"rigid_link.one_of": "one rigid link at least"}),
            (
                "{d35: {one_of: []}, d45: {one_of: [-1]}}",
                {"rigid_link.d35.one_of": "one rigid link at least", "rigid_link.d45.one_of[0]": "than 0"},
            ),
            ("{one_of: [{d35: 410, d45: 415}], d35: 4}", {"rigid_link.d35": "cannot stand beside"}),
            ("{one_of: [{d35: [1, 2], d45: 415}]}", {"rigid_link.one_of[0].d35": "a number, but is a list"}),
            ("{one_of: [{d35: 410, nam: a}]}", {"rigid_link.one_of[0].nam": "did you mean 'name'"}),
            ("{d35: [410, 455, 500], d45: 460}", {"rigid_link.d35": "[low, high] or {one_of: [...]}"}),
            ("{d35: {oneof: [410]}, d45: 415}", {"rigid_link.d35.oneof": "did you mean 'one_of'"}),
            (
                "{d35: {one_of: [410, 900, 410]}, d45: {one_of: [415, 460, 415]}}",
                {
                    "rigid_link.d35.one_of[1]": "d35 exceeds d45 by at least 440",
                    "rigid_link.d35.one_of[2]": "the same d35 and d45 as rigid_link.d35.one_of[0]",
                },
            ),
            (
                "{one_of: [{name: a, d35: 9, d45: 15}, {name: a, d35: 410, d45: 415}, {d35: 410, d45: 415}]}",
                {
                    "rigid_link.one_of[0]": "d35 + d45 is at most 24",
                    "rigid_link.one_of[1].name": "'a' is the name of rigid_link.one_of[0] already",
                    "rigid_link.one_of[2]": "the same d35 and d45",
                },
            ),
        ],
    )
    def test_every_mistake_is_named_at_its_own_key(self, rigid_link, expected, tmp_path):
        with pytest.raises(synth.InputError) as caught:
            read(rigid_link, tmp_path)
        told = {mistake.key: mistake.message for mistake in caught.value.mistakes}
        assert all(words in told.get(key, "") for key, words in expected.items()), told
        assert all(mistake.line == 6 for mistake in caught.value.mistakes)

    def test_a_shape_that_was_measured_says_which_it_has(self, tmp_path):
        read(LISTS, tmp_path)
        file = tmp_path / "measured.yaml"
        start = "synth: 1\nlength_unit: mm\nrobot: robot.yaml\nrounding: 1\n"
        stated = "distances: {d13: 650, d14: 667, d23: 603, d24: 619"
        file.write_text(f"{start}{stated}}}")
        with pytest.raises(synth.InputError, match="d35 is one of several in the robot"):
            load_measurements(file)
        file.write_text(f"{start}{stated}, d35: 455, d45: 460}}")
        (measured,) = load_measurements(file)
        assert measured.robot.rigid_links is None
        assert measured.robot.rigid_link.d35.lower == 0.455
        file.write_text(f"{start}{stated}, d35: 490, d45: 480}}")
        with pytest.raises(synth.InputError, match=r"they are 410\.0 to 455\.0 mm apart"):
            load_measurements(file)


class TestValue:
    @pytest.mark.parametrize(
        ("names", "links", "key"),
        [
            ([], [], "links"),
            (["a"], [RigidLink(0.4, 0.4), RigidLink(0.5, 0.5)], "links"),
            (["a"], [RigidLink([0.4, 0.5], 0.4)], "links[0]"),
            (["a"], ["b"], "links[0]"),
            ([""], [RigidLink(0.4, 0.4)], "names[0]"),
            (["a", "a"], [RigidLink(0.4, 0.4), RigidLink(0.5, 0.5)], "names[1]"),
            (["a", "b"], [RigidLink(0.4, 0.4), RigidLink(0.4, 0.4, 0.01)], "links[1]"),
        ],
    )
    def test_what_is_no_catalogue_is_refused(self, names, links, key):
        with pytest.raises(synth.InputError) as caught:
            RigidLinkChoices(names, links)
        assert [mistake.key for mistake in caught.value.mistakes] == [key]

    def test_a_robot_has_one_of_its_catalogue(self):
        robot = replace(ROBOT, rigid_links=CATALOGUE)
        assert robot.rigid_link == ROBOT.rigid_link  # which is one of it
        assert replace(robot, rigid_link=RigidLink(0.3, 0.31)).rigid_link == CATALOGUE.links[0]
        with pytest.raises(synth.InputError) as caught:
            replace(robot, rigid_links=RigidLinkChoices(["open"], [RigidLink(0.3, 0.4)]))
        assert [mistake.key for mistake in caught.value.mistakes] == ["rigid_links.links[0]"]
