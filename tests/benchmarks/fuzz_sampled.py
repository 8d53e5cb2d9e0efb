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

FAMILIES = ("points", "catalogue", "mesh", "scan", "path", "shape")
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
        if family == "shape" and content.get("topology", "general") == "general":
            continue
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
        if not _ask_for(fuzz, rng, family, *patch):
            continue
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


def _ask_for(fuzz: FuzzTask, rng, family: str, low, high, grid) -> bool:
    """Put obstacles and a surface or a path of a patch into a task, moved a little if it is a wild one.

    Returns:
        Whether there is one.
    """
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
    asks = {"mesh": _mesh, "scan": _scan, "path": _path, "shape": _shape}[family]
    entry = asks(fuzz, rng, low, high, move)
    if fuzz.kind == "wild":
        fuzz.planted = None
    fuzz.content = rounded(fuzz.content | (entry or {}))
    return entry is not None


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
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    some = faces[rng.choice(len(faces), size=_FINE, p=areas / areas.sum())]
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


def _shape(fuzz: FuzzTask, rng, low, high, move):
    """Return a part of the sphere or the level rectangle that an arm of a special topology covers."""
    arm, topology = fuzz.planted, fuzz.content["topology"]
    middle = arm.reached(0.5 * (low + high))
    centre = arm.to_task(arm.axis_points[1 if topology == "puma" else 0])
    radius = np.linalg.norm(middle - centre)
    size = 1e-3 * float(log_uniform(rng, 10.0, 400.0))
    for _ in range(8):
        fine = middle + rng.uniform(-size, size, (4 * _FINE, 3))
        if topology == "scara":
            fine[:, 2] = middle[2]
        else:
            fine = centre + radius * (fine - centre) / np.linalg.norm(fine - centre, axis=1, keepdims=True)
        fine = fine[np.linalg.norm(fine - middle, axis=1) <= size][:_FINE]
        if _is_reached(fuzz, fine[:60]):
            break
        size *= 0.5
    else:
        return None
    fuzz.fine["shape"] = fine
    shift = 1e3 * (move(middle) - middle)
    region = [{"sphere": {"center": 1e3 * middle, "radius": 1e3 * size}}]
    if topology == "scara":
        square = {"center": 1e3 * middle, "normal": [0, 0, 1], "along": [1, 1, 0], "size": [2e3 * size] * 2}
        asked = {"rectangle": square | {"center": square["center"] + shift}}
    else:
        asked = {"sphere": {"center": 1e3 * centre + shift, "radius": 1e3 * radius}}
    if fuzz.kind == "wild":  # then all of it is moved as one
        fuzz.fine["shape"] = fine + 1e-3 * shift
        region[0]["sphere"]["center"] = 1e3 * middle + shift
    tolerance = 1e3 * _tolerance(fuzz, rng, 0.0)
    return {"surface": {"name": "shape", **asked, "region": region, "tolerance": tolerance} | _less(rng)}


def _is_reached(fuzz: FuzzTask, points):
    """Whether an arm reaches points, and is legal and clear of everything there."""
    arm, task = fuzz.planted, parsed(fuzz.content)
    joints = arm.closest(points)
    if not len(points) or arm.misses(joints, points).max() > 1e-7:
        return False
    solids = [obstacle.solid for obstacle in task.obstacles]
    return not any(
        arm.breaches_at(each, task.floor_in_base, solids) or arm.rod_from_tube(each) < _CLEAR
        for each in joints
    )


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
