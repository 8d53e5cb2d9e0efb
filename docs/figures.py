"""Draws all pictures of README and docs: `python docs/figures.py`, from the project's root."""

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from colours import BLUE, GREEN, GREY, INK, ORANGE, PURPLE
from figure_of_bound import bound_picture
from figure_of_revolution import revolution_picture
from figure_of_sweep import sweep_picture
from figure_of_task import task_picture
from figures_of_theory import categories_picture, cognates_picture, five_points_picture
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth import PRESETS, link_to_pose, load_task, solve
from synth.export import draw_robot, draw_sheet
from synth.guide import make_guide
from synth.measurement import nearest_realisable
from synth.measurement.distances.reading import load_measurements
from synth.robot import LinkReach

ROOT = Path(__file__).parents[1]
TASK = ROOT / "problems" / "four-targets" / "task.yaml"
PUBLISHED = ROOT / "problems" / "clark2020.yaml"
MARKERS = {
    "general": ("o", BLUE, "general"),
    "puma": ("s", ORANGE, "PUMA-like"),
    "scara": ("^", GREEN, "SCARA"),
    "spherical": ("D", PURPLE, "spherical"),
}


def robot_picture() -> Figure:
    """Draw the robot with the names of its points, axes, angles and distances."""
    figure = Figure(figsize=(7.5, 7.4))
    FigureCanvasAgg(figure)
    draw_robot(figure.add_axes((0.0, 0.0, 1.0, 1.0)), 10.0, whole=True)
    return figure


def reconfiguration_picture() -> Figure:
    """Draw where the published link can put joint 2, and where the twelve published shapes have it."""
    robot = PRESETS["malleable-2dof"]
    reach, base = LinkReach(robot.link), np.array([0.0, 0.0, robot.d12])
    figure = Figure(figsize=(7.5, 6.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.09, 0.08, 0.89, 0.9))
    rho, z = np.meshgrid(np.linspace(0.0, 0.75, 601), np.linspace(0.0, 0.8, 641))
    inside = reach.contains(np.stack([rho, np.zeros_like(rho), z], axis=-1) - base)
    axes.contourf(1e3 * rho, 1e3 * z, inside, levels=[0.5, 1.5], colors=[BLUE], alpha=0.1)
    for index, curve in enumerate(reach.boundary(361)):
        line = 1e3 * (curve + base[[0, 2]])
        line[line[:, 1] < 0.0] = np.nan
        axes.plot(
            *line.T, color=BLUE, linewidth=1.2, label=None if index else "limit of the reach, closed form"
        )
    shown = set()
    for measurement in load_measurements(PUBLISHED):
        points = nearest_realisable(measurement.distances.among(4)).points
        axis = (points[3] - points[2]) / robot.d34
        joint = points[2] + robot.tip_offset * axis
        shape = link_to_pose(robot.link, joint - base, axis)
        if shape is not None:
            line = 1e3 * (shape.centreline(0.005) + base)
            _, end = shape.end_frame()
            outwards = end[:2] / np.hypot(*end[:2])  # seen along the normal of the half-plane with its end
            axes.plot(line[:, :2] @ outwards, line[:, 2], color=GREY, linewidth=1.0, alpha=0.45)
        kind = measurement.intended.value
        marker, colour, name = MARKERS[kind]
        x, y = 1e3 * np.hypot(joint[0], joint[1]), 1e3 * joint[2]
        label = None if kind in shown else f"published, meant to be {name}"
        shown.add(kind)
        axes.plot(
            x,
            y,
            marker,
            color=colour,
            markersize=8,
            markeredgecolor="white",
            zorder=5,
            label=label,
            linestyle="none",
        )
        side = -15 if measurement.name == "b" else 7  # b and d are nearly the same
        axes.annotate(measurement.name, (x, y), (side, 5), textcoords="offset points", fontsize=11, zorder=6)
    axes.axhline(0.0, color=GREY, linewidth=2.5)
    axes.text(690, 8, "floor", color=GREY, ha="right")
    axes.axvline(0.0, color=GREY, linewidth=0.8, linestyle="-.")
    axes.plot([0, 0], [0, 1e3 * robot.d12], color=ORANGE, linewidth=5, solid_capstyle="butt", zorder=4)
    axes.text(8, 22, "P1P2", color=INK)
    axes.set(
        xlim=(-90, 720), ylim=(-15, 790), xlabel="distance from axis 1, ρ, mm", ylabel="height over P1, z, mm"
    )
    axes.set_aspect("equal")
    axes.grid(color="#e8e8e8", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.legend(loc="upper right", fontsize=9, framealpha=1.0)
    return figure


PICTURES = {  # but those of a task and of its sheet
    "docs/pictures/robot.png": robot_picture,
    "docs/pictures/revolution.png": revolution_picture,
    "docs/reconfiguration.png": reconfiguration_picture,
    "docs/pictures/five-points.png": five_points_picture,
    "docs/pictures/categories.png": categories_picture,
    "docs/pictures/cognates.png": cognates_picture,
    "docs/pictures/bound.png": bound_picture,
    "docs/pictures/sweep.png": sweep_picture,
}


def main() -> None:
    """Draw all pictures; the one of a simulation where MuJoCo is installed."""
    for path, picture in PICTURES.items():
        picture().savefig(ROOT / path, dpi=110)
    solution = solve(load_task(TASK))
    task_picture(solution).savefig(ROOT / "docs" / "workspace.png", dpi=110)
    crates = solve(load_task(ROOT / "problems" / "two-crates" / "task.yaml"))
    sheet = draw_sheet(crates, make_guide(crates.task, crates.best), "png")
    (ROOT / "docs" / "guide.png").write_bytes(sheet)
    if find_spec("mujoco"):
        import_module("pick_and_place").main()


if __name__ == "__main__":
    main()
