"""A task drawn at random, and what is known of its answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.errors import InputError
from synth.task import Task, parse_task

if TYPE_CHECKING:
    from oracle import OracleArm

_MEANT = 500.0  # mm from P1, a place that nobody takes for a mistaken unit, whatever robot is drawn here


@dataclass
class FuzzTask:
    """A task file's content, and what is known of its answer.

    Attributes:
        number: The seed that draws it again.
        kind: "planted", "impossible" or "wild".
        content: The task file, lengths in its own unit.
        planted: The planted arm, or None.
        joints: Its joint angles at the targets, rad.
        why: What makes the task impossible, or what is special about it.
        tags: What was drawn.
        files: The text of files that the task names.
        fine: Of each surface and path by its name points all over it, in the task frame, shape (n, 3), m.
    """

    number: int
    kind: str
    content: dict[str, Any]
    planted: OracleArm | None = None
    joints: np.ndarray | None = None
    why: str = ""
    tags: list[str] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    fine: dict[str, np.ndarray] = field(default_factory=dict)

    def read(self) -> Task:
        """Return the task as it is read, with the files that it names."""
        with TemporaryDirectory() as directory:
            for name, text in self.files.items():
                (Path(directory) / name).write_text(text)
            return parse_task(self.content, directory=Path(directory))


def parsed(content) -> Task:
    """Return the values of a task file's content, with a target of no consequence where it has none."""
    p1 = np.array(content.get("base", {"position": [0.0, 0.0, 0.0]})["position"])
    return parse_task({"targets": [{"position": p1 + [_MEANT, 0.0, 0.0]}]} | content)


def is_meant(content) -> bool:
    """Whether a content is not refused because its sizes look like those of a mistaken unit of length."""
    try:
        parsed(content)
    except InputError as error:
        if "length_unit" not in str(error):
            raise
        return False
    return True
