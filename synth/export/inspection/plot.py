"""The workspace of a measured shape: its section, with all that the measurement allows, and a view."""

from __future__ import annotations

import io
import math
import textwrap
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from synth.export.sheet import AXIS, GHOST, LINK, TARGET

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from synth.arrays import FloatArray
    from synth.measurement import Inspection

_SHAPES = 120  # drawn of the sampled ones
_AROUND = np.linspace(0.0, 2.0 * math.pi, 361)


def draw_inspection(inspection: Inspection, file_format: str = "pdf") -> bytes:
    """Return a picture: the section (rho, z) of the workspace about axis 1, and a view of it.

    In grey the sections of shapes drawn from what the measurement allows, in blue that of the nearest one:
    solid where joint 2 gets within its limits, if a shape of the link for it is known, dashed elsewhere.
    The cross is the recorded end effector; the dots about it are what its distances allow.

    Args:
        inspection: The inspection.
        file_format: "pdf", or another one that matplotlib writes, such as "png" or "svg".

    Returns:
        The file's content, the same for the same inspection: it bears no date.
    """
    import matplotlib as mpl  # noqa: PLC0415 - half a second, paid only when something is drawn
    from matplotlib.figure import Figure  # noqa: PLC0415

    content = io.BytesIO()
    with mpl.rc_context(), warnings.catch_warnings():
        mpl.rcdefaults()
        mpl.rc("font", family="DejaVu Sans", size=8.0)
        mpl.rc("text", usetex=False, parse_math=False)
        mpl.rc("pdf", fonttype=42)
        # A name in a script that the font lacks prints as boxes; that is no reason to talk of fonts.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        figure = Figure(figsize=(10.0, 4.8))
        verdict = "realisable" if inspection.is_realisable else "NOT realisable"
        name = textwrap.shorten(inspection.measurement.name, 60, placeholder=" …") or "measured"
        figure.text(0.03, 0.94, f"{name}: {verdict}", fontsize=12.0, weight="bold")
        _draw_section(figure.add_axes((0.07, 0.12, 0.43, 0.74)), inspection)
        figure.legend(loc="upper left", bbox_to_anchor=(0.025, 0.93), ncols=4, fontsize=7.0, frameon=False)
        _draw_view(figure.add_axes((0.5, 0.0, 0.5, 0.92), projection="3d"), inspection)
        metadata = {"CreationDate": None} if file_format == "pdf" else None
        figure.savefig(content, format=file_format, metadata=metadata, dpi=150)
    return content.getvalue()


def _draw_section(axes: Axes, inspection: Inspection) -> None:
    samples, arm = inspection.samples, inspection.link.arm
    if samples is not None:
        some = samples.part(0, _SHAPES)
        for index, curve in enumerate(1e3 * some.sections()):
            label = "shapes that the measurement allows" if index == 0 else None
            axes.plot(*curve.T, color=GHOST, linewidth=0.5, alpha=0.25, zorder=1, label=label)
        if some.pose is not None:
            axes.plot(*1e3 * some.pose.T, ".", color=AXIS, markersize=1.5, alpha=0.8, zorder=6)
    axes.plot(*_section(inspection.circle.points(_AROUND)).T, "--", color=LINK, linewidth=1.0, zorder=2,
              label="nearest shape")  # fmt: skip
    if inspection.link.found:
        limits = arm.robot.joint_limits.second
        within = arm.forward_kinematics(0.0, np.linspace(limits.lower, limits.upper, 361))
        axes.plot(
            *_section(within).T, color=LINK, linewidth=2.0, zorder=3, label="within the limits of joint 2"
        )
    if inspection.pose is not None:
        axes.plot(*1e3 * inspection.pose, "X", color=TARGET, markersize=6.0, markeredgecolor="white",
                  zorder=5, label="recorded end effector")  # fmt: skip
    axes.axvline(0.0, color=AXIS, linewidth=0.8, linestyle="-.")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="distance from axis 1, ρ, mm", ylabel="height above P1, z, mm")
    axes.grid(color="#E8E8E8", linewidth=0.4)


def _draw_view(axes: Any, inspection: Inspection) -> None:
    """Draw the nearest shape's workspace, the part within the joint limits in blue, cut open."""
    arm, circle = inspection.link.arm, inspection.circle
    turns = np.linspace(0.0, 2.0 * math.pi, 73)
    axes.plot_wireframe(*_swept(circle.points(_AROUND[::6]), turns), color=GHOST, linewidth=0.3, alpha=0.5,
                        rcount=24, ccount=20)  # fmt: skip
    if inspection.link.found:
        limits = arm.robot.joint_limits
        # A third is left out, so that the robot inside can be seen.
        theta1 = np.linspace(limits.base.lower, limits.base.upper, 121)[:81]
        theta2 = np.linspace(limits.second.lower, limits.second.upper, 61)
        reached = 1e3 * arm.forward_kinematics(theta1[:, None], theta2)
        axes.plot_surface(
            *np.moveaxis(reached, -1, 0), color=LINK, alpha=0.3, linewidth=0, rcount=81, ccount=61
        )
        link = 1e3 * (arm.shape.centreline() + arm.base_joint[1])
        axes.plot(*link.T, color=TARGET, linewidth=4.0, solid_capstyle="round", zorder=6)
        p3, p4 = 1e3 * arm.axis_points[2:]
        axes.plot(*np.array([2.0 * p3 - p4, 2.0 * p4 - p3]).T, color=AXIS, linewidth=2.5, zorder=7)
    axes.plot([0, 0], [0, 0], [0, 1e3 * arm.robot.d12], color=AXIS, linewidth=2.5, zorder=7)
    if inspection.pose is not None:
        rho, z = 1e3 * inspection.pose
        ring = np.stack([rho * np.cos(turns), rho * np.sin(turns), np.full_like(turns, z)])
        axes.plot(*ring, color=TARGET, linewidth=1.0, linestyle=":")
    axes.set_aspect("equal")
    axes.view_init(elev=22.0, azim=-62.0)
    axes.locator_params(nbins=5)
    axes.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm")
    axes.tick_params(labelsize=6.0)


def _section(points: FloatArray) -> FloatArray:
    return 1e3 * np.stack([np.hypot(points[..., 0], points[..., 1]), points[..., 2]], axis=-1)


def _swept(points: FloatArray, turns: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return points turned about axis 1 as grids of x, y, z, mm."""
    x, y, z = 1e3 * points.T
    cos, sin = np.cos(turns)[:, None], np.sin(turns)[:, None]
    return cos * x - sin * y, sin * x + cos * y, np.broadcast_to(z, (len(turns), len(z)))
