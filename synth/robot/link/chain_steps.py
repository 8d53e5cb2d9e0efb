"""Steps that bring chains of arcs to an aim within the limits of the link, and then ease them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self

import numpy as np

from synth.arrays import frozen_value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.arrays import FloatArray
    from synth.robot.hardware import Interval
    from synth.robot.link.arc_chains import ArcChains
    from synth.robot.link.chain_limits import Projection

ARRIVED = 1e-10  # what may be left of an aim, in units of the bend radius and rad

_PATIENCE = 10  # steps after which a chain must have come closer
_PROGRESS = 0.9  # of its miss: what keeps more than this is given up
_FIRST_DAMPING = 1e-3
_LEAST_DAMPING = 1e-13
_MOST_DAMPING = 1e6
_DUAL_STEPS = 20
_DUAL_PRECISION = 1e-12
_EASING_STEPS = 80
_ON_THE_WAY = 1e-6  # what may be left of an aim between two easing steps
_SETTLED = 1e-6  # relative gain of a step below which, three times, a chain is at its optimum


class Aim(Protocol):
    """What rows of unknowns are to meet, each its own. The last unknown of a row is theta1, in rad."""

    @property
    def theta1(self) -> Interval:
        """Where theta1 may be."""
        ...

    def take(self, rows: NDArray[np.intp]) -> Self:
        """Return the aims of some of the rows."""
        ...

    def off(self, chains: ArcChains, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what is left of the aims, shape (n, m), and its derivative, shape (n, m, unknowns + 1)."""
        ...


@frozen_value
class Wish:
    """What is wanted of the chains at their aim: to be bent little or, with a present one, to change little.

    Attributes:
        chains: What the rows mean.
        current: The unknowns of the present chain, shape (unknowns,), or None.
    """

    chains: ArcChains
    current: FloatArray | None

    def cost(self, x: FloatArray) -> FloatArray:
        """Return the bending energy, or the squared change, of rows x, shape (...)."""
        if self.current is None:
            return self.chains.energy(x[..., :-1])
        return np.asarray(np.sum((x[..., :-1] - self.current) ** 2, axis=-1))

    def direction(self, x: FloatArray) -> FloatArray:
        """Return the step from rows x, shape (n, unknowns + 1), that would be right if there were no aim."""
        still = np.zeros(len(x))
        if self.current is not None:
            return np.column_stack([self.current - x[:, :-1], still])
        # The energy is sum(k^2) L / arcs: its derivative by q, over its second derivative by a curvature.
        middle = self.chains.link.length.middle / self.chains.link.min_bend_radius
        shorter = np.sum(x[:, :-2] ** 2, axis=1) * middle / self.chains.length(x[:, :-1])
        return np.column_stack([-x[:, :-2], -0.5 * shorter / np.sqrt(self.chains.arcs), still])


def stepped(chains: ArcChains, aim: Aim, starts: FloatArray, steps: int) -> tuple[FloatArray, FloatArray]:
    """Improve chains by damped Gauss-Newton steps within their limits.

    Args:
        chains: What the rows mean.
        aim: What they are to meet.
        starts: Rows within the limits, shape (n, unknowns + 1).
        steps: The most steps.

    Returns:
        The rows, and the norm of what is left of each aim, shape (n,).
    """
    x = np.array(starts)
    off, slope = aim.off(chains, x)
    left = np.linalg.norm(off, axis=1)
    damping, earlier = np.full(len(x), _FIRST_DAMPING), np.full(len(x), np.inf)
    for step in range(steps):
        if step % _PATIENCE == 0:
            damping[left > _PROGRESS * earlier] = np.inf
            earlier = left.copy()
        going = np.flatnonzero((left > ARRIVED) & (damping < _MOST_DAMPING))
        if not len(going):
            break
        goal = np.einsum("nij,nj->ni", slope[going], x[going]) - off[going]
        some = aim.take(going)
        moved = constrained(chains, some, x[going], (x[going], slope[going], goal), damping[going])
        moved_off, moved_slope = some.off(chains, moved)
        moved_left = np.linalg.norm(moved_off, axis=1)
        better = moved_left < left[going]
        rows = going[better]
        x[rows], off[rows], slope[rows] = moved[better], moved_off[better], moved_slope[better]
        left[rows] = moved_left[better]
        less, more = 0.1 * damping[going], 10.0 * np.maximum(damping[going], 1e-6)
        damping[going] = np.maximum(np.where(better, less, more), _LEAST_DAMPING)
    return x, left


def eased(chains: ArcChains, aim: Aim, x: FloatArray, wish: Wish) -> FloatArray:
    """Return rows that meet their aim moved along it to a local minimum of what is wished."""
    x, cost = np.array(x), wish.cost(x)
    stride, settled = np.ones(len(x)), np.zeros(len(x), dtype=int)
    for _ in range(_EASING_STEPS):
        going = np.flatnonzero((stride > 1e-3) & (settled < 3))
        if not len(going):
            break
        some = aim.take(going)
        off, slope = some.off(chains, x[going])
        goal = np.einsum("nij,nj->ni", slope, x[going]) - off
        centre = x[going] + stride[going, None] * wish.direction(x[going])
        exact = np.full(len(going), 1e-9)
        moved = constrained(chains, some, x[going], (centre, slope, goal), exact)
        moved, left = stepped(chains, some, moved, 4)
        gain = 1.0 - wish.cost(moved) / np.maximum(cost[going], 1e-300)
        better = (left <= _ON_THE_WAY) & (gain > 0.0)
        x[going[better]], cost[going[better]] = moved[better], wish.cost(moved[better])
        settled[going] = np.where(better & (gain > _SETTLED), 0, settled[going] + better)
        stride[going] *= np.where(better, 1.5, 0.4)
        stride = np.minimum(stride, 1.0)
    return stepped(chains, aim, x, _PATIENCE)[0]


def constrained(
    chains: ArcChains,
    aim: Aim,
    x: FloatArray,
    problem: tuple[FloatArray, FloatArray, FloatArray],
    damping: FloatArray,
) -> FloatArray:
    """Return rows y within the limits that minimise |y - centre|^2 / 2 + |slope y - goal|^2 / (2 damping).

    By Newton's method on the dual problem: y is the projection of centre - slope^T mu into the limits, and
    the concave dual function of mu has the gradient slope y - goal - damping mu.

    Args:
        chains: What the rows mean.
        aim: Of which only the limits of theta1 count.
        x: Rows whose lengths the limit of the total bend is taken for, shape (n, unknowns + 1).
        problem: Centre, shape (n, unknowns + 1), slope, (n, m, unknowns + 1), and goal, (n, m).
        damping: Shape (n,).
    """
    centre, slope, goal = problem
    length = chains.length(x[:, :-1])

    def answer(
        rows: NDArray[np.intp], mu: FloatArray
    ) -> tuple[FloatArray, Projection, NDArray[np.bool_], FloatArray, FloatArray]:
        y = centre[rows] - np.einsum("nij,ni->nj", slope[rows], mu)
        y[:, :-1], projection = chains.projected(y[:, :-1], length[rows])
        turned = np.clip(y[:, -1], aim.theta1.lower, aim.theta1.upper)
        turns = turned == y[:, -1]
        y[:, -1] = turned
        miss = np.einsum("nij,nj->ni", slope[rows], y) - goal[rows]
        dual = 0.5 * np.sum((y - centre[rows]) ** 2, axis=1) + np.sum(mu * miss, axis=1)
        dual -= 0.5 * damping[rows] * np.sum(mu**2, axis=1)
        return y, projection, turns, miss - damping[rows, None] * mu, dual

    mu, held = np.zeros_like(goal), np.full(len(x), _DUAL_PRECISION)
    y, projection, turns, gradient, dual = answer(np.arange(len(x)), mu)
    for _ in range(_DUAL_STEPS):
        going = np.flatnonzero((np.linalg.norm(gradient, axis=1) > _DUAL_PRECISION) & (held < _MOST_DAMPING))
        if not len(going):
            break
        by_unknowns, by_turn = slope[going, :, :-1], slope[going, :, -1] * turns[going, None]
        hessian = projection.take(going).between(by_unknowns) + by_turn[:, :, None] * by_turn[:, None, :]
        hessian += (damping[going] + held[going])[:, None, None] * np.eye(goal.shape[1])
        trial = mu[going] + np.linalg.solve(hessian, gradient[going, :, None])[..., 0]
        changed = answer(going, trial)
        better = changed[-1] >= dual[going] - 1e-15 * np.abs(dual[going])
        rows = going[better]
        mu[rows] = trial[better]
        y[rows], turns[rows], gradient[rows], dual[rows] = (changed[i][better] for i in (0, 2, 3, 4))
        for whole, part in zip(projection, changed[1], strict=True):
            whole[rows] = part[better]
        held[going] = np.where(better, 0.1 * held[going], np.maximum(100.0 * held[going], 1e-6))
        held = np.maximum(held, _DUAL_PRECISION)
    y[:, :-1] = chains.into_limits(y[:, :-1])
    return y
