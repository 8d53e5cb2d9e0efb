"""What is told of a result: headline, reasons, help, targets, shapes; true, and nothing twice."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from planted_guide import (
    ARM,
    DESIGN,
    GUIDE,
    JOINTS,
    NOTHING,
    SOLUTION,
    TASK,
    make_arm,
    make_design,
)

from synth.errors import SynthError
from synth.guide import MARKERS, guide_text, make_guide, solution_text
from synth.guide.instructions import (
    tolerance_sentences,
)
from synth.guide.sensitivity import ShapeTolerance, shape_tolerance
from synth.robot import MOST_CLEARANCE, LinkShape
from synth.synthesis import (
    Bound,
    Design,
    Release,
    Status,
    clearance_told,
    help_told,
    showing,
    verify,
)
from synth.synthesis.wanted.ways import Motion
from synth.task import DEFAULT_TOLERANCE


@pytest.mark.parametrize("missed", [1, 3])
def test_a_task_that_is_not_met_has_no_tolerance_and_no_instruction(missed):
    """Not even if all targets but one are reached: the one that is barely met is no measure of anything."""
    task, design = make_design(ARM, JOINTS, [[0.9] * 3] * missed + [[1e-3, 0.0, 0.0]] * (3 - missed))
    tolerance = shape_tolerance(task, design)
    assert math.isnan(tolerance.position)
    assert math.isnan(tolerance.direction)
    assert tolerance.position_target == ShapeTolerance().direction_target == ""
    guide = make_guide(task, design)
    assert not guide.met
    assert guide.forgiveness is None
    assert tolerance_sentences(guide) == guide.ways == ()
    for status in (Status.BEST_EFFORT, Status.PROVEN_IMPOSSIBLE, Status.LIMIT):
        solution = replace(SOLUTION, task=task, designs=(design,), status=status, reasons=("it is too far",))
        text = guide_text(guide, solution)
        assert f"✗ a task: {status.sentence}" in text.splitlines()[0]
        assert "• it is too far" in text
        assert "✗ t0  MISSED" in text
        for words in ("Set joint 1", "Hold axis 2", "P3", "END", "hand", "bend radius"):
            assert words not in text


def test_only_where_there_is_a_shape_is_it_called_the_nearest():
    for status in (Status.BEST_EFFORT, Status.LIMIT):
        assert "nearest" in status.told(with_shape=True)
        assert status.told(with_shape=False) == status.sentence
        assert "nearest" not in str(replace(NOTHING, status=status))
        assert "this is" not in status.sentence


def test_a_default_tolerance_is_marked_as_such():
    text = str(replace(SOLUTION, **on(make_design(ARM, JOINTS, np.zeros((3, 3)), DEFAULT_TOLERANCE))))
    assert "of 1.000 mm, the default" in text
    assert "the default" not in str(SOLUTION)


def on(made):
    task, design = made
    return {"task": task, "designs": (design,)}


def test_proof_and_help_stand_below_the_headline_and_speak_of_the_shape_shown():
    task, design = make_design(ARM, JOINTS, np.full((3, 3), 0.1))
    worst = 1e3 * design.verification.misses.max()
    bound = Bound(0.02, 0.0201, 2e-3, 7)
    release = Release("floor", 0.1, 0.1, "a floor 100.0 mm lower", design, task)
    solution = replace(
        SOLUTION, task=task, designs=(design,), status=Status.PROVEN_IMPOSSIBLE,
        reasons=(bound.sentence,), bound=bound, releases=(release,),
    )  # fmt: skip
    lines = str(solution).splitlines()
    assert lines[2].startswith(
        "• proven: every shape misses some target by at least 20.000 mm; the worst miss of"
    )
    gap = float(re.search(r"within ([\d.]+) mm", lines[2])[1])
    assert worst - 20.0 <= gap < worst - 20.0 + 1.1e-3
    assert lines[3] == "• a floor 100.0 mm lower would do"
    assert lines[4].startswith("✗ t0")


def test_of_many_reasons_some_are_told_and_the_others_counted():
    text = str(replace(NOTHING, reasons=tuple(f"reason {i}" for i in range(48))))
    assert "reason 4" in text
    assert "reason 5" not in text
    assert "and 43 more of this kind" in text


def test_another_shape_is_shown_on_request():
    other = make_arm(curvatures=((2.0, 1.0), (-2.0, 3.0), (1.0, 5.0)))
    second = Design(other, verify(TASK, other))
    both = replace(SOLUTION, designs=(DESIGN, second))
    shown = showing(both, 2)
    assert shown.robot is other
    assert shown.shape_numbers == (2, 1)
    assert "this is shape 2 (" in str(shown)
    assert solution_text(shown, alternatives=True).splitlines()[-1].startswith("  1  worst miss")
    assert showing(both, 1).shape_numbers == (1, 2)
    for number in (0, 3):
        with pytest.raises(
            SynthError, match=f"there is no shape {number} to show: there are 2 distinct shapes"
        ):
            showing(both, number)
    with pytest.raises(SynthError, match="there is no shape of this task"):
        showing(NOTHING, 1)


def test_the_text_holds_the_headline_the_angle_and_the_points():
    text = guide_text(GUIDE, SOLUTION)
    lines = text.splitlines()
    assert lines[0] == f"✓ a task: {Status.FOUND.sentence}"
    assert "2. Set joint 1 to 180.0 deg and hold it there, joint 2 at 180.0 deg." in lines
    rows = {name: line.split()[1:] for line in lines for name in MARKERS if line.startswith(f"{name}   ")}
    for name, row in zip(MARKERS, GUIDE.hold.markers, strict=True):
        np.testing.assert_allclose(np.array(rows[name], dtype=float), 1e3 * row, atol=0.051)
    assert f"link {1e3 * ARM.shape.length:.1f} mm long" in text
    assert "seed 7, 3 starts, 1.25 s" in text
    assert "nan" not in text


def test_a_solution_without_a_shape_has_a_summary_and_its_reasons():
    text = guide_text(None, NOTHING)
    assert text == str(NOTHING)
    assert "• no\n• never\n• 3 targets asked for, none reached" in text


def test_the_other_shapes_have_a_line_each_on_request():
    both = replace(SOLUTION, designs=(DESIGN, DESIGN))
    assert solution_text(both) == guide_text(GUIDE, both)
    assert solution_text(SOLUTION, alternatives=True) == guide_text(GUIDE, SOLUTION)
    assert solution_text(both, alternatives=True).splitlines()[-1].startswith("  2  worst miss")
    assert solution_text(NOTHING, alternatives=True) == str(NOTHING)


def test_a_task_that_is_missed_tells_what_would_help():
    task, design = make_design(ARM, JOINTS, np.full((3, 3), 0.1))
    missed = replace(SOLUTION, task=task, designs=(design,), status=Status.BEST_EFFORT)
    told = help_told(missed)
    worst = 1e3 * design.verification.misses.max()
    tolerance = float(
        re.search(r"tolerances of ([\d.]+) mm would be met by the nearest shape found", told[0])[1]
    )
    assert worst <= tolerance < worst + 0.01
    # That is true: with such tolerances the same shape is found to do.
    loose = replace(task, targets=tuple(replace(t, tolerance=1e-3 * tolerance) for t in task.targets))
    assert verify(loose, design.arm, design.verification.joints).found
    assert ["--why" in each for each in told[1:]] == [True, False]
    assert "--prove" in told[2]
    assert all(f"• {each}" in str(missed).splitlines() for each in told)
    stopped = help_told(replace(missed, status=Status.LIMIT, explained=True))
    assert "more time may find a shape" in stopped
    assert not any("--why" in each for each in stopped)
    impossible = help_told(replace(missed, status=Status.PROVEN_IMPOSSIBLE))
    assert len(impossible) == 1  # no tolerance is promised, and nothing is left to prove
    assert help_told(SOLUTION) == []


def test_a_straight_link_is_told_as_one_without_a_bend():
    straight = LinkShape([[1e-4, 0.0]], [0.6]).describe()
    assert straight == "link 600.0 mm long, as good as straight"


def test_the_headline_of_a_shape_without_a_way_says_so():
    ways = (Motion("a", "b", np.zeros((0, 2))),)
    design = replace(SOLUTION.best, ways=ways)
    headline = str(replace(SOLUTION, designs=(design,))).splitlines()[0]
    assert headline.endswith(": every target is reached, but no way was found from a to b")


def test_a_clearance_is_told_no_farther_than_it_was_looked_for():
    assert clearance_told(MOST_CLEARANCE) == "100.0 mm at least"
    assert clearance_told(np.nextafter(MOST_CLEARANCE, 0.0)) == "100.0 mm at least"
    assert clearance_told(0.04999) == "49.9 mm"
