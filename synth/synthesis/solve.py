"""The sentence itself: task -> start points -> nonlinear program -> independent check -> solution."""

from __future__ import annotations

import math
import threading
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from synth.errors import SolverError
from synth.robot import ANYWHERE, Interval, links_to_poses
from synth.synthesis.certificate import Certifier
from synth.synthesis.exact_starts import exact_designs
from synth.synthesis.impossibility import why_impossible
from synth.synthesis.many_targets import improved, levelled, part_of, ranked
from synth.synthesis.nlp import Structure, SynthesisNlp, shared_nlp
from synth.synthesis.population import ARCS
from synth.synthesis.screening import Start, starts
from synth.synthesis.separation import separations
from synth.synthesis.solution import Design, Solution, Status, Timing
from synth.synthesis.verification import verify
from synth.task import Objective

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from synth.arrays import FloatArray
    from synth.robot import Arm, LinkShape
    from synth.synthesis.bound import Bound
    from synth.synthesis.separation import Separation
    from synth.task import Task

_STARTS_AT_MOST = 48
_STARTS_WHEN_IMPOSSIBLE = 12  # for a good best effort
_FOLLOWED = 2  # shapes of a neighbour that are polished
_STARTS_AFTER_FOUND = 4  # for distinct, gentler and nearer alternatives
_STARTS_NO_BETTER = 2  # likewise, of shapes that miss a target
_ALTERNATIVES = 8
_PROOF_TIME = 60.0  # s
# Shapes whose objective is above this multiple of the best one's are no alternatives to it.
_COMPARABLE = 1.5
# A shape that uses less than this part of every tolerance meets the targets exactly: what it misses is
# the price of the gentlest bend.
_EXACTLY = 2e-3
# Two shapes nearer than this all along, m, are one: a hand places the link to 9.6 +- 2.1 mm (Ranne,
# Clark and Rojas, 2022).
_SAME_SHAPE = 0.010
# How often planes between the arm and obstacles are taken anew where the solver ended.
_PLANES_ANEW = 5
_GAINED = 0.9  # of the objective before: the least gain for which to go on
# Targets of all shapes together that are looked at where the search knew only a part of them.
_VERIFIED_AT_MOST = 20_000
_REASONS = 3  # of a kind that are told
_CLASHES = ("obstacle", "itself")


@dataclass(frozen=True)
class Progress:
    """How far a search is: start points polished, of at most how many, and the best worst miss, m.

    While a proof runs, `lower_bound` is the bound so far, m.
    """

    starts: int
    starts_at_most: int
    worst_miss: float
    found: bool
    lower_bound: float | None = None


def solve(
    task: Task,
    *,
    seed: int = 0,
    warm_start: Solution | None = None,
    prove: bool = False,
    time_limit: float = math.inf,
    stop: Callable[[], bool] | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Solution:
    """Find a shape of the malleable link with which the end effector reaches the targets.

    Args:
        task: What is asked.
        seed: Seed of the search.
        warm_start: The solution of a task nearby, of the same robot: targets a few millimetres or
            centimetres away. If one of its two best shapes, polished for this task, reaches every target
            it is returned, with no other shapes beside it. If not, the whole search follows.
        prove: Whether to bound how little any shape can miss; that takes seconds, a minute at most.
        time_limit: Time after which the best shape so far is returned, s.
        stop: Asked many times a second; when it says yes, the best shape so far is returned.
        progress: Told after each start point, and of each step of the proof.

    Returns:
        The solution, whatever was found; its status says what it is worth.
    """
    part = part_of(task, seed)
    search = _Search(task, part, seed, _Clock(time_limit), stop or _never, progress or _silent)
    near = warm_start.designs if warm_start is not None and warm_start.task.robot == task.robot else ()
    if not search.follow(near):
        search.run()
    if prove:
        search.prove()
    return search.solution()


def follow(
    task: Task,
    designs: Sequence[Design],
    *,
    starts: int = 0,
    seed: int = 0,
    stop: Callable[[], bool] | None = None,
) -> Solution:
    """Polish shapes for a task nearby, maybe of a robot nearly the same, and search little farther.

    Args:
        task: The task.
        designs: Shapes, the most promising first.
        starts: How many start points are polished, too, if none of the shapes will do.
        seed: As for `solve`.
        stop: As for `solve`.
    """
    search = _Search(task, part_of(task, seed), seed, _Clock(math.inf), stop or _never, _silent)
    if not search.follow(designs) and starts:
        search.run(starts)
    return search.solution()


def _never() -> bool:
    return False


def _silent(_progress: Progress) -> None:
    pass


class _Clock:
    """Where the time goes."""

    def __init__(self, time_limit: float) -> None:
        self._began = time.perf_counter()
        self._time_limit = time_limit
        self._spent = {"screening": 0.0, "solving": 0.0, "verifying": 0.0, "proving": 0.0}

    @contextmanager
    def on(self, part: str) -> Iterator[None]:
        """Count the time of a block under the name of a part."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self._spent[part] += time.perf_counter() - began

    def is_up(self) -> bool:
        return time.perf_counter() - self._began > self._time_limit

    def timing(self) -> Timing:
        return Timing(time.perf_counter() - self._began, **self._spent)


@dataclass
class _Search:
    """One run of `solve`: the designs so far, for the part of the task that is searched with."""

    task: Task
    part: Task
    seed: int
    clock: _Clock
    stop: Callable[[], bool]
    progress: Callable[[Progress], None]
    designs: list[Design] = field(default_factory=list)
    blocked: list[Design] = field(default_factory=list)
    breakdowns: list[str] = field(default_factory=list)
    starts: int = 0
    starts_at_most: int = 0
    starts_found: int = 0  # since a shape was found, that start included
    interrupted: bool = False
    bound: Bound | None = None

    @cached_property
    def _impossible(self) -> tuple[str, ...]:
        return why_impossible(self.task)

    def follow(self, designs: Sequence[Design]) -> bool:
        """Polish the best shapes for a task nearby; whether one of them reaches every target."""
        for design in designs[:_FOLLOWED]:
            arm = replace(design.arm, robot=self.task.robot, base=self.task.base)
            self._polish(Start(arm, arm.closest_joints(self.part.table.positions)[0]), near=True)
            self.starts += 1
            if self._found() or self._out_of_time():
                break
        return self._found()

    def run(self, most: int | None = None) -> None:
        """Polish start points until enough is found, or the time is up; if `most`, quick ones, so many."""
        self.starts_at_most = self.starts + (most or self._usual_starts)
        no_better = 0
        for start in self._start_points(quick=most is not None or bool(self._impossible)):
            if self._out_of_time():
                # A start that was not polished is better than nothing.
                if not self.designs:
                    self._keep(start.arm, start.joints)
                if self.designs or len(self.blocked) >= _STARTS_WHEN_IMPOSSIBLE:
                    return
                continue
            if not self._may_be_better(start):
                no_better += 1
                if no_better > _STARTS_NO_BETTER:
                    if start.agreed:
                        return
                    continue
            self._polish(start)
            if self._led_astray(start) and self._keep(start.arm, start.joints).verification.possible:
                self._polish(start, near=True)
            self.starts += 1
            self.starts_found += self._found()
            self._report()
            if self.starts >= self.starts_at_most or self.starts_found > _STARTS_AFTER_FOUND:
                return

    def _may_be_better(self, start: Start) -> bool:
        """Whether a start may lead to a better shape than the best: not if its valley is above that."""
        if not self.designs or self._found():
            return True
        least = start.cost / float(self.part.tolerances.min()) ** 2  # in the mean, so also of the worst
        if self.part.objective is Objective.LEAST_SQUARES:
            least *= len(self.part.targets)
        return least < min(_rank(self.part, design)[1] for design in self.designs)

    def _led_astray(self, start: Start) -> bool:
        """Whether polishing may have led away from a start that is nearly an answer, by long first steps."""
        sum_of_squares = self.part.objective is Objective.LEAST_SQUARES
        return sum_of_squares and not self._found() and self._may_be_better(start)

    def prove(self) -> None:
        """Bound how little any shape can miss, unless the search was stopped already."""
        if self.interrupted:
            return
        until = time.perf_counter() + _PROOF_TIME
        certifier = Certifier(
            self.part,
            float(self.task.tolerances.min()),
            self.designs,
            self._keep,
            lambda: self.stop() or self.clock.is_up() or time.perf_counter() > until,
            lambda worst, lower: self.progress(
                Progress(self.starts, self.starts_at_most, worst, self._found(), lower)
            ),
            np.random.default_rng(self.seed),
        )
        with self.clock.on("proving"):
            self.bound = certifier.certificate()

    def _bound_for(self, designs: tuple[Design, ...]) -> Bound | None:
        """Return the bound with what was found for all targets: that of a part holds for all of them."""
        if self.bound is None or self.part is self.task:
            return self.bound
        relative = [float(np.max(d.verification.misses / self.task.tolerances)) for d in designs]
        best = self.bound.tightest_tolerance * min(relative, default=math.inf)
        return replace(self.bound, best_found=best)

    def solution(self) -> Solution:
        """Rank what was found and say what it is worth."""
        designs = self._for_all_targets(_best_of(self.part, [*self.designs, *self._changing_little()]))
        status, reasons = self._verdict(designs)
        misses = _what_misses(self.task, designs[0]) if designs else []
        message = ": ".join(filter(None, [status.sentence, "; ".join([*misses, *reasons])]))
        return Solution(
            self.task,
            status,
            message,
            reasons,
            self.seed,
            designs,
            self.starts,
            self.clock.timing(),
            self._bound_for(designs),
        )

    @property
    def _usual_starts(self) -> int:
        return _STARTS_WHEN_IMPOSSIBLE if self._impossible else _STARTS_AT_MOST

    def _start_points(self, *, quick: bool) -> Iterator[Start]:
        candidates = starts(self.part, self.seed, quick=quick, stop=self._out_of_time)
        while True:
            with self.clock.on("screening"):
                start = next(candidates, None)
            if start is None:
                return
            yield start

    def _verdict(self, designs: tuple[Design, ...]) -> tuple[Status, tuple[str, ...]]:
        """Return how the search ended, and why it found no more, as far as that is known."""
        if designs and designs[0].verification.found:
            return Status.FOUND, ()
        if self._impossible:
            return Status.PROVEN_IMPOSSIBLE, self._impossible
        if self.bound is not None and self.bound.excludes:
            return Status.PROVEN_IMPOSSIBLE, (self.bound.sentence,)
        if self.breakdowns and not (self.designs or self.blocked):
            return Status.FAILED, tuple(self.breakdowns[:1])
        status = Status.LIMIT if self.interrupted else Status.BEST_EFFORT
        if designs:
            return status, _why_not_exact(self.task)
        # As far as the shape tells that breaks the fewest limits.
        nearest = min((d.verification.violations for d in self.blocked), key=len, default=())
        blocking = [violation.sentence for violation in nearest[:_REASONS]]
        return status, ("no shape was found that the hardware can take", *blocking)

    def _polish(self, start: Start, *, near: bool = False) -> None:
        """Solve from one start; where something is in the way, take the planes before it anew.

        Args:
            start: The start.
            near: Whether the answer is near, so that the solver begins with short steps.
        """
        arm, joints, itself = start.arm, start.joints, False
        best = math.inf
        for _ in range(_PLANES_ANEW):
            with self.clock.on("solving"):
                planes = separations(self.part, arm, joints, itself=itself)
                try:
                    answer = self._nlp(planes, near=near).solve(self.part, arm, joints, self._out_of_time)
                except SolverError as error:
                    self.breakdowns.append(str(error))
                    return
            arm, joints = answer.arm, answer.joints
            design = self._keep(arm, joints)
            clashes = [v for v in design.verification.violations if v.limit.startswith(_CLASHES)]
            if not itself and any(clash.limit == "itself" for clash in clashes):
                # The start kept clearer of itself than where the way from there led without planes.
                arm, joints, itself = start.arm, start.joints, True
            # Other planes may give way: as long as they do, or as something is in the way.
            objective = _rank(self.part, design)[1]
            done = not planes or objective > _GAINED * best or design.verification.found
            best = min(best, objective)
            if (done and not clashes) or self._out_of_time():
                return

    def _nlp(self, planes: Sequence[Separation], *, near: bool) -> SynthesisNlp:
        structure = Structure.of(self.part)
        if planes:
            return SynthesisNlp(structure, ARCS, planes)
        return shared_nlp(structure, ARCS, near, threading.get_ident())

    def _keep(self, arm: Arm, joints: FloatArray) -> Design:
        """Check a shape, keep it where it belongs, and return it."""
        with self.clock.on("verifying"):
            design = Design(arm, verify(self.part, arm, joints))
        (self.designs if design.verification.possible else self.blocked).append(design)
        return design

    def _changing_little(self) -> list[Design]:
        """Return the shapes found, bent again: to the same workspace, as near to the present one as may be.

        Joint 1 takes up by how much the link is turned about axis 1, if its limits allow.
        """
        current, found = self.task.current, [design for design in self.designs if design.verification.found]
        if current is None or not found:
            return []
        best = [design.arm for design in _best_of(self.part, found)]
        ends = [arm.shape.end_frame() for arm in best]
        positions, axes = np.array([end for _, end in ends]), np.array([frame[:, 0] for frame, _ in ends])
        bent_again = []
        for where in (ANYWHERE, Interval.fixed(0.0)):
            with self.clock.on("solving"):
                shapes = links_to_poses(
                    self.task.robot.link, positions, axes, current=current, theta1=where, seed=self.seed
                )
            with self.clock.on("verifying"):
                for arm, shape in zip(best, shapes, strict=True):
                    if shape is not None:
                        nearer = replace(arm, shape=shape)
                        bent_again.append(Design(nearer, verify(self.part, nearer)))
        return [design for design in bent_again if design.verification.found]

    def _for_all_targets(self, designs: tuple[Design, ...]) -> tuple[Design, ...]:
        """Return designs improved for all targets, and verified with them, in their order."""
        if self.part is self.task:
            return designs
        with self.clock.on("solving"):
            arms = ranked(self.task, [design.arm for design in designs], self.seed)
        whole = []
        for found in arms[: max(1, _VERIFIED_AT_MOST // len(self.task.targets))]:
            with self.clock.on("solving"):
                arm = improved(self.task, found)
                if self.task.objective is Objective.MINIMAX:
                    arm = levelled(self.task, arm)
            with self.clock.on("verifying"):
                check = verify(self.task, arm)
                # The steps know neither floor nor obstacles.
                if not check.possible:
                    arm, check = found, verify(self.task, found)
            if check.possible:
                whole.append(Design(arm, check))
            else:
                self.blocked.append(Design(arm, check))
        return _best_of(self.task, whole)

    def _found(self) -> bool:
        return any(design.verification.found for design in self.designs)

    def _out_of_time(self) -> bool:
        self.interrupted = self.interrupted or self.stop() or self.clock.is_up()
        return self.interrupted

    def _report(self) -> None:
        worst = min((float(design.verification.misses.max()) for design in self.designs), default=math.inf)
        self.progress(Progress(self.starts, self.starts_at_most, worst, self._found()))


def _what_misses(task: Task, design: Design) -> list[str]:
    """Return a sentence for each target that is not reached, the worst first, three at most."""
    check = design.verification
    order = np.argsort(-check.misses / task.tolerances)
    order = order[~np.array(check.within_tolerance)[order]]
    sentences = [
        f"{task.targets[i].name} misses by {1e3 * check.misses[i]:.2f} mm" for i in order[:3].tolist()
    ]
    return sentences if len(order) <= 3 else [*sentences, f"and {len(order) - 3} more"]


def _why_not_exact(task: Task) -> tuple[str, ...]:
    """Return a sentence if algebra knows of no arm at all that meets the targets exactly."""
    if exact_designs(task) != ():
        return ()
    count = len(task.targets)
    return (f"no arm with this rigid link passes exactly through such {count} targets, by algebra",)


def _rank(task: Task, design: Design) -> tuple[int, float]:
    """Return what is smaller for a better design.

    First those that meet every target exactly, then those that do within its tolerance, both by their
    gentleness or, if the task names the present shape, by how little they change it; then the others by
    the task's objective.
    """
    check = design.verification
    relative = check.misses / task.tolerances
    if check.found:
        return int(relative.max() > _EXACTLY), _effort(task, design.arm.shape)
    weighted = task.weights * relative**2
    return 2, float(weighted.max() if task.objective is Objective.MINIMAX else weighted.sum())


def _effort(task: Task, shape: LinkShape) -> float:
    """Return how far the link moves from its present shape, m^2 in the mean, or else its bending energy."""
    if task.current is None:
        return shape.bending_energy
    share = np.linspace(0.0, 1.0, 50)
    moved = shape.point_at(share * shape.length) - task.current.point_at(share * task.current.length)
    return float(np.mean(np.sum(moved**2, axis=1)))


def _best_of(task: Task, designs: list[Design]) -> tuple[Design, ...]:
    """Return the best designs in order, each different from those before by more than a hand can tell.

    Beside a found design only found ones count, beside a best effort those that miss nearly as little.
    """
    kept: list[Design] = []
    for design in sorted(designs, key=lambda design: _rank(task, design)):
        if kept and not _comparable(_rank(task, design), _rank(task, kept[0])):
            break
        if all(_difference(design, other) > _SAME_SHAPE for other in kept):
            kept.append(design)
    return tuple(kept[:_ALTERNATIVES])


def _comparable(rank: tuple[int, float], best: tuple[int, float]) -> bool:
    missing = 2
    if best[0] < missing:
        return rank[0] < missing
    return rank[1] <= _COMPARABLE * best[1]


def _difference(one: Design, other: Design) -> float:
    """Return the largest distance between two robots: along their links, on axis 2, at P5, m."""
    points = []
    for arm in (one.arm, other.arm):
        link = arm.shape.point_at(np.linspace(0.0, arm.shape.length, 20))
        points.append(
            np.vstack([link, arm.axis_points, arm.base.to_base(arm.forward_kinematics(0.0, np.pi))])
        )
    return float(np.linalg.norm(points[0] - points[1], axis=1).max())
