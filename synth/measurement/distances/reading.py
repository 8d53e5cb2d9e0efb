"""Measured shapes from files: distances or markers, checked as strictly as a task."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen
from synth.errors import InputError, Mistake
from synth.files import Document, KeyPath, read_file, read_text
from synth.measurement.distances.measured import MeasuredDistances, Measurement, Precision
from synth.measurement.distances.schema import ConfigurationEntry, MeasuredFile
from synth.robot import Interval, RigidLink
from synth.task import PER_METRE, RobotEntry, as_path, named_robot, off_the_hardware, robot_within, validate

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from synth.robot import Robot

# Errors of a distance in those of a coordinate: both ends may be off, at worst along the space diagonal.
_ROUNDED_COORDINATE = 2.0 * math.sqrt(3.0)
_NOISY_COORDINATE = math.sqrt(2.0)


def load_measurements(path: str | os.PathLike[str]) -> tuple[Measurement, ...]:
    """Read a file of measured shapes.

    Args:
        path: The file; a robot file that it names is looked for beside it.

    Returns:
        One measurement, or those under `configurations` in their order; in metres.

    Raises:
        InputError: The file, or the robot file it names, cannot be read or is wrong; with every
            mistake, in the order of the file.
    """
    path = as_path(path)
    return _measurements(read_file(path), directory=path.parent, name=path.stem)


def parse_measurements(
    source: str | Mapping[str, object], *, directory: str | os.PathLike[str] = ".", name: str = "measured"
) -> tuple[Measurement, ...]:
    """Read measured shapes from a YAML text or from a mapping with the same keys.

    Args:
        source: The text or the mapping; it states its `length_unit` as a file does.
        directory: Where a robot file that it names is looked for.
        name: What a single shape is called if the source states no name.

    Returns:
        As `load_measurements`.

    Raises:
        InputError: As `load_measurements`; mistakes name no file and, in a mapping, no line.
    """
    document = read_text(source) if isinstance(source, str) else Document.from_mapping(source)
    return _measurements(document, directory=Path(directory), name=name)


def _measurements(document: Document, directory: Path, name: str) -> tuple[Measurement, ...]:
    content = document.value if isinstance(document.value, dict) else {}
    reference = content.get("robot")
    robot = named_robot(document, reference, directory) if isinstance(reference, str) else None
    _report_what_is_missing(document, content)
    file = validate(document, MeasuredFile)
    if file is None or document.is_wrong:
        raise document.error()
    per_metre = PER_METRE[file.length_unit]
    if isinstance(file.robot, RobotEntry):
        robot = robot_within(document, file.robot, file.length_unit)
    assert robot is not None, "a robot is named or described"  # noqa: S101 - for the type checker
    entries: dict[str, tuple[KeyPath, ConfigurationEntry]] = {file.name or name: ((), file)}
    if "configurations" in file.model_fields_set:
        entries = {key: (("configurations", key), entry) for key, entry in file.configurations.items()}
    for path, entry in entries.values():
        _report_open_rigid_link(document, path, entry, robot)
        _report_coincident_markers(document, path, entry)
    if document.is_wrong:
        raise document.error()
    common, measurements = _precision(file, per_metre), []
    for key, (path, entry) in entries.items():
        try:
            precision = _precision(entry, per_metre) or common
            measurements.append(_measurement(key, entry, robot, precision, per_metre))
        except InputError as error:
            document.refuse(error, path)
    if document.is_wrong:
        raise document.error()
    return tuple(measurements)


def _report_what_is_missing(document: Document, content: Mapping[str, object]) -> None:
    """Report what no single key is to blame for; keys of a wrong type are left to the schema."""
    if "configurations" not in content:
        _report_one(document, (), content, content)
        return
    for key in ("distances", "markers", "intended"):
        if key in content:
            document.report((key,), "stands beside 'configurations': put it into one of them")
    _report_two_precisions(document, (), content)
    several = content["configurations"]
    if not isinstance(several, dict):
        return
    if not several:
        document.report(("configurations",), "must hold one configuration at least, but is empty")
    for key, entry in several.items():
        if isinstance(entry, dict):
            _report_one(document, ("configurations", key), entry, content)


def _report_one(
    document: Document, path: KeyPath, entry: Mapping[str, object], content: Mapping[str, object]
) -> None:
    """Report what one shape lacks or has too much of."""
    if ("distances" in entry) == ("markers" in entry):
        document.report(path, "needs either 'distances' or 'markers'")
    distances = entry.get("distances")
    if isinstance(distances, dict) and len({"d15", "d25"} & distances.keys()) == 1:
        message = "d15 and d25 say only together where the end effector was: give both or none"
        document.report((*path, "distances"), message)
    if not {"rounding", "sigma"} & (entry.keys() | content.keys()):
        document.report(path, "needs 'rounding' (the step the numbers are rounded to) or 'sigma'")
    _report_two_precisions(document, path, entry)


def _report_two_precisions(document: Document, path: KeyPath, entry: Mapping[str, object]) -> None:
    if {"rounding", "sigma"} <= entry.keys():
        document.report((*path, "sigma"), "stands beside 'rounding': give one of them")


def _report_open_rigid_link(
    document: Document, path: KeyPath, entry: ConfigurationEntry, robot: Robot
) -> None:
    """Report a rigid link that is neither given by the robot nor measured."""
    markers = "markers" in entry.model_fields_set
    if markers and "P5" in entry.markers.model_fields_set:
        return
    stated = set() if markers else entry.distances.model_fields_set
    open_yet = "[low, high]" if robot.rigid_links is None else "one of several"
    for name in sorted({"d35", "d45"} - _known_lengths(robot).keys() - stated):
        message = f"{name} is {open_yet} in the robot: give the {name} of this one, or the marker P5"
        document.report((*path, "markers" if markers else "distances"), message)


def _report_coincident_markers(document: Document, path: KeyPath, entry: ConfigurationEntry) -> None:
    if "markers" not in entry.model_fields_set:
        return
    for first, second in (("P1", "P2"), ("P3", "P4")):
        if getattr(entry.markers, first) == getattr(entry.markers, second):
            message = f"is the same point as {first}: their axis has no direction"
            document.report((*path, "markers", second), message)


def _precision(entry: ConfigurationEntry, per_metre: float) -> Precision | None:
    if "rounding" in entry.model_fields_set:
        return Precision.from_rounding(entry.rounding / per_metre)
    return Precision.from_sigma(entry.sigma / per_metre) if "sigma" in entry.model_fields_set else None


def _measurement(
    name: str, entry: ConfigurationEntry, robot: Robot, precision: Precision | None, per_metre: float
) -> Measurement:
    assert precision is not None, "a precision is given"  # noqa: S101 - for the type checker
    markers = None
    if "distances" in entry.model_fields_set:
        stated = entry.distances.model_dump(exclude_unset=True)
        measured = {key: value / per_metre for key, value in stated.items()}
        of_distances = precision
    else:
        given = sorted(entry.markers.model_dump(exclude_unset=True).items())
        markers = frozen(np.array([position for _, position in given]) / per_metre)
        measured = _between(markers)
        of_distances = replace(
            precision,
            sigma=_NOISY_COORDINATE * precision.sigma,
            bound=precision.bound * (_ROUNDED_COORDINATE if precision.is_rounding else _NOISY_COORDINATE),
        )
    is_stated = markers is None
    if wrong := off_the_hardware(measured, robot, of_distances.bound):
        keys = {name: f"distances.{name}" if is_stated else "markers" for name in wrong}
        raise InputError([Mistake(sentence, key=keys[name]) for name, sentence in wrong.items()])
    known = {"d12": robot.d12, "d34": robot.d34, **_known_lengths(robot)}
    distances = MeasuredDistances.of(measured, of_distances, known)
    return Measurement(
        name=name,
        robot=replace(
            robot,
            d12=distances["d12"],
            d34=distances["d34"],
            rigid_link=RigidLink(Interval.fixed(distances["d35"]), Interval.fixed(distances["d45"])),
            rigid_links=None,
        ),
        precision=precision,
        distances=distances,
        markers=markers,
        intended=entry.intended,
    )


def _known_lengths(robot: Robot) -> dict[str, float]:
    """Return d35 and d45 as far as the robot says them, m."""
    if robot.rigid_links is not None:
        return {}
    rigid = robot.rigid_link
    return {key: i.lower for key, i in (("d35", rigid.d35), ("d45", rigid.d45)) if i.is_fixed}


def _between(markers: FloatArray) -> dict[str, float]:
    """Return the distances between markers by their names, m."""
    return {
        f"d{i + 1}{j + 1}": float(np.linalg.norm(markers[i] - markers[j]))
        for i, j in combinations(range(len(markers)), 2)
    }
