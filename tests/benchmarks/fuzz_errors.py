"""Whether what is told of errors is true, by trial: arms whose link ends a little elsewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from fuzz_faults import Fault
from oracle import OracleArm, rotation

if TYPE_CHECKING:
    from collections.abc import Iterator

_HANDS, _SIGMAS = 150, 5.0
_DIRECTIONS = 24
_TRIED_SLACK = 2e-6  # m: what the oracle's joints are off the best ones by


def _displaced(arm: OracleArm, shift, turn) -> OracleArm:
    """Return an arm whose link ends elsewhere: its end moved and its frame turned about it."""
    frame, origin = arm.end
    moved = replace(arm)
    vars(moved)["end"] = (rotation(turn) @ frame, origin + shift)  # in the place of what is computed once
    return moved


def _misses(arm: OracleArm, told, samples=361):
    """Return the least misses of the targets, its joints at their best."""
    targets = told.task.table.positions
    joints = arm.closest(targets, samples=samples, valleys=3, halvings=25)
    return arm.misses(joints, targets)


def _on_sphere(rng, count):
    directions = rng.normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def faults_of_errors(told) -> Iterator[Fault]:
    """Try the errors that are said to be harmless, and hands as published."""
    guide, rng = told.content["guide"], np.random.default_rng(0)
    tolerance = guide["tolerance"]
    place, tilt = tolerance["position"], tolerance["direction"]
    frame = told.arm.end[0]
    around = np.linspace(0.0, 2.0 * np.pi, _DIRECTIONS, endpoint=False)[:, None]
    across = np.cos(around) * frame[:, 1] + np.sin(around) * frame[:, 2]
    for what, shifts, turns in (
        ("a shift", place * _on_sphere(rng, _DIRECTIONS), 0.0 * across),
        ("a tilt", 0.0 * across, tilt * across),
        ("half of each", 0.5 * place * _on_sphere(rng, _DIRECTIONS), 0.5 * tilt * rng.permutation(across)),
    ):
        beyond = [
            float(np.max(_misses(_displaced(told.arm, shift, turn), told) - told.task.tolerances))
            for shift, turn in zip(shifts, turns, strict=True)
        ]
        if max(beyond) > _TRIED_SLACK:
            yield Fault(
                "untrue",
                f"{what} of {1e3 * place:.4g} mm, {np.degrees(tilt):.4g} deg is not harmless: a target is "
                f"{1e3 * max(beyond):.4g} mm beyond its tolerance of {1e3 * told.task.tolerances.min():.4g}",
            )
    yield from _by_hand(told, guide["forgiveness"], rng)


def _by_hand(told, forgiveness, rng) -> Iterator[Fault]:
    """Place the link by hands as published, as many as it takes to tell a wrong figure from chance."""
    off = np.maximum(rng.normal(9.64e-3, 2.06e-3, _HANDS), 0.0)[:, None] * _on_sphere(rng, _HANDS)
    turns = np.radians(np.maximum(rng.normal(4.0, 1.2, _HANDS), 0.0))[:, None] * _on_sphere(rng, _HANDS)
    misses = np.array(
        [_misses(_displaced(told.arm, *each), told, 181) for each in zip(off, turns, strict=True)]
    )
    worst = misses.max(axis=1)
    mean, doubt = float(worst.mean()), _SIGMAS * float(worst.std()) / np.sqrt(_HANDS) * np.sqrt(2.2) + 2e-5
    # With joints that are nearer by than what is said to be expected nobody is misled.
    if mean > forgiveness["expected_worst_miss"] + doubt:
        said = 1e3 * forgiveness["expected_worst_miss"]
        yield Fault("untrue", f"a hand's expected worst miss is {1e3 * mean:.3f} mm, said {said:.3f}")
    within = (misses <= told.task.tolerances).all(axis=1)
    doubt = _SIGMAS * np.sqrt(max(within.mean() * (1.0 - within.mean()), 0.02) / _HANDS * 2.2)
    if within.mean() < forgiveness["chance"] - doubt:
        yield Fault("untrue", f"a hand's chance is {within.mean():.2f}, said {forgiveness['chance']:.2f}")
