"""The peers: each searches until its race is over, restarting as its own documentation advises."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable

import cma
import compiled_miss
import numpy as np
from compiled_link import bounds
from compiled_residuals import jacobian, residuals
from peer_gamma import raw_gamma
from peer_race import Race
from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.core.callback import Callback
from pymoo.core.problem import Problem
from pymoo.optimize import minimize as pymoo_minimize
from pymoo.termination.default import DefaultSingleObjectiveTermination
from scipy.optimize import differential_evolution, least_squares, minimize

from synth.errors import SolverError
from synth.synthesis import solve
from synth.synthesis.nlp import Structure, shared_nlp
from synth.synthesis.shapes.shapes import ARCS
from synth.watch import Watch

Method = Callable[[Race], None]


def evolution(race: Race) -> None:
    """scipy differential_evolution: vectorised over the compiled miss, polished by L-BFGS-B.

    best1bin. Eight members an unknown (default 15), recombination 0.9 (0.7), dither (0.3, 0.8) (0.5, 1), tol
    0.1 (0.01, the polish does the rest) took a third of the time of the defaults, and succeeded as often.
    """
    box = list(zip(*bounds(race.task), strict=True))

    def watch(intermediate_result) -> bool:
        return race.offer(intermediate_result.x, intermediate_result.fun)

    while not race.over:
        answer = differential_evolution(
            compiled_miss.costs, box, args=race.arguments, vectorized=True, updating="deferred",
            popsize=8, recombination=0.9, mutation=(0.3, 0.8), tol=0.1, maxiter=2000, polish=False,
            rng=race.rng, callback=watch,
        )  # fmt: skip
        _polish(race, answer.x)
        race.finish()


def _polish(race: Race, x: np.ndarray) -> None:
    """As differential_evolution's own polish, but with the compiled gradient, and able to stop."""
    if race.over:
        return

    def value_and_slope(x):
        rows = residuals(x, *race.arguments)
        return rows @ rows, 2.0 * jacobian(x, *race.arguments).T @ rows

    def watch(intermediate_result) -> None:
        if race.offer(intermediate_result.x, intermediate_result.fun):
            raise StopIteration

    box = list(zip(*bounds(race.task), strict=True))
    answer = minimize(
        value_and_slope, x, jac=True, method="L-BFGS-B", bounds=box, callback=watch,
        options={"ftol": 1e-14, "gtol": 1e-12, "maxiter": 1000},
    )  # fmt: skip
    race.offer(answer.x, answer.fun)


def cma_es(race: Race) -> None:
    """CMA-ES with BIPOP restarts: unknowns scaled to one box, first step 0.3 of its width."""
    lower, upper = bounds(race.task)
    width = upper - lower

    def costs(scaled):
        return compiled_miss.costs(
            np.ascontiguousarray((lower + width * np.array(scaled)).T), *race.arguments
        )

    def watch(strategy) -> bool:
        return race.offer(lower + width * strategy.best.x, strategy.best.f)

    while not race.over:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cma.fmin2(
                None, lambda: race.rng.uniform(size=len(lower)), 0.3,
                {
                    "bounds": [0.0, 1.0], "seed": int(race.rng.integers(1, 2**31)), "verbose": -9,
                    "termination_callback": watch, "tolfun": 1e-12, "tolx": 1e-9,
                },
                parallel_objective=lambda scaled, *_: list(costs(scaled)), bipop=True,
                restarts=9 if race.told else 2,
            )  # fmt: skip
        race.finish()


class _Shapes(Problem):
    """The mean squared miss over the box of the unknowns, for pymoo."""

    def __init__(self, race: Race) -> None:
        lower, upper = bounds(race.task)
        super().__init__(n_var=len(lower), n_obj=1, xl=lower, xu=upper)
        self._race = race

    def _evaluate(self, x, out, *_arguments, **_options) -> None:
        out["F"] = compiled_miss.costs(np.ascontiguousarray(x.T), *self._race.arguments)


class _Watch(Callback):
    def __init__(self, race: Race) -> None:
        super().__init__()
        self._race = race

    def notify(self, algorithm) -> None:
        best = algorithm.opt[0]
        if self._race.offer(best.X, float(best.F[0])):
            algorithm.termination.terminate()


def genetic(race: Race) -> None:
    """pymoo's GA: 100 shapes, SBX and polynomial mutation, its own termination, L-BFGS-B at the end."""
    while not race.over:
        answer = pymoo_minimize(
            _Shapes(race), GA(pop_size=100, eliminate_duplicates=True),
            DefaultSingleObjectiveTermination(ftol=1e-8, period=30), callback=_Watch(race),
            seed=int(race.rng.integers(2**31)), verbose=False,
        )  # fmt: skip
        _polish(race, answer.X)
        race.finish()


def least_squares_differences(race: Race) -> None:
    """Multi-start scipy least_squares as it comes: trf within the box, Jacobian by its own differences."""
    box = bounds(race.task)
    while not race.over:
        for start in race.starts():
            inside = np.clip(start, box[0] + 1e-6, box[1] - 1e-6)
            answer = least_squares(residuals, inside, bounds=box, args=race.arguments)
            race.count_minimum(2.0 * answer.cost)
            if race.offer(answer.x, 2.0 * answer.cost):
                return


def least_squares_compiled(race: Race) -> None:
    """Multi-start scipy least_squares: lm, with a compiled Jacobian across the free joints."""
    while not race.over:
        for start in race.starts():
            answer = least_squares(
                residuals, start, jacobian,
                method="lm", args=race.arguments, max_nfev=60,
            )  # fmt: skip
            race.count_minimum(2.0 * answer.cost)
            if race.offer(answer.x, 2.0 * answer.cost):
                return


def lifted(race: Race) -> None:
    """Multi-start Ipopt on the lifted form, `synth`'s own program, from random shapes."""
    nlp = shared_nlp(Structure.of(race.task), ARCS, False, threading.get_ident())
    watch = Watch(stop=lambda: race.seconds > race.budget)
    while not race.over:
        for start in race.starts():
            arm = race.arm(start)
            joints, _ = arm.closest_joints(race.targets)
            try:
                answer = nlp.solve(race.task, arm, joints, watch)
            except SolverError:
                continue
            if race.offer_arm(answer.arm, answer.joints):
                return


def first_shape(race: Race) -> None:
    """`synth.solve` itself, stopped when every target is within its tolerance."""
    solution = solve(race.task, alternatives=0)
    race.offer_arm(solution.best.arm, solution.best.verification.joints)


METHODS: dict[str, Method] = {
    "differential evolution (scipy)": evolution,
    "CMA-ES (cma)": cma_es,
    "genetic algorithm (pymoo)": genetic,
    "multi-start Ipopt, raw Gamma": raw_gamma,
    "multi-start Ipopt, lifted": lifted,
    "multi-start least squares (scipy)": least_squares_differences,
    "least squares, Jacobian compiled": least_squares_compiled,
}
# Its answers are surfaces, judged by the distance to them; limits of link and joints do not count.
NOT_AN_ARM = frozenset({"multi-start Ipopt, raw Gamma"})
