"""A solution from its file: the same value again, and verified again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from synth.checks import described
from synth.errors import InputError, Mistake
from synth.files import Document, KeyPath
from synth.solution_file.design_reading import to_design
from synth.solution_file.schema import SCHEMA, SolutionFile
from synth.solution_file.task_reading import to_task
from synth.synthesis import Bound, Design, Release, Solution, Status, Timing
from synth.task import as_path, validate

if TYPE_CHECKING:
    import os

    from synth.solution_file.schema import ReleasePart
    from synth.solution_file.told_schema import BoundPart
    from synth.task import Task

_MAX_BYTES = 200_000_000


def load_solution(path: str | os.PathLike[str]) -> Solution:
    """Read a solution from its file, and verify it again.

    Args:
        path: The file, as `synth solve` writes it.

    Returns:
        The solution that was written, whatever its status.

    Raises:
        InputError: The file cannot be read or is no such solution, or what it says of a shape is not true;
            with every mistake.
    """
    return _solution(Document.from_json(_text(path), str(path)))


def load_solved(path: str | os.PathLike[str]) -> Solution:
    """Read a solution that holds a shape: for those who need one.

    Raises:
        InputError: As `load_solution`, or it holds none.
    """
    solution = load_solution(path)
    if not solution.designs:
        raise InputError([Mistake(f"holds no shape: {solution.message}", str(path), key="link")])
    return solution


def solution_from_json(source: object) -> Solution:
    """Return a solution from a JSON text or from the mapping that `solution_to_json` returned.

    Args:
        source: The text or the mapping.

    Raises:
        InputError: As `load_solution`; mistakes name no file.
    """
    if isinstance(source, str):
        return _solution(Document.from_json(source))
    if isinstance(source, Mapping):
        return _solution(Document.from_mapping(source))
    wanted = "must be a JSON text or a mapping"
    raise InputError([Mistake(f"{wanted}, but is {described(source)}", key="source")])


def _text(path: str | os.PathLike[str]) -> str:
    try:
        with as_path(path).open("rb") as stream:
            data = stream.read(_MAX_BYTES + 1)
        if len(data) > _MAX_BYTES:
            raise InputError([Mistake(f"is larger than {_MAX_BYTES // 1_000_000} MB", str(path))])
        return data.decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError([Mistake("there is no such file", str(path))]) from None
    except OSError as error:
        raise InputError([Mistake(f"cannot be read: {error.strerror or error}", str(path))]) from None
    except ValueError:
        raise InputError([Mistake("is no JSON", str(path))]) from None


def _solution(document: Document) -> Solution:
    _check_schema(document)
    read = validate(document, SolutionFile)
    task = None if read is None else to_task(document, ("task",), read.task)
    if read is None or task is None:
        raise document.error()
    designs = _designs(document, task, read)
    releases = [
        _release(document, ("releases", place), task, each) for place, each in enumerate(read.releases)
    ]
    if read.status is Status.FOUND and not (designs and designs[0] and designs[0].verification.found):
        document.report(("status",), "is 'found', but not every target is reached within its tolerance")
    if document.is_wrong:
        raise document.error()
    return Solution(
        task=task,
        status=read.status,
        message=read.message,
        reasons=tuple(read.reasons),
        seed=read.seed,
        designs=tuple(design for design in designs if design is not None),
        starts=read.starts,
        time=Timing(0.0, 0.0, 0.0, 0.0) if read.time is None else Timing(**read.time.model_dump()),
        bound=None if read.bound is None else _bound(read.bound),
        releases=tuple(release for release in releases if release is not None),
        notes=tuple(read.notes),
        breakdown=read.breakdown,
        shape=read.shape or 1,
        explained=read.explained,
        version=read.version,
    )


def _check_schema(document: Document) -> None:
    """Refuse what is no solution of this version before its keys are looked at."""
    content: Any = document.value
    if not isinstance(content, dict):
        raise InputError([Mistake("is no solution of synth", document.file)])
    schema = content.get("schema")
    if schema == SCHEMA:
        return
    if isinstance(schema, str) and schema.startswith("synth.solution/"):
        wanted = f"{SCHEMA} is needed, which holds the whole task: solve the task again"
        document.report(("schema",), f"is {schema[:40]!r}, and {wanted}")
    else:
        document.report(("schema",), f"is no solution of synth: it names no schema {SCHEMA}")
    raise document.error()


def _designs(document: Document, task: Task, read: SolutionFile) -> list[Design | None]:
    if read.link is None:
        return []
    return [
        to_design(document, (), task, read, read.targets, read.targets_unseen),
        *(
            to_design(document, ("alternatives", place), task, each, each.targets)
            for place, each in enumerate(read.alternatives)
        ),
    ]


def _release(document: Document, path: KeyPath, task: Task, read: ReleasePart) -> Release | None:
    released = to_task(document, (*path, "task"), read.task, task.table)
    if released is None:
        return None
    design = to_design(document, (*path, "design"), released, read.design, read.design.targets)
    if design is None:
        return None
    if not design.verification.found:
        document.report((*path, "design"), "does not meet the task released")
    return Release(read.limit, read.amount, read.share, read.sentence, design, released)


def _bound(read: BoundPart) -> Bound:
    return Bound(
        lower_bound=read.lower_bound,
        best_found=math.inf if read.best_found is None else read.best_found,
        tightest_tolerance=read.tightest_tolerance or 0.0,
        boxes=read.boxes,
        left_out=tuple(read.left_out),
        weighted=read.weighted,
    )
