"""Whether what the terminal shows is true: every line must be one that is known, every number in it right.

A line that is worded anew is a fault until it is read anew here, or it would pass unread.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fuzz_errors import faults_of_errors
from fuzz_faults import Fault, wrongly_told
from fuzz_guide import GUIDE_LINES
from fuzz_lines import MOST_LINES, SUMMARY_LINES, Told

if TYPE_CHECKING:
    from collections.abc import Iterator


_NUMBER = r"(-?\d+\.?\d*)"
_STATUSES = {
    "every target is within its tolerance": "found",
    "no shape was found that reaches every target": "best_effort",
    "no shape of this robot can do the task": "proven_impossible",
    "stopped before the search was complete": "limit",
    "the solver broke down": "failed",
}
_OF_NEAREST = "; what follows is of the nearest shape found"
_FIXED_LINES = (
    r"solving with --(why|prove) .*",
    r"more time may find a shape",
)


def faults_of_text(told: Told, text: str) -> Iterator[Fault]:
    """Check the message of the JSON, the text line by line, and by trial what is told of errors."""
    yield from faults_of_lines(told, text)
    if told.content["status"] == "found":
        yield from faults_of_errors(told)


def faults_of_lines(told: Told, text: str) -> Iterator[Fault]:
    """Check the message of the JSON, and the text line by line."""
    content = told.content
    if re.search(r"\bnan\b|\binf\b", content["message"] + text):
        yield Fault("untrue", "a number is nan or inf")
    yield from _message(told)
    headline, _, *lines = text.split("\n")
    yield from _headline(told, headline)
    patterns = SUMMARY_LINES | (GUIDE_LINES if content["status"] == "found" else {})
    for line in filter(None, lines):
        bare = line.removeprefix("• ")
        if bare in content["reasons"] or bare in content["notes"]:
            continue
        found = [(judge, match) for words, judge in patterns.items() if (match := re.fullmatch(words, bare))]
        if found:
            judge, match = found[0]
            yield from judge(told, *match.groups())
        elif not any(re.fullmatch(words, bare) for words in _FIXED_LINES):
            yield Fault("not judged", f"a line: {bare}")
    yield from _are_all_there(told, text)


def _message(told: Told) -> Iterator[Fault]:
    """Check the JSON's message: its status, the three worst misses, the reasons."""
    content, message = told.content, told.content["message"]
    for name, number in re.findall(rf"(?:: |; )(\w+) misses by {_NUMBER} mm", message):
        yield from wrongly_told(message, number, 1e3 * told.misses[told.names[name]], "up")
    if content["status"] != "found" and told.arm is not None:
        missed = sum(not target["within_tolerance"] for target in content["targets"])
        worst = len(re.findall(r"(?:: |; )\w+ misses by \d", message))
        more = sum(map(int, re.findall(r"; and (\d+) more(?:$|; )", message)))
        if missed != worst + more:
            yield Fault("untrue", f"{missed} targets are missed: {message}")
    if content["status"] == "found" and len(content["ways"]) == sum(way["found"] for way in content["ways"]):
        if message != "every target is within its tolerance":
            yield Fault("not judged", f"a message: {message}")
    elif not message.endswith("; ".join(content["reasons"])):
        yield Fault("untrue", f"the message leaves out a reason: {message}")


def _headline(told: Told, headline: str) -> Iterator[Fault]:
    """Check the first line: the sign, the task's name, and how it ended."""
    content, task = told.content, told.task
    sign, words = headline[0], headline[2:].removeprefix(f"{task.name}: ")
    if sign != ("✓" if content["status"] == "found" else "✗") or not content["message"].startswith(words):
        yield Fault("untrue", f"{content['status']}, but: {headline}")
    missing = [f"{way['from']} to {way['to']}" for way in content["ways"] or [] if not way["found"]]
    if content["status"] == "found" and missing:
        said = re.findall(r"no way was found from (\w+ to \w+)", words)
        more = sum(map(int, re.findall(r"and (\d+) more", words)))
        if said != missing[: len(said)] or len(said) + more != len(missing):
            yield Fault("untrue", f"no ways for {missing}, but: {words}")
    elif _STATUSES.get(words.removesuffix(_OF_NEAREST)) != content["status"]:
        yield Fault("not judged", f"a headline: {headline}")
    if words.endswith(_OF_NEAREST) != (content["status"] != "found" and told.arm is not None):
        yield Fault("untrue", f"of a nearest shape: {headline}")


def _are_all_there(told: Told, text: str) -> Iterator[Fault]:
    """Check that nothing is left out, and that nobody is told to bend a shape that misses."""
    content, count = told.content, len(told.names)
    lines = len(re.findall(r"^[✓✗] .* miss ", text, re.MULTILINE))
    if lines != (min(count, MOST_LINES) if told.arm is not None else 0):
        yield Fault("not judged", f"{lines} lines of {count} targets are read")
    if content["status"] == "found":
        wanted = ["Set joint 1 to", "Hold axis 2 within", "kind of shape:", "as published", "By tape:"]
        wanted += [f"{way['from']} to {way['to']}: " for way in content["ways"][:MOST_LINES]]
        for words in wanted:
            if words not in text:
                yield Fault("untrue", f"it is not told: {words}")
    else:
        for words in ("Hold axis 2 within", "Set joint 1 to", "Soften", "as published"):
            if words in text:
                yield Fault("instructions", f"a task that is not met is told: {words} ...")
