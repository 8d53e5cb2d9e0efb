"""`synth learn`: from the checks of what one person bent to that person's hand."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.errors import InputError, Mistake
from synth.export import hand_to_json, json_bytes, json_text, write_all
from synth.guide import hand_text
from synth.measurement import errors_of_checks, learned_hand

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def learn_files(checks: Sequence[Path], output: Path | None, *, as_json: bool) -> ExitCode:
    """Learn a hand from files of checks, and say what was learned.

    Args:
        checks: The files, or folders that hold them.
        output: The file for the hand, or None.
        as_json: Whether JSON is printed, and nothing else.

    Returns:
        The exit code.

    Raises:
        InputError: None of the files tells anything of a hand.
    """
    errors = errors_of_checks(checks)
    if not errors:
        none = "holds no check of an arm that was seen, so there is nothing to learn from"
        raise InputError([Mistake(none, ", ".join(map(str, checks)))])
    hand, counts = learned_hand(errors), Counter(error.deed for error in errors)
    content = hand_to_json(hand, counts)
    if output is not None:
        for path in write_all({output.name: json_bytes(content)}, output.parent):
            say(f"wrote {path}", on_stderr=True)
    say(json_text(content, indent=2) if as_json else hand_text(hand, counts))
    return ExitCode.DONE
