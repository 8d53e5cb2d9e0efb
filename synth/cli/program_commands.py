"""The commands about files that are there already: `synth schema`, `synth export` and `synth guide`."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import click

from synth.cli.exit_codes import ExitCode


@click.command()
@click.argument("kind", metavar="KIND", type=click.Choice(["task", "robot", "solution", "measured"]))
def schema(kind: str) -> None:
    """Print what a file may hold, as JSON Schema (draft 2020-12).

    KIND is task, robot, solution (solution.json) or measured: the rows of a file of markers, or the YAML
    file of `synth inspect`.
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        import json

        from synth.cli.say import say
        from synth.measurement import measured_schema
        from synth.solution_file import solution_schema
        from synth.task import robot_schema, task_schema

        schemas = {
            "task": task_schema,
            "robot": robot_schema,
            "solution": solution_schema,
            "measured": measured_schema,
        }
        say(json.dumps(schemas[kind](), indent=2))
        return ExitCode.DONE

    sys.exit(run(command, math.inf))


@click.command()
@click.argument("solution", metavar="SOLUTION.json", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path), required=True,
    help="Write the files into this directory.",
)  # fmt: skip
@click.option("--urdf", is_flag=True, help="robot.urdf, and the mesh that it shows.")
@click.option("--srdf", is_flag=True, help="robot.srdf: the group, a state at each target.")
@click.option("--mjcf", is_flag=True, help="robot.xml for MuJoCo, with targets and obstacles.")
@click.option("--xrdf", is_flag=True, help="robot.xrdf: collision spheres, beside the URDF.")
@click.option("--mesh", is_flag=True, help="The workspace as STL, PLY and GLB.")
@click.option("--dh", is_flag=True, help="dh.json: Denavit-Hartenberg parameters.")
@click.option("--c", "c", is_flag=True, help="kinematics.c: forward kinematics and Jacobian.")
@click.option("--trajectory", is_flag=True, help="Through the targets or along the path, as CSV and JSON.")
@click.option(
    "--shape", metavar="K", type=click.IntRange(min=1), default=1,
    help="Export the K-th shape of the file.  [default: 1, the one it tells of first]",
)  # fmt: skip
def export(solution: Path, output: Path, *, shape: int, **kinds: bool) -> None:
    """Write files for planners and simulators: of the kinds that are named, or of all.

    SOLUTION.json is the file of a solution; it is verified again. All files are in metres and radians.

    \b
    Exit codes:
      0  all files are written
      2  wrong input, and nothing is written
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        from synth.cli.say import say
        from synth.export import write_planner_files
        from synth.solution_file import load_solved
        from synth.synthesis import showing

        solved = load_solved(solution)
        if shape != 1:
            solved = showing(solved, shape)
        for path in write_planner_files(solved, output, [kind for kind, asked in kinds.items() if asked]):
            say(f"wrote {path}", on_stderr=True)
        return ExitCode.DONE

    sys.exit(run(command, math.inf))


@click.command()
@click.argument("solution", metavar="SOLUTION.json", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", metavar="DIR", type=click.Path(path_type=Path),
    help="Write the page into this directory.  [default: that of the solution]",
)  # fmt: skip
@click.option(
    "--shape", metavar="K", type=click.IntRange(min=1), default=1,
    help="Begin with the K-th shape of the file.  [default: 1, the one it tells of first]",
)  # fmt: skip
def guide(solution: Path, output: Path | None, *, shape: int) -> None:
    """Write guide.html, the guide as a page for a browser, from a solution.

    SOLUTION.json is the file of a solution; it is verified again. The page is one file, and needs no network.

    \b
    Exit codes:
      0  the page is written
      2  wrong input, and nothing is written
    """
    from synth.cli.session import Session, run

    def command(_session: Session) -> ExitCode:
        from synth.cli.say import say
        from synth.export import write_page
        from synth.solution_file import load_solution
        from synth.synthesis import showing

        solved = load_solution(solution)
        if shape != 1:
            solved = showing(solved, shape)
        for path in write_page(solved, output or solution.parent):
            say(f"wrote {path}", on_stderr=True)
        return ExitCode.DONE

    sys.exit(run(command, math.inf))


COMMANDS = (export, guide, schema)
