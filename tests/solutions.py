"""A solution as its file states it (synth.solution/2), written from the contract and not by the exporter."""

from __future__ import annotations

import json


def _arcs(shape):
    return [
        {"curvature": list(k), "length": length}
        for k, length in zip(shape.curvatures.tolist(), shape.lengths.tolist(), strict=True)
    ]


def _distances(arm):
    return {"35": arm.d35, "45": arm.d45}


def solution_document(task, designs):
    robot, arm = task.robot, designs[0].arm
    link, rigid, limits = robot.link, robot.rigid_link, robot.joint_limits

    def pair(interval):
        return [interval.lower, interval.upper]

    return {
        "schema": "synth.solution/2",
        "status": "found" if designs[0].verification.found else "best_effort",
        "message": "as found",
        "task": {
            "name": task.name,
            "robot": {
                "name": robot.name,
                "d12": robot.d12,
                "link": {
                    "length": pair(link.length),
                    "min_bend_radius": link.min_bend_radius,
                    "diameter": link.diameter,
                    "max_total_bend": link.max_total_bend,
                },
                "tip_offset": robot.tip_offset,
                "d34": robot.d34,
                "rigid_link": {"d35": pair(rigid.d35), "d45": pair(rigid.d45), "diameter": rigid.diameter},
                "joint_limits": {"base": pair(limits.base), "second": pair(limits.second)},
            },
            "base": {"position": task.base.position.tolist(), "yaw": task.base.yaw},
            "floor": task.floor_height,
            "topology": task.topology.value,
            "objective": task.objective.value,
            "targets": [
                {
                    "name": t.name,
                    "position": list(map(float, t.position)),
                    "tolerance": t.tolerance,
                    "weight": t.weight,
                }
                for t in task.targets
            ],
            "obstacles": [],
        },
        "distances": _distances(arm),
        "link": {"arcs": _arcs(arm.shape)},
        "alternatives": [
            {"distances": _distances(d.arm), "link": {"arcs": _arcs(d.arm.shape)}} for d in designs[1:]
        ],
    }


def write_solution(path, task, designs):
    path.write_text(json.dumps(solution_document(task, designs)))
    return path


def write_markers(path, readings):
    """Write readings as the plain CSV, in millimetres and degrees."""
    import numpy as np  # noqa: PLC0415

    rows = ["marker,x_mm,y_mm,z_mm,joint1_deg,joint2_deg"]
    for name, point, joints in zip(readings.names, readings.positions, readings.joints, strict=True):
        rows.append(",".join([name, *(repr(float(v)) for v in [*(1e3 * point), *np.degrees(joints)])]))
    path.write_text("\n".join(rows) + "\n")
    return path
