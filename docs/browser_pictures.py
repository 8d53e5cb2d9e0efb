"""Takes the pictures of the pages that only a browser can: `python docs/browser_pictures.py`, from the project's root.

It needs Chromium, and half a minute.
"""

import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "benchmarks"))

from browser import browser  # noqa: E402 - after the path
from live_page import play  # noqa: E402

from synth import load_task, solve  # noqa: E402
from synth.export import write_page  # noqa: E402

PICTURES = ROOT / "docs" / "pictures"


def main() -> None:
    """Take the pictures of the page and of the live page."""
    solution = solve(load_task(ROOT / "problems" / "through-the-window" / "task.yaml"))
    with tempfile.TemporaryDirectory() as folder:
        (page,) = write_page(solution, folder)
        with browser() as tab:
            tab.show(page.as_uri(), 1360, 800)
            (PICTURES / "guide-page.jpg").write_bytes(tab.picture("jpeg"))
        play(Path(folder))
        shutil.copy(Path(folder) / "live-correct.jpg", PICTURES / "guide-live.jpg")


if __name__ == "__main__":
    main()
