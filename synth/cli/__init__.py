"""The command line: the one place that prints and exits.

What a command needs is imported inside it: `synth --help` must not wait for a solver.
"""

from synth.cli.main import main

__all__ = ["main"]
