"""Makes the gallery: a page for each folder of `problems/`, by running its task; `python docs/gallery.py`.

A page shows what the command really printed, and the build fails where an answer is not the known one.
"""

from __future__ import annotations

import hashlib
import re
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from click.testing import CliRunner
from figure_of_task import task_picture

from synth import Solution, load_task, solution_to_json, solve
from synth.cli import main as synth_command

ROOT = Path(__file__).parents[1]
PROBLEMS, GALLERY = ROOT / "problems", ROOT / "docs" / "gallery"
sys.path.append(str(ROOT / "tests"))  # the facts of the problems, and who checks them

from facts import Facts, broken_facts, facts_of, measured  # noqa: E402 - after the path
from oracle import OracleArm  # noqa: E402 - after the path

# From simple to hard; what is not named here comes last.
ORDER = (
    "two-crates", "one-target", "three-targets", "four-targets", "twelve-targets", "moved-base", "own-robot",
    "asked-scara",
    "plane", "sphere", "puma-sphere", "free-rigid-link", "three-rigid-links", "published-shape", "through-the-window",
    "below-the-floor", "out-of-reach", "three-on-the-axis",
)  # fmt: skip
QUANTITIES = {
    "worst_miss": "worst miss, mm",
    "total_bend_deg": "bend of the link in all, deg",
    "circle_radius": "radius R of the circle of P5, mm",
    "axes_apart": "distance a of the axes, mm",
    "common_normal_height": "height z0 of their common normal, mm",
}
THUMBNAIL = 2.6  # inches


@dataclass(frozen=True)
class Run:
    """What came of the task of a folder."""

    solution: Solution
    printed: str
    seconds: float


def names() -> list[str]:
    """Return the names of all problems, from simple to hard."""
    found = sorted(path.parent.name for path in PROBLEMS.glob("*/task.yaml"))
    return sorted(found, key=lambda name: ORDER.index(name) if name in ORDER else len(ORDER))


def command(name: str) -> list[str]:
    """Return the arguments of `synth` that the README of a problem gives."""
    story = (PROBLEMS / name / "README.md").read_text(encoding="utf-8")
    return re.findall(r"^synth (solve .*)$", story, re.MULTILINE)[0].split()


def run(name: str) -> Run:
    """Run the command of a problem's README, files left out; refuse an answer that is not the known one."""
    arguments = [each for each in command(name) if each not in {"-o", "out"}]
    started = time.perf_counter()
    answer = CliRunner().invoke(synth_command, arguments)
    seconds = time.perf_counter() - started
    task = load_task(PROBLEMS / name / "task.yaml")
    solution = solve(task, prove="--prove" in arguments)
    if broken := broken_facts(facts_of(name), task, solution):
        raise ValueError(f"{name}: {'; '.join(broken)}")
    return Run(solution, answer.output, seconds)


def story(name: str) -> dict[str, str]:
    """Return the sections of a problem's README by heading, the beginning as "" and the title as "title"."""
    text = (PROBLEMS / name / "README.md").read_text(encoding="utf-8")
    text = re.sub(r"\]\(\.\./([\w-]+)/README\.md\)", r"](\1.md)", text)
    text = text.replace("](../../docs/", "](../")
    title, _, rest = text.removeprefix("# ").partition("\n")
    rest = re.sub(
        r"^```\n.*?^```\n", "", rest, flags=re.MULTILINE | re.DOTALL
    )  # the sketch: there is a picture
    first, *others = re.split(r"^## ", rest, flags=re.MULTILINE)
    sections = dict(section.split("\n", 1) for section in others)
    return {"title": title, "": first.strip(), **{key: text.strip() for key, text in sections.items()}}


def check_table(facts: Facts, solution: Solution) -> str:
    """Return what is known of the answer beside what was found."""
    content = solution_to_json(solution)
    arm = OracleArm.stated(solution.task, content)
    joints = np.array([target["joints"] for target in content["targets"]])
    found = measured(solution.task, arm, joints)
    rows = [f"| status | {facts.status} | {content['status']} |"]
    for quantity, (low, high) in facts.between.items():
        rows.append(f"| {QUANTITIES[quantity]} | {low:g} to {high:g} | {found[quantity]:.3f} |")
    return "\n".join(["| | known | found |", "|---|---|---|", *rows])


def page(name: str, made: Run) -> str:
    """Return the page of a problem."""
    told, facts = story(name), facts_of(name)
    summary, _, rest = made.printed.rstrip().partition("\n\n")
    shown = re.sub(r"^```sh\n.*?^```\n*", "", told["Run it"], flags=re.MULTILINE | re.DOTALL)
    steps = f":::{{dropdown}} What it printed below\n```text\n{rest}\n```\n:::\n" if rest else ""
    following = names()[(names().index(name) + 1) % len(names())]
    return f"""# {told["title"]}

{told[""]}

![The arm at its first target, its workspace cut open, and the targets]({name}.png)

## The task

{{download}}`task.yaml <../../problems/{name}/task.yaml>`, or `problems/{name}/task.yaml` in a copy of the repository:

```yaml
{(PROBLEMS / name / "task.yaml").read_text(encoding="utf-8").rstrip()}
```

## Run it

```text
$ synth {" ".join(command(name))}
{summary}
```

{steps}
It took {made.seconds:.1f} s when this page was made.

{shown}

## The check

{check_table(facts, made.solution)}

{facts.source.strip()} `tests/test_problems.py` compares the answer with this for three seeds, by kinematics of its own.

:::{{dropdown}} Why the answer must be what it is
{told["Why the answer must be what it is"]}
:::

## Limits

{told["Limits"]}

Next: [{story(following)["title"]}]({following}.md)
"""


def card(name: str, made: Run) -> str:
    """Return the card of a problem in the grid."""
    title, _, rest = story(name)["title"].partition(":")
    return f"""::::{{grid-item-card}} {title}
:link: {name}
:link-type: doc
:img-top: {name}-small.png

{rest.strip().capitalize()} <br> *{made.solution.status.value.replace("_", " ")}*
::::
"""


def index(cards: list[str]) -> str:
    """Return the page with the grid of all problems."""
    return f"""# Gallery

Each task here was solved when these pages were made; its answer is known beforehand, by a small theorem or by
the shape that its targets were made with, and compared. From simple to hard, the impossible last.

:::::{{grid}} 1 2 3 3
:gutter: 3

{"".join(cards)}
:::::

```{{toctree}}
:hidden:

{chr(10).join(names())}
```
"""


def state() -> str:
    """Return a fingerprint of all that the gallery depends on."""
    sources = [*(ROOT / "synth").rglob("*.py"), *PROBLEMS.rglob("*.*"), *(ROOT / "docs").glob("*.py")]
    digest = hashlib.sha256()
    for path in sorted(sources):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def write_gallery(directory: Path = GALLERY) -> None:
    """Run all problems and write their pages, unless they were made from what is here now."""
    made_from = directory / ".made-from"
    if made_from.exists() and made_from.read_text() == state():
        return
    directory.mkdir(exist_ok=True)
    cards = []
    for name in names():
        made = run(name)
        task_picture(made.solution).savefig(directory / f"{name}.png", dpi=110)
        task_picture(made.solution, width=THUMBNAIL, named=False).savefig(
            directory / f"{name}-small.png", dpi=130
        )
        (directory / f"{name}.md").write_text(page(name, made), encoding="utf-8")
        cards.append(card(name, made))
    (directory / "index.md").write_text(index(cards), encoding="utf-8")
    made_from.write_text(state())


if __name__ == "__main__":
    write_gallery()
