"""Tasks and robots from files: read once, checked strictly, every mistake at once.

Beyond this module a task is frozen values in metres and radians, never a mapping.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from synth.checks import described
from synth.errors import InputError, Mistake
from synth.files import Document, KeyPath, key_text, read_file, read_text
from synth.names import did_you_mean
from synth.robot import PRESETS
from synth.surfaces import read_corners, read_points
from synth.task.entry_types import default_name
from synth.task.entry_values import to_task
from synth.task.model import Task
from synth.task.robot_schema import RobotEntry, RobotFile
from synth.task.robot_values import to_robot
from synth.task.schema import SampledTaskFile, TaskFile
from synth.task.sizes import PER_METRE, unmeant_distances, unmeant_sizes, unmeant_sizes_of_robot
from synth.task.wording import validate
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from synth.arrays import FloatArray
    from synth.robot import Robot

_ROBOT_FILES = {".yaml", ".yml", ".json"}


def load_task(path: str | os.PathLike[str], *, is_up: Callable[[], bool] = never) -> Task:
    """Read a task file.

    Args:
        path: The file; a robot file that it names is looked for beside it.
        is_up: Asked now and then whether the time for reading is up.

    Returns:
        The task in metres and radians; its name is that of the file if it states none.

    Raises:
        InputError: The file, or the robot file it names, cannot be read or is wrong; with every
            mistake, in the order of the file.
        TimeLimitError: The time for reading was up.
    """
    path = as_path(path)
    return _task(read_file(path, is_up), directory=path.parent, name=path.stem)


def parse_task(
    source: str | Mapping[str, object], *, directory: str | os.PathLike[str] = ".", name: str = "task"
) -> Task:
    """Read a task from a YAML text or from a mapping with the same keys.

    Args:
        source: The text or the mapping; it states its `length_unit` as a file does. A mapping may
            hold tuples and arrays for lists.
        directory: Where a robot file that it names is looked for.
        name: What the task is called if it states no name.

    Returns:
        The task in metres and radians.

    Raises:
        InputError: As `load_task`; mistakes name no file and, in a mapping, no line.
    """
    document = read_text(source) if isinstance(source, str) else Document.from_mapping(source)
    return _task(document, directory=Path(directory), name=name)


def as_task(source: object, *, is_up: Callable[[], bool] = never) -> Task:
    """Return a task from whatever stands for one: itself, the path of its file, or a mapping as in a file.

    Args:
        source: What stands for it.
        is_up: Asked now and then whether the time for reading a file is up.

    Raises:
        InputError: The source is none of these, its file or mapping is wrong, or its sizes cannot be meant.
    """
    if isinstance(source, Task):
        refuse_if_any(unmeant_sizes(source))
        return source
    if isinstance(source, str | os.PathLike):
        return load_task(source, is_up=is_up)
    if isinstance(source, Mapping):
        return parse_task(source)
    wanted = "must be a Task, the path of a task file, or a mapping"
    raise InputError([Mistake(f"{wanted}, but is {described(source)}", key="task")])


def load_robot(path: str | os.PathLike[str]) -> Robot:
    """Read a robot file.

    Args:
        path: The file, or the name of a preset.

    Returns:
        The robot in metres and radians; its name is that of the file if it states none.

    Raises:
        InputError: The file cannot be read or is wrong; with every mistake, in the order of the file.
    """
    if isinstance(path, str) and path in PRESETS:
        return PRESETS[path]
    path = as_path(path)
    return _robot(read_file(path), name=path.stem)


def _robot(document: Document, name: str) -> Robot:
    """Read a robot file's document."""
    if isinstance(document.value, dict) and {"synth", "targets"} & document.value.keys():
        document.report((), "is a task file, but a robot file is expected")
        raise document.error()
    if isinstance(document.value, str):  # of whatever file was named nothing is quoted
        document.report((), "is no robot file: a mapping (key: value) is expected")
        raise document.error()
    entry = validate(document, RobotFile)
    if entry is None or document.is_wrong:
        raise document.error()
    try:
        robot = to_robot(entry, PER_METRE[entry.length_unit], name)
        refuse_if_any(unmeant_sizes_of_robot(robot))
    except InputError as error:
        raise document.refuse(error) from None
    return robot


def as_path(path: str | os.PathLike[str]) -> Path:
    """Return a path; what is none is refused as any wrong input."""
    if not isinstance(path, str | os.PathLike):
        raise InputError([Mistake(f"must be a path, but is {described(path)}", key="path")])
    return Path(path)


def refuse_if_any(mistakes: Sequence[Mistake]) -> None:
    """Raise mistakes as one error, if there are any."""
    if mistakes:
        raise InputError(mistakes)


def _task(document: Document, directory: Path, name: str) -> Task:
    """Read a task's document; the robot and the names are checked even where the rest is wrong."""
    content = document.value if isinstance(document.value, dict) else {}
    reference = content.get("robot")
    robot = named_robot(document, reference, directory) if isinstance(reference, str) else None
    base = content.get("base")
    choices = base.get("choices") if isinstance(base, dict) else None
    for path, kind, entries in (
        (("targets",), "target", content.get("targets")),
        (("obstacles",), "obstacle", content.get("obstacles")),
        (("surface",), "surface", content.get("surface")),
        (("path",), "path", content.get("path")),
        (("base", "choices"), "place", choices),
    ):
        _report_names_given_twice(document, path, kind, entries)
    read = _files_of(document, "surface", {"points": read_points, "mesh": read_corners}, directory)
    waypoints = _files_of(document, "path", {"csv": read_points}, directory)
    document.see_the_time()
    file = validate(document, SampledTaskFile if {"surface", "path"} & content.keys() else TaskFile)
    if file is None or document.is_wrong:
        raise document.error()
    if isinstance(file.robot, RobotEntry):
        robot = robot_within(document, file.robot, file.length_unit)
    assert robot is not None, "a robot is named or described"  # noqa: S101 - for the type checker
    try:
        task = to_task(file, robot, read, waypoints, name)
        refuse_if_any(unmeant_distances(task, file.length_unit))
    except InputError as error:
        raise document.refuse(error) from None
    document.see_the_time()
    return task


def robot_within(document: Document, entry: RobotEntry, unit: str) -> Robot:
    """Return the robot that a file describes under `robot`, in the file's unit unless it states its own."""
    try:
        own = unit if entry.length_unit is None else entry.length_unit
        robot = to_robot(entry, PER_METRE[own], "inline robot")
        refuse_if_any(unmeant_sizes_of_robot(robot))
    except InputError as error:
        raise document.refuse(error, ("robot",)) from None
    return robot


def _files_of(
    document: Document, key: str, readers: Mapping[str, Callable[..., FloatArray]], directory: Path
) -> dict[int, FloatArray]:
    """Return what the files hold that entries under a key name, by their numbers, with mistakes reported.

    What reads the files is given by the keys within an entry that name them.
    """
    read = {}
    given = document.value.get(key) if isinstance(document.value, dict) else None
    for index, entry in enumerate(given if isinstance(given, list) else [given]):
        path: KeyPath = (key, index) if isinstance(given, list) else (key,)
        for kind, reader in readers.items():
            file = entry.get(kind) if isinstance(entry, dict) else None
            if isinstance(file, str) and file:
                try:
                    read[index] = reader(directory / file, document.see_the_time)
                except InputError as error:
                    _adopt(document, (*path, kind), error)
    return read


def named_robot(document: Document, reference: str, directory: Path) -> Robot | None:
    """Return a preset or the robot of a file, or None with the mistakes reported."""
    if reference in PRESETS:
        return PRESETS[reference]
    is_path = "/" in reference or Path(reference).suffix.lower() in _ROBOT_FILES
    if not (is_path and reference.isprintable()):
        known = did_you_mean(reference, PRESETS) or f"; presets are {', '.join(PRESETS)}"
        document.report(
            ("robot",), f"{reference[:40]!r} is neither a preset nor the path of a YAML file{known}"
        )
        return None
    try:
        return load_robot(directory / reference)
    except InputError as error:
        _adopt(document, ("robot",), error)
    return None


def _adopt(document: Document, path: KeyPath, error: InputError) -> None:
    """Take over the mistakes in a file that a key names; one of the file as a whole is told with that key."""
    are_lines = any(mistake.line is not None for mistake in error.mistakes)
    for mistake in error.mistakes:
        if are_lines:
            document.adopt(path, mistake)
        else:
            document.report(path, f"{mistake.file}: {mistake.message}")


def _report_names_given_twice(document: Document, path: KeyPath, kind: str, entries: object) -> None:
    first: dict[str, int] = {}
    for index, entry in enumerate(entries if isinstance(entries, list) else []):
        name = entry.get("name", default_name(kind, index)) if isinstance(entry, dict) else None
        if not isinstance(name, str):
            continue
        if first.setdefault(name, index) != index:
            message = f"{name[:40]!r} is the name of {key_text(path)}[{first[name]}] already"
            document.report((*path, index, "name"), message)
