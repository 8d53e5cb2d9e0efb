"""Inspections as files: data, and a picture of each workspace; written whole or not at all."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from synth.export.files import json_bytes, write_all
from synth.export.inspection_json import inspections_to_json
from synth.export.inspection_plot import draw_inspection

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence
    from pathlib import Path

    from synth.measurement import Inspection


def write_inspections(inspections: Sequence[Inspection], directory: str | os.PathLike[str]) -> list[Path]:
    """Write `inspect.json` and for each shape `workspace-NAME.pdf`, the same bytes for the same input.

    Args:
        inspections: One for each measured shape.
        directory: Where to; it is made if it is not there. Files of these names are replaced.

    Returns:
        The paths of the files, in this order.

    Raises:
        SynthError: They cannot be written.
    """
    files = {"inspect.json": json_bytes(inspections_to_json(inspections))}
    for number, inspection in enumerate(inspections, start=1):
        name = inspection.measurement.name
        # A name may hold what a file's name must not; the number keeps two such apart.
        word = name if re.fullmatch(r"[\w-]{1,60}", name, re.ASCII) else str(number)
        files[f"workspace-{word}.pdf"] = draw_inspection(inspection)
    return write_all(files, directory)
