"""What the page of other optimisers says follows from the figures, and its pictures can be read."""

import sys
from dataclasses import replace
from itertools import starmap
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from legibility import alike_in_grey, pale_lines, pale_texts
from matplotlib.backends.backend_agg import FigureCanvasAgg

sys.path.insert(0, str(Path(__file__).parent / "benchmarks"))

import peer_report
from peer_pictures import noisy_picture, planted_picture, success
from peer_report import Outcome, Report

OURS, FIRST, FLOOR = "`synth.solve`", "the same, stopped when found", "floor"
KIN = {OURS: OURS, FIRST: "that stopped when found", FLOOR: "the floor"}
PEERS = ["evolution", "strategy", "genetic", "raw Gamma", "lifted", "least squares", "compiled"]


def result(seconds, *, reached=True, rms=0.02):
    time = seconds if reached else np.inf
    return SimpleNamespace(rms=rms if reached else 2.0 * rms, seconds=seconds, reached=reached, time=time)


def report(peers, untold=None):
    """A report of two planted and three noisy tasks: ours takes 0.4, its first shape 0.2, the floor 0.1 s.

    For each peer its time on noisy tasks, and which of them it equals; 0.05 s on planted tasks.
    """
    kin = {OURS: result(0.4), FIRST: result(0.2), FLOOR: result(0.1)}

    def noisy(seed, told):
        return kin | {
            name: result(seconds, reached=reached[seed]) for name, (seconds, reached) in told.items()
        }

    planted = [Outcome(kind, 0, kind, kin | {name: result(0.05) for name in peers}, kin) for kind in (2, 4)]
    outcomes = [Outcome(0, seed, 6, noisy(seed, peers), noisy(seed, untold or peers)) for seed in range(3)]
    least = dict.fromkeys(range(3), 0.02)
    return Report([*planted, *outcomes], least, OURS, KIN, frozenset({"raw Gamma"}), 5.0)


def peers(**changes):
    return {name: changes.get(name, (0.8, [True, True, False])) for name in PEERS}


def test_the_fastest_peer_is_compared_with_each_form_of_ours():
    text = report(peers()).text()
    assert (
        "planted: the fastest peer of each task takes 0.12 times as long as `synth.solve`, 0.25 times as "
        "long as that stopped when found and 0.5 times as long as the floor (medians of 2 tasks)"
    ) in text


def test_a_peer_that_equals_ours_on_all_tasks_is_named_and_one_that_does_not_is_not():
    text = report(peers(compiled=(0.2, [True] * 3)), peers()).text()
    told, untold = (line for line in text.splitlines() if line.startswith("- noisy, "))
    assert "1 of 6 peers equals `synth.solve` on all 3 tasks: compiled in 0.5 times its time" in told
    assert "no peer equals `synth.solve` on all 3 tasks, the best of them on 2" in untold


def test_answers_that_are_no_arms_are_no_peers():
    fast = {**peers(), "raw Gamma": (0.001, [True] * 3)}
    text = report(fast).text()
    assert "no peer equals" in text
    assert "takes 2 times as long as `synth.solve`" in text


def test_where_no_peer_reaches_most_goals_no_ratio_is_told():
    text = report({name: (0.8, [False] * 3) for name in PEERS}).text()
    assert text.count("on most tasks no peer equals it") == 2
    assert "inf" not in text
    assert "nan" not in text


def test_a_hair_below_the_least_known_is_no_minus_nothing():
    told = report(peers())
    least = dict.fromkeys(range(3), 0.02 * (1.0 + 1e-09))
    assert "-0.00" not in replace(told, least=least).text()


def test_success_grows_with_each_task_and_ends_at_the_share_that_was_equalled():
    told = report(peers(compiled=(0.2, [True, False, True])))
    times, shares = success(told.noisy, "results", "compiled")
    assert times.tolist() == [0.2, 0.2]
    assert shares.tolist() == pytest.approx([1 / 3, 2 / 3])
    for axes in noisy_picture(told).axes:
        lines = {line.get_label(): line for line in axes.lines}
        assert lines["compiled"].get_ydata()[-1] == pytest.approx(2 / 3)
        assert lines["synth.solve"].get_ydata()[-1] == 1.0
        assert FLOOR not in lines
        assert lines["compiled"].get_xdata()[-1] == 5.0


@pytest.mark.parametrize("picture", [planted_picture, noisy_picture])
def test_the_pictures_can_be_read_in_grey_too(picture):
    figure = picture(report({name: (0.3 + i, [True, i > 2, False]) for i, name in enumerate(PEERS)}))
    FigureCanvasAgg(figure)
    assert not pale_texts(figure)
    assert not pale_lines(figure)
    assert not alike_in_grey(figure)


def test_a_table_replaces_its_own_part_of_the_page_alone(tmp_path, monkeypatch):
    page = tmp_path / "peers.md"
    marks = ["<!-- written by tests/benchmarks/peers.py{} -->\n{}\n<!-- end -->\n"] * 2
    page.write_text(
        "one\n" + "two\n".join(starmap(str.format, zip(marks, ("", " --bounds"), "ab", strict=True)))
    )
    monkeypatch.setattr(peer_report, "PAGE", page)
    peer_report.write_bounds("the bounds", 3.0)
    lines = page.read_text().splitlines()
    assert "a" in lines
    assert "b" not in lines
    assert "the bounds" in lines
    peer_report.write(report(peers()), SimpleNamespace(tasks=1, budget=5.0, clock="cpu", workers=1))
    assert "the bounds" in page.read_text()
    assert "told the goal" in page.read_text()
    assert "a" not in page.read_text().splitlines()
