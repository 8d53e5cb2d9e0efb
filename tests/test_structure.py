"""The plan of the rooms: imports run downwards and through doors, nothing goes round in circles."""

import ast
import re
from graphlib import CycleError, TopologicalSorter

import pytest
from package_files import FILES, FOLDERS, MODULES, PACKAGE, TESTS

# Each folder is a room, and its `__init__` the door; beside it stand the rooms it may enter. What lies in no
# room everything may use.
_SEARCH = {"robot", "synthesis.check", "synthesis.shapes", "synthesis.starts", "synthesis.wanted", "task"}
ROOMS = {
    "cli": {"export", "guide", "live", "measurement", "solution_file", "sweep", "synthesis", "task"},
    "live": {"export", "guide", "live.streams", "measurement", "robot", "synthesis"},
    "live.streams": set(),
    "sweep": {"export", "solution_file", "synthesis", "task"},
    "solution_file": {"files", "geometry", "paths", "robot", "surfaces", "synthesis", "task"},
    "export.inspection": {"export", "export.sheet", "measurement"},
    "export.planners": {"geometry", "robot", "synthesis", "task", "trajectories"},
    "trajectories": {"synthesis"},
    "export.page": {"export.sheet", "geometry", "guide", "robot", "synthesis", "task"},
    "export": {
        "export.page",
        "export.planners",
        "export.sheet",
        "geometry",
        "guide",
        "measurement",
        "paths",
        "robot",
        "synthesis",
        "task",
    },
    "export.sheet": {"geometry", "guide", "robot", "synthesis", "task"},
    "guide.loop": {"measurement", "robot", "synthesis", "task"},
    "guide": {"robot", "synthesis", "task"},
    "synthesis": _SEARCH
    | {"geometry", "synthesis.bound", "synthesis.nlp", "synthesis.searching"}
    | {"synthesis.solution", "synthesis.whole"},
    "synthesis.whole": _SEARCH | {"synthesis.searching"},
    "synthesis.searching": _SEARCH | {"synthesis.nlp"},
    "synthesis.solution": {
        "robot",
        "synthesis.bound",
        "synthesis.check",
        "synthesis.starts",
        "synthesis.wanted",
        "task",
    },
    "synthesis.wanted": {
        "geometry",
        "robot",
        "synthesis.check",
        "synthesis.shapes",
        "synthesis.starts",
        "task",
    },
    "synthesis.starts": {"geometry", "robot", "synthesis.check", "synthesis.shapes", "task"},
    "synthesis.shapes": {"geometry", "robot", "task"},
    "synthesis.nlp": {"geometry", "robot", "task"},
    "synthesis.bound": {"robot", "task"},
    "synthesis.check": {"geometry", "paths", "robot", "surfaces", "task"},
    "measurement": {
        "measurement.calibration",
        "measurement.distances",
        "measurement.hand",
        "measurement.markers",
        "task",
    },
    "measurement.calibration": {"geometry", "measurement.markers", "robot"},
    "measurement.distances": {"files", "geometry", "robot", "task"},
    "measurement.hand": {"files", "measurement.markers", "task"},
    "measurement.markers": {"geometry", "measurement.captures", "robot"},
    "measurement.captures": set(),
    "task": {"files", "geometry", "paths", "robot", "surfaces", "task.model"},
    "task.model": {"geometry", "paths", "robot", "surfaces"},
    "surfaces": {"geometry"},
    "paths": set(),
    "files": set(),
    "robot": {"geometry", "robot.hardware", "robot.link"},
    "robot.link": {"robot.hardware"},
    "robot.hardware": set(),
    "geometry.exact": {"geometry"},
    "geometry": set(),
}
LIBRARIES = {
    "c3d": {"measurement/captures/c3d_file.py"},
    "casadi": {
        "export/planners/symbolic.py",
        "synthesis/nlp/arm.py",
        "synthesis/nlp/blocks.py",
        "synthesis/nlp/ipopt.py",
        "synthesis/nlp/program.py",
    },
    "cvxpy": {"measurement/distances/relaxation.py"},
    "click": {
        "cli/main.py",
        "cli/loop_commands.py",
        "cli/new.py",
        "cli/program_commands.py",
        "cli/terminal.py",
    },
    "rich": {"cli/session.py"},
    "rosbags": {"measurement/captures/ros_bag.py"},
    "ruamel": {"files/yaml_text.py"},
    "sympy": {"geometry/derivation.py"},
    "trimesh": {"surfaces/mesh_file.py"},
}


def imports(file):
    """Return every module that a file imports, also those for the type checker only."""
    for node in ast.walk(ast.parse((PACKAGE / file).read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            assert not node.level, f"{file} imports by a relative path"
            yield node.module


def own_imports(file):
    """Return the modules of the package that a file imports, without the name of the package."""
    return [module.removeprefix("synth.") for module in imports(file) if module.startswith("synth.")]


def room_of(module):
    """Return the innermost room in which a module lies, or an empty text."""
    parts = module.split(".")
    return next((room for n in range(len(parts), 0, -1) if (room := ".".join(parts[:n])) in ROOMS), "")


def door_into(module, room):
    """Return the door through which a room gets to a module; None if it stands in the same room."""
    parts = room_of(module).split(".") if room_of(module) else []
    inside = [".".join(parts[:n]) for n in range(1, len(parts) + 1)]
    return next((door for door in inside if not f"{room}.".startswith(f"{door}.")), None)


def circle(arrows):
    """Return a circle of a graph, or an empty list."""
    try:
        TopologicalSorter(arrows).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_the_plan_names_every_room():
    assert {folder.replace("/", ".") for folder in FOLDERS} == set(ROOMS)


def test_the_plan_has_no_circle():
    assert not circle(ROOMS)


@pytest.mark.parametrize("file", MODULES)
def test_other_rooms_are_entered_where_the_plan_says_and_by_their_doors(file):
    room = room_of(file.removesuffix(".py").replace("/", "."))
    for module in own_imports(file):
        door = door_into(module, room)
        if door is not None and room:
            assert door in ROOMS[room], f"{file} imports {module}"
        if door is not None:
            assert module == door, f"{file} imports {module} past the door of {door}"


@pytest.mark.parametrize("file", [file for file in FILES if file not in MODULES and "/" in file])
def test_a_door_opens_into_its_own_room(file):
    room = file.removesuffix("/__init__.py").replace("/", ".")
    for module in own_imports(file):
        assert not room_of(module) or module.startswith(f"{room}."), f"{file} imports {module}"
        assert door_into(module, room) in (None, module), f"{file} imports {module} past a door"


def test_files_import_one_another_in_no_circle():
    arrows = {
        file.removesuffix(".py").replace("/", "."): [
            module for module in own_imports(file) if f"{module.replace('.', '/')}.py" in MODULES
        ]
        for file in MODULES
    }
    assert not circle(arrows)


def test_only_the_methods_of_a_solution_go_through_the_door_of_the_package():
    through = {file for file in FILES if 'import_module("synth")' in (PACKAGE / file).read_text()}
    assert through == {"synthesis/solution/solution.py"}


def test_circles_and_ways_past_doors_are_seen():
    assert circle({"a": ["b"], "b": ["c"], "c": ["a"]})
    assert door_into("synthesis.shapes.shapes", "guide") == "synthesis"
    assert door_into("synthesis.shapes.shapes", "synthesis") == "synthesis.shapes"
    assert door_into("synthesis.shapes.shapes", "synthesis.nlp") == "synthesis.shapes"
    assert door_into("synthesis.run", "synthesis.starts") is None
    assert door_into("errors", "synthesis.starts") is None


@pytest.mark.parametrize("file", MODULES)
def test_a_room_within_imports_no_file_of_the_room_around_it(file):
    room = room_of(file.removesuffix(".py").replace("/", "."))
    around = room.rpartition(".")[0]
    for module in own_imports(file):
        within_plan = around in ROOMS.get(room, ())
        assert not around or within_plan or room_of(module) != around, f"{file} imports {module}"


def test_the_files_that_the_docs_send_a_reader_to_are_there():
    page = (TESTS.parent / "docs" / "how-it-works.md").read_text()
    table = page.split("## Where to change what")[1].split("\n## ")[0]
    named = re.findall(r"`([\w/]+\.py)`", table)
    assert len(named) > 15
    assert set(named) <= set(FILES)


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_lives_where_it_may(library):
    users = {file for file in FILES if any(module.split(".")[0] == library for module in imports(file))}
    assert users == LIBRARIES[library]


@pytest.mark.parametrize(
    ("library", "rooms"), [("matplotlib", {"export"}), ("pydantic", {"measurement", "solution_file", "task"})]
)
def test_a_library_lives_in_the_rooms_where_it_may(library, rooms):
    users = {file for file in FILES if any(module.split(".")[0] == library for module in imports(file))}
    assert {file.split("/")[0] for file in users} == rooms


def test_no_test_imports_another():
    for file in sorted(TESTS.glob("*.py")):
        modules = {module for node in ast.walk(ast.parse(file.read_text())) for module in _imported(node)}
        assert not {module for module in modules if module.startswith("test_")}, file.name


def _imported(node):
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module or ""] if isinstance(node, ast.ImportFrom) else []
