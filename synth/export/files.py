"""A solution as a set of files, written whole or not at all."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from synth.errors import SynthError
from synth.export.markers import markers_csv
from synth.export.sheet import draw_sheet
from synth.export.solution_json import solution_to_json
from synth.guide import make_guide

if TYPE_CHECKING:
    from collections.abc import Mapping

    from synth.synthesis import Solution


def write_files(solution: Solution, directory: str | os.PathLike[str]) -> list[Path]:
    """Write `solution.json`, `guide.pdf` and `markers.csv`, the same bytes for the same solution.

    Args:
        solution: What a synthesis found, whatever its status.
        directory: Where to; it is made if it is not there. Files of these names are replaced.

    Returns:
        The paths of the files, in this order.

    Raises:
        SynthError: They cannot be written. Files of an earlier run are then as they were.
    """
    guide = make_guide(solution.task, solution.designs[0]) if solution.designs else None
    content = json.dumps(solution_to_json(solution), indent=1, allow_nan=False, ensure_ascii=False)
    files = {
        "solution.json": (content + "\n").encode(),
        "guide.pdf": draw_sheet(solution, guide),
        "markers.csv": markers_csv(guide).encode(),
    }
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
        return _replace({directory / name: content for name, content in files.items()})
    except OSError as error:
        raise _cannot_write(directory, error) from error


def prepare_directory(directory: str | os.PathLike[str]) -> None:
    """Make a directory and see that files can be written there, before a search spends its time.

    Args:
        directory: The directory; it may be there.

    Raises:
        SynthError: Files cannot be written there.
    """
    try:
        Path(directory).mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        raise _cannot_write(Path(directory), error) from error


def _cannot_write(directory: Path, error: OSError) -> SynthError:
    return SynthError(f"cannot write to {directory}: {error.strerror or error}")


def _replace(files: Mapping[Path, bytes]) -> list[Path]:
    """Write all files beside their places, then move them there: a reader never meets half of one."""
    # The process id keeps two runs apart that write to one directory.
    beside = {path: path.with_name(f".{path.name}.{os.getpid()}.part") for path in files}
    try:
        for path, content in files.items():
            beside[path].write_bytes(content)
        for path, temporary in beside.items():
            temporary.replace(path)
    finally:
        for temporary in beside.values():
            temporary.unlink(missing_ok=True)
    return list(files)
