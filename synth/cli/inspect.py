"""`synth inspect`: what a measured shape of the robot is, and how sure that is."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from synth.cli.exit_codes import ExitCode
from synth.errors import SolverError, SynthError
from synth.export import prepare_directory
from synth.export.inspection_files import write_inspections
from synth.export.inspection_json import inspections_to_json
from synth.measurement import inspect
from synth.measurement.text import inspection_text, inspections_markdown
from synth.task.measured_file import load_measurements

if TYPE_CHECKING:
    from pathlib import Path


def inspect_file(file: Path, output: Path | None, *, form: str, seed: int, samples: int) -> ExitCode:
    """Inspect a file of measured shapes and say what was found.

    Args:
        file: The file.
        output: Directory for `inspect.json` and the pictures, or None.
        form: "text", "json" or "markdown".
        seed: Seed of the samples and of the search for the link's shape.
        samples: How many shapes to draw for the ranges.

    Returns:
        The exit code.
    """
    try:
        measurements = load_measurements(file)
        if output is not None:
            prepare_directory(output)
        inspections = [inspect(measurement, seed=seed, samples=samples) for measurement in measurements]
        if form == "json":
            click.echo(json.dumps(inspections_to_json(inspections), indent=2, allow_nan=False))
        elif form == "markdown":
            click.echo(inspections_markdown(inspections))
        else:
            click.echo("\n\n".join(map(inspection_text, inspections)))
        for path in [] if output is None else write_inspections(inspections, output):
            click.echo(f"wrote {path}", err=True)
    except SynthError as error:
        click.echo(str(error), err=True)
        return ExitCode.BROKEN if isinstance(error, SolverError) else ExitCode.WRONG_INPUT
    return ExitCode.DONE if all(one.is_realisable for one in inspections) else ExitCode.NOT_MET
