"""Rooms, files, classes and tests are small, and are called what says something."""

import ast
from pathlib import Path

import pytest
from package_files import FILES, FOLDERS, MODULES, PACKAGE, TESTS

MOST_MODULES, MOST_LINES, MEAN_LINES = 14, 250, 150
MOST_OF_A_CLASS, MOST_MUTABLE = 150, 8  # lines with what they tell, and attributes


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_room_is_crowded(folder):
    assert len([file for file in MODULES if str(Path(file).parent) == folder]) <= MOST_MODULES


def test_files_are_short():
    lines = {file: len((PACKAGE / file).read_text().splitlines()) for file in FILES}
    assert {file: count for file, count in lines.items() if count > MOST_LINES} == {}
    assert sum(lines.values()) / len(lines) <= MEAN_LINES


def test_tests_are_short():
    lines = {path.name: len(path.read_text().splitlines()) for path in TESTS.rglob("*.py")}
    assert {file: count for file, count in lines.items() if count > MOST_LINES} == {}


def rebound(node):
    """Return the attributes that a class binds anew after it is made: what of it is mutable."""
    return {
        each.attr
        for method in node.body
        if isinstance(method, ast.FunctionDef) and method.name != "__init__"
        for each in ast.walk(method)
        if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store)
        if isinstance(each.value, ast.Name) and each.value.id == "self"
    }


def classes(text):
    """Return the classes of a file."""
    return [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ClassDef)]


@pytest.mark.parametrize("file", MODULES)
def test_classes_are_small_and_change_little(file):
    found = classes((PACKAGE / file).read_text())
    assert [node.name for node in found if node.end_lineno - node.lineno >= MOST_OF_A_CLASS] == []
    assert [node.name for node in found if len(rebound(node)) > MOST_MUTABLE] == []


def test_what_a_class_binds_anew_is_seen():
    methods = "    def __init__(self):\n        self.a = self.b = 0\n    def go(self, other):\n"
    (node,) = classes(f"class A:\n{methods}        self.b += 1\n        self.c, other.d = self.a, 2\n")
    assert rebound(node) == {"b", "c"}
    assert node.end_lineno - node.lineno + 1 == 6


def test_no_room_is_called_what_says_nothing():
    for file in FILES:
        assert Path(file).stem not in {"utils", "helpers", "common", "misc"}
