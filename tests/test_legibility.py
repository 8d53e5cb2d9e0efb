"""Pictures and sheet can be read: enough contrast, and what colours tell apart grey tells apart, too."""

import importlib
from pathlib import Path

import numpy as np
import pytest
from legibility import alike_in_grey, contrast, pale_lines, pale_texts
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth import load_task, make_guide, solve
from synth.export import draw_sheet

ROOT = Path(__file__).parents[1]
NAMES = ["robot", "revolution", "reconfiguration", "five_points", "categories", "cognates", "bound", "sweep"]


@pytest.fixture(scope="module", params=[*NAMES, "task", "sheet"])
def figure(request):
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "docs"))
        figures = importlib.import_module("figures")
        if request.param in NAMES:
            return getattr(figures, f"{request.param}_picture")()
        solution = solve(load_task(ROOT / "problems" / "two-crates" / "task.yaml"), alternatives=0)
        if request.param == "task":
            return figures.task_picture(solution)
        kept = []
        patch.setattr(Figure, "savefig", lambda self, *_, **__: kept.append(self))
        draw_sheet(solution, make_guide(solution.task, solution.best), "png")
        FigureCanvasAgg(kept[0])
        return kept[0]


def test_every_word_stands_out(figure):
    assert not pale_texts(figure)


def test_every_line_that_a_legend_names_stands_out_and_is_known_in_grey(figure):
    assert not pale_lines(figure)
    assert not alike_in_grey(figure)


def test_the_yardstick_is_that_of_wcag():
    assert contrast("black", "white") == pytest.approx(21.0)
    assert contrast("#777777", "white") == pytest.approx(4.48, abs=0.01)


def test_what_cannot_be_read_is_seen():
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.text(0.5, 0.5, "pale", color="#aaaaaa")
    axes.text(0.5, 0.3, "dark on dark", color="#333333", bbox={"facecolor": "#111111"})
    axes.plot([0, 1], [0, 1], color="#ffee00", label="yellow")
    for colour in ("#0072b2", "#1070b0"):
        axes.plot([0, 1], [1, 0], color=colour, label=colour)
    assert {name for name, _ in pale_texts(figure)} == {"pale", "dark on dark"}
    assert [name for name, _ in pale_lines(figure)] == ["yellow"]
    assert alike_in_grey(figure) == [("#0072b2", "#1070b0")]


def every_axes(figure):
    """Axes in which something is measured: those with a frame, but for bars of colours."""
    return [axes for axes in figure.axes if axes.axison and axes.get_label() != "<colorbar>"]


@pytest.mark.parametrize("name", ["categories", "cognates", "bound", "sweep"])
def test_lengths_have_a_unit_and_are_as_long_in_every_direction(name, monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    figure = getattr(importlib.import_module("figures"), f"{name}_picture")()
    assert {axes.get_aspect() for axes in figure.axes if axes.get_label() != "<colorbar>"} == {1.0}
    for axes in every_axes(figure):
        assert axes.get_xlabel().endswith(", mm")
        assert axes.get_ylabel().endswith(", mm") or not axes.get_ylabel()
    assert any(axes.get_ylabel() for axes in every_axes(figure))


def test_cognates_in_the_picture_have_one_section(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    figure = importlib.import_module("figures_of_theory").cognates_picture()
    one, other, curve = figure.axes[1].lines[:3]
    line = curve.get_xydata()
    for points in (one.get_xydata(), other.get_xydata()):
        nearest = np.argmin(np.linalg.norm(points[:, None] - 0.5 * (line[1:] + line[:-1]), axis=-1), axis=1)
        along, off = (line[1:] - line[:-1])[nearest], points - line[nearest]
        apart = np.abs(along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0]) / np.linalg.norm(along, axis=1)
        assert apart.max() < 0.5  # mm, of a curve drawn in 240 pieces


def test_the_map_of_the_sweep_holds_its_table(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    sweep = importlib.import_module("sweep_of_bases")
    told = sweep.counts()
    assert set(told) == {tuple(np.round(place, 6)) for place in sweep.PLACES}
    figure = importlib.import_module("figure_of_sweep").sweep_picture()
    numbers = sorted(int(text.get_text()) for text in figure.axes[0].texts)
    assert numbers == sorted(told.values())
