"""Many tasks: solved on any executor, kept in a store, resumed where they were."""

from synth.sweep.outcome import SweepProgress, TaskOutcome
from synth.sweep.solve_many import solve_many

__all__ = ["SweepProgress", "TaskOutcome", "solve_many"]
