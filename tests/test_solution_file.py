"""A solution from its file: equal to the one that was written, verified again, and never believed."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from planted import noisy, out_of_reach, planted_task
from planted_obstacles import planted_with_obstacles
from planted_surfaces import as_points
from solutions import solution_document

import synth
from synth.errors import InputError
from synth.export import json_bytes, solution_to_json
from synth.robot import JointRates, RigidLink
from synth.solution_file import load_solution, solution_schema
from synth.solution_file.schema import SolutionFile
from synth.synthesis import Solution, Status, explain, showing, solve
from synth.task import Objective, Topology


def _free_rigid_link():
    task, arm = planted_task(7, 4)
    robot = replace(
        task.robot,
        rigid_link=RigidLink([0.4, arm.d35], [0.4, arm.d45], 0.03),
        joint_rates=JointRates([2.0, 1.1], 3.3),
    )
    return solve(replace(task, robot=robot, current=arm.shape), alternatives=1)


def _blocked():
    task, _ = planted_task(11, 6)
    link = replace(task.robot.link, length=0.9 * task.robot.link.length.lower)
    short = replace(task, robot=replace(task.robot, link=link))
    return explain(solve(short, alternatives=0), time_limit=4.0)


MAKERS = {
    "found": lambda: solve(planted_task(5, 3)[0]),
    "another shape": lambda: showing(made("found"), 2),
    "obstacles": lambda: solve(planted_with_obstacles("window", 2)[0]),
    "shelf": lambda: solve(planted_with_obstacles("shelf", 1)[0], alternatives=0),
    "free rigid link": _free_rigid_link,
    "best effort": lambda: solve(noisy(3, objective=Objective.MINIMAX, topology=Topology.GENERAL)),
    "impossible": lambda: solve(out_of_reach(2)),
    "proven": lambda: solve(noisy(1), prove=True, time_limit=4.0),
    "released": _blocked,
    "stopped": lambda: solve(noisy(3), stop=lambda: True),
    "no shape": lambda: replace(made("found"), designs=(), status=Status.FAILED, breakdown="Traceback"),
    "scan": lambda: solve(as_points(0, 60)[0], alternatives=0),
    "many targets": lambda: solve(noisy(2, 60), time_limit=4.0, alternatives=0),
}


@cache
def made(name):
    return MAKERS[name]()


@pytest.fixture(params=MAKERS)
def solution(request):
    return made(request.param)


@pytest.fixture
def found():
    return made("found")


def written(solution):
    return json.loads(json_bytes(solution_to_json(solution)))


def test_a_solution_that_is_read_is_the_one_that_was_written(solution, tmp_path):
    path = tmp_path / "solution.json"
    path.write_bytes(json_bytes(solution_to_json(solution)))
    again = load_solution(path)
    assert again == solution
    assert Solution.from_json(path.read_text()) == solution
    assert Solution.from_json(solution_to_json(solution)) == solution
    assert json_bytes(solution_to_json(again)) == path.read_bytes()
    for one, other in zip(again.designs, solution.designs, strict=True):
        assert one.verification == other.verification


def keys_beyond(model, content, path=""):
    """Yield the keys of a document that no field of its model describes."""
    fields = {field.alias or name: field for name, field in model.model_fields.items()}
    for key, value in content.items():
        if key not in fields:
            yield f"{path}.{key}"
            continue
        inner = [each for each in _models(fields[key].annotation) if value is not None]
        for each in value if isinstance(value, list) else [value]:
            if inner and isinstance(each, dict):
                yield from keys_beyond(inner[0], each, f"{path}.{key}")


def _models(annotation):
    if hasattr(annotation, "model_fields"):
        return [annotation]
    return [model for part in getattr(annotation, "__args__", ()) for model in _models(part)]


def test_every_key_that_is_written_is_described(solution):
    assert list(keys_beyond(SolutionFile, written(solution))) == []


def test_the_statuses_are_as_meant():
    assert made("best effort").status is Status.BEST_EFFORT
    assert made("impossible").status is Status.PROVEN_IMPOSSIBLE
    assert made("stopped").status is Status.LIMIT
    assert made("released").releases
    assert made("proven").bound is not None


def test_of_many_targets_only_the_worst_are_told_and_the_rest_is_found_again(found, monkeypatch):
    monkeypatch.setattr("synth.export.solution_json.MOST_TARGETS", 2)
    content = written(found)
    assert content["targets_left_out"] == 1
    check = Solution.from_json(json.dumps(content)).best.verification
    assert check.found
    np.testing.assert_allclose(check.misses, found.best.verification.misses, atol=1e-6)


def test_another_version_that_found_it_is_kept(found):
    content = written(found) | {"version": "0.0.7"}
    assert Solution.from_json(json.dumps(content)).version == "0.0.7"
    assert solution_to_json(Solution.from_json(content))["version"] == "0.0.7"


def _changed(content, path, value):
    *outer, key = path
    inner = content
    for part in outer:
        inner = inner[part]
    inner[key] = value
    return content


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("targets", 1, "miss"), 0.01, "targets[1].miss: says 10.000 mm, but the shape misses by"),
        (("targets", 1, "name"), "nobody", "targets[1].name: is no target of the task"),
        (("task", "targets", 0, "position"), [0.3, 0.3, 0.3], "status: is 'found', but"),
        (("task", "targets", 0, "tolerance"), -1.0, "task.targets[0].tolerance: must be greater than 0"),
        (("task", "robot", "link", "length"), [0.1, 0.2], "link: is no shape that the hardware can take"),
        (
            ("task", "robot", "link", "length"),
            [0.7, 0.6],
            "task.robot.link.length: must run from low to high",
        ),
        (("task", "robot", "d34"), 5.0, "task.robot.rigid_link: no triangle"),
        (("task", "topology"), "cube", "task.topology: must be"),
        (("task", "obstacles"), [{"name": "x"}], "task.obstacles[0]: must be one of sphere, box and capsule"),
        (("ways", 0, "joints", 0), [9.0, 3.0], "ways[0]: is not clear of everything within the limits"),
        (("link", "arcs"), [], "link.arcs: must hold one at least, but is an empty list"),
        (
            ("link", "arcs", 0, "length"),
            "long",
            "link.arcs[0].length: must be a number, but is the text 'long'",
        ),
        (("rigid_link",), {"d35": 0.455}, "rigid_link.d45: is missing (distance from P4 to P5, m)"),
        (("alternatives", 0, "targets", 0, "miss"), 0.02, "alternatives[0].targets[0].miss: says 20.000 mm"),
        (("status",), "perfect", "status: must be"),
        (("message",), None, "message: must be text"),
        (("seed",), -1, "seed: must be at least 0"),
        (("task", "floor"), float("nan"), "task.floor: must be a finite number"),
        (("schema",), "synth.solution/1", "schema: is 'synth.solution/1', and synth.solution/2 is needed"),
    ],
)
def test_what_is_not_true_is_refused_with_its_key(found, path, value, told, tmp_path):
    file = tmp_path / "solution.json"
    file.write_text(json.dumps(_changed(written(found), path, value)))
    with pytest.raises(InputError) as caught:
        load_solution(file)
    assert f"{file}: {told}" in str(caught.value)


def test_a_wall_across_a_way_is_noticed(found):
    content = written(found)
    way = np.array(content["ways"][0]["joints"])
    between = found.robot.forward_kinematics(*way.mean(axis=0))
    content["task"]["obstacles"] = [{"name": "post", "sphere": {"center": list(between), "radius": 0.02}}]
    with pytest.raises(InputError, match=r"ways\[0\]: is not clear"):
        Solution.from_json(content)


def test_every_mistake_is_told_at_once(found):
    content = written(found)
    content["seed"], content["status"] = "none", "perfect"
    content["task"]["targets"][2]["position"] = [1.0, 2.0]
    with pytest.raises(InputError) as caught:
        Solution.from_json(content)
    assert {mistake.key for mistake in caught.value.mistakes} == {
        "seed",
        "status",
        "task.targets[2].position",
    }


@pytest.mark.parametrize("text", ["", "[]", "{", "nan", '{"schema": 3}', '"x"', "[" * 100_000])
def test_what_is_no_solution_is_refused(text):
    with pytest.raises(InputError):
        Solution.from_json(text)


def test_what_is_neither_text_nor_mapping_is_refused():
    with pytest.raises(InputError, match="source: must be a JSON text or a mapping, but is 3"):
        Solution.from_json(3)


def test_a_file_that_is_not_there_and_one_that_is_no_text_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        load_solution(tmp_path / "none.json")
    (tmp_path / "bytes.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="is no JSON"):
        load_solution(tmp_path / "bytes.json")


def test_keys_of_other_programs_are_passed_over(found):
    content = written(found) | {"planner": {"speed": 3}}
    assert Solution.from_json(content) == found


def test_a_file_by_the_contract_alone_is_read(found):
    """Written by another hand: no rigid link but its distances, and nothing that can be computed."""
    content = solution_document(found.task, found.designs)
    again = Solution.from_json(content)
    assert again.found
    np.testing.assert_allclose(again.robot.axis_points, found.robot.axis_points, atol=1e-12)


def test_what_is_written_fits_the_schema(solution):
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.validate(written(solution), solution_schema(), cls=jsonschema.Draft202012Validator)


def test_the_public_names_are_there():
    assert synth.load_solution is load_solution
    assert Solution.from_json.__self__ is Solution
