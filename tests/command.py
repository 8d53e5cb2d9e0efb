"""The command: in a process of its own, maybe with something changed inside, or in this one."""

import subprocess
import sys

from click.testing import CliRunner

from synth.cli import main

_MAIN = "\nfrom synth.cli import main\nmain(prog_name='synth')\n"


def program(*arguments, before="", **options):
    """Return how the command ended in a process of its own, which first runs a few lines of Python."""
    options = {"capture_output": True, "text": True, "timeout": 300, **options}
    return subprocess.run(
        [sys.executable, "-c", before + _MAIN, *map(str, arguments)], check=False, **options
    )


def invoked(*arguments):
    """Return how the command ended in this process."""
    return CliRunner().invoke(main, [str(each) for each in arguments])
