"""What a person at the terminal sees and does while a search runs."""

from __future__ import annotations

import signal
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    from synth.synthesis import Progress


@contextmanager
def interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a request to stop; a second one interrupts as usual.

    Yields:
        A function that says whether Ctrl-C was pressed.
    """
    pressed = False

    def press(_signal: int, _frame: FrameType | None) -> None:
        nonlocal pressed
        pressed = True
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sys.stderr.write("\nstopping; the best shape so far is kept\n")

    before = signal.signal(signal.SIGINT, press)
    try:
        yield lambda: pressed
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def search_progress() -> Iterator[Callable[[Progress], None] | None]:
    """Show a progress bar on stderr if that is a terminal; else stay silent.

    Yields:
        What to tell of each step, or None.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("searching"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("looking at many shapes", total=None)

        def show(progress: Progress) -> None:
            best = f"best shape misses by {1e3 * progress.worst_miss:.3f} mm at most"
            if progress.lower_bound is not None:
                best += f", every shape by {1e3 * progress.lower_bound:.3f} mm"
            bar.update(task, total=progress.starts_at_most, completed=progress.starts, description=best)

        yield show
