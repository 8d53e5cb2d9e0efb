"""Every worked task is solved, and its facts and misses are checked without `synth.robot`.

The kinematics below follow the conventions of the file format, from the arcs and joint angles that a
solution states. The shapes that targets were planted with are checked in the same way, so that the
source of a fact is no mere claim. Facts are in millimetres and degrees.
"""

import re
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np
import pytest
from planted_obstacles import brute_distance
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from ruamel.yaml import YAML
from scipy.spatial.transform import Rotation

import synth

PROBLEMS = Path(__file__).parents[1] / "problems"
NAMES = sorted(path.name for path in PROBLEMS.iterdir() if path.is_dir())
SLACK = 1e-6  # m and rad
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Point = Annotated[list[float], Field(min_length=3, max_length=3)]
Quantity = Literal["worst_miss", "total_bend_deg", "circle_radius", "axes_apart", "common_normal_height"]


class Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Sphere(Strict):
    centre: Point
    radius: float
    within: float


class Plane(Strict):
    height: float
    within: float


class Bend(Strict):
    length: float
    bend_radius: float | None = None  # a straight piece
    towards_deg: float = 0.0


class RigidLink(Strict):
    d35: float
    d45: float


class Planted(Strict):
    arcs: list[Bend]
    rigid_link: RigidLink | None = None
    joints_deg: dict[str, Pair]
    within: float


class Facts(Strict):
    source: str
    status: Literal["found", "best_effort", "proven_impossible"]
    between: dict[Quantity, Pair]
    sphere: Sphere | None = None
    plane: Plane | None = None
    planted: Planted | None = None


def turned(points, angle):
    """Return points turned about z."""
    (x, y, z), cosine, sine = points.T, np.cos(angle), np.sin(angle)
    return np.column_stack([cosine * x - sine * y, sine * x + cosine * y, z])


def inside(values, interval):
    return np.all((interval.lower - SLACK <= values) & (values <= interval.upper + SLACK))


class Shape(NamedTuple):
    """A robot in one shape: curvatures and lengths of its arcs, and its rigid link, in metres."""

    task: synth.Task
    curvatures: np.ndarray
    lengths: np.ndarray
    d35: float
    d45: float

    @classmethod
    def stated(cls, task, solution):
        arcs = solution["link"]["arcs"]
        return cls(
            task,
            np.array([arc["curvature"] for arc in arcs]),
            np.array([arc["length"] for arc in arcs]),
            solution["distances"]["35"],
            solution["distances"]["45"],
        )

    @classmethod
    def planted(cls, task, planted):
        towards = np.radians([arc.towards_deg for arc in planted.arcs])
        bends = np.array([1e3 / arc.bend_radius if arc.bend_radius else 0.0 for arc in planted.arcs])
        curvatures = bends[:, None] * np.column_stack([np.cos(towards), np.sin(towards)])
        rigid, chosen = task.robot.rigid_link, planted.rigid_link
        d35, d45 = (chosen.d35 / 1e3, chosen.d45 / 1e3) if chosen else (rigid.d35.lower, rigid.d45.lower)
        return cls(task, curvatures, np.array([arc.length for arc in planted.arcs]) / 1e3, d35, d45)

    @property
    def bends(self):
        return np.linalg.norm(self.curvatures, axis=1)

    def link(self):
        """Return the end frame and points of the centreline, each arc cut into 20."""
        frame, points = np.eye(3), [np.array([0.0, 0.0, self.task.robot.d12])]
        for (kx, ky), length in zip(self.curvatures, self.lengths / 20, strict=True):
            k = max(np.hypot(kx, ky), 1e-9)
            sideways = (1.0 - np.cos(k * length)) / k**2
            step = np.array([kx * sideways, ky * sideways, np.sin(k * length) / k])
            turn = Rotation.from_rotvec([-length * ky, length * kx, 0.0]).as_matrix()
            for _ in range(20):
                points.append(points[-1] + frame @ step)
                frame = frame @ turn
        return frame, np.array(points)

    def circle(self):
        """Return P3 and P4, the direction u of axis 2, and centre and radius of P5's circle."""
        robot, (frame, points) = self.task.robot, self.link()
        u, s35 = frame[:, 0], self.d35**2
        p3 = points[-1] - robot.tip_offset * u
        a = (s35 - self.d45**2 + robot.d34**2) / (2 * robot.d34)
        return np.array([p3, p3 + robot.d34 * u]), u, p3 + a * u, np.sqrt(s35 - a**2)

    def end_effector(self, joints):
        """Return P5 in the base frame for joint angles, shape (n, 2), rad."""
        frame, (_, u, c, radius) = self.link()[0], self.circle()
        theta1, theta2 = np.asarray(joints).T
        t = frame[:, 2]
        at_zero = c - radius * (np.cos(theta2)[:, None] * t + np.sin(theta2)[:, None] * np.cross(u, t))
        return turned(at_zero, theta1)

    def misses(self, joints):
        base = self.task.base
        reached = turned(self.end_effector(joints), base.yaw) + base.position
        return np.linalg.norm(reached - [target.position for target in self.task.targets], axis=1)

    def sweep(self):
        """Return P5 all along the range of joint 2: the workspace, but for the turn of joint 1."""
        second = self.task.robot.joint_limits.second
        theta2 = np.linspace(second.lower, second.upper, 200)
        return self.end_effector(np.column_stack([np.full(200, np.pi), theta2]))

    def check_limits(self, joints):
        robot, floor = self.task.robot, -np.inf if self.task.floor is None else self.task.floor
        theta1, theta2 = np.asarray(joints).T
        assert inside(theta1, robot.joint_limits.base)
        assert inside(theta2, robot.joint_limits.second)
        assert inside(self.lengths.sum(), robot.link.length)
        assert self.bends.max() * robot.link.min_bend_radius <= 1.0 + SLACK
        assert self.bends @ self.lengths <= robot.link.max_total_bend + SLACK
        assert inside(self.d35, robot.rigid_link.d35)
        assert inside(self.d45, robot.rigid_link.d45)
        # The tube is as thick below its centreline as above, but for its first half diameter in the mount.
        tube = self.link()[1][4:] - [0.0, 0.0, 0.5 * robot.link.diameter]
        for points in (tube, self.circle()[0], self.end_effector(joints)):
            assert points[:, 2].min() >= floor - SLACK

    def clearances(self, joints):
        """Return how far points of tube and rigid link keep from the obstacles at each target, m."""
        points = self.link()[1]
        least = []
        for theta1, tip in zip(np.asarray(joints)[:, 0], self.end_effector(joints), strict=True):
            link = turned(points, np.array(theta1))
            rod = link[-1] + np.linspace(0.0, 1.0, 200)[:, None] * (tip - link[-1])
            solids = [obstacle.solid for obstacle in self.task.obstacles]
            least.append(
                min(
                    min(
                        brute_distance(solid, link[5:]).min() - 0.5 * self.task.robot.link.diameter,
                        brute_distance(solid, rod).min(),
                    )
                    for solid in solids
                )
            )
        return np.array(least)

    def measured(self, joints):
        """Return what `between` may speak of, in mm and deg."""
        _, u, c, radius = self.circle()
        foot = c - u * (c[:2] @ u[:2]) / max(u[:2] @ u[:2], 1e-12)  # nearest to axis 1 on axis 2
        return {
            "worst_miss": 1e3 * self.misses(joints).max(),
            "total_bend_deg": np.degrees(self.bends @ self.lengths),
            "circle_radius": 1e3 * radius,
            "axes_apart": 1e3 * np.hypot(foot[0], foot[1]),
            "common_normal_height": 1e3 * foot[2],
        }


def facts_of(name):
    content = YAML(typ="safe").load(PROBLEMS / name / "facts.yaml")
    return Facts.model_validate(content)


@pytest.mark.parametrize("name", NAMES)
def test_problem(name):
    facts, task = facts_of(name), synth.load_task(PROBLEMS / name / "task.yaml")
    solution = synth.solution_to_json(synth.solve(task))
    assert solution["status"] == facts.status, solution["message"]

    targets, shape = solution["targets"], Shape.stated(task, solution)
    joints = [target["joints"] for target in targets]
    shape.check_limits(joints)
    for target, given, miss in zip(targets, task.targets, shape.misses(joints), strict=True):
        assert target["name"] == given.name
        assert abs(miss - target["miss"]) <= SLACK, target
        assert target["within_tolerance"] == (miss <= given.tolerance), target
    assert all(target["within_tolerance"] for target in targets) == (facts.status == "found")

    if task.obstacles:
        stated = np.array([target["clearance"] for target in targets])
        assert (stated >= -SLACK).all()
        # A lower bound, less what lies between the points, 8 mm apart.
        assert (stated <= shape.clearances(joints) + SLACK).all()
        assert (stated >= np.minimum(shape.clearances(joints), 0.1) - 5e-3).all()

    measured = shape.measured(joints)
    for quantity, (low, high) in facts.between.items():
        assert low <= measured[quantity] <= high, quantity
    swept = 1e3 * shape.sweep()
    if sphere := facts.sphere:
        distances = np.linalg.norm(swept - sphere.centre, axis=1)
        assert np.abs(distances - sphere.radius).max() <= sphere.within
    if plane := facts.plane:
        assert np.abs(swept[:, 2] - plane.height).max() <= plane.within


@pytest.mark.parametrize("name", [name for name in NAMES if facts_of(name).planted])
def test_planted_shape_is_what_its_facts_say(name):
    facts, task = facts_of(name), synth.load_task(PROBLEMS / name / "task.yaml")
    shape = Shape.planted(task, facts.planted)
    assert list(facts.planted.joints_deg) == [target.name for target in task.targets]
    joints = np.radians(list(facts.planted.joints_deg.values()))
    shape.check_limits(joints)
    assert shape.misses(joints).max() <= facts.planted.within / 1e3
    if task.obstacles:
        assert shape.clearances(joints).min() >= 0.0
    if facts.status == "found":
        assert facts.planted.within / 1e3 <= task.tolerances.min()


def test_facts_that_are_misspelt_are_refused():
    content = YAML(typ="safe").load(PROBLEMS / "sphere" / "facts.yaml")
    for wrong in (
        {"catgory": "spherical"},
        {"between": {"worst": [0, 1]}},
        {"sphere": {"centre": [0, 0, 0], "radius": 700, "within": 5, "radious": 1}},
    ):
        with pytest.raises(ValidationError):
            Facts.model_validate(content | wrong)


def test_every_folder_has_its_three_files_and_its_row_in_the_index():
    rows = []
    for name in NAMES:
        assert sorted(path.name for path in (PROBLEMS / name).iterdir()) == [
            "README.md",
            "facts.yaml",
            "task.yaml",
        ]
        story = (PROBLEMS / name / "README.md").read_text(encoding="utf-8")
        assert f"synth solve problems/{name}/task.yaml" in story
        title = story.splitlines()[0].removeprefix("# ")
        rows.append(f"| [{name}]({name}/README.md) | {title} | {facts_of(name).status} |")
    index = (PROBLEMS / "README.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\| \[.*\|$", index, flags=re.MULTILINE)) == rows
