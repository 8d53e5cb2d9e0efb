"""The command line: the one place that prints and exits.

What a command needs is imported inside it: `synth --help` must not wait for a solver.
"""

from synth.cli.loop_commands import COMMANDS as _OF_THE_LOOP
from synth.cli.main import main
from synth.cli.program_commands import COMMANDS as _FOR_PROGRAMS

for command in (*_OF_THE_LOOP, *_FOR_PROGRAMS):
    main.add_command(command)

__all__ = ["main"]
