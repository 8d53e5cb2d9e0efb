"""Random robots, obstacles and what else a task says beside its targets."""

from __future__ import annotations

import numpy as np

TOPOLOGIES = {"any": 0.6, "general": 0.1, "puma": 0.1, "scara": 0.1, "spherical": 0.1}


def chosen(rng, shares):
    return str(rng.choice(list(shares), p=list(shares.values())))


def log_uniform(rng, low, high, size=None):
    return np.exp(rng.uniform(np.log(low), np.log(high), size))


def rounded(value):
    """Return numbers that YAML prints and reads alike."""
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [rounded(item) for item in value]
    return float(value) if isinstance(value, float | np.floating) else value


def random_robot(rng, tags):
    """Return a robot as a mapping in mm."""
    if rng.uniform() < 0.25:
        tags.append("preset")
        return "malleable-2dof"
    radius = log_uniform(rng, 40.0, 300.0)
    lower = radius * log_uniform(rng, 1.5, 8.0)
    upper = lower * rng.choice([1.0, rng.uniform(1.0, 1.2), rng.uniform(1.2, 2.0)])
    link = {"length": lower if upper == lower else [lower, upper], "min_bend_radius": radius}
    if rng.uniform() < 0.7:
        link["diameter"] = radius * rng.uniform(0.05, 0.9)
    if rng.uniform() < 0.6:
        link["max_total_bend_deg"] = rng.uniform(60.0, 450.0)
    d34 = log_uniform(rng, 20.0, 200.0)
    robot = {"d12": log_uniform(rng, 10.0, 300.0), "link": link, "d34": d34}
    tip = 0.5 * d34
    if rng.uniform() < 0.5:
        tip = rng.uniform(-0.5, 1.5) * d34
        robot["tip_offset"] = tip
    robot["rigid_link"] = random_rigid_link(rng, tip, d34, lower, tags)
    limits = {}
    for name, around in (("base", rng.uniform(-180.0, 360.0)), ("second", 180.0)):
        kind = rng.choice(["absent", "wide", "narrow"], p=[0.25, 0.45, 0.3])
        if kind == "absent":
            continue
        width = rng.uniform(200.0, 360.0) if kind == "wide" else log_uniform(rng, 10.0, 200.0)
        middle = around + rng.uniform(-60.0, 60.0)
        limits[name] = [middle - 0.5 * width, middle + 0.5 * width]
        tags.append(f"{kind} {name}")
    if limits:
        robot["joint_limits_deg"] = limits
    return robot


def random_rigid_link(rng, tip, d34, length, tags):
    """Return d35 and d45 in mm: fixed, one free, or both; some ranges reach a flat triangle, R = 0."""
    reach, aside = length * rng.uniform(0.2, 1.2), rng.normal() * 0.3 * d34
    d35, d45 = np.hypot(reach, tip + aside), np.hypot(reach, tip + aside - d34)
    free = rng.choice(["fixed", "d35", "d45", "both"], p=[0.55, 0.1, 0.1, 0.25])
    flat = free != "fixed" and rng.uniform() < 0.4
    # The triangle is flat where d35 and d45 differ by d34.
    share = rng.uniform(1.2, 3.0) * d34 / min(d35, d45) if flat else rng.uniform(0.005, 0.15)
    share = min(share, 0.9)
    rigid = {"d35": d35, "d45": d45}
    for name in ("d35", "d45"):
        if free in {name, "both"}:
            rigid[name] = [rigid[name] * (1.0 - share), rigid[name] * (1.0 + share * rng.uniform(0.2, 1.0))]
    if rng.uniform() < 0.4:
        rigid["diameter"] = rng.uniform(2.0, 40.0)
    tags.append(f"rigid {free}" + (" flat" if flat else ""))
    return rigid


def random_content(rng, tags):
    """Return a task without targets and obstacles, as a mapping in mm."""
    content = {"synth": 1, "length_unit": "mm", "robot": random_robot(rng, tags)}
    topology = chosen(rng, TOPOLOGIES)
    if topology != "any":
        content["topology"] = topology
        tags.append(topology)
    if rng.uniform() < 0.4:
        content["objective"] = "minimax"
        tags.append("minimax")
    floor = rng.choice(["absent", "null", "low", "high"], p=[0.4, 0.25, 0.2, 0.15])
    d12 = content["robot"]["d12"] if isinstance(content["robot"], dict) else 58.0
    if floor == "null":
        content["floor"] = None
    elif floor == "low":
        content["floor"] = -rng.uniform(20.0, 400.0)
    elif floor == "high":
        content["floor"] = d12 * rng.uniform(0.1, 0.9)
    if rng.uniform() < 0.5:
        # A floor that is written is a height above the base here: only with P1 at z = 0 has it one reading.
        height = 0.0 if floor in {"low", "high"} else rng.normal() * 300.0
        content["base"] = {
            "position": [*(rng.normal(size=2) * 300.0), height],
            "yaw_deg": rng.uniform(-180.0, 180.0),
        }
    tags.append(f"floor {floor}")
    return rounded(content)


def random_obstacle(rng, size, around):
    """Return a solid as a mapping in mm, about a point in mm."""
    centre = around + rng.normal(size=3) * 0.4 * size
    kind = rng.choice(["sphere", "box", "capsule"])
    if kind == "sphere":
        return {"sphere": {"center": centre, "radius": log_uniform(rng, 0.01, 0.3) * size}}
    if kind == "box":
        extent = log_uniform(rng, 0.01, 0.7, 3) * size
        return {"box": {"center": centre, "size": extent, "yaw_deg": rng.uniform(-180.0, 180.0)}}
    along = rng.normal(size=3) * 0.3 * size
    radius = log_uniform(rng, 0.005, 0.1) * size
    return {"capsule": {"from": centre - along, "to": centre + along, "radius": radius}}
