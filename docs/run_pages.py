"""Runs what the pages show: `python docs/run_pages.py` writes anew what the commands on them answer.

A block of the language `console` is one command with all that it answers. `console like` is the same for an answer with
numbers that rounding and time decide: it is compared without them, and a last line `...` leaves out the rest.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from click.testing import CliRunner

from synth.cli import main as synth_command

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]
MADE = ROOT / "docs" / "gallery"  # when the site is built
_BLOCK = re.compile(r"^```(python|console)( like)?\n(.*?)^```", re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")
_REST = "...\n"


def pages() -> list[Path]:
    """Return all pages that are written by hand or stand in the repository, README first."""
    found = sorted(page for page in (ROOT / "docs").rglob("*.md") if MADE not in page.parents)
    return [ROOT / "README.md", *found]


@dataclass(frozen=True)
class Shown:
    """What a page shows of a command, and what it answers.

    Attributes:
        start: Where in the text of the page the answer begins.
        line: The command.
        told: Its answer on the page.
        answer: What it really answers.
        like: Whether numbers may differ.
    """

    start: int
    line: str
    told: str
    answer: str
    like: bool

    @property
    def agrees(self) -> bool:
        """Whether the page tells the truth."""
        told, answer = self.told, self.expected
        return _NUMBER.sub("#", told) == _NUMBER.sub("#", answer) if self.like else told == answer

    @property
    def expected(self) -> str:
        """The answer, as far as the page shows it."""
        if not (self.like and self.told.endswith(_REST)):
            return self.answer
        count = self.told.count("\n") - 1
        return "".join(self.answer.splitlines(keepends=True)[:count]) + _REST


@contextlib.contextmanager
def workplace() -> Iterator[None]:
    """Work in a folder that holds nothing but the problems, so that a page may write files."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as directory:
        for name in ("problems", "docs", "tests"):
            (Path(directory) / name).symlink_to(ROOT / name)
        os.chdir(directory)
        try:
            yield
        finally:
            os.chdir(before)


def code_of(page: Path) -> str:
    """Return all Python code of a page, from top to bottom."""
    blocks = _BLOCK.findall(page.read_text(encoding="utf-8"))
    return "\n".join(text for language, _, text in blocks if language == "python")


def run_page(page: Path) -> list[Shown]:
    """Run all code and all commands of a page from top to bottom; return what it shows of the commands."""
    names: dict[str, object] = {}
    shown = []
    with workplace():
        for block in _BLOCK.finditer(page.read_text(encoding="utf-8")):
            language, like, text = block.groups()
            if language == "python":
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(text, page.name, "exec"), names)  # noqa: S102 - our own text
                continue
            line, _, told = text.partition("\n")
            arguments = shlex.split(line.removeprefix("$ synth "))
            answer = CliRunner().invoke(synth_command, arguments, prog_name="synth", terminal_width=100)
            shown.append(Shown(block.start(3) + len(line) + 1, line, told, answer.output, bool(like)))
    return shown


def rewrite(page: Path) -> bool:
    """Write anew what the commands of a page answer; return whether anything changed."""
    text = page.read_text(encoding="utf-8")
    before = text
    for each in reversed(run_page(page)):
        if not each.agrees:
            text = text[: each.start] + each.expected + text[each.start + len(each.told) :]
    page.write_text(text, encoding="utf-8")
    return text != before


def main() -> None:
    """Write all pages anew."""
    for page in pages():
        if _BLOCK.search(page.read_text(encoding="utf-8")) and rewrite(page):
            print(f"wrote {page.relative_to(ROOT)}")  # noqa: T201 - a script


if __name__ == "__main__":
    main()
