"""The rooms and their doors: imports run downwards, and a heavy library lives in few files."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "synth"
ROOMS = ["cli", "export", "guide", "measurement", "synthesis", "task", "robot", "geometry"]
LIBRARIES = {
    "casadi": {
        "synthesis/nlp/arm.py",
        "synthesis/nlp/blocks.py",
        "synthesis/nlp/ipopt.py",
        "synthesis/nlp/program.py",
    },
    "cvxpy": {"measurement/relaxation.py"},
    "click": {"cli/main.py", "cli/terminal.py"},
    "rich": {"cli/session.py"},
    "ruamel": {"task/yaml_text.py"},
    "sympy": {"geometry/derivation.py"},
}
FILES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))


def imports(file):
    """Return every module that a file imports, also those for the type checker only."""
    for node in ast.walk(ast.parse((PACKAGE / file).read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


@pytest.mark.parametrize("file", [file for file in FILES if file.split("/")[0] in ROOMS])
def test_imports_run_downwards(file):
    room = file.split("/")[0]
    for module in imports(file):
        other = module.split(".")[1] if module.startswith("synth.") else ""
        if other in ROOMS:
            assert ROOMS.index(other) >= ROOMS.index(room), f"{file} imports {module}"


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_lives_where_it_may(library):
    users = {file for file in FILES if any(module.split(".")[0] == library for module in imports(file))}
    assert users == LIBRARIES[library]


@pytest.mark.parametrize("library", ["matplotlib", "pydantic"])
def test_a_library_lives_in_one_room(library):
    users = {file for file in FILES if any(module.split(".")[0] == library for module in imports(file))}
    assert len({file.split("/")[0] for file in users}) == 1


def test_no_room_is_called_what_says_nothing():
    for file in FILES:
        assert Path(file).stem not in {"utils", "helpers", "common", "misc"}


def test_no_test_imports_another():
    for file in sorted(Path(__file__).parent.glob("*.py")):
        modules = {module for node in ast.walk(ast.parse(file.read_text())) for module in _imported(node)}
        assert not {module for module in modules if module.startswith("test_")}, file.name


def _imported(node):
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module or ""] if isinstance(node, ast.ImportFrom) else []
