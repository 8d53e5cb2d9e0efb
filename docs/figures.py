"""Draws the pictures of README and docs: `python docs/figures.py`, from the project's root."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from synth import Solution, load_task, solve
from synth.export import draw_sheet
from synth.guide import make_guide

ROOT = Path(__file__).parents[1]
TASK = ROOT / "problems" / "four-targets" / "task.yaml"
BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "#555555"


def workspace_picture(solution: Solution) -> Figure:
    """Draw the arm, its workspace within the joint limits, and the targets."""
    arm, targets = solution.robot, solution.targets
    figure = Figure(figsize=(7.5, 4.6))
    FigureCanvasAgg(figure)
    # Larger than the page, because the axes leave wide margins around what they show.
    axes = figure.add_axes((-0.2, -0.65, 1.36, 2.21), projection="3d", computed_zorder=False)
    limits = arm.robot.joint_limits
    theta1 = np.linspace(limits.base.lower, limits.base.upper, 121)[:, None]
    theta2 = np.linspace(limits.second.lower, limits.second.upper, 61)
    surface = 1e3 * arm.forward_kinematics(theta1, theta2)
    # Cut open, so that the arm inside can be seen.
    axes.plot_surface(
        *np.moveaxis(surface[20:], -1, 0), color=BLUE, alpha=0.13, linewidth=0, rcount=120, ccount=60
    )
    axes.plot_wireframe(
        *np.moveaxis(surface[20:], -1, 0), color=BLUE, alpha=0.25, linewidth=0.4, rcount=25, ccount=12
    )
    turn = targets[0].joints[0]
    cos, sin = np.cos(turn), np.sin(turn)
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    link = 1e3 * (arm.shape.centreline() + arm.base_joint[1]) @ turned
    p3, p4 = 1e3 * arm.axis_points[2:] @ turned
    axes.plot(*link.T, color=GREY, linewidth=7, solid_capstyle="round", zorder=5)
    axes.plot(*np.array([1.8 * p3 - 0.8 * p4, 1.8 * p4 - 0.8 * p3]).T, color=ORANGE, linewidth=3, zorder=6)
    axes.plot(*np.array([[0, 0, 0], [0, 0, 120]]).T, color=ORANGE, linewidth=3, zorder=6)
    axes.plot(*np.array([link[-1], 1e3 * targets[0].reached]).T, color=GREY, linewidth=4, zorder=6)
    positions = 1e3 * np.array([target.position for target in targets])
    axes.scatter(*positions.T, color="black", s=45, depthshade=False, zorder=7)
    for target, position in zip(targets, positions, strict=True):
        axes.text(*(position + [25, 25, 30]), target.name, fontsize=11, zorder=8)
    axes.set_aspect("equal")
    axes.view_init(elev=22, azim=-62)
    axes.set_axis_off()
    return figure


def main() -> None:
    """Solve the task of the README and draw it."""
    solution = solve(load_task(TASK))
    figure = workspace_picture(solution)
    figure.savefig(ROOT / "docs" / "workspace.png", dpi=110)
    sheet = draw_sheet(solution, make_guide(solution.task, solution.best), "png")
    (ROOT / "docs" / "guide.png").write_bytes(sheet)


if __name__ == "__main__":
    main()
