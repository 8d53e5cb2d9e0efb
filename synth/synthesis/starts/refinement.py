"""Gauss-Newton on many shapes at once: from promising starts to the bottoms of their valleys.

It knows neither the floor nor the gentlest bend: it finds out cheaply which of some hundred starts lead
anywhere, so that the nonlinear program need not try them all.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from synth.synthesis.shapes import Postures, TargetsSeen
from synth.synthesis.starts.descent import ENOUGH, EXACT, Descent
from synth.synthesis.starts.refined import Refined
from synth.task import Objective
from synth.watch import never

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.arrays import FloatArray
    from synth.synthesis.shapes import Shapes
    from synth.task import Task

_ITERATIONS = {Objective.LEAST_SQUARES: 20, Objective.MINIMAX: 24}
# Ever larger exponents of the misses, until the norm is the worst miss to a few parts in 10,000; half the way
# on, the shapes that are no longer promising are given up.
_LEVELLING = tuple(12.0 * 1.5**k for k in range(1, 8)), tuple(12.0 * 1.5**k for k in range(8, 17))
_LEVELLED = 10
_TOGETHER = 4000  # postures, so that the arrays stay in the cache


def refine(
    task: Task,
    shapes: Shapes,
    theta2: FloatArray | None = None,
    iterations: int | None = None,
    *,
    near: bool = False,
    enough: int = ENOUGH,
    met: float = EXACT,
    is_up: Callable[[], bool] = never,
) -> Refined:
    """Improve shapes by damped Gauss-Newton steps, their limits and those of the joints observed.

    Each target keeps its own joint angles, which follow the shape: the residual is what is left of
    P5 - target across the directions in which the joints are free to move.

    Args:
        task: The task.
        shapes: The starts, of shape (N,).
        theta2: Angle of joint 2 at which each start is to meet each target, shape (N, n), rad, and stay on
            that branch; by default the nearest one, which is looked for again from time to time.
        iterations: Number of steps; by default enough to arrive, mostly.
        near: Whether the starts were refined before: the norm whose valleys are the widest is left out.
        enough: With so many shapes that meet all targets, of those led together, no more steps are taken.
        met: The cost with which they do, m^2.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The improved shapes.
    """
    iterations = iterations or _ITERATIONS[task.objective]
    return _descents(
        task,
        shapes,
        theta2,
        lambda descent: descent.after(
            iterations, keep_branches=theta2 is not None, near=near, enough=enough, met=met
        ),
        is_up,
    )


def refine_the_best(
    task: Task, shapes: Shapes, steps: tuple[int, int], one_in: int, is_up: Callable[[], bool] = never
) -> Refined:
    """Improve shapes by some steps, and only the best of them by more.

    Args:
        task: The task.
        shapes: The starts, of shape (N,).
        steps: How many at first, and how many more.
        one_in: Of how many one goes on.
        is_up: As for `refine`.
    """
    first, more = steps
    refined = refine(task, shapes, iterations=first, is_up=is_up).best(-(-len(shapes.length) // one_in))
    return refine(task, refined.shapes, iterations=more, near=True, is_up=is_up)


def _descents(
    task: Task,
    shapes: Shapes,
    theta2: FloatArray | None,
    led: Callable[[Descent], Refined],
    is_up: Callable[[], bool],
    *,
    clear: bool = False,
) -> Refined:
    """Return shapes after their descents, led a part of them at a time."""
    together = max(1, _TOGETHER // len(task.targets))
    parts = []
    for first in range(0, len(shapes.length), together):
        some = slice(first, first + together)
        part = shapes.take(some)
        aims = TargetsSeen.by(task, part)
        if theta2 is None:
            postures = Postures.nearest(aims, part.kinematics)
        else:
            postures = Postures.at(aims, part.kinematics, theta2[some])
        parts.append(led(Descent(task, aims, part, postures, is_up, clear=clear)))
    return Refined.joined(parts)


def level(task: Task, refined: Refined, is_up: Callable[[], bool] = never) -> Refined:
    """Lower the worst miss of shapes for which it is nearly the least already.

    The exponent of the norm is raised step by step: each norm's least is close to that of the one before, so
    a few steps lead from one to the next, however sharp the norm has become.

    Args:
        task: The task, for the worst miss.
        refined: Shapes, each with the branches of joint 2 on which it stays.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The best of the shapes, with lower ones; their costs are nearly the worst misses squared, m^2.
    """
    for exponents in _LEVELLING:
        led = partial(Descent.level, exponents=exponents)
        refined = _descents(task, refined.shapes, refined.joints[..., 1], led, is_up).best(_LEVELLED)
    return refined


def cleared(task: Task, refined: Refined, is_up: Callable[[], bool] = never) -> Refined:
    """Move shapes out of obstacles and out of themselves, as their targets allow.

    Args:
        task: The task.
        refined: Shapes, each with the branches of joint 2 on which it stays.
        is_up: Asked after each step whether to end with what there is.

    Returns:
        The shapes; their costs count the misses alone.
    """
    return _descents(task, refined.shapes, refined.joints[..., 1], Descent.cleared, is_up, clear=True)
