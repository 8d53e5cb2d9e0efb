"""A solution as a set of files, written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.checks import refuse_unless
from synth.errors import InputError, Mistake, SynthError, TimeLimitError, in_a_line
from synth.export.markers import markers_csv
from synth.export.page import draw_page, page_content, page_of
from synth.export.planners import KINDS, kinds_of, planner_files
from synth.export.sheet import draw_sheet
from synth.export.solution_json import solution_to_json
from synth.guide import make_guide
from synth.synthesis import Solution
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from synth.guide import Guide

_MOST_INDENTED = 1000  # targets in a file that is laid out for the eye
SOLUTION_FILES = ("solution.json", "guide.pdf", "guide.html", "markers.csv")
_DRAWN: Mapping[str, Callable[[Solution, Guide | None], bytes]] = {
    "guide.pdf": draw_sheet,
    "guide.html": draw_page,
}


@frozen_value
class Written:
    """What became of a set of files.

    Attributes:
        paths: Those that were written.
        failed: What could not be made, by name, and why; an older file of that name is gone, for it would
            belong to another solution.
    """

    paths: tuple[Path, ...]
    failed: Mapping[str, BaseException]

    @property
    def sentences(self) -> tuple[str, ...]:
        """A sentence for each file that could not be made."""
        return tuple(f"{name} could not be made: {in_a_line(error)}" for name, error in self.failed.items())


def write_files(solution: Solution, directory: str | os.PathLike[str]) -> list[Path]:
    """Write all files of a solution, `SOLUTION_FILES`; the same bytes for the same solution.

    Args:
        solution: What a synthesis found, whatever its status.
        directory: Where to; it is made if it is not there. Files of these names are replaced.

    Returns:
        The paths of the files, in this order.

    Raises:
        SynthError: They cannot be written. Files of an earlier run are then as they were. Or sheet or page
            could not be drawn: then the others are written, and there is none of that name.
    """
    written = write_what_can_be(solution, directory)
    if written.failed:
        raise SynthError("; ".join(written.sentences)) from next(iter(written.failed.values()))
    return list(written.paths)


def write_what_can_be(
    solution: Solution, directory: str | os.PathLike[str], *, is_up: Callable[[], bool] = never
) -> Written:
    """Write the files of a solution, without sheet or page if it cannot be drawn, whatever the reason.

    Args:
        solution: What a synthesis found, whatever its status.
        directory: Where to; it is made if it is not there. Files of these names are replaced.
        is_up: Asked whether the time is up: then a sheet, which takes a second, is not begun.

    Raises:
        SynthError: They cannot be written. Files of an earlier run are then as they were.
    """
    refuse_unless("solution", solution, Solution)
    guide = _guide_of(solution)
    files = {
        "solution.json": json_bytes(solution_to_json(solution)),
        "markers.csv": markers_csv(guide).encode(),
    }
    failed: dict[str, BaseException] = {}
    for name, draw in _DRAWN.items():
        try:
            _see_the_time(is_up)
            files[name] = draw(solution, guide)
        except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - the answer is not lost with a drawing
            failed[name] = error
    files = {name: files[name] for name in SOLUTION_FILES if name in files}
    return Written(tuple(write_all(files, directory, without=failed)), failed)


def _see_the_time(is_up: Callable[[], bool]) -> None:
    if is_up():
        raise TimeLimitError("the time limit was over before it was begun")


def write_page(solution: Solution, directory: str | os.PathLike[str]) -> list[Path]:
    """Write `guide.html` alone.

    Args:
        solution: What a synthesis found, whatever its status.
        directory: Where to; it is made if it is not there. A file of this name is replaced.

    Raises:
        SynthError: It cannot be written. A file of an earlier run is then as it was.
    """
    refuse_unless("solution", solution, Solution)
    return write_all({"guide.html": draw_page(solution, _guide_of(solution))}, directory)


def live_page(solution: Solution) -> bytes:
    """Return the page that shows what happens while the link is bent; it asks where it comes from for events.

    Args:
        solution: A solution that is found.
    """
    return page_of(page_content(solution, _guide_of(solution)) | {"live": True})


def _guide_of(solution: Solution) -> Guide | None:
    return make_guide(solution.task, solution.designs[0]) if solution.designs else None


def write_planner_files(
    solution: Solution, directory: str | os.PathLike[str], kinds: Iterable[str] = ()
) -> list[Path]:
    """Write files for planners and simulators, all of them or none; see `Solution.export`.

    Args:
        solution: A solution that holds a shape.
        directory: Where to; it is made if it is not there. Files of these names are replaced.
        kinds: Which: urdf, srdf, mjcf, xrdf, mesh, dh, c, trajectory. All of them if none is named; of a
            shape that lacks ways no trajectory then.

    Returns:
        The paths of the files.

    Raises:
        InputError: There is no such kind.
        NotFoundError: The solution holds no shape.
        SynthError: A way is missing for a trajectory, or the files cannot be written. Files of an earlier
            run are then as they were.
    """
    refuse_unless("solution", solution, Solution)
    kinds = tuple(kinds) or kinds_of(solution)
    unknown = [kind for kind in kinds if kind not in KINDS]
    if unknown:
        known = f"known are {', '.join(KINDS)}"
        raise InputError([Mistake(f"is no kind of file; {known}", key=str(kind)) for kind in unknown])
    return write_all(planner_files(solution, kinds), directory)


def write_all(
    files: Mapping[str, bytes], directory: str | os.PathLike[str], *, without: Iterable[str] = ()
) -> list[Path]:
    """Write files into a directory, all or none; a reader never meets half of one.

    Args:
        files: Contents by name.
        directory: Where to; it is made if it is not there.
        without: Names of files that must not be there any more.

    Returns:
        The paths of the files, in the order given.

    Raises:
        SynthError: They cannot be written. What stood there before stands there still.
    """
    directory = Path(directory)
    gone = [directory / name for name in without]
    # All are written beside their places, then moved there; the process id keeps two runs apart.
    beside = {directory / name: directory / f".{name}.{os.getpid()}.part" for name in files}
    try:
        directory.mkdir(parents=True, exist_ok=True)
        _see_that_files_can_be(beside)
        for path, temporary in beside.items():
            temporary.write_bytes(files[path.name])
        with _restored_if_it_fails([*beside, *gone]):
            for path, temporary in beside.items():
                temporary.replace(path)
            for path in gone:
                path.unlink(missing_ok=True)
    except OSError as error:
        raise _cannot_write(directory, error) from error
    finally:
        for temporary in beside.values():
            with contextlib.suppress(OSError):
                temporary.unlink()
    return list(beside)


@contextlib.contextmanager
def _restored_if_it_fails(paths: Sequence[Path]) -> Iterator[None]:
    """Put files back as they were, or away if they were not there, if a block fails."""
    before = {path: path.read_bytes() if path.exists() else None for path in paths}
    try:
        yield
    except BaseException:
        for path, content in before.items():
            with contextlib.suppress(OSError):
                if content is None:
                    path.unlink(missing_ok=True)
                else:
                    path.write_bytes(content)
        raise


def json_bytes(content: Mapping[str, object]) -> bytes:
    """Return plain data as the bytes of a JSON file."""
    text = json_text(content, indent=1, ensure_ascii=False) + "\n"
    return text.encode("utf-8", "backslashreplace")  # half a character of a foreign name is no reason to fail


def json_text(content: Mapping[str, object], *, indent: int, ensure_ascii: bool = True) -> str:
    """Return plain data as JSON; very much of it on one line, which is written twenty times as fast.

    Args:
        content: The data.
        indent: By how much each level is indented.
        ensure_ascii: Whether other characters are escaped.
    """
    task = content.get("task")
    many = isinstance(task, dict) and len(task.get("targets", ())) > _MOST_INDENTED
    return json.dumps(content, indent=None if many else indent, allow_nan=False, ensure_ascii=ensure_ascii)


def prepare_directory(directory: str | os.PathLike[str], names: Iterable[str] = ()) -> None:
    """Make a directory and see that files can be written there, before a search spends its time.

    Args:
        directory: The directory; it may be there.
        names: Names of the files that are to be written.

    Raises:
        SynthError: Files cannot be written there.
    """
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
        _see_that_files_can_be(directory / name for name in names)
    except OSError as error:
        raise _cannot_write(directory, error) from error


def _see_that_files_can_be(paths: Iterable[Path]) -> None:
    """Raise an error if something that is no file stands in the place of one."""
    for path in paths:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, f"{path.name} is a directory, and a file is to be there")


def _cannot_write(directory: Path, error: OSError) -> SynthError:
    return SynthError(f"cannot write to {directory}: {error.strerror or error}")
