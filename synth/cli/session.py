"""What holds for every command: Ctrl-C, the time limit, and a net under what nobody foresaw."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import traceback
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, TypeVar

from synth.cli.exit_codes import ExitCode
from synth.cli.say import say
from synth.errors import SolverError, SynthError, TimeLimitError, in_a_line
from synth.rounding import at_least, at_most

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    from synth.synthesis import Progress

_T = TypeVar("_T")
_WRITING = 1.3  # s, what drawing the sheet and writing take on a usual machine
_WRITING_ONE = 1e-5  # s, likewise of each of many targets
_SEARCHING = 0.3  # of the time left, at least for the search
_LATE = 0.4  # s, in which a small task is still read and looked at
_LOOK = 0.1  # s, between looks at whether the user wishes to stop
DEBUG = "SYNTH_DEBUG"  # if this is set in the environment, what nobody foresaw is shown with its traceback


class Session:
    """One run of a command, from before its modules load until its answer is printed.

    The first Ctrl-C, or a request of the system to end, is a wish to stop: the command goes on with what it
    has, and writes it. A second one ends it at once.

    Args:
        time_limit: Time after which the command should have ended, s.
        clock: Returns the time, s.

    Attributes:
        broken: Whether something broke that nobody foresaw.
        told_when_stopping: What the user is told who wishes to stop.
    """

    def __init__(self, time_limit: float, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._until = clock() + time_limit
        self._wishes = 0
        self.broken = False
        self.told_when_stopping = "stopping; the best shape so far is kept"

    def stop(self) -> bool:
        """Whether the user wishes to stop."""
        return self._wishes > 0

    def goes_on_until_stopped(self) -> None:
        """Wait until the user wishes to stop."""
        self.told_when_stopping = "stopping"
        while not self.stop():
            time.sleep(_LOOK)

    @property
    def remaining(self) -> float:
        """The time left, s; never below 0."""
        return max(self._until - self._clock(), 0.0)

    def is_up(self) -> bool:
        """Whether the time is up."""
        return self.remaining <= 0.0

    def is_late(self) -> bool:
        """Whether the time is up for a while, so that it is too late to begin anything."""
        return self._clock() > self._until + _LATE

    def for_search(self, count: int) -> float:
        """Return the time left for a search, s: what is found is then still to be drawn and written.

        Args:
            count: How many targets are written.
        """
        return max(self.remaining - _WRITING - count * _WRITING_ONE, _SEARCHING * self.remaining)

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Take Ctrl-C and requests to end as wishes to stop."""
        in_main = threading.current_thread() is threading.main_thread()
        signals = [signal.SIGINT, signal.SIGTERM] if in_main else []  # no other thread may
        before = [(each, signal.signal(each, self._wish)) for each in signals]
        try:
            yield
        finally:
            for each, handler in before:
                signal.signal(each, handler)

    def _wish(self, _signal: int, _frame: FrameType | None) -> None:
        self._wishes += 1
        if self._wishes > 1:
            raise KeyboardInterrupt
        with suppress(OSError):  # not through a buffer, which may be in the middle of something else
            os.write(2, f"\n{self.told_when_stopping}\n".encode())

    def attempt(self, what: str, do: Callable[[], _T], otherwise: _T) -> _T:
        """Return what a step of the command returns, or something else if it breaks.

        Args:
            what: What it does, for the user.
            do: The step.
            otherwise: What is returned if it breaks in a way that nobody foresaw.
        """
        try:
            return do()
        except SynthError:
            raise
        except Exception as error:  # noqa: BLE001 - the net: the answer is kept whatever breaks
            self.tell_of(what, error)
            return otherwise

    def tell_of(self, what: str, error: BaseException) -> None:
        """Say in a sentence what broke; with its traceback if that was asked for."""
        self.broken = True
        if os.environ.get(DEBUG):
            say("".join(traceback.format_exception(error)), on_stderr=True)
        sentence = f"{what} broke off: {in_a_line(error)}"
        say(f"{sentence}; please report this ({DEBUG}=1 shows where)", on_stderr=True)


def run(command: Callable[[Session], ExitCode], time_limit: float) -> ExitCode:
    """Run a command in a session, and turn every way in which it may end into an exit code.

    Args:
        command: What to do.
        time_limit: Time after which it should have ended, s.
    """
    session = Session(time_limit)
    _occupy_closed_streams()
    try:
        with session.interruptible():
            return command(session)
    except TimeLimitError as error:
        say(str(error), on_stderr=True)
        return ExitCode.NOT_MET
    except SynthError as error:
        say(str(error), on_stderr=True)
        return ExitCode.BROKEN if isinstance(error, SolverError) else ExitCode.WRONG_INPUT
    except KeyboardInterrupt:
        say("ended at once, as asked for twice", on_stderr=True)
        return ExitCode.INTERRUPTED
    except Exception as error:  # noqa: BLE001 - as in `attempt`
        session.tell_of("synth", error)
        return ExitCode.BROKEN


def _occupy_closed_streams() -> None:
    """Lead streams that were closed before the program began nowhere.

    Else the next file opened gets the number of one, and with it what libraries print.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free


@contextmanager
def search_progress() -> Iterator[Callable[[Progress], None] | None]:
    """Show a progress bar on stderr if that is a terminal; else stay silent.

    Yields:
        What to tell of each step, or None.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("searching"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("looking at many shapes", total=None)

        def show(progress: Progress) -> None:
            total = progress.starts_at_most or None
            bar.update(task, total=total, completed=progress.starts, description=progress_sentence(progress))

        yield show


def progress_sentence(progress: Progress) -> str:
    """Return how far a run is, for a line on the terminal."""
    parts = [progress.phase] if progress.phase else []
    if progress.worst_miss < float("inf"):
        parts.append(f"best shape misses by {at_most(progress.worst_miss, digits=3)}")
    if progress.lower_bound is not None:
        parts.append(f"every shape by {at_least(progress.lower_bound, digits=3)}")
    return ", ".join(parts) or "looking at many shapes"
