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


def shown(page):
    """Return what a page shows of the program: each line of a command with what it answers."""
    return [tuple(block.split("\n", 1)) for block in blocks(page, "console")]


@pytest.mark.parametrize("page", [page for page in PAGES if shown(page)], ids=lambda page: page.stem)
def test_what_a_page_shows_of_the_program_is_what_it_answers(page):
    for line, told in shown(page):
        arguments = line.removeprefix("$ synth ").split()
        answer = CliRunner().invoke(main, arguments, prog_name="synth", terminal_width=100)
        assert told == answer.output, f"{page.name}: {line}"


@pytest.mark.parametrize("command", ["", *(f"{name} " for name in main.commands)])
def test_every_command_has_its_help_on_a_page(command):
    lines = [line for page in PAGES for line, _ in shown(page)]
    assert lines.count(f"$ synth {command}--help") == 1


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
