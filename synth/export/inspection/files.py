"""Inspections as files: data, and a picture of each workspace; written whole or not at all."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from synth.export.files import Written
from synth.export.inspection.json import inspections_to_json
from synth.export.inspection.plot import draw_inspection
from synth.export.json_data import json_bytes
from synth.export.writing import write_all

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from synth.measurement import Inspection, Measurement


def file_names(measurements: Sequence[Measurement]) -> list[str]:
    """Return `inspect.json` and for each measured shape `workspace-NAME.pdf`."""
    names = ["inspect.json"]
    for number, measurement in enumerate(measurements, start=1):
        name = measurement.name
        # A name may hold what a file's name must not; the number keeps two such apart.
        word = name if re.fullmatch(r"[\w-]{1,60}", name, re.ASCII) else str(number)
        names.append(f"workspace-{word}.pdf")
    return names


def write_inspections(inspections: Sequence[Inspection], directory: str | os.PathLike[str]) -> Written:
    """Write the files of inspections, the same bytes for the same input, without pictures that fail.

    Args:
        inspections: One for each measured shape.
        directory: Where to; it is made if it is not there. Files of these names are replaced.

    Returns:
        What was written, `inspect.json` first, and which pictures could not be drawn.

    Raises:
        SynthError: They cannot be written.
    """
    data, *pictures = file_names([inspection.measurement for inspection in inspections])
    files, failed = {data: json_bytes(inspections_to_json(inspections))}, {}
    for name, inspection in zip(pictures, inspections, strict=True):
        try:
            files[name] = draw_inspection(inspection)
        except Exception as error:  # noqa: BLE001 - the answer is not lost with its picture
            failed[name] = error
    return Written(tuple(write_all(files, directory, without=failed)), failed)
