"""Every key of a file, every option and every public name stands on a page."""

import re
import sys
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import synth
from synth.cli import main
from synth.measurement import load_measurements

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

import reference_pages as made  # noqa: E402 - after the path

PYTHON = (ROOT / "docs" / "reference" / "python.md").read_text()
COMMANDS = (ROOT / "docs" / "command-line.md").read_text() + (
    ROOT / "docs" / "published-configurations.md"
).read_text()
CONFIGURED = [page for page in made.PAGES if page.name != "measured-file"]


@pytest.mark.parametrize("name", made.pages())
def test_a_page_is_what_the_models_say_now(name):
    assert (made.REFERENCE / name).read_text() == made.pages()[name]


@pytest.mark.parametrize("page", made.PAGES, ids=lambda page: page.name)
def test_every_key_has_a_meaning_a_unit_and_an_example(page):
    shown = made.examples_of(page)
    for path, field in made.keys_of(page.model).items():
        assert field.description, path
        assert path in shown, path
        made.unit_of(path)  # an unknown key raises


def test_the_keys_are_those_of_the_schema():
    def keys(schema, definitions, path=""):
        for key, stated in schema.get("properties", {}).items():
            yield f"{path}{key}"
            entry = next((one for one in stated.get("oneOf", ()) if "items" in one), stated)
            inside, deeper = entry, f"{path}{key}."
            if "items" in entry:
                inside, deeper = entry["items"], f"{path}{key}[]."
            name = inside.get("$ref", "").rpartition("/")[2]
            if name in definitions and key != "robot":
                yield from keys(definitions[name], definitions, deeper)

    schema = synth.task.task_schema()
    assert set(made.keys_of(made.TaskFile)) == set(keys(schema, schema["$defs"]))


@pytest.mark.parametrize(
    "text", [text for page in CONFIGURED for text in page.examples], ids=lambda text: text.splitlines()[1]
)
def test_the_examples_of_task_and_robot_files_are_read(text, tmp_path):
    (tmp_path / "scan.csv").write_text("x,y,z\n" + "".join(f"{400 + i},0,300\n" for i in range(9)))
    (tmp_path / "seam.csv").write_text("400,0,300\n420,90,300\n380,90,320\n")
    if "bowl.stl" in text:
        trimesh = pytest.importorskip("trimesh")
        trimesh.creation.icosphere(radius=400.0).export(tmp_path / "bowl.stl")
    (tmp_path / "file.yaml").write_text(text)
    if "synth" in YAML(typ="safe").load(text):
        assert synth.load_task(tmp_path / "file.yaml").targets
    else:
        assert synth.load_robot(tmp_path / "file.yaml").name == "my robot"


@pytest.mark.parametrize("text", next(page for page in made.PAGES if page not in CONFIGURED).examples)
def test_the_examples_of_measured_files_are_read(text, tmp_path):
    (tmp_path / "file.yaml").write_text(text)
    assert load_measurements(tmp_path / "file.yaml")


def paths(value, path=""):
    if isinstance(value, dict):
        for key, inside in value.items():
            yield f"{path}{key}"
            yield from paths(inside, f"{path}{key}.")
    elif isinstance(value, list):
        for inside in value:
            yield from paths(inside, f"{path.removesuffix('.')}[].")


def test_every_public_name_is_on_the_page_of_python():
    shown = re.findall(r"^\.\. (?:auto|py:)\w+:: (\w+)$", PYTHON, re.MULTILINE)
    assert sorted(set(shown) - {"synth"}) == sorted(synth.__all__)
    assert len(shown) == len(set(shown))


def test_a_public_thing_says_what_it_is():
    for name in set(synth.__all__) - {"__version__", "PRESETS"}:
        assert len(getattr(synth, name).__doc__.split()) >= 4, name


@pytest.mark.parametrize("name", main.commands)
def test_every_option_says_what_it_does_and_is_on_a_page(name):
    for option in main.commands[name].params:
        if option.param_type_name == "option":
            assert option.help, option.name
            assert all(
                re.search(rf"{re.escape(flag)}\b", COMMANDS) for flag in option.opts if flag[:2] == "--"
            )
