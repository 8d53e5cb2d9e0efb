"""`guide.pdf`: one A4 page, to be held while the link is bent; of a task not met, what is missed."""

from __future__ import annotations

import io
import sys
from importlib.util import LazyLoader, find_spec, module_from_spec
from typing import TYPE_CHECKING

from synth.export.sheet.layout import draw
from synth.export.sheet.met_page import fill_met
from synth.export.sheet.missed_page import fill_missed
from synth.export.sheet.page import HEIGHT, MARGIN, WIDTH, Page
from synth.export.sheet.scene import Scene
from synth.export.sheet.target_table import listed_targets
from synth.export.sheet.typesetting import FAMILY, shortened, width
from synth.version import __version__

if TYPE_CHECKING:
    from synth.guide import Guide
    from synth.synthesis import Solution

_TITLE = 16.0  # pt; less for a long name
_NAME, _ROBOT = 150.0, 60.0  # mm, of the task's and the robot's name
_FARTHEST_DOWN = 178.0  # mm; the drawings begin no lower


def draw_sheet(solution: Solution, guide: Guide | None, file_format: str = "pdf") -> bytes:
    """Return the page: what to do, the points to be met and the drawings; or what is missed, and why.

    The points and the blue link are those at `guide.hold`; lengths are in mm, in the task frame.

    Args:
        solution: What a synthesis found, whatever its status.
        guide: The guide to its first shape, or None if there is no shape.
        file_format: "pdf", or another one that matplotlib writes, such as "png" or "svg".

    Returns:
        The file's content, the same for the same solution: it bears no date.
    """
    # Half a second to import, paid only when a sheet is drawn; no pyplot, so no global state.
    import matplotlib as mpl  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    _loaded_when_used("fontTools", "subset")  # only for fonts that are cut to size, and slow to load
    content = io.BytesIO()
    with mpl.rc_context():
        mpl.rcdefaults()  # the user's own style is for the user's own plots
        mpl.rc("font", family=FAMILY)
        mpl.rc("text", usetex=False, parse_math=False)  # a $ in a name is a dollar
        # Glyph by glyph, since to cut a whole font to size takes a second. Latin letters can be searched.
        mpl.rc("pdf", fonttype=3)
        mpl.rc("hatch", linewidth=0.4)
        figure = Figure(figsize=(WIDTH / 25.4, HEIGHT / 25.4))
        _fill(Page(figure), solution, guide)
        metadata = {"CreationDate": None} if file_format == "pdf" else None
        figure.savefig(content, format=file_format, metadata=metadata, dpi=150)
    return content.getvalue()


def _loaded_when_used(package: str, name: str) -> None:
    """Let a module of a package load when something of it is used, not when it is imported."""
    full = f"{package}.{name}"
    found = None if full in sys.modules else find_spec(full)
    if found is None or found.loader is None:
        return
    found.loader = LazyLoader(found.loader)
    module = module_from_spec(found)
    found.loader.exec_module(module)
    sys.modules[full] = module
    setattr(sys.modules[package], name, module)  # so that "from package import name" does not look closer


def _fill(page: Page, solution: Solution, guide: Guide | None) -> None:
    """Put everything on the page."""
    _header(page, solution)
    if guide is not None and guide.met:
        bottom = fill_met(page, solution, guide)
    else:
        bottom = fill_missed(page, solution)
    listed = listed_targets(solution)
    labels = [str(index + 1) if index in listed else "" for index in range(len(solution.task.targets))]
    draw(page, solution, Scene.of(solution, guide, labels), min(bottom, _FARTHEST_DOWN))


def _header(page: Page, solution: Solution) -> None:
    name = shortened(solution.task.name, WIDTH - 2 * MARGIN, _TITLE, bold=True) or "task"
    size = _TITLE * min(1.0, _NAME / width(name, _TITLE, bold=True))
    page.text(MARGIN, 18.0, name, size, weight="bold")
    shape = "" if not solution.designs else f", shape {solution.shape} of {len(solution.designs)}"
    robot = shortened(solution.task.robot.name, _ROBOT, 6.5)
    right = f"{robot}, seed {solution.seed}{shape}, synth {__version__}"
    page.text(WIDTH - MARGIN, 10.0, right, 6.5, ha="right", color="#555555")
