"""A solution as a set of files, written whole or not at all."""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from synth.checks import refuse_unless
from synth.errors import SynthError
from synth.export.markers import markers_csv
from synth.export.sheet import draw_sheet
from synth.export.solution_json import solution_to_json
from synth.guide import make_guide
from synth.synthesis import Solution

if TYPE_CHECKING:
    from collections.abc import Mapping


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
    refuse_unless("solution", solution, Solution)
    guide = make_guide(solution.task, solution.designs[0]) if solution.designs else None
    return write_all(
        {
            "solution.json": json_bytes(solution_to_json(solution)),
            "guide.pdf": draw_sheet(solution, guide),
            "markers.csv": markers_csv(guide).encode(),
        },
        directory,
    )


def write_all(files: Mapping[str, bytes], directory: str | os.PathLike[str]) -> list[Path]:
    """Write files into a directory, whole or not at all; a reader never meets half of one.

    Args:
        files: Contents by name.
        directory: Where to; it is made if it is not there.

    Returns:
        The paths of the files, in the order given.

    Raises:
        SynthError: They cannot be written.
    """
    directory = Path(directory)
    # All are written beside their places, then moved there; the process id keeps two runs apart.
    beside = {directory / name: directory / f".{name}.{os.getpid()}.part" for name in files}
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for path, temporary in beside.items():
            temporary.write_bytes(files[path.name])
        for path, temporary in beside.items():
            temporary.replace(path)
    except OSError as error:
        raise _cannot_write(directory, error) from error
    finally:
        for temporary in beside.values():
            with contextlib.suppress(OSError):
                temporary.unlink()
    return list(beside)


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return plain data as the bytes of a JSON file."""
    return (json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False) + "\n").encode()


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
