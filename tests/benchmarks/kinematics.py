"""How long forward and inverse kinematics take, beside pinocchio and the Robotics Toolbox where installed.

    python tests/benchmarks/kinematics.py [--points 1000000]

Times are of the processor, of one core; each is the best of a few runs.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from planted import planted_arm
from robot_files import solution_with

if TYPE_CHECKING:
    from collections.abc import Callable


def best_time(run: Callable[[], object], repeats: int = 20) -> float:
    """Return the least time of the processor that something takes, s."""
    times = []
    for _ in range(repeats):
        began = time.process_time()
        run()
        times.append(time.process_time() - began)
    return min(times)


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=1_000_000)
    count = parser.parse_args().points
    arm = planted_arm(np.random.default_rng(3))
    joints = np.random.default_rng(0).uniform(*arm.joint_bounds, (count, 2))
    points = arm.forward_kinematics(*joints.T)
    few, rows = 1000, []
    forward = best_time(lambda: arm.forward_kinematics(*joints.T))
    rows.append(("synth, forward, arrays", forward / count))
    inverse = best_time(lambda: arm.inverse_kinematics(points, within=1e-6))
    rows.append(("synth, inverse, arrays", inverse / count))
    miss = arm.inverse_kinematics(points, within=1e-6).miss[:, 0].max()
    single = best_time(lambda: [arm.inverse_kinematics(point, within=1e-6) for point in points[:few]])
    rows.append(("synth, inverse, one point", single / few))
    single = best_time(lambda: [arm.inverse_kinematics(point) for point in points[:few]])
    rows.append(("synth, inverse, one, no bound", single / few))
    postures = joints[:few].tolist()
    single = best_time(lambda: [arm.forward_kinematics(*posture) for posture in postures])
    rows.append(("synth, forward, one posture", single / few))
    with tempfile.TemporaryDirectory() as folder:
        urdf = str(solution_with(arm).export(folder, "urdf")[0])
        rows += list(others(urdf, joints[:few]))
    for name, seconds in rows:
        print(f"{name:<34} {1e6 * seconds:9.3f} us {1.0 / seconds:12.0f} a second")
    print(f"largest miss of the inverse: {miss:.1e} m")


def others(urdf: str, joints: np.ndarray) -> list[tuple[str, float]]:
    """Return how long others take for the forward kinematics of one posture, s."""
    rows = []
    warnings.simplefilter("ignore")
    if importlib.util.find_spec("pinocchio"):
        import pinocchio  # noqa: PLC0415

        model = pinocchio.buildModelFromUrdf(urdf)
        data = model.createData()
        run = lambda: [pinocchio.framesForwardKinematics(model, data, each) for each in joints]  # noqa: E731
        rows.append(("pinocchio, forward, one posture", best_time(run) / len(joints)))
    if importlib.util.find_spec("roboticstoolbox"):
        import roboticstoolbox  # noqa: PLC0415

        robot = roboticstoolbox.Robot.URDF(urdf)
        run = lambda: [robot.fkine(each, end="tool0") for each in joints]  # noqa: E731
        rows.append(("Robotics Toolbox, forward, one", best_time(run) / len(joints)))
    return rows


if __name__ == "__main__":
    main()
