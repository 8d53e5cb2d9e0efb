"""`synth check` and `synth calibrate` from files: what they print, and how they end."""

import json
from dataclasses import replace

import numpy as np
import pytest
from capture_files import motive_text
from command import invoked
from planted import ROBOT, planted_task
from solutions import solution_document, write_markers, write_solution
from standing import BARS, HOLD, SIGMA, seen

from synth.measurement import StandingArm
from synth.synthesis import solve


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    task, _ = planted_task(5, 3)
    task = replace(task, targets=tuple(replace(each, tolerance=5e-3) for each in task.targets))
    solution = solve(task)
    folder = tmp_path_factory.mktemp("loop")
    return task, solution, folder, write_solution(folder / "solution.json", task, solution.designs)


def markers(scene, arm, names=BARS):
    return write_markers(scene[2] / "markers.csv", seen(arm, names, np.random.default_rng(0)))


def wanted(scene):
    return StandingArm.of(scene[1].designs[0].arm, HOLD)


def test_a_solution_without_a_shape_is_refused(scene, tmp_path):
    path = tmp_path / "solution.json"
    content = solution_document(scene[0], scene[1].designs)
    path.write_text(json.dumps({**content, "status": "failed", "link": None}))
    result = invoked("check", markers(scene, wanted(scene)), path)
    assert result.exit_code == 2
    assert "holds no shape" in result.output


def test_a_link_in_its_place_is_locked(scene):
    result = invoked("check", markers(scene, wanted(scene)), scene[3], "--base-calibrated")
    assert result.exit_code == 0, result.output
    assert "lock it" in result.output


def test_a_recording_with_y_up_is_checked_like_a_table(scene, tmp_path):
    readings = seen(wanted(scene), BARS, np.random.default_rng(0))
    y_up = readings.positions @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    path = tmp_path / "at rest.csv"
    path.write_text(motive_text([*readings.names, "Unlabeled 7"], [[*y_up, y_up[0]]]))
    result = invoked("check", path, scene[3], "--base-calibrated")
    assert result.exit_code == 0, result.output
    assert "lock it" in result.output
    assert "passed over, being no markers of this arm: 'Arm:Unlabeled 7'" in result.output
    assert "P1 to P2 points along y of the file: its frame was turned so that z is up" in result.output


def test_the_json_of_a_check_is_the_contract(scene, tmp_path):
    off = wanted(scene).moved(np.array([0.006, -0.005, 0.004, 0.03, 0.02, -0.04]))
    result = invoked(
        "check",
        markers(scene, off),
        scene[3],
        "--base-calibrated",
        "--json",
        "--settings",
        30,
        "-o",
        tmp_path,
    )
    assert result.exit_code == 1, result.output
    content = json.loads(result.stdout)
    assert json.loads((tmp_path / "check.json").read_text()) == content
    assert content["schema"] == "synth.check/1"
    assert content["status"] == "correct"
    assert content["lock"] is False
    assert content["probability_all_within"] < 0.5
    axis = content["measured"]["axis2"]
    assert np.linalg.norm(np.array(axis["point"]) - off.end) < 1e-3
    assert np.linalg.norm(np.array(axis["direction"]) - off.axis) < 5e-3
    assert content["measured"]["markers_used"] == BARS.split()
    for target in content["targets"]:
        assert len(target["joints"]) == 2
        assert 0.0 < target["expected_miss"] <= target["miss_95"]
    correction = content["correction"]
    move = np.concatenate([correction["move"], correction["rotate"]])
    p3 = np.array(correction["markers"]["P3"])
    aim = off.moved(move)
    assert np.linalg.norm(p3 - (aim.end - ROBOT.tip_offset * aim.axis)) < 2e-3
    assert correction["words"]
    assert set(content["settings"]) >= {"base", "rigid_link", "expected_worst_miss"}


def test_markers_that_are_not_believed_end_with_2(scene):
    path = markers(scene, wanted(scene))
    path.write_text(path.read_text().replace("x_mm,y_mm,z_mm", "x_m,y_m,z_m"))
    assert invoked("check", path, scene[3]).exit_code == 2
    readings = seen(wanted(scene), BARS)
    path = write_markers(scene[2] / "cm.csv", replace(readings, positions=10.0 * readings.positions))
    result = invoked("check", path, scene[3], "--json")
    assert result.exit_code == 2
    assert json.loads(result.stdout)["status"] == "unusable"
    assert "the unit is wrong" in json.loads(result.stdout)["message"]


def test_calibration_from_a_file(scene):
    rng = np.random.default_rng(0)
    limits = ROBOT.joint_limits
    joints = np.column_stack(
        [
            rng.uniform(limits.base.lower, limits.base.upper, 100),
            rng.uniform(limits.second.lower, limits.second.upper, 100),
        ]
    )
    true = wanted(scene).moved(np.array([0.005, 0.0, 0.003, 0.02, 0.0, 0.01]))
    points = 1e3 * (true.forward(joints) + SIGMA * rng.normal(size=(100, 3)))
    table = np.hstack([points, np.degrees(joints)])
    path = scene[2] / "points.csv"
    np.savetxt(path, table, delimiter=",", header="x_mm,y_mm,z_mm,joint1_deg,joint2_deg", comments="")
    result = invoked("calibrate", path, scene[3], "--json")
    assert result.exit_code == 0, result.output
    content = json.loads(result.stdout)
    assert content["schema"] == "synth.calibration/1"
    assert content["surface_rms"] < 0.1e-3
    assert np.array(content["covariance"]).shape == (5, 5)
    assert np.linalg.norm(np.array(content["axis2"]["direction"]) - true.axis) < 1e-3
    assert content["distances"]["34"] == pytest.approx(ROBOT.d34)
    assert len(content["targets"]) == 3
    np.savetxt(path, table[table[:, 4] < 90.0][:, :3], delimiter=",", header="x_mm,y_mm,z_mm", comments="")
    result = invoked("calibrate", path, scene[3])
    assert result.exit_code == 1
    assert "does not determine the surface" in result.output


def checked_into(folder, scene, arm, *options):
    result = invoked(
        "check", markers(scene, arm), scene[3], "--base-calibrated", "-o", folder, "--json", *options
    )
    return json.loads(result.stdout)


def test_what_a_hand_did_is_told_by_each_check_and_learned_from_all(scene, tmp_path):
    aim = wanted(scene)
    off = np.array([0.006, -0.005, 0.004, 0.0, 0.02, -0.04])
    first = checked_into(tmp_path / "1", scene, aim.moved(off))
    assert first["hand"]["deed"] == "placed"
    np.testing.assert_allclose(first["hand"]["error"][:3], off[:3], atol=1e-3)
    assert np.linalg.norm(first["hand"]["error"][3:]) == pytest.approx(np.hypot(0.02, 0.04), abs=0.02)
    asked = np.array([*first["correction"]["move"], *first["correction"]["rotate"]])
    error = np.array([0.001, 0.002, -0.002, 0.0, 0.0, 0.0])
    corrected = aim.moved(off).moved(asked + error)
    second = checked_into(tmp_path / "2", scene, corrected, "--after", tmp_path / "1" / "check.json")
    assert second["hand"]["deed"] == "corrected"
    np.testing.assert_allclose(second["hand"]["asked"], asked)
    np.testing.assert_allclose(second["hand"]["error"][:3], error[:3], atol=1e-3)
    assert second["lock"]
    stiff = corrected.moved(np.array([0.0, 0.0, 0.004, 0.0, 0.0, 0.0]))
    after = ("--after", tmp_path / "2" / "check.json", "--stiff")
    third = checked_into(tmp_path / "3", scene, stiff, *after)
    assert third["hand"]["deed"] == "stiffened"
    assert not np.any(third["hand"]["asked"])

    learned = invoked("learn", tmp_path, "-o", tmp_path / "hand.json")
    assert learned.exit_code == 0, learned.output
    assert learned.output.count("times seen: 1\n") == 3
    hand = json.loads((tmp_path / "hand.json").read_text())
    assert hand["checks"] == {"placed": 1, "corrected": 1, "stiffened": 1}
    assert hand["drift"]["shift"] > 1.5e-3  # 4 mm were seen where 1.5 mm are supposed
    told = checked_into(tmp_path / "4", scene, aim.moved(off), "--hand", tmp_path / "hand.json")
    assert told["correction"]["expected_worst_miss"] != first["correction"]["expected_worst_miss"]


def test_there_is_nothing_to_learn_from_other_files(scene, tmp_path):
    nothing = invoked("learn", tmp_path)
    assert nothing.exit_code == 2
    assert "nothing to learn from" in nothing.output
    solution = invoked("learn", scene[3])
    assert solution.exit_code == 2
    assert "schema" in solution.output
    (tmp_path / "hand.json").write_text('{"schema": "synth.hand/1", "share": -0.4}')
    wrong = invoked("check", markers(scene, wanted(scene)), scene[3], "--hand", tmp_path / "hand.json")
    assert wrong.exit_code == 2
    assert "share" in wrong.output
    assert "placement" in wrong.output


def test_markers_without_names_are_told_by_where_they_must_be(scene, tmp_path):
    rng = np.random.default_rng(1)
    readings = seen(wanted(scene).moved(np.array([0.006, -0.005, 0.004, 0.0, 0.02, -0.04])), BARS, rng)
    points = np.vstack([readings.positions, [[0.3, 0.7, 0.2]]])[rng.permutation(len(readings.names) + 1)]
    unnamed, named = tmp_path / "points.csv", write_markers(tmp_path / "markers.csv", readings)
    rows = "\n".join(",".join(f"{1e3 * x:.4f}" for x in point) for point in points)
    unnamed.write_text(f"x_mm,y_mm,z_mm\n{rows}\n")
    answers = [
        invoked("check", file, scene[3], "--base-calibrated", "--json", *options)
        for file, options in ((named, ()), (unnamed, ("--markers", BARS)))
    ]
    told = [json.loads(answer.stdout)["measured"]["axis2"]["point"] for answer in answers]
    np.testing.assert_allclose(*told, atol=1e-5)
    assert "passed over, being no markers of this arm: 1 points" in answers[1].stderr
    wrong = invoked("check", unnamed, scene[3], "--markers", "P1 P3 P3 Q7")
    assert wrong.exit_code == 2
    assert "there is no marker 'Q7'" in wrong.output
    assert "P3 is there twice" in wrong.output
