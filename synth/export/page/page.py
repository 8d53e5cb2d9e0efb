"""`guide.html`: style, script and data in one file, which asks no network for anything."""

from __future__ import annotations

import html
import json
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from synth.export.page.content import page_content

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from synth.guide import Guide
    from synth.synthesis import Solution

_STYLES = ("page.css", "print.css")
# In this order: each file is a set of functions, and the last one begins.
_SCRIPTS = (
    "matrices.js",
    "meshes.js",
    "arm.js",
    "workspace.js",
    "drawing.js",
    "camera.js",
    "view.js",
    "labels.js",
    "panel.js",
    "tables.js",
    "live.js",
    "page.js",
)
_ONLY_LIVE = "live.js"


def draw_page(solution: Solution, guide: Guide | None) -> bytes:
    """Return the page of a solution: the scene to look around in, what to do, the shapes compared.

    Args:
        solution: What a synthesis found, whatever its status.
        guide: The guide to its first shape, or None if there is no shape.

    Returns:
        The file's content, the same for the same solution.
    """
    return page_of(page_content(solution, guide))


def page_of(content: Mapping[str, Any]) -> bytes:
    """Return the page that shows some content, as `page_content` returns it."""
    # In a script nothing but "<" can end it, or begin a comment.
    data = json.dumps(content, default=_listed, allow_nan=False, separators=(",", ":"))
    data = data.replace("<", "\\u003c")
    filled = _template(live="live" in content)
    for place, text in (("DATA", data), ("TITLE", html.escape(content["name"]))):  # a name may hold a place
        filled = filled.replace(f"{{{{{place}}}}}", text, 1)
    return filled.encode("utf-8", "backslashreplace")


def _listed(value: NDArray[Any]) -> object:
    """Return an array as JSON can hold it."""
    return value.tolist()


@cache
def _template(*, live: bool) -> str:
    """Return the page without title and data; a live one may ask where it comes from, any other nobody."""
    folder = files("synth.export.page").joinpath("parts")
    text = folder.joinpath("page.html").read_text(encoding="utf-8")
    text = text.replace("{{ASKED}}", "'self'" if live else "'none'", 1)
    scripts = [name for name in _SCRIPTS if live or name != _ONLY_LIVE]
    for place, names in (("STYLE", _STYLES), ("SCRIPT", scripts)):
        parts = "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in names)
        text = text.replace(f"{{{{{place}}}}}", parts, 1)
    return text
