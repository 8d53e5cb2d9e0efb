"""No prose that a machine does not check: the code in README and docs runs, the help is the real one."""

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

import synth
from synth.cli import main

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if blocks(page, "python")], ids=lambda page: page.stem
)
def test_the_python_of_a_page_runs_from_top_to_bottom(page, monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {}
    for block in blocks(page, "python"):
        exec(compile(block, page.name, "exec"), names)  # noqa: S102 - our own text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_help_texts_of_a_page_are_those_of_the_program(page):
    for block in blocks(page, "console"):
        command, _, shown = block.partition("\n")
        arguments = command.removeprefix("$ synth ").split()
        answer = CliRunner().invoke(main, arguments, prog_name="synth", terminal_width=100)
        assert shown == answer.output, f"{page.name}: $ synth {' '.join(arguments)}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_links_of_a_page_lead_somewhere(page):
    for link in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text()):
        assert (page.parent / link).exists(), link


def test_every_public_name_resolves():
    for name in synth.__all__:
        assert getattr(synth, name) is not None
    assert set(synth.__all__) <= set(dir(synth))


def test_the_version_is_written_once():
    assert f"version: {synth.__version__}" in (ROOT / "CITATION.cff").read_text()
    assert f"## {synth.__version__}" in (ROOT / "CHANGELOG.md").read_text()
