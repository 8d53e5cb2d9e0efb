"""Exit codes, a part of the interface."""

from enum import IntEnum


class ExitCode(IntEnum):
    """How a command ended."""

    DONE = 0  # found; or realisable
    NOT_MET = 1  # not found within tolerance, and the best effort is given; or not realisable
    WRONG_INPUT = 2  # every mistake named with its file, line and key
    BROKEN = 3  # the solver, or anything else, broke down; what was found before is kept
    INTERRUPTED = 130  # ended at once by a second Ctrl-C, as shells have it
