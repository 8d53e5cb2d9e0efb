"""Trajectories through the targets: on the ways, within limits."""

import csv
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from planted import planted_task
from planted_obstacles import planted_with_obstacles

import synth
from synth.errors import InputError, SynthError
from synth.synthesis import Motion, solve
from synth.trajectories import trajectory
from synth.trajectories.profile import Profile

LIMITS = {"speed": 2.0, "acceleration": 5.0}


@pytest.fixture(scope="module", params=["free", "window"])
def solution(request):
    task = planted_task(5, 4)[0] if request.param == "free" else planted_with_obstacles("window", 2)[0]
    found = solve(task, alternatives=0)
    assert all(way.found for way in found.best.ways)
    return found


def test_it_keeps_the_limits_of_the_joints(solution):
    path = trajectory(solution, **LIMITS)
    lower, upper = solution.robot.joint_bounds
    assert (path.positions >= lower - 1e-9).all()
    assert (path.positions <= upper + 1e-9).all()
    assert np.abs(path.velocities).max() <= 2.0 + 1e-12
    assert np.abs(path.accelerations).max() <= 5.0 + 1e-12
    assert (np.diff(path.times) > 0.0).all()
    assert np.diff(path.times).max() <= 0.01 + 1e-12


def test_one_joint_is_at_its_limit_all_the_time(solution):
    path = trajectory(solution, **LIMITS)
    fast = np.abs(path.velocities).max(axis=1) > 2.0 - 1e-9
    hard = np.abs(path.accelerations).max(axis=1) > 5.0 - 1e-9
    rests = np.abs(path.velocities).max(axis=1) < 1e-9
    assert (fast | hard | rests).mean() > 0.99


def test_velocities_and_accelerations_are_derivatives(solution):
    path = trajectory(solution, period=1e-3, **LIMITS)
    step = np.diff(path.times)[:, None]
    mean = np.diff(path.positions, axis=0) / step
    np.testing.assert_allclose(mean, 0.5 * (path.velocities[1:] + path.velocities[:-1]), atol=1e-6)
    gained = np.diff(path.velocities, axis=0) / step
    np.testing.assert_allclose(gained, path.accelerations[:-1], atol=1e-6)


def test_it_is_clear_all_along_and_stops_at_each_target(solution):
    path = trajectory(solution, pause=0.25, **LIMITS)
    assert solution.clear(path.positions).all()
    times = np.linspace(0.0, path.duration, 3000)
    assert solution.clear(path.at(times)).all()
    for target in solution.targets:
        stop = path.stops[target.name]
        for time in (stop, stop + 0.2):
            reached = solution.robot.forward_kinematics(*path.at(time))
            assert np.linalg.norm(reached - target.position) <= target.miss + 1e-9
        assert np.abs(path.velocities[np.argmin(np.abs(path.times - stop))]).max() < 1e-12
    assert path.duration == pytest.approx(path.stops[solution.targets[-1].name] + 0.25)


def test_a_short_way_never_gets_up_to_speed():
    profile = Profile.fastest(np.zeros(2), np.array([0.01, -0.02]), np.full(2, 2.0), np.full(2, 5.0))
    assert profile.duration == pytest.approx(2.0 * np.sqrt(0.02 / 5.0))
    position, velocity, _ = profile.at([0.0, 0.5 * profile.duration, profile.duration, 9.0])
    np.testing.assert_allclose(position[1], [0.005, -0.01])
    np.testing.assert_allclose(position[2:], [[0.01, -0.02]] * 2)
    assert np.abs(velocity).max() < 2.0


def test_a_long_way_takes_what_a_trapezoid_takes():
    profile = Profile.fastest(np.zeros(2), np.array([3.0, 1.0]), np.full(2, 2.0), np.full(2, 5.0))
    assert profile.duration == pytest.approx(3.0 / 2.0 + 2.0 / 5.0)
    still = Profile.fastest(np.ones(2), np.ones(2), np.full(2, 2.0), np.full(2, 5.0))
    assert still.duration == 0.0
    np.testing.assert_array_equal(still.at([0.0, 1.0])[0], np.ones((2, 2)))


def test_one_target_is_a_rest():
    solution = solve(planted_task(3, 1)[0], alternatives=0)
    path = trajectory(solution, pause=1.0)
    assert path.duration == 1.0
    np.testing.assert_array_equal(path.positions, np.tile(solution.targets[0].joints, (2, 1)))


def test_a_missing_way_is_an_error(solution, tmp_path):
    design = solution.best
    lost = (Motion("a", "b", np.empty((0, 2))), *design.ways[1:])
    broken = replace(solution, designs=(replace(design, ways=lost),))
    with pytest.raises(SynthError, match="a to b: no way was found"):
        trajectory(broken)
    with pytest.raises(SynthError, match="a to b: no way was found"):
        broken.export(tmp_path, "urdf", "trajectory")
    assert list(tmp_path.iterdir()) == []
    names = {path.name for path in broken.export(tmp_path)}
    assert "robot.urdf" in names
    assert "trajectory.csv" not in names


def test_wrong_arguments_are_told_together(solution):
    with pytest.raises(InputError) as caught:
        trajectory(solution, speed=0.0, acceleration=-1.0, pause=-1.0, period=float("nan"))
    assert [mistake.key for mistake in caught.value.mistakes] == ["speed", "acceleration", "pause", "period"]
    with pytest.raises(InputError) as caught:
        trajectory(solution, speed=[1.0, -1.0], acceleration=[1.0])
    assert [mistake.key for mistake in caught.value.mistakes] == ["speed[1]", "acceleration"]


def test_csv_and_json_hold_all_of_it(solution, tmp_path):
    path = trajectory(solution, pause=0.5, **LIMITS)
    rows = list(csv.reader(io.StringIO(path.to_csv())))
    assert rows[0] == [
        "time_s", "joint1_rad", "joint2_rad", "joint1_rad_s", "joint2_rad_s", "joint1_rad_s2", "joint2_rad_s2"
    ]  # fmt: skip
    table = np.array(rows[1:], dtype=float)
    np.testing.assert_array_equal(table[:, 0], path.times)
    np.testing.assert_array_equal(table[:, 1:3], path.positions)
    content = json.loads(json.dumps(path.to_json()))
    assert content["joint_names"] == ["joint1", "joint2"]
    point = content["points"][-1]
    seconds = point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"]
    assert seconds == pytest.approx(path.duration, abs=1e-9)
    assert point["positions"] == path.positions[-1].tolist()
    solution.export(tmp_path, "trajectory")
    assert (tmp_path / "trajectory.csv").read_text().splitlines()[0] == ",".join(rows[0])
    exported = json.loads((tmp_path / "trajectory.json").read_text())
    assert len(exported["points"]) == len((tmp_path / "trajectory.csv").read_text().splitlines()) - 1
    assert "metres, radians" in " ".join(exported["source"])


CORNER = {
    "synth": 1,
    "length_unit": "mm",
    "robot": "malleable-2dof",
    "path": {
        "waypoints": [[420, -150, 220], [420, 150, 220], [450, 150, 300]],
        "tolerance": 10,
        "speed": 400,
    },
}


@pytest.fixture(scope="module")
def cornered():
    found = solve(synth.parse_task(CORNER), alternatives=0)
    assert found.found
    return found


@pytest.mark.parametrize("limits", [LIMITS, {"speed": 0.2, "acceleration": 10.0}, {"acceleration": 0.3}])
def test_along_a_path_the_limits_of_the_joints_and_its_speed_are_kept(cornered, limits):
    path, (told,) = trajectory(cornered, **limits), cornered.best.verification.followed
    steps = np.diff(path.times)
    assert (steps > 0.0).all()
    assert steps.max() <= 0.01 + 1e-12
    rates = np.diff(path.positions, axis=0) / steps[:, None]
    assert np.abs(rates).max() <= limits.get("speed", 2.7) * (1.0 + 1e-9)
    assert np.abs(path.velocities).max() <= limits.get("speed", 2.7) * (1.0 + 1e-9)
    assert np.abs(path.accelerations).max() <= limits["acceleration"] * (1.0 + 1e-9)
    np.testing.assert_array_equal(path.positions[[0, -1]], told.joints[[0, -1]])
    reached = cornered.robot.forward_kinematics(*path.positions.T)
    moved = np.linalg.norm(np.diff(reached, axis=0), axis=1) / steps
    assert moved.max() <= 0.4 * 1.05  # of the path itself 0.4 is kept; P5 strays from it
    assert path.stops == {"path, start": 0.0, "path, end": path.duration}


def test_along_a_path_the_joints_are_as_fast_as_they_may_be_somewhere(cornered):
    path = trajectory(cornered, acceleration=1.0)
    assert np.abs(path.accelerations).max() > 0.9


def test_of_two_paths_no_trajectory_is_known():
    both = [{"waypoints": [[420, -150 + y, 220], [420, y, 220]], "tolerance": 10} for y in (0, 200)]
    found = solve(synth.parse_task({**CORNER, "path": both}), alternatives=0)
    assert found.found
    with pytest.raises(SynthError, match="along one path"):
        trajectory(found)
