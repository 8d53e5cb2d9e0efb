"""Hops from valley to valley, where no shape meets all targets.

Such targets make many valleys of the objective, one for each way in which they may lie on the near or the
far side of the surface. Most valleys are beside a better one: a shape bent a little differently is nearest
to some targets on their other side, and the steps from there lead elsewhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.synthesis.population import ARCS, Population, into_limits
from synth.synthesis.refinement import nearest_theta2, refine

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from synth.synthesis.refinement import Refined
    from synth.task import Task

# Rounds, shapes kept of those that miss differently, and children of each.
_ROUNDS, _PARENTS, _CHILDREN = 8, 20, 10
# Sizes of the changes, in units of the largest curvature; lengths change by a twentieth of that, m.
_SIZES, _LENGTHS = (0.03, 0.1, 0.3), 0.05
# Mean squared misses below this, m^2, end it; those nearer to each other than by this part are alike.
_EXACT, _ALIKE = 1e-14, 0.01


def hopped(task: Task, refined: Refined, rng: np.random.Generator) -> Refined:
    """Return the best shapes after a search by random changes of the best ones.

    Args:
        task: The task.
        refined: Shapes at the bottoms of their valleys.
        rng: Source of randomness.
    """
    for _ in range(_ROUNDS):
        if refined.cost.min() < _EXACT:
            break
        parents = np.repeat(_different(refined)[:_PARENTS], _CHILDREN)
        unknowns = refined.population.unknowns[parents]
        size = rng.choice(_SIZES, (len(parents), 1)) * np.ones(unknowns.shape)
        size[:, 2 * ARCS :] *= _LENGTHS
        changed = into_limits(task.robot, unknowns + size * rng.normal(size=unknowns.shape))
        population = Population(task.robot, changed)
        children = refine(task, population, nearest_theta2(task, population.kinematics))
        refined = refined.improved_by(children)
    return refined


def _different(refined: Refined) -> NDArray[np.intp]:
    """Return the best shapes in order, those aside that miss like one before: they are one surface."""
    order = np.argsort(refined.cost, kind="stable")
    kinds = np.round(np.log(refined.cost[order] + _EXACT) / _ALIKE)
    return np.asarray(order[np.flatnonzero(np.diff(kinds, prepend=-np.inf))])
