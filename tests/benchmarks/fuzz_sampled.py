"""Random tasks with surfaces and paths, on robots of all kinds, some of them with catalogues of rigid links.

What is planted is a patch of the joint angles of a legal shape, in which it is clear of everything: a mesh,
points or a path of it, with a tolerance that the planted arm keeps with room to spare, by the oracle. Of a
wild task every point is moved a little, smoothly, and nobody knows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from fuzz_catalogues import catalogued, with_catalogue
from fuzz_drawn import FuzzTask, is_meant, parsed
from fuzz_robots import log_uniform, random_content, rounded
from fuzz_tasks import ROOM, fuzz_task, legal_joints, planted_arm, with_obstacles
from oracle import OracleArm, distance_from_solid, longest_rod
from planted_paths import joint_curve

FAMILIES = ("points", "catalogue", "mesh", "scan", "path")
_WILD = 0.3  # share of the tasks
_CATALOGUE = 0.4  # share of the sampled ones
_GRID = 7  # postures of a patch either way in which the arm must be legal
_CLEAR = 1e-3  # m, between them
_FINE = 1500  # points that the oracle looks at


def drawn(number: int, family: str) -> FuzzTask:
    """Return the task of a number in a family."""
    if family == "points":
        return fuzz_task(number)
    if family == "catalogue":
        return with_catalogue(number)
    return _sampled(number, family)


def _sampled(number: int, family: str) -> FuzzTask:
    """Return a task with a surface or a path."""
    rng = np.random.default_rng([number, 12, FAMILIES.index(family)])
    kind = "wild" if rng.uniform() < _WILD else "planted"
    while True:
        tags: list[str] = [family]
        content = random_content(rng, tags)
        task = parsed(content)
        arm = planted_arm(task, rng)
        patch = None if arm is None else _patch(task, arm, rng)
        if patch is None:
            continue
        if rng.uniform() < _CATALOGUE:
            content = catalogued(rng, content, task.robot, (arm.d35, arm.d45))
            arm = replace(arm, robot=parsed(content).robot)
            tags.append("catalogue")
        content = {"synth": content["synth"], "name": f"fuzz {number}"} | content
        fuzz = FuzzTask(number, kind, content, arm, tags=tags)
        _ask_for(fuzz, rng, family, *patch)
        if is_meant({key: fuzz.content[key] for key in fuzz.content if key not in {"surface", "path"}}):
            return fuzz


def _patch(task, arm: OracleArm, rng):
    """Return the ends of joint angles in which an arm is legal and clear of itself and the floor, or None."""
    middle = legal_joints(task, arm, 1, rng)
    if middle is None:
        return None
    limits = task.robot.joint_limits
    lower, upper = (
        np.array([getattr(limits.base, end), getattr(limits.second, end)]) for end in ("lower", "upper")
    )
    width = log_uniform(rng, [0.1, 0.1], [2.0, 1.5])
    low = np.maximum(middle[0] - rng.uniform(0.2, 0.8, 2) * width, lower + 1e-3 * (upper - lower))
    high = np.minimum(low + width, upper - 1e-3 * (upper - lower))
    grid = np.stack(np.meshgrid(*np.linspace(low, high, _GRID).T, indexing="ij"), axis=-1).reshape(-1, 2)
    for joints in grid:
        floor = None if task.floor_in_base is None else task.floor_in_base + _CLEAR
        if arm.breaches_at(joints, floor) or arm.rod_from_tube(joints) < _CLEAR:
            return None
    return low, high, grid


def _ask_for(fuzz: FuzzTask, rng, family: str, low, high, grid) -> None:
    """Put obstacles and a surface or a path of a patch into a task, moved a little if it is a wild one."""
    arm = fuzz.planted
    task = parsed(fuzz.content)
    size = 1e3 * (task.robot.link.length.upper + longest_rod(task.robot))
    p2, middle = arm.to_task(arm.axis_points[1]), 1e3 * arm.reached(grid).mean(axis=0)
    fuzz.content = with_obstacles(
        parsed,
        fuzz.content,
        middle,
        size,
        rng,
        lambda solid: (
            distance_from_solid(solid, p2) > arm.tube_radius + ROOM
            and arm.clearance(grid, [solid]) >= 5.0 * ROOM
        ),
    )
    move = _moved(fuzz, rng, size)
    entry = {"mesh": _mesh, "scan": _scan, "path": _path}[family](fuzz, rng, low, high, move)
    if fuzz.kind == "wild":
        fuzz.planted = None
    fuzz.content = rounded(fuzz.content | entry)


def _moved(fuzz: FuzzTask, rng, size):
    """Return what moves points of a wild task smoothly, by a little; those of a planted one stay."""
    if fuzz.kind == "planted":
        return lambda points: points
    wave, phase = rng.normal(size=(3, 3)) * 2e3 / size, rng.uniform(0.0, 2.0 * np.pi, 3)
    by = log_uniform(rng, 1e-4, 0.05) * size * 1e-3
    fuzz.why = f"moved by {1e3 * by:.2f} mm"
    return lambda points: points + by * np.sin(points @ wave + phase)


def _tolerance(fuzz: FuzzTask, rng, off):
    """Return a tolerance, m, that an arm keeps which is off by so much, with room to spare."""
    room = float(off) * rng.uniform(1.5, 4.0) if fuzz.kind == "planted" else 0.0
    return max(room, 1e-3 * float(log_uniform(rng, 0.05, 10.0)))


def _mesh(fuzz: FuzzTask, rng, low, high, move):
    """Return a mesh of a patch; its triangles cut corners."""
    arm, counts = fuzz.planted, rng.integers(4, 40, 2)
    theta1, theta2 = (np.linspace(*ends, n + 1) for *ends, n in zip(low, high, counts, strict=True))
    joints = np.stack(np.meshgrid(theta1, theta2, indexing="ij"), axis=-1)
    grid = move(arm.reached(joints))
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    some = faces[rng.integers(len(faces), size=_FINE)]
    fine = np.einsum("nc,ncx->nx", rng.dirichlet(np.ones(3), _FINE), some)
    off = arm.misses(arm.closest(fine), fine).max()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (1e3 * faces).reshape(-1, 3).tolist()]
    lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(len(faces))]
    fuzz.files["patch.obj"], fuzz.fine["patch"] = "\n".join(lines) + "\n", fine
    surface = {"name": "patch", "mesh": "patch.obj", "tolerance": 1e3 * _tolerance(fuzz, rng, off)}
    return {"surface": surface | _less(rng)}


def _scan(fuzz: FuzzTask, rng, low, high, move):
    """Return points of a patch, some with noise, and some with outliers that may be left."""
    count = int(log_uniform(rng, 20, 2000))
    points = move(fuzz.planted.reached(rng.uniform(low, high, (count, 2))))
    if rng.uniform() < 0.4:
        points = points + rng.normal(size=points.shape) * 1e-3 * log_uniform(rng, 0.01, 5.0)
    off = fuzz.planted.misses(fuzz.planted.closest(points), points).max()
    surface = {"name": "scan", "points": "scan.csv", "tolerance": 1e3 * _tolerance(fuzz, rng, off)}
    surface |= _less(rng)
    wrong = rng.choice(count, int((1.0 - surface.get("coverage", 1.0)) * count), replace=False)
    if rng.uniform() < 0.5:
        points[wrong] += rng.normal(size=(len(wrong), 3)) * 0.1
    rows = [f"{x!r},{y!r},{z!r}" for x, y, z in (1e3 * points).tolist()]
    fuzz.files["scan.csv"], fuzz.fine["scan"] = "\n".join(["x,y,z", *rows]) + "\n", points
    return {"surface": surface}


def _less(rng):
    """Return how much of a surface is asked for: mostly all of it."""
    return {"coverage": rng.uniform(0.3, 0.95)} if rng.uniform() < 0.3 else {}


def _path(fuzz: FuzzTask, rng, low, high, move):
    """Return waypoints that an arm passes as its joints turn smoothly, and what is between them."""
    spline = rng.uniform() < 0.4
    count = int(rng.integers(4, 30)) if spline else int(log_uniform(rng, 2, 200))
    joints = joint_curve(int(rng.integers(1_000_000)), low, high, count)
    waypoints = move(fuzz.planted.reached(joints))
    path = {
        "name": "path",
        "waypoints": 1e3 * waypoints,
        "interpolation": "spline" if spline else "straight",
    }
    (read,) = parsed(rounded(fuzz.content | {"path": path})).paths
    # The joints turn evenly between waypoints, and P5 is then compared with the path at the same share.
    share = np.linspace(0.0, 1.0, 33)[:-1, None, None]
    between = (joints[:-1] + share * np.diff(joints, axis=0)).reshape(-1, 2)
    ends = np.asarray(read.ends)
    along = (ends[:-1] + share[..., 0] * np.diff(ends)).ravel()
    fine = read.at(along)
    off = fuzz.planted.misses(between, fine).max()
    fuzz.fine["path"] = fine
    path["tolerance"] = 1e3 * _tolerance(fuzz, rng, off)
    if rng.uniform() < 0.5:
        path["speed"] = float(log_uniform(rng, 1.0, 500.0))
    return {"path": path}
