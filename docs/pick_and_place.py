"""A crate carried from one place to another in MuJoCo: `python docs/pick_and_place.py` draws it, with no display.

The model is the exported one, and its motors are led along the trajectory of the solution. A gripper is not modelled: from
pick to place the crate is welded to P5, and its weight held up as that of the arm is.
"""

from __future__ import annotations

import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

os.environ.setdefault("MUJOCO_GL", "egl")  # before MuJoCo is imported: drawn without a display

import mujoco
import numpy as np
from colours import BLUE, INK, ORANGE
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import synth

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "pictures" / "pick-and-place.png"
PAUSE = 1.5  # s at each target
SETTLED = 1.4  # s after it was reached, when the motors have caught up
CRATE = 0.03  # m, half its size
STEP = 5e-4  # s: short beside the time in which the motors move a crate
PASSED = {"contype": 0, "conaffinity": 0}  # what the arm may pass through
STAND, BOX = {"rgba": [0.7, 0.7, 0.7, 1.0], **PASSED}, {"rgba": [0.84, 0.37, 0.0, 1.0], **PASSED}
UNDER_WAY = 0.6  # of the time from pick to place


def solution() -> synth.Solution:
    """Solve the two crates with a rigid link that is 16 mm thick, so that it can be seen."""
    task = synth.load_task(ROOT / "problems" / "two-crates" / "task.yaml")
    rod = replace(task.robot.rigid_link, diameter=0.016)
    return synth.solve(replace(task, robot=replace(task.robot, rigid_link=rod)))


def model_of(solution: synth.Solution) -> tuple[Any, Any]:
    """Return the exported model with a crate below the first target, and its state at the first target."""
    with tempfile.TemporaryDirectory() as folder:
        solution.export(folder, "mjcf")
        spec = mujoco.MjSpec.from_file(str(Path(folder) / "robot.xml"))
    start = solution.targets[0].reached - [0.0, 0.0, CRATE]
    crate = spec.worldbody.add_body(name="crate", pos=start, gravcomp=1.0)
    crate.add_freejoint()
    box = mujoco.mjtGeom.mjGEOM_BOX
    crate.add_geom(type=box, size=[CRATE] * 3, mass=0.2, **BOX)
    for target in solution.targets:  # stands, to be seen only
        height = 0.5 * (target.position[2] - 2.0 * CRATE)
        where = [*target.position[:2], height]
        spec.worldbody.add_geom(type=box, size=[CRATE, CRATE, height], pos=where, **STAND)
    weld = {"type": mujoco.mjtEq.mjEQ_WELD, "objtype": mujoco.mjtObj.mjOBJ_BODY, "name2": "crate"}
    spec.add_equality(name="grip", name1="tool0", active=False, **weld)
    _lit(spec)
    spec.option.timestep = STEP
    model = spec.compile()
    data = mujoco.MjData(model)
    first = solution.targets[0].joints
    data.qpos[:2] = data.ctrl[:] = first
    mujoco.mj_forward(model, data)
    return model, data


def _lit(spec: Any) -> None:
    """Make a model bright enough to be printed."""
    spec.visual.headlight.ambient[:] = spec.visual.headlight.diffuse[:] = 0.45
    sky, gradient = mujoco.mjtTexture.mjTEXTURE_SKYBOX, mujoco.mjtBuiltin.mjBUILTIN_GRADIENT
    spec.add_texture(type=sky, builtin=gradient, rgb1=[1, 1, 1], rgb2=[0.8, 0.85, 0.9], width=64, height=384)
    spec.geom("floor").rgba[:] = 0.6, 0.6, 0.6, 1.0
    for name, colour in (("malleable_link", [0.0, 0.45, 0.7, 1.0]), ("rigid_link", [0.1, 0.1, 0.1, 1.0])):
        for geom in spec.body(name).geoms:
            geom.rgba[:] = colour


def grip(model: Any, data: Any, *, closed: bool) -> None:
    """Weld the crate to tool0 as it stands there, or let it go."""
    weld = model.equality("grip").id
    tool, crate = data.body("tool0"), data.body("crate")
    turned, back = np.empty(4), np.empty(4)
    mujoco.mju_negQuat(back, tool.xquat)
    mujoco.mju_mulQuat(turned, back, crate.xquat)
    model.eq_data[weld, :3] = 0.0
    model.eq_data[weld, 3:6] = tool.xmat.reshape(3, 3).T @ (crate.xpos - tool.xpos)
    model.eq_data[weld, 6:10] = turned
    data.eq_active[weld] = closed


def carried(
    solution: synth.Solution, seen: Callable[[Any, Any], None] = lambda _model, _data: None
) -> dict[str, float]:
    """Carry the crate from the first target to the last.

    Args:
        solution: A solution whose best shape has all ways.
        seen: Shown the model and its state at each step.

    Returns:
        How far P5 is from each target as it rests there, m.
    """
    path = synth.trajectory(solution, pause=PAUSE)
    model, data = model_of(solution)
    misses = {}
    for target in solution.targets:
        while data.time < path.stops[target.name] + SETTLED:
            data.ctrl[:] = path.at(data.time)
            mujoco.mj_step(model, data)
            if data.ncon:
                raise RuntimeError("the arm touches something")
            seen(model, data)
        misses[target.name] = float(np.linalg.norm(data.site("P5").xpos - target.position))
        grip(model, data, closed=target is not solution.targets[-1])
    return misses


class _Film:
    """Pictures of a simulation at some times, and its joint angles."""

    def __init__(self, times: list[float]) -> None:
        self._left, self._renderer = list(times), None
        self.frames: list[np.ndarray] = []
        self.joints: list[tuple[float, ...]] = []

    def __call__(self, model: Any, data: Any) -> None:
        """Look at the state of a model."""
        self.joints.append((data.time, *data.ctrl, *data.qpos[:2]))
        if not self._left or data.time < self._left[0]:
            return
        self._left.pop(0)
        camera = mujoco.MjvCamera()
        camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = (
            [0.05, 0.17, 0.27],
            1.65,
            -60,
            -20,
        )
        self._renderer = self._renderer or mujoco.Renderer(model, 480, 560)
        self._renderer.update_scene(data, camera)
        self.frames.append(self._renderer.render())


def picture(solution: synth.Solution) -> Figure:
    """Draw the arm at the first target, under way and at the last, and its joint angles over time."""
    first, last = solution.targets[0], solution.targets[-1]
    stops = synth.trajectory(solution, pause=PAUSE).stops
    start, end = stops[first.name] + PAUSE, stops[last.name]
    film = _Film([start - 0.1, start + UNDER_WAY * (end - start), end + SETTLED - 0.01])
    misses = carried(solution, film)
    figure = Figure(figsize=(8.4, 5.2))
    FigureCanvasAgg(figure)
    titles = (
        f"{first.name}: {1e3 * misses[first.name]:.2f} mm off",
        "under way",
        f"{last.name}: {1e3 * misses[last.name]:.2f} mm off",
    )
    for index, (frame, title) in enumerate(zip(film.frames, titles, strict=True)):
        axes = figure.add_axes((0.005 + 0.332 * index, 0.5, 0.326, 0.45))
        axes.imshow(frame)
        axes.set_title(title, fontsize=10)
        axes.axis("off")
    table = np.array(film.joints)
    axes = figure.add_axes((0.08, 0.1, 0.9, 0.34))
    for index, (style, colour) in enumerate((("-", BLUE), ("--", ORANGE))):
        joint = f"joint {index + 1}"
        axes.plot(
            table[:, 0], np.degrees(table[:, 3 + index]), style, color=colour, label=f"{joint}, simulated"
        )
        axes.plot(table[:, 0], np.degrees(table[:, 1 + index]), ":", color=INK, linewidth=1.0)
    axes.plot([], [], ":", color=INK, linewidth=1.0, label="trajectory")
    axes.set(xlabel="time, s", ylabel="joint angle, deg", xlim=(0.0, table[-1, 0]))
    axes.grid(color="#e8e8e8", linewidth=0.5)
    axes.legend(fontsize=9, loc="center left")
    return figure


def main() -> None:
    """Carry the crate and draw it."""
    picture(solution()).savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
