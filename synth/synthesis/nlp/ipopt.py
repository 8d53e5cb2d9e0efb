"""Ipopt: with which options it runs, how it is asked to stop, and which of its endings are answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from synth.errors import SolverError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from synth.arrays import FloatArray
    from synth.synthesis.nlp.blocks import Constraints, Unknowns
    from synth.watch import Watch

_OPTIONS = {
    "print_time": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.linear_solver": "mumps",
    "ipopt.max_iter": 300,
    "ipopt.tol": 1e-8,
    "ipopt.constr_viol_tol": 1e-9,
}
_PUSHES = ("ipopt.bound_push", "ipopt.bound_frac", "ipopt.slack_bound_push", "ipopt.slack_bound_frac")
# Barrier and distance from the bounds with which the solver begins near the answer.
_NEAR = {"ipopt.mu_init": 1e-6} | dict.fromkeys(_PUSHES, 1e-6)
# From a shape that is nearly clear short first steps lead to a clear one; long ones lose it.
_NEARLY_CLEAR = {"ipopt.mu_init": 1e-4} | dict.fromkeys(_PUSHES, 1e-5)

_ANSWERS = frozenset(
    {
        "Solve_Succeeded",
        "Solved_To_Acceptable_Level",
        "Feasible_Point_Found",
        "Search_Direction_Becomes_Too_Small",
        "Maximum_Iterations_Exceeded",
        "Maximum_WallTime_Exceeded",
        "User_Requested_Stop",
        "Infeasible_Problem_Detected",
        "Restoration_Failed",
        "Diverging_Iterates",
    }
)


class Ipopt:
    """The solver of one program: least objective over the unknowns, under the constraints.

    Args:
        x: The unknowns.
        g: The constraints.
        parameters: What has other values in each run, a column.
        objective: What is to be least.
        near: Whether it starts near the answer.
        nearly_clear: Whether, if not, it starts nearly clear of obstacles.
    """

    def __init__(
        self,
        x: Unknowns,
        g: Constraints,
        parameters: ca.SX,
        objective: ca.SX,
        *,
        near: bool,
        nearly_clear: bool,
    ) -> None:
        self._bounds = {"lbx": x.lower, "ubx": x.upper, "lbg": g.lower, "ubg": g.upper}
        problem = {"x": x.vector, "p": parameters, "f": objective, "g": g.vector}
        options: dict[str, Any] = dict(_OPTIONS)
        if near:
            options |= _NEAR
        elif nearly_clear:
            options |= _NEARLY_CLEAR
        # The solver keeps no reference to its callback: this object must.
        self._iterations = _Iterations(problem["x"].numel(), problem["g"].numel(), parameters.numel())
        options["iteration_callback"] = self._iterations
        self._solver = ca.nlpsol("synthesis", "ipopt", problem, options)

    def solve(
        self, start: FloatArray, parameters: FloatArray, watch: Watch | None
    ) -> tuple[FloatArray, str, int]:
        """Run from a start.

        Args:
            start: Values of the unknowns to start from.
            parameters: Values of the parameters.
            watch: Asked once an iteration; when it is up, the solver ends with what it has.

        Returns:
            The values of the unknowns where it ended, its own word for how, and the number of iterations.

        Raises:
            SolverError: It broke down without an answer.
            KeyboardInterrupt: The user interrupted it (it swallows the exception).
            BaseException: What the watch raised, for the same reason only here.
        """
        self._iterations.watch, self._iterations.raised = watch, None
        x = self._solver(x0=start, p=parameters, **self._bounds)["x"]
        raised = self._iterations.raised
        self._iterations.watch = self._iterations.raised = None
        if raised is not None:
            raise raised
        statistics = self._solver.stats()
        status = str(statistics["return_status"])
        if status == "NonIpopt_Exception_Thrown":
            raise KeyboardInterrupt
        values = np.asarray(x.full()).ravel()
        if status not in _ANSWERS or not np.isfinite(values).all():
            raise SolverError(f"Ipopt ended with {status}")
        return values, status, int(statistics["iter_count"])


class _Iterations(ca.Callback):
    """Asked by Ipopt once an iteration whether to go on."""

    def __init__(self, unknowns: int, constraints: int, parameters: int) -> None:
        ca.Callback.__init__(self)
        self._rows = {"x": unknowns, "lam_x": unknowns, "f": 1, "g": constraints, "lam_g": constraints}
        self._rows["lam_p"] = parameters
        self.watch: Watch | None = None
        self.raised: BaseException | None = None
        self.construct("iterations", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, index: int) -> str:
        return str(ca.nlpsol_out(index))

    def get_sparsity_in(self, index: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self._rows.get(ca.nlpsol_out(index), 0), 1)

    def eval(self, _arguments: Sequence[ca.DM]) -> list[int]:
        try:
            return [int(self.watch is not None and self.watch.is_up())]
        except BaseException as error:  # noqa: BLE001 - raised again as soon as the solver has returned
            self.raised = error
            return [1]
