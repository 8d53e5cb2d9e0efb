"""What global solvers prove of the worst miss, beside `synth solve --prove`, on the same tasks."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import pyscipopt
from lifted_program import PER_METRE, LiftedProgram
from peer_gamma import feasibility, gamma_terms, longest
from peer_report import markdown_table
from peer_tasks import noisy_task

from synth.synthesis import solve
from synth.task import Objective

try:
    import gurobipy
except ImportError:  # its row is left out then
    gurobipy = None

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.task import Task

GAP = 1e-4  # m: all may end when the bound is as near as this to the best they know, as `--prove` does
TASKS = ((2, 0), (6, 1), (6, 2))  # numbers of targets and seeds of noisy tasks
_HEAD = ["method", "targets", "worst miss at least, mm", "least worst miss found, mm", "time, s"]


@dataclass(frozen=True)
class Proof:
    """What was proven of a task: the bound and the least worst miss found, m; and the time it took, s."""

    bound: float
    best: float
    seconds: float


def _scip(state: Callable[[pyscipopt.Model], object], seconds: float, per_metre: float) -> Proof:
    """Let SCIP minimise what a program is stated to return, in so much processor time, s."""
    model = pyscipopt.Model()
    model.hideOutput()
    model.setParam("timing/clocktype", 1)
    model.setParam("limits/time", seconds)
    model.setParam("limits/absgap", per_metre * GAP)
    model.setObjective(state(model))
    began = time.process_time()
    model.optimize()
    best = model.getObjVal() / per_metre if model.getNSols() else math.inf
    return Proof(model.getDualbound() / per_metre, best, time.process_time() - began)


def _quartics(model: pyscipopt.Model, task: Task, worst_known: float) -> object:
    """State the quartics: the four squared distances, the coefficients of Gamma, and a point for each target.

    The point (rho, z) of the surface lies in the target's half-plane. Limits of link and joints are left out.
    """
    robot = task.robot
    lower, upper = longest(robot)
    s = [model.addVar(f"s{i}", lb=lower[i], ub=upper[i]) for i in range(4)]
    for slack in feasibility(robot, s):
        model.addCons(slack >= 0.0)
    q = []
    for i, term in enumerate(gamma_terms(robot, s)):
        q.append(model.addVar(f"q{i}", lb=None))
        model.addCons(q[-1] == term)
    worst = model.addVar("worst", lb=0.0, ub=worst_known)
    for x, y, z_target in task.positions_in_base:
        r = math.hypot(x, y)
        rho = model.addVar(lb=max(r - worst_known, 0.0), ub=r + worst_known)
        z = model.addVar(lb=z_target - worst_known, ub=z_target + worst_known)
        n = model.addVar(lb=0.0, ub=(r + worst_known) ** 2 + (abs(z_target) + worst_known) ** 2)
        model.addCons(n == rho * rho + z * z)
        height = robot.d12 * z
        model.addCons(
            q[0] * n * n + q[1] * height * n + q[2] * rho * rho + q[3] * z * z + q[4] * height + q[5] == 0.0
        )
        off = (rho - r) * (rho - r) + (z - z_target) * (z - z_target)
        model.addCons(PER_METRE**2 * (off - worst * worst) <= 0.0)  # squares of small misses are tiny in m^2
    return worst


def _lifted(model: object, require: Callable, task: Task, worst_known: float) -> object:
    def unknown(name: str, lower: float, upper: float) -> object:
        return model.addVar(name=name, lb=lower, ub=upper)

    return LiftedProgram(unknown, require, task, worst_known).state()


def by_scip_quartics(task: Task, worst_known: float, seconds: float) -> Proof:
    return _scip(lambda model: _quartics(model, task, worst_known), seconds, 1.0)


def by_scip_lifted(task: Task, worst_known: float, seconds: float) -> Proof:
    return _scip(lambda model: _lifted(model, model.addCons, task, worst_known), seconds, PER_METRE)


def by_gurobi_lifted(task: Task, worst_known: float, seconds: float) -> Proof:
    """Let Gurobi bound the worst miss, on one thread; the restricted licence of its package is enough."""
    with gurobipy.Env(params={"OutputFlag": 0}) as environment, gurobipy.Model(env=environment) as model:
        for name, value in {
            "NonConvex": 2,
            "Threads": 1,
            "MIPGap": 0.0,
            "MIPGapAbs": PER_METRE * GAP,
        }.items():
            model.setParam(name, value)
        model.setObjective(_lifted(model, model.addConstr, task, worst_known))
        began = time.process_time()

        def watch(running: gurobipy.Model, _where: int) -> None:
            if time.process_time() - began > seconds:
                running.terminate()

        model.optimize(watch)
        best = model.ObjVal / PER_METRE if model.SolCount else math.inf
        return Proof(model.ObjBound / PER_METRE, best, time.process_time() - began)


def by_synth(task: Task, _worst_known: float, seconds: float) -> Proof:
    """Search and prove: what the others are told is found here, too."""
    began = time.process_time()
    bound = solve(task, prove=True, time_limit=seconds).bound
    return Proof(bound.lower_bound, bound.best_found, time.process_time() - began)


PROVERS = {
    "`synth solve --prove`": by_synth,
    "SCIP, quartics": by_scip_quartics,
    "SCIP, lifted program": by_scip_lifted,
    "Gurobi, lifted program": by_gurobi_lifted,
}


def bounds_table(seconds: float) -> str:
    """Return in Markdown what each prover proves in so much time, s, of tasks of two and of six targets."""
    rows = []
    for count, seed in TASKS:
        task = replace(noisy_task(seed, count), objective=Objective.MINIMAX)
        worst_known = float(solve(task).best.verification.misses.max()) + GAP
        for name, prover in PROVERS.items():
            if prover is by_gurobi_lifted and gurobipy is None:
                print("Gurobi is left out: the package gurobipy is not installed", flush=True)
                continue
            rows.append([name, f"{count}, seed {seed}", *_figures(prover(task, worst_known, seconds))])
            print(", ".join(rows[-1]), flush=True)
    return "\n".join(markdown_table(_HEAD, rows))


def _figures(proof: Proof) -> list[str]:
    """Return bound and best, mm, the bound rounded down, and the time, s."""
    bound = max(math.floor(1e5 * proof.bound) / 100.0, 0.0)
    best = f"{max(math.ceil(1e5 * proof.best), 0) / 100.0:.2f}" if math.isfinite(proof.best) else "none"
    return [f"{bound:.2f}", best, f"{proof.seconds:.3g}"]
