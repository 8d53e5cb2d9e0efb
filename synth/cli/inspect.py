"""`synth inspect`: what a measured shape of the robot is, and how sure that is."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from synth.cli.session import Session
    from synth.measurement import Inspection


def inspect_file(
    session: Session, file: Path, output: Path | None, *, form: str, seed: int, samples: int
) -> ExitCode:
    """Inspect a file of measured shapes and say what was found: first as files, then in words.

    Args:
        session: The run of the command.
        file: The file.
        output: Directory for `inspect.json` and the pictures, or None.
        form: "text", "json" or "markdown".
        seed: Seed of the samples and of the search for the link's shape.
        samples: How many shapes to draw for the ranges.

    Returns:
        The exit code.
    """
    from synth.export import file_names, prepare_directory
    from synth.measurement import inspect, load_measurements

    measurements = load_measurements(file)
    if output is not None:
        prepare_directory(output, file_names(measurements))
    inspections: list[Inspection] = []
    for measurement in measurements:
        if session.stop():
            break
        found = session.attempt(
            f"the inspection of {measurement.name}",
            lambda one=measurement: inspect(one, seed=seed, samples=samples),  # type: ignore[misc]
            None,
        )
        inspections += [] if found is None else [found]
    kept = output is None or not inspections or _write(inspections, output)
    said = say(_text(inspections, form)) or output is not None
    if session.broken or not kept or not said:
        return ExitCode.BROKEN
    if len(inspections) < len(measurements):
        say(f"stopped: {len(inspections)} of {len(measurements)} shapes were looked at", on_stderr=True)
        return ExitCode.INTERRUPTED
    return ExitCode.DONE if all(one.is_realisable for one in inspections) else ExitCode.NOT_MET


def _text(inspections: Sequence[Inspection], form: str) -> str:
    from synth.export import inspection_text, inspections_markdown, inspections_to_json

    if form == "json":
        return json.dumps(inspections_to_json(inspections), indent=2, allow_nan=False)
    if form == "markdown":
        return inspections_markdown(inspections)
    return "\n\n".join(map(inspection_text, inspections))


def _write(inspections: Sequence[Inspection], output: Path) -> bool:
    """Write the files, and say which; whether all of them are there."""
    from synth.export import write_inspections

    written = write_inspections(inspections, output)
    for path in written.paths:
        say(f"wrote {path}", on_stderr=True)
    for sentence in written.sentences:
        say(sentence, on_stderr=True)
    return not written.failed
