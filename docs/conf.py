"""How Sphinx builds the site: `sphinx-build -W --keep-going docs site`, with no network."""

import sys
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS))

from gallery import write_gallery  # noqa: E402 - after the path

import synth  # noqa: E402

project, author = "synth", "The synth developers"
release = version = synth.__version__
copyright = author  # noqa: A001 - Sphinx asks for this name
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # brings MathJax along: a reader in a workshop has no network
    "sphinx_design",
]
source_suffix = {".md": "markdown"}
exclude_patterns = ["pictures/*.md"]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
highlight_language = "none"  # a block without a language is a sketch
napoleon_google_docstring, napoleon_numpy_docstring = True, False
autodoc_typehints = "description"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
suppress_warnings = ["ref.python"]  # `shape` is a field of two classes, and a word
html_theme = "pydata_sphinx_theme"
html_title = "synth"
html_static_path = ["static"]
html_favicon = "static/icon.svg"
html_context = {"default_mode": "auto"}
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "show_prev_next": True,
    "navigation_with_keys": False,
    "header_links_before_dropdown": 6,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}


def keep_bars(_app: object, _what: str, _name: str, _it: object, _options: object, lines: list[str]) -> None:
    """Keep |x| in docstrings what it is: an absolute value, no substitution."""
    lines[:] = [line.replace("|", "\\|") for line in lines]


def setup(app: object) -> None:
    """Make the gallery before the pages are read."""
    app.connect("builder-inited", lambda _app: write_gallery())  # type: ignore[attr-defined]
    app.connect("autodoc-process-docstring", keep_bars, priority=400)  # type: ignore[attr-defined]
