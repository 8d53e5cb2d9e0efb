"""Tasks for runs of the command that are disturbed, and what is left of them."""

import json
from pathlib import Path

ONE_TARGET = Path(__file__).parents[1] / "problems" / "one-target" / "task.yaml"
NAMES = {"solution.json", "guide.pdf", "guide.html", "markers.csv"}


def status(directory):
    return json.loads((directory / "solution.json").read_text(encoding="utf-8"))["status"]


def names(directory):
    return {path.name for path in directory.iterdir()}
