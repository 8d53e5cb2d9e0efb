"""`synth schema`: what a file may hold, as JSON Schema."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.measurement import measured_schema
from synth.solution_file import solution_schema
from synth.task import robot_schema, task_schema

if TYPE_CHECKING:
    from collections.abc import Callable

_SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "task": task_schema,
    "robot": robot_schema,
    "solution": solution_schema,
    "measured": measured_schema,
}


def print_schema(kind: str) -> ExitCode:
    """Print the JSON Schema of a kind of file.

    Args:
        kind: "task", "robot", "solution" or "measured".

    Returns:
        The exit code.
    """
    say(json.dumps(_SCHEMAS[kind](), indent=2))
    return ExitCode.DONE
