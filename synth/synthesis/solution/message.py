"""What a search says of itself: its status, and in words what is missed and why."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from synth.rounding import Unit, rounded_up
from synth.sentences import SentenceEnum
from synth.synthesis.solution.path_text import beyond_joint_limits
from synth.synthesis.starts import exact_arms

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.synthesis.check import Verification
    from synth.synthesis.wanted import Design
    from synth.task import Task

_REACHED_WITHOUT_WAY = "every target is reached, but"
_ENOUGH_COVERED = "as much of every surface as was asked for is within its tolerance, and every target"
_PASSES_AXIS = 3.0  # deg
_NEIGHBOURS = 20
_ASKED = 5_000  # points of a surface whose normals are looked at
_AMONG = 100_000  # points of a scan among which neighbours are looked for
_REASONS = 3  # of a kind that are told


class Status(SentenceEnum):
    """How a synthesis ended."""

    FOUND = "found", "every target is within its tolerance"
    BEST_EFFORT = "best_effort", "no shape was found that reaches every target"
    PROVEN_IMPOSSIBLE = "proven_impossible", "no shape of this robot can do the task"
    LIMIT = "limit", "stopped before the search was complete"
    FAILED = "failed", "the solver broke down"

    def told(self, *, with_shape: bool) -> str:
        """Return the sentence, with what the shape shown is, if there is one."""
        if with_shape and self in (Status.BEST_EFFORT, Status.LIMIT, Status.PROVEN_IMPOSSIBLE):
            return f"{self.sentence}; what follows is of the nearest shape found"
        return self.sentence


def message(task: Task, status: Status, designs: Sequence[Design], reasons: Sequence[str]) -> str:
    """Return how a search ended in one sentence: its status, what the best shape misses, and why."""
    misses = _what_misses(task, designs[0]) if designs else []
    return ": ".join(filter(None, [ending(status, designs), "; ".join([*misses, *reasons])]))


def ending(status: Status, designs: Sequence[Design]) -> str:
    """Return how a search ended without what is missed: its status, or that ways are missing.

    Args:
        status: How it ended.
        designs: Its shapes, the one that is told of first.
    """
    ways = designs[0].ways if designs and designs[0].verification.found else ()
    no_way = [f"no way was found from {way.start} to {way.end}" for way in ways if not way.found]
    if not no_way:
        partial = designs and any(each.asked < 1.0 for each in designs[0].verification.coverings)
        if partial and designs[0].verification.found:
            return _ENOUGH_COVERED
        return status.told(with_shape=bool(designs))
    more = [f"and {len(no_way) - _REASONS} more"] if len(no_way) > _REASONS else []
    return f"{_REACHED_WITHOUT_WAY} {'; '.join([*no_way[:_REASONS], *more])}"


def note_on_ways(designs: Sequence[Design], *, interrupted: bool) -> str:
    """Return that ways may be missing for lack of time alone; nothing if that cannot be."""
    missing = designs and any(not way.found for way in designs[0].ways)
    if not (missing and interrupted):
        return ""
    return "the time was up before all ways from target to target had been looked for"


def why_no_better(task: Task, designs: Sequence[Design], blocked: Sequence[Design]) -> tuple[str, ...]:
    """Return sentences that say why a search found no more, as far as that is known.

    Args:
        task: The task.
        designs: The shapes that were found, the best first.
        blocked: Shapes that the hardware cannot take.
    """
    if designs:
        return (*beyond_joint_limits(task, designs[0]), *not_of_revolution(task), *_why_not_exact(task))
    # As far as the shape tells that breaks the fewest limits.
    nearest = min((d.verification.violations for d in blocked), key=len, default=())
    blocking = [violation.sentence for violation in nearest[:_REASONS]]
    return ("no shape was found that the hardware can take", *blocking)


def _what_misses(task: Task, design: Design) -> list[str]:
    """Return a sentence for each target that is not reached, the worst first, three at most."""
    check = design.verification
    sampled = [each.sentence for each in check.coverings if not each.met]
    sampled += [each.sentence for each in check.between if not each.met]
    sampled += [each.sentence for each in check.followed if not each.met]
    order = np.argsort(-check.misses / task.tolerances)
    order = order[~np.array(check.within_tolerance)[order] & (task.surface_of_targets[order] < 0)]
    sentences = [*sampled, *(_how_missed(task, check, index) for index in order[:3].tolist())]
    return sentences if len(order) <= 3 else [*sentences, f"and {len(order) - 3} more"]


def _how_missed(task: Task, check: Verification, index: int) -> str:
    """Return by how much a target is missed, or by how much the rigid link points elsewhere there."""
    target, miss, astray = task.targets[index], check.misses[index], check.astray[index]
    if miss <= target.tolerance and target.approach is not None and astray > target.approach.tolerance:
        off, allowed = (rounded_up(angle, Unit.DEG, 2) for angle in (astray, target.approach.tolerance))
        return f"{target.name} is arrived at {off} deg beside its direction, where {allowed} deg are allowed"
    return f"{target.name} misses by {rounded_up(miss, digits=2)} mm"


def _why_not_exact(task: Task) -> tuple[str, ...]:
    """Return a sentence if algebra knows of no arm at all that meets the targets exactly."""
    robot = task.robot
    with_each = (replace(robot, rigid_link=link) for link in robot.possible_rigid_links)
    if task.places is not None or any(exact_arms(replace(task, robot=each)) != () for each in with_each):
        return ()
    count, which = (
        len(task.targets),
        "this rigid link" if robot.rigid_links is None else "any of the rigid links",
    )
    return (f"no arm with {which} passes exactly through such {count} targets, by algebra",)


def not_of_revolution(task: Task) -> tuple[str, ...]:
    """Return a sentence for each surface that is none of revolution about axis 1, as every workspace is.

    All normals of such a surface meet its axis. Those of a scan are taken from its neighbouring points.
    """
    if task.places is not None:
        return ()
    told = []
    for surface in task.surfaces:
        cells = surface.samples
        points = task.base.to_base(cells.points)
        if len(points) > _AMONG and not cells.are_joined:
            points = np.random.default_rng(0).choice(points, _AMONG, replace=False)
        some = slice(None, None, -(-len(points) // _ASKED))  # of very many, evenly along the list
        if cells.are_joined:
            normals = (cells.normals @ task.base.rotation)[some]
        else:
            normals = _normals_of(points, some)
        points = points[some]
        around = np.stack([-points[:, 1], points[:, 0]], axis=-1)
        around /= np.maximum(np.linalg.norm(around, axis=1, keepdims=True), 1e-12)
        sines = np.abs(np.einsum("ni,ni->n", normals[:, :2], around))
        passed = float(np.degrees(np.arcsin(np.clip(np.median(sines), 0.0, 1.0))))
        if passed >= _PASSES_AXIS:
            told.append(
                f"{surface.name} is no surface of revolution about axis 1, and every workspace is one: at "
                f"about half of its samples the normal passes the axis by {math.floor(passed)} deg or more"
            )
    return tuple(told)


def _normals_of(points: FloatArray, some: slice) -> FloatArray:
    """Return unit normals of planes through the neighbours of some points, shape (n, 3)."""
    from scipy.spatial import cKDTree  # type: ignore[import-untyped]  # noqa: PLC0415

    if len(points) < _NEIGHBOURS:
        return np.zeros_like(points[some])
    tree = cKDTree(points, balanced_tree=False, compact_nodes=False)
    beside = points[tree.query(points[some], _NEIGHBOURS)[1]]
    spread = beside - beside.mean(axis=1, keepdims=True)
    return np.asarray(np.linalg.eigh(np.einsum("nki,nkj->nij", spread, spread))[1][..., 0])
