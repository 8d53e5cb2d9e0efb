"""No prose that a machine does not check: code on the pages runs, commands answer what the pages show."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import synth
from synth.cli import main

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

from run_pages import Shown, code_of, pages, run_page  # noqa: E402 - after the path

PAGES = pages()
BUILT = {"gallery"}  # folders of pages that only the site has


def blocks(page, language):
    return re.findall(rf"^ *```{language}\n(.*?)^ *```", page.read_text(), re.MULTILINE | re.DOTALL)


def named(page):
    return page.relative_to(ROOT).with_suffix("").as_posix()


@pytest.mark.parametrize(
    "page",
    [page for page in PAGES if any(blocks(page, kind) for kind in ("python", "console", "console like"))],
    ids=named,
)
def test_the_code_of_a_page_runs_and_its_commands_answer_what_it_shows(page):
    for shown in run_page(page):
        assert shown.agrees or shown.told == shown.expected, f"{page.name}: {shown.line}"


def test_an_answer_that_is_not_the_real_one_is_seen():
    told, answer = "a miss of 1.0 mm\n...\n", "a miss of 2.0 mm\nand more\n"
    assert Shown(0, "", told, answer, like=True).agrees
    assert not Shown(0, "", told, answer, like=False).agrees
    assert not Shown(0, "", told.replace("miss", "gap"), answer, like=True).agrees


def test_a_strict_type_checker_accepts_the_code_of_all_pages_and_values_from_lists(tmp_path):
    pytest.importorskip("mypy", reason="of the extra dev")
    for page in PAGES:
        (tmp_path / f"{named(page).replace('/', '_').replace('-', '_')}.py").write_text(code_of(page))
    (tmp_path / "built_values.py").write_text((ROOT / "tests/built_values.py").read_text())
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", ROOT / "pyproject.toml", *tmp_path.glob("*.py")],
        cwd=tmp_path,
        check=False,
        env={**os.environ, "MYPYPATH": f"{ROOT}{os.pathsep}{ROOT / 'docs'}"},
        capture_output=True,
        text=True,
    )
    assert checked.returncode == 0, checked.stdout + checked.stderr


def tasks_shown():
    return [
        pytest.param(text, id=f"{named(page)}-{number}")
        for page in PAGES
        for number, text in enumerate(blocks(page, "yaml"))
        if text.startswith("synth: 1") and re.search("^(targets|path):", text, re.MULTILINE)
    ]


@pytest.mark.parametrize("text", tasks_shown())
def test_a_task_on_a_page_can_be_read(text, tmp_path):
    (tmp_path / "scan.csv").write_text("x,y,z\n" + "".join(f"{400 + i},0,300\n" for i in range(9)))
    (tmp_path / "seam.csv").write_text("400,0,300\n420,90,300\n380,90,320\n")
    assert synth.parse_task(text, directory=tmp_path).targets


@pytest.mark.parametrize("command", ["", *(f"{name} " for name in main.commands)])
def test_every_command_has_its_help_on_a_page(command):
    lines = [block.split("\n", 1)[0] for page in PAGES for block in blocks(page, "console")]
    assert lines.count(f"$ synth {command}--help") == 1


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_the_links_of_a_page_lead_somewhere(page):
    for link in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text()):
        path = page.parent / link
        assert path.exists() or path.parent.name in BUILT, link


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_a_page_says_what_it_is_for_and_has_one_title(page):
    outside = re.sub(r"^ *```.*?^ *```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    if page.stem != "changelog":
        assert len(re.findall(r"^# .", outside, re.MULTILINE)) == 1
        first = page.read_text().split("\n", 2)[2].lstrip()
        assert re.match(r"[A-Z`]", first), "the first sentence after the title is no sentence"


def test_every_public_name_resolves():
    for name in synth.__all__:
        assert getattr(synth, name) is not None
    assert set(synth.__all__) <= set(dir(synth))


def test_the_version_is_written_once():
    assert f"version: {synth.__version__}" in (ROOT / "CITATION.cff").read_text()
    assert f"## {synth.__version__}" in (ROOT / "CHANGELOG.md").read_text()
