"""The facts of the worked tasks in `problems/`, and whether a solution agrees with them, by the oracle.

Facts are in millimetres and degrees.
"""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from oracle import SLACK, OracleArm
from oracle_kinematics import turned
from pydantic import BaseModel, ConfigDict, Field
from ruamel.yaml import YAML
from scipy.spatial import cKDTree

import synth
from synth.geometry import Box
from synth.robot import BasePose

PROBLEMS = Path(__file__).parents[1] / "problems"
NAMES = sorted(path.name for path in PROBLEMS.iterdir() if path.is_dir())
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
    joints_deg: dict[str, Pair] = {}
    waypoint_joints_deg: list[Pair] = []
    within: float


class Facts(Strict):
    source: str
    status: Literal["found", "best_effort", "proven_impossible"]
    between: dict[Quantity, Pair]
    sphere: Sphere | None = None
    plane: Plane | None = None
    planted: Planted | None = None


def facts_of(name):
    return Facts.model_validate(YAML(typ="safe").load(PROBLEMS / name / "facts.yaml"))


def task_of(name):
    return synth.load_task(PROBLEMS / name / "task.yaml")


def planted_arm_of(task, planted):
    """Return the arm that the facts say the targets were planted with."""
    towards = np.radians([arc.towards_deg for arc in planted.arcs])
    bends = np.array([1e3 / arc.bend_radius if arc.bend_radius else 0.0 for arc in planted.arcs])
    curvatures = bends[:, None] * np.column_stack([np.cos(towards), np.sin(towards)])
    rigid, chosen = task.robot.rigid_link, planted.rigid_link
    d35, d45 = (chosen.d35 / 1e3, chosen.d45 / 1e3) if chosen else (rigid.d35.lower, rigid.d45.lower)
    lengths = np.array([arc.length for arc in planted.arcs]) / 1e3
    return OracleArm(task.robot, curvatures, lengths, d35, d45, task.base.position, task.base.yaw)


def measured(task, arm, joints):
    """Return what `between` may speak of, in mm and deg."""
    u, (centre, radius) = arm.end[0][:, 0], arm.circle
    foot = centre - u * (centre[:2] @ u[:2]) / max(u[:2] @ u[:2], 1e-12)  # nearest to axis 1 on axis 2
    return {
        "worst_miss": 1e3 * arm.misses(joints, task.table.positions).max(),
        "total_bend_deg": np.degrees(arm.total_bend),
        "circle_radius": 1e3 * radius,
        "axes_apart": 1e3 * np.hypot(foot[0], foot[1]),
        "common_normal_height": 1e3 * foot[2],
    }


def sweep(task, arm):
    """Return P5 all along the range of joint 2, mm: the workspace, but for the turn of joint 1."""
    second = task.robot.joint_limits.second
    theta2 = np.linspace(second.lower, second.upper, 200)
    return 1e3 * arm.end_effector(np.column_stack([np.full(200, np.pi), theta2]))


def directions_broken(task, arm, joints):
    """Return where the rigid link points otherwise than a target asks for, as sentences."""
    centre, _ = arm.circle
    for target, (theta1, theta2) in zip(task.targets, joints, strict=True):
        if target.approach is None:
            continue
        pointing = arm.reached(np.array([[theta1, theta2]]))[0] - arm.to_task(turned(centre, theta1))
        angle = np.arccos(pointing @ target.approach.direction / np.linalg.norm(pointing))
        if angle > target.approach.tolerance + 1e-5:
            yield f"{target.name} is arrived at {np.degrees(angle):.3f} deg beside its direction"


def limits_broken(task, arm, joints):
    """Return the limits that an arm breaks in itself or at a target, as sentences."""
    solids = [obstacle.solid for obstacle in task.obstacles]
    if not task.base.is_upright and isinstance(task.floor, float):  # the floor is no height in the base frame
        solids.append(Box([0.0, 0.0, task.floor - 50.0], [100.0, 100.0, 100.0]))
    breaches = [*arm.breaches_of_shape(task.floor_in_base)]
    for each in joints:
        breaches += arm.breaches_at(each, task.floor_in_base, solids)
    told = [f"{breach.limit} broken by {breach.amount:.2e}" for breach in breaches]
    if not arm.is_topology(task.topology.value):
        told.append(f"not {task.topology.value}")
    return told


def broken_facts(facts, task, solution):
    """Return what a solution says or is against the facts, as sentences; none where all holds."""
    content = synth.solution_to_json(solution)
    told = [] if content["status"] == facts.status else [f"status {content['status']}: {content['message']}"]
    if content["link"] is None:
        return [*told, "no shape"]
    if task.places is not None:
        stands = BasePose(**content["base"])
        if not task.places.contains(stands):
            told.append(f"the base stands at {stands}")
        task = task.standing_at(stands)
    arm = OracleArm.stated(task, content)
    joints = np.array([target["joints"] for target in content["targets"]])
    whole, place = task, {name: index for index, name in enumerate(task.table.names)}
    of = [place[target["name"]] for target in content["targets"]]
    if len(of) < len(place):  # of many the worst are told
        task = task.asking_for(task.table.take(np.array(of)))
    reached = np.array([target["within_tolerance"] for target in content["targets"]])
    return [
        *told,
        *limits_broken(task, arm, joints[reached] if whole.is_partial else joints),
        *directions_broken(task, arm, joints),
        *_misses_broken(task, arm, content["targets"], joints),
        *(_clearances_broken(task, arm, content["targets"]) if task.obstacles else ()),
        *_paths_broken(whole, arm, content["paths"] or []),
        *_surfaces_broken(whole, arm, content["surfaces"] or []),
        *_numbers_broken(facts, measured(task, arm, joints), sweep(task, arm)),
    ]


def _misses_broken(task, arm, targets, joints):
    misses = arm.misses(joints, task.table.positions)
    for target, given, miss in zip(targets, task.targets, misses, strict=True):
        if target["name"] != given.name:
            yield f"{given.name} is called {target['name']}"
        if abs(miss - target["miss"]) > SLACK:
            yield f"{given.name} misses by {miss}, stated {target['miss']}"
        if target["within_tolerance"] != (miss <= given.tolerance):
            yield f"{given.name} misses by {miss}, stated within tolerance: {target['within_tolerance']}"


def _numbers_broken(facts, numbers, swept):
    for quantity, (low, high) in facts.between.items():
        if not low <= numbers[quantity] <= high:
            yield f"{quantity} is {numbers[quantity]:.6g}, not between {low} and {high}"
    if sphere := facts.sphere:
        off = np.abs(np.linalg.norm(swept - sphere.centre, axis=1) - sphere.radius).max()
        if not off <= sphere.within:
            yield f"the workspace is {off:.3g} mm off the sphere"
    if plane := facts.plane:
        off = np.abs(swept[:, 2] - plane.height).max()
        if not off <= plane.within:
            yield f"the workspace is {off:.3g} mm off the plane"


def _paths_broken(task, arm, told):
    """Follow the joint angles that are told along each path, seven of them between each two."""
    for path, followed in zip(task.paths, told, strict=True):
        joints, points = np.array(followed["joints"]), np.array(followed["points"])
        share = np.linspace(0.0, 1.0, 8)[:, None, None]
        between = joints[:-1] + share * np.diff(joints, axis=0)
        fine = path.at(np.linspace(0.0, path.ends[-1], 100_001))
        along = cKDTree(fine)
        # P5 may be nearer to a point of the path other than its own, never farther from all.
        off = along.query(arm.to_task(arm.end_effector(between)).reshape(-1, 3))[0].max()
        stated = max(followed["largest"], 1e-6)
        if not off - 1e-5 <= stated <= path.tolerance:
            yield f"{path.name} is left by {off}, stated {stated}"
        if np.abs(np.diff(joints, axis=0)).max() > 0.2:
            yield f"{path.name} is followed with a jump"
        if along.query(points)[0].max() > 1e-5 or cKDTree(points).query(fine)[0].max() > 0.02:
            yield f"{path.name} is not followed all along"
        if limits_broken(task, arm, joints[:: max(len(joints) // 50, 1)]):
            yield f"{path.name} is not clear all along"


def _surfaces_broken(task, arm, told):
    """Look at each surface at ten times the samples."""
    for surface, covered in zip(task.surfaces, told, strict=True):
        cells = surface.cells(10 * len(surface.samples))
        points = cells.points[np.random.default_rng(0).permutation(len(cells))[:2500]]
        misses = arm.misses(arm.closest(points), points)
        share = float(np.mean(misses <= surface.tolerance))
        if abs(share - covered["share"]) > 0.01 or share < surface.coverage - 0.01:
            yield f"of {surface.name} {share:.3f} are covered, stated {covered['share']:.3f}"
        between = covered["between"]
        if between and surface.coverage == 1.0 and misses.max() > between["largest"] + SLACK:
            yield f"{surface.name} is missed by {misses.max()} somewhere, stated {between['largest']}"


def _clearances_broken(task, arm, targets):
    """Compare with the oracle: a stated clearance is a lower bound, to 0.1 mm, and told up to 100 mm."""
    solids, told = [obstacle.solid for obstacle in task.obstacles], []
    for target in targets:
        stated, true = target["clearance"], min(float(arm.clearances(target["joints"], solids).min()), 0.1)
        if not max(true - 1e-4, -SLACK) <= stated <= true + 2.0 * SLACK:
            told.append(f"{target['name']} is clear by {true:.6f} m, stated {stated}")
    return told
