"""A solution as a set of files: for programs, for the hand, for the eye."""

from __future__ import annotations

from typing import TYPE_CHECKING

from synth.arrays import frozen_value
from synth.checks import refuse_unless
from synth.errors import InputError, Mistake, SynthError, TimeLimitError, in_a_line
from synth.export.json_data import json_bytes
from synth.export.markers import markers_csv
from synth.export.page import draw_page, page_content, page_of
from synth.export.planners import KINDS, kinds_of, planner_files
from synth.export.sheet import draw_sheet
from synth.export.solution_json import solution_to_json
from synth.export.writing import write_all
from synth.guide import make_guide
from synth.synthesis import Solution
from synth.watch import never

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from synth.guide import Guide

SOLUTION_FILES = ("solution.json", "guide.pdf", "guide.html", "markers.csv")


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
        is_up: Asked whether the time is up: then sheet and page, which take a second, are not begun.

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
    for name, draw in {"guide.pdf": draw_sheet, "guide.html": draw_page}.items():
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
