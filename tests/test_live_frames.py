"""Frames of a live stream with another axis up: turned as a recording is, and checked as any other."""

import json
from dataclasses import replace

import numpy as np
import pytest
from planted import ROBOT, planted_task
from standing import BARS, seen

from synth.live.checker import Checker, CheckSettings
from synth.live.feed import Feed
from synth.live.sources import feed_lines
from synth.measurement import StandingArm, axis_up, turn_to_z
from synth.synthesis import solve

SETTINGS = CheckSettings(3, 0.455e-3, base_calibrated=True, confidence=0.95, stiff=False)


@pytest.fixture(scope="module")
def checker():
    task, _ = planted_task(5, 3)
    wide = replace(task, targets=tuple(replace(each, tolerance=5e-3) for each in task.targets))
    return Checker(solve(wide), SETTINGS)


@pytest.fixture(scope="module")
def frame(checker):
    return seen(StandingArm.of(checker._solution.robot, checker.joint1), BARS)


def lines(frame):
    for name, (x, y, z) in zip(frame.names, frame.positions.tolist(), strict=True):
        yield json.dumps({"marker": name, "x_mm": 1e3 * x, "y_mm": 1e3 * y, "z_mm": 1e3 * z})


def up(frame, axis):
    """Return a frame as it is seen where another axis is up."""
    return replace(frame, positions=frame.positions @ turn_to_z(axis))


@pytest.mark.parametrize("axis", ["z", "y", "x"])
def test_lines_are_turned_once_p1_and_p2_are_seen(checker, frame, axis):
    feed = Feed()
    feed_lines(feed, lines(up(frame, axis)), ROBOT, checker.joint1)
    told = json.loads(dict(feed.after(0, 0.0)[1])["frame"])
    assert told["up"] == axis
    np.testing.assert_allclose(list(told["markers"].values()), frame.positions, atol=1e-6)
    assert checker.told_of(feed.recent())["lock"]


def test_what_was_up_holds_until_the_markers_show_something_else(frame):
    now = [0.0]
    feed = Feed(lambda: now[0])

    def recent(seen):
        now[0] += 10.0
        feed.saw(seen)
        return feed.recent()[0].positions

    np.testing.assert_allclose(recent(up(frame, "y")), frame.positions, atol=1e-12)
    one = frame.without("P2")
    np.testing.assert_allclose(recent(up(one, "y")), one.positions, atol=1e-12)
    np.testing.assert_allclose(recent(frame), frame.positions, atol=1e-12)
    leaning = replace(frame, positions=frame.positions @ [[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    assert not axis_up(leaning)
    np.testing.assert_allclose(recent(leaning), leaning.positions, atol=1e-12)
