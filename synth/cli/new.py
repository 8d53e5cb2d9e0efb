"""`synth new`: a first task of one's own, that solves as it is and says what may be written into it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from synth.cli.exit_codes import ExitCode
    from synth.cli.session import Session

FIRST_TASK = """\
# yaml-language-server: $schema=task.schema.json
# By the line above editors complete and check keys, once `synth schema task > task.schema.json` was run here.

# A task for `synth solve`. It solves as it is; put your own targets in place of these.

synth: 1                        # version of this format
length_unit: mm                 # of all lengths below: mm, cm or m
robot: malleable-2dof           # the published prototype; or the path of a robot file of your own

# The points that the end effector P5 shall reach, with one shape of the link. [x, y, z] in the task frame,
# which is that of the base unless `base` says otherwise: P1 the origin, z up along axis 1, x where joint 1
# reads zero. `tolerance` is the largest miss that you forgive, 1 mm if it is not written. A hand that bends
# the link places its end to about 10 mm; below 5 mm be ready to measure and correct (`synth check`).
targets:
  - {name: pick, position: [512.0, 140.5, 210.0], tolerance: 5.0}
  - {name: place, position: [-300.0, 420.0, 180.0], tolerance: 5.0}

# What else may be asked; take the "# " away from what you need.
# name: two crates              # what the result is called; the name of this file if it is not written
# base: {position: [0, 0, 0], yaw_deg: 0}       # where the robot stands; a number may be a range, [-200, 200]
# floor: 0                      # link, joint 2 and end effector stay above this height; null: no floor
# topology: any                 # general | puma | scara | spherical
# objective: least_squares      # minimax: the worst miss, where not all targets can be met
# obstacles:                    # solids to keep clear of
#   - {name: column, capsule: {from: [600, 600, 0], to: [600, 600, 900], radius: 40}}
#   - {name: shelf, box: {center: [-700, 500, 800], size: [400, 200, 20], yaw_deg: 30}}
#   - {name: lamp, sphere: {center: [0, 0, 1300], radius: 80}}
"""


@click.command()
@click.argument("name", metavar="[NAME]", type=click.Path(path_type=Path), default=Path("task.yaml"))
def new(name: Path) -> None:
    """Write a commented task to begin with, NAME.yaml; task.yaml if no name is given.

    It solves as it is. A file that is there already is left as it was, with exit code 2.
    """
    from synth.cli.session import run

    def command(_session: Session) -> ExitCode:
        return write_first_task(name)

    sys.exit(run(command, float("inf")))


def write_first_task(name: Path) -> ExitCode:
    """Write the commented task and say what to do with it.

    Args:
        name: Path of the file; `.yaml` is added if it does not end so.

    Returns:
        The exit code.

    Raises:
        SynthError: Something of that name is there, or the file cannot be written.
    """
    from synth.cli.exit_codes import ExitCode
    from synth.cli.say import say
    from synth.errors import SynthError

    file = name if name.suffix in {".yaml", ".yml"} else name.parent / f"{name.name or 'task'}.yaml"
    try:
        with file.open("x", encoding="utf-8") as stream:
            stream.write(FIRST_TASK)
    except FileExistsError as error:
        raise SynthError(f"{file} is there already and was left as it was; give another name") from error
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise SynthError(f"cannot write {file}: {why}") from error
    say(f"wrote {file}; it solves as it is: synth solve {_quoted(file)} -o out")
    return ExitCode.DONE


def _quoted(file: Path) -> str:
    import shlex

    return shlex.quote(str(file))
