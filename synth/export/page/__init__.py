"""The guide as a page: guide.html, one file that a browser opens with no network."""

from synth.export.page.content import page_content
from synth.export.page.page import draw_page, page_of

__all__ = ["draw_page", "page_content", "page_of"]
