"""Writes the reference of the files from the models that read them: `python docs/reference_pages.py`.

Meaning and default of a key come from its model, its example from a file on the page that holds every key and is read
by the tests; what unit a key has is stated here, since no model knows it.
"""

from __future__ import annotations

import typing
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from pydantic import BaseModel
from pydantic_core import PydanticUndefined
from ruamel.yaml import YAML

from synth.measurement.distances.schema import MeasuredFile
from synth.solution_file.schema import SolutionFile
from synth.task.robot_schema import RobotFile
from synth.task.schema import TaskFile

REFERENCE = Path(__file__).parent / "reference"
LENGTHS = [
    "position", "tolerance", "center", "radius", "size", "from", "to", "length", "P1",
    "P2", "P3", "P4", "P5", "d12", "d13", "d14", "d15", "d23",
    "d24", "d25", "d34", "d35", "d45", "floor", "min_bend_radius", "diameter", "tip_offset",
    "rounding", "sigma", "radii", "margin", "point", "waypoints",
]  # fmt: skip
# Parts of a solution that have a page of their own, or are described in the same file already.
ELSEWHERE = ("task.", "releases[].task.", "releases[].design.", "alternatives[].")
# Of these, which no model requires on its own, a file holds the first two or the last.
EITHER = ("rigid_link.d35", "rigid_link.d45", "rigid_link.one_of")
UNITS = (
    dict.fromkeys(LENGTHS, "length")
    | dict.fromkeys(
        ("yaw_deg", "rpy_deg", "tolerance_deg", "joint1_deg", "base", "second", "max_total_bend_deg"), "deg"
    )
    | {"curvature": "1/length", "speed": "length/s"}
    | {"max_speed_deg_s": "deg/s", "max_acceleration_deg_s2": "deg/s^2"}
)
PLAIN = [  # keys of words, counts and parts, which have no unit
    "synth", "name", "length_unit", "robot", "targets", "weight", "surface", "points", "topology",
    "objective", "obstacles", "sphere", "box", "capsule", "current", "arcs", "markers", "link",
    "rigid_link", "joint_limits_deg", "joint_rates", "intended", "distances", "configurations", "choices", "approach",
    "direction", "mesh", "cylinder", "torus", "rectangle", "disc", "plane", "pose", "region", "side", "coverage",
    "axis", "normal", "along", "path", "csv", "closed", "interpolation",
]  # fmt: skip


@dataclass(frozen=True)
class FilePage:
    """A page about one kind of file."""

    name: str
    title: str
    first: str
    model: type[BaseModel]
    examples: tuple[str, ...]


TASK = """\
synth: 1
name: two crates and a shelf
length_unit: mm
robot: malleable-2dof
base: {position: [0, 0, 0], yaw_deg: 0}
floor: 0
topology: any
objective: least_squares
targets:
  - {name: pick, position: [512.0, 140.5, 210.0], tolerance: 5, weight: 1}
  - {name: place, position: [-300, 420, 180], tolerance: 5}
obstacles:
  - {name: shelf, box: {center: [-700, 500, 800], size: [400, 200, 20], yaw_deg: 30}}
  - {name: column, capsule: {from: [600, 600, 0], to: [600, 600, 900], radius: 40}}
  - {name: lamp, sphere: {center: [0, 0, 1300], radius: 80}}
current: {arcs: [{curvature: [0.002, -0.001], length: 300}, {curvature: [0, 0], length: 320}]}
"""
TASK_MARKERS = """\
synth: 1
length_unit: mm
robot: malleable-2dof
targets:
  - {name: pick, position: [512.0, 140.5, 210.0]}
surface: {points: scan.csv, tolerance: 3}
current: {markers: {P3: [-43.7, 166.1, 439.4], P4: [-60.0, 121.6, 427.1], joint1_deg: 180}}
"""
TASK_RANGE = """\
synth: 1
name: somewhere on the wall, welded from above
length_unit: mm
robot: malleable-2dof
base: {position: [[-200, 200], 700, 500], rpy_deg: [90, 0, [-180, 180]]}
targets:
  - {name: weld, position: [300, 100, 200], tolerance: 5, approach: {direction: [0, 0, -1], tolerance_deg: 30}}
"""
TASK_CHOICES = """\
synth: 1
name: two places with clamps
length_unit: mm
robot: malleable-2dof
base:
  choices:
    - {name: bench, position: [0, 0, 0], yaw_deg: 90}
    - {name: wall, position: [0, 700, 500], rpy_deg: [90, 0, 0]}
targets:
  - {name: pick, position: [400, 200, 150], tolerance: 5}
"""
TASK_SURFACES = """\
synth: 1
name: four fifths of several surfaces
length_unit: mm
robot: malleable-2dof
surface:
  - {name: bowl, sphere: {center: [0, 0, 0], radius: 500}, tolerance: 2, coverage: 0.8, side: both,
     region: [{sphere: {center: [350, 0, 350], radius: 100}}, {box: {center: [0, 350, 350], size: [90, 90, 90], yaw_deg: 30}},
              {capsule: {from: [300, 0, 300], to: [400, 0, 400], radius: 50}}]}
  - {name: panel, points: scan.csv, length_unit: mm, pose: {position: [0, 0, 10], rpy_deg: [0, 0, 15]}, coverage: 0.8}
  - {name: pipe, cylinder: {from: [400, 0, 100], to: [400, 0, 400], radius: 40}, margin: 5, coverage: 0.8}
  - {name: rim, torus: {center: [0, 0, 200], axis: [0, 0, 1], radii: [400, 50]}, coverage: 0.8}
  - {name: shelf, rectangle: {center: [400, 0, 300], normal: [0, 0, 1], along: [1, 0, 0], size: [200, 100]}, coverage: 0.8}
  - {name: lid, disc: {center: [0, 400, 300], normal: [0, 0, 1], radius: 60}, coverage: 0.8}
  - {name: wall, plane: {point: [500, 0, 0], normal: [1, 0, 0]}, coverage: 0.8,
     region: [{box: {center: [500, 0, 300], size: [10, 200, 200]}}]}
"""
TASK_MESH = """\
synth: 1
length_unit: mm
robot: malleable-2dof
surface: [{mesh: bowl.stl, length_unit: mm, tolerance: 3}]
"""
TASK_PATHS = """\
synth: 1
name: a belt and a seam
length_unit: mm
robot: malleable-2dof
path:
  - {name: belt, waypoints: [[420, -250, 220], [420, 250, 220]], tolerance: 5, speed: 100}
  - {name: seam, csv: seam.csv, closed: true, interpolation: spline, tolerance: 5}
"""
ROBOT = """\
name: my robot
length_unit: mm
d12: 58
link: {length: [550, 700], min_bend_radius: 110, diameter: 50, max_total_bend_deg: 286}
tip_offset: 24.5
d34: 49
rigid_link: {d35: 455, d45: 460, diameter: 20}
joint_limits_deg: {base: [10, 350], second: [53, 307]}
joint_rates:
  base: {max_speed_deg_s: 150, max_acceleration_deg_s2: 500}
  second: {max_speed_deg_s: 120, max_acceleration_deg_s2: 400}
"""
ROBOT_LENGTHS = """\
name: my robot
length_unit: mm
d12: 58
link: {length: [550, 700], min_bend_radius: 110, diameter: 50}
d34: 49
rigid_link: {d35: {one_of: [410, 455, 500]}, d45: {one_of: [415, 460, 505]}}
"""
ROBOT_CATALOGUE = """\
name: my robot
length_unit: mm
d12: 58
link: {length: [550, 700], min_bend_radius: 110, diameter: 50}
d34: 49
rigid_link:
  one_of:
    - {name: short, d35: 410, d45: 415, diameter: 18}
    - {name: bought, d35: 455, d45: 460}
  diameter: 20
"""
MEASURED = """\
synth: 1
name: a shape measured by tape
length_unit: mm
robot: malleable-2dof
rounding: 1
intended: puma
distances: {d13: 650, d14: 667, d15: 969, d23: 603, d24: 619, d25: 930, d12: 58, d34: 49, d35: 455, d45: 460}
"""
MEASURED_MARKERS = """\
synth: 1
length_unit: mm
robot: malleable-2dof
sigma: 0.5
markers: {P1: [0, 0, 0], P2: [0, 0, 58], P3: [-43.7, 166.1, 439.4], P4: [-60, 121.6, 427.1], P5: [-403.6, 373.2, 253.3]}
"""
MEASURED_SEVERAL = """\
synth: 1
length_unit: mm
robot: malleable-2dof
configurations:
  by tape:
    rounding: 1
    intended: puma
    distances: {d13: 650, d14: 667, d15: 969, d23: 603, d24: 619, d25: 930, d12: 58, d34: 49, d35: 455, d45: 460}
  by camera:
    sigma: 0.5
    markers: {P1: [0, 0, 0], P2: [0, 0, 58], P3: [-43.7, 166.1, 439.4], P4: [-60, 121.6, 427.1], P5: [-403.6, 373.2, 253.3]}
"""
PAGES = (
    FilePage(
        "task-file", "Task files",
        "A task file says what `synth solve` shall reach, with which robot, and what is in the way. Where there is a `surface` or\na `path`, `targets` may be left out; what `robot` holds is on [a page of its own](robot-file.md).",
        TaskFile, (TASK, TASK_MARKERS, TASK_RANGE, TASK_CHOICES, TASK_SURFACES, TASK_MESH, TASK_PATHS),
    ),
    FilePage(
        "robot-file", "Robot files",
        "A robot file says what is fixed in a robot; a task names its path, or holds the same keys under `robot`.",
        RobotFile, (ROBOT, ROBOT_LENGTHS, ROBOT_CATALOGUE),
    ),
    FilePage(
        "measured-file", "Files of measured shapes",
        "A file of measured shapes is what `synth inspect` reads: distances or markers of a link that is bent already.\nWhat `robot` holds is on [a page of its own](robot-file.md).",
        MeasuredFile, (MEASURED, MEASURED_MARKERS, MEASURED_SEVERAL),
    ),
)  # fmt: skip


def parts_of(annotation: object, *, listed: bool = False) -> dict[type[BaseModel], bool]:
    """Return the models that the type of a key holds, and whether a list of each may stand there."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return {annotation: listed}
    found: dict[type[BaseModel], bool] = {}
    for argument in typing.get_args(annotation):
        inside = parts_of(argument, listed=listed or typing.get_origin(annotation) is list)
        found |= {part: found.get(part, False) or in_list for part, in_list in inside.items()}
    return found


def keys_of(model: type[BaseModel], path: str = "") -> dict[str, typing.Any]:
    """Return every key that a file may hold, by its path, with the field of its model."""
    found = {}
    for name, field in model.model_fields.items():
        key = f"{path}{field.alias or name}"
        found[key] = field
        for part, listed in parts_of(field.annotation).items():
            inside = "configurations.*." if key == "configurations" else f"{key}[]." if listed else f"{key}."
            found |= {} if name == "robot" else keys_of(part, inside)  # that has a page of its own
    return found


def values_of(content: object, path: str = "") -> dict[str, object]:
    """Return the first value that stands under each path of a document."""
    found: dict[str, object] = {}
    if isinstance(content, dict):
        for key, value in content.items():
            named = f"{path}{'*' if path == 'configurations.' else key}"
            found.setdefault(named, value)
            deeper = f"{named}[]." if isinstance(value, list) else f"{named}."
            for deep in value if isinstance(value, list) else [value]:
                found = values_of(deep, deeper) | found
    return found


def examples_of(page: FilePage) -> dict[str, object]:
    """Return a value for each path, from the examples of a page."""
    found: dict[str, object] = {}
    for text in page.examples:
        found = values_of(YAML(typ="safe").load(text)) | found
    return found


def _written(value: object) -> str:
    if isinstance(value, dict | list) and any(isinstance(each, dict) for each in _inner(value)):
        return "below"
    if isinstance(value, list):
        return f"`[{', '.join(map(str, value))}]`"
    return "below" if isinstance(value, dict) else f"`{value}`"


def _inner(value: dict | list) -> list[object]:
    return list(value.values() if isinstance(value, dict) else value)


def _default(path: str, field: typing.Any) -> str:
    if path in EITHER:
        return "**d35 and d45, or one_of**"
    if field.is_required():
        return "**must be given**"
    if field.default is PydanticUndefined:
        made = field.default_factory()
        told = "absent" in field.description
        if told or made is None:
            return "as told" if told else "none"
        return "see below"
    if isinstance(field.default, Enum):
        return f"`{field.default.value}`"
    return "none" if field.default in ([], None) else _written(field.default)


def unit_of(path: str) -> str:
    """Return the unit of a key: "length" is the unit that the file states. Raises KeyError for a key not known here."""
    key = path.rpartition(".")[2]
    if path in {"base", "joint_rates.base", "joint_rates.second"}:
        return ""
    if key == "one_of":
        return "" if path == "rigid_link.one_of" else "length"
    if key == "length" and path.endswith("rigid_link.length"):
        return "length"
    return UNITS[key] if key in UNITS else dict.fromkeys([*PLAIN, "*"], "")[key]


def _choices(field: typing.Any) -> str:
    found = [field.annotation, *typing.get_args(field.annotation)]
    kinds = [each for each in found if isinstance(each, type) and issubclass(each, Enum)]
    return f"; one of {', '.join(f'`{member.value}`' for member in kinds[0])}" if kinds else ""


def file_page(page: FilePage) -> str:
    """Return the page about a kind of file."""
    shown = examples_of(page)
    rows = [
        f"| `{path}` | {field.description}{_choices(field)} | {unit_of(path)} | {_default(path, field)} "
        f"| {_written(shown[path])} |"
        for path, field in keys_of(page.model).items()
    ]
    examples = "\n".join(f"```yaml\n{text}```\n" for text in page.examples)
    return f"""# {page.title}

{page.first}

Lengths are in the unit that the file states under `length_unit`, angles in degrees. `[]` stands for each entry of a list. A key
that is not in the table is a mistake, told with its line.

| key | meaning | unit | default | example |
|---|---|---|---|---|
{chr(10).join(rows)}

Between them the examples hold every key:

{examples}"""


def solution_page() -> str:
    """Return the page about solution files, made from the model that reads them."""
    rows = [
        f"| `{path}` | {field.description} |"
        for path, field in keys_of(SolutionFile).items()
        if not path.startswith(ELSEWHERE)
    ]
    return f"""# Solution files

A solution file is what `synth solve -o DIR` writes and `--json` prints: the task, the answer and the guide in one, so
that it can be loaded and verified again with no other file. All is in metres, seconds and radians; what JSON cannot
hold, infinity, is null. `[]` stands for each entry of a list. `synth schema solution` prints the same as JSON Schema.

| key | meaning |
|---|---|
{chr(10).join(rows)}
"""


def pages() -> dict[str, str]:
    """Return all pages by the names of their files."""
    return {f"{page.name}.md": file_page(page) for page in PAGES} | {"solution-file.md": solution_page()}


def main() -> None:
    """Write the pages."""
    for name, text in pages().items():
        (REFERENCE / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
