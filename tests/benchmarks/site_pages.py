"""Looks at the site in a real browser: `python tests/benchmarks/site_pages.py SITE [DIR]`, once it is built.

Opens every page, wide and light, narrow and dark. It fails where a script complains, where the network is
asked for anything, where a picture is missing, or where a page is wider than its window. Pictures of one page
of each kind are left in DIR.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from browser import browser

if TYPE_CHECKING:
    from browser import Browser

SIZES = {"wide": (1360, 900, False), "narrow": (390, 844, True), "dark": (1360, 900, True)}
PICTURED = (
    "index", "tutorial", "theory", "bound", "gallery/index", "gallery/two-crates", "how-to/many-tasks",
    "how-to/from-the-sheet-to-a-locked-arm", "reference/task-file",
)  # fmt: skip
WIDER = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
MISSING = "[...document.images].filter((one) => one.complete && !one.naturalWidth).map((one) => one.src)"


def look(tab: Browser, page: Path, name: str, into: Path) -> list[str]:
    """Look at a page in all ways; return what is wrong with it."""
    wrong = []
    for kind, (width, height, dark) in SIZES.items():
        if kind == "dark" and name not in PICTURED:
            continue
        tab.show(page.resolve().as_uri(), width, height, dark=dark)
        if (excess := tab.evaluate(WIDER)) > 1:
            wrong.append(f"{name}, {kind}: {excess} points wider than the window")
        wrong += [f"{name}: {source} is missing" for source in tab.evaluate(MISSING)]
        if name in PICTURED:
            (into / f"{name.replace('/', '-')}-{kind}.png").write_bytes(tab.picture())
    return wrong


def main() -> None:
    """Look at all pages and say what is wrong."""
    site = Path(sys.argv[1])
    into = Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp(prefix="site-"))
    into.mkdir(parents=True, exist_ok=True)
    pages = {page.relative_to(site).with_suffix("").as_posix(): page for page in sorted(site.rglob("*.html"))}
    pages = {name: page for name, page in pages.items() if not name.startswith("_")}
    wrong: list[str] = []
    with browser() as tab:
        for name, page in pages.items():
            wrong += look(tab, page, name, into)
        wrong += tab.complaints
        wrong += [f"{url} was asked for" for url in set(tab.requests) if not url.startswith("file://")]
    print(*wrong, sep="\n")
    print(f"{len(pages)} pages, {len(wrong)} faults; pictures in {into}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
