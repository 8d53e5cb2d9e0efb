"""The commands about a solution that is there: `synth schema`, `synth export` and `synth guide`."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import click

from synth.cli.exit_codes import ExitCode
from synth.cli.loop_commands import how_to_check


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
@click.option("--live", is_flag=True, help="Serve the page and show on it where the markers are now.")
@click.option(
    "--port", metavar="N", type=click.IntRange(0, 65535), default=0,
    help="Port of the live page, on this machine alone.  [default: any that is free]",
)  # fmt: skip
@click.option(
    "--udp", metavar="N", type=click.IntRange(1, 65535),
    help="Take the markers from datagrams to this port of this machine.  [default: lines on stdin]",
)  # fmt: skip
@click.option(
    "--natnet", metavar="HOST",
    help="Take the markers from Motive (OptiTrack) at HOST or HOST:PORT, by NatNet 3 or 4.",
)  # fmt: skip
@click.option(
    "--qtm", metavar="HOST",
    help="Take the markers from QTM (Qualisys) at HOST or HOST:PORT.",
)  # fmt: skip
@click.option(
    "--replay", metavar="FILE", type=click.Path(path_type=Path),
    help="Take the markers from a recording that `synth check` reads, 100 frames a second.",
)  # fmt: skip
@click.option(
    "--speed", metavar="X", type=click.FloatRange(0.01, 1000.0), default=1.0, show_default=True,
    help="Of the recording.",
)  # fmt: skip
@how_to_check
def guide(
    solution: Path,
    output: Path | None,
    *,
    shape: int,
    live: bool,
    port: int,
    udp: int | None,
    natnet: str | None,
    qtm: str | None,
    replay: Path | None,
    speed: float,
    marker_error: float,
    **how: Any,
) -> None:
    """Write guide.html, the guide as a page for a browser, or serve it while the link is bent.

    SOLUTION.json is the file of a solution; it is verified again. The page is one file, and needs no network.
    With --live it shows the markers as they come, and what to do now; each line is a JSON object with
    marker, x_mm, y_mm, z_mm as in a file of markers. Ctrl-C ends it.

    \b
    Exit codes:
      0  the page is written, or was served
      2  wrong input, and nothing is written
    """
    from synth.cli.session import Session, run

    told = [each for each in (udp, natnet, qtm, replay) if each is not None]
    if not live and (told or port):
        raise click.UsageError("--port, --udp, --natnet, --qtm and --replay are for --live.")
    if len(told) > 1:
        raise click.UsageError("--udp, --natnet, --qtm and --replay exclude each other.")

    def command(session: Session) -> ExitCode:
        from synth.cli.say import say
        from synth.export import write_page
        from synth.live import MotiveStream, QtmStream, Recording, served_live
        from synth.solution_file import load_solution
        from synth.synthesis import showing

        solved = load_solution(solution)
        if shape != 1:
            solved = showing(solved, shape)
        if not live:
            for path in write_page(solved, output or solution.parent):
                say(f"wrote {path}", on_stderr=True)
            return ExitCode.DONE
        source: Any = sys.stdin if udp is None else udp
        if replay is not None:
            source = Recording(replay, speed)
        elif natnet is not None:
            source = MotiveStream(natnet)
        elif qtm is not None:
            source = QtmStream(qtm)
        with served_live(solved, source, port, marker_error=marker_error / 1000.0, **how) as address:
            say(address)
            session.goes_on_until_stopped()
        return ExitCode.DONE

    sys.exit(run(command, math.inf))


COMMANDS = (export, guide, schema)
