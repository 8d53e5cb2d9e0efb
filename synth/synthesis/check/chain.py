"""Of several postures at each of many places, one at each: those between which it costs least to get on."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.arrays import FloatArray


class Chain(NamedTuple):
    """The cheapest chain of postures.

    Attributes:
        cost: What it costs; infinite where there is none.
        taken: Which posture it takes at each place; empty where there is none.
        passed: Which step no chain gets over; as many as there are steps where one gets over all.
        reached: Which postures before that step chains get to.
    """

    cost: float
    taken: list[int]
    passed: int
    reached: NDArray[np.bool_]


def cheapest_chain(first: FloatArray, steps: Sequence[FloatArray]) -> Chain:
    """Return the chain of postures that costs least.

    Args:
        first: What each posture at the first place costs, shape (k,).
        steps: For each place but the last what it costs to get from each of its postures to each at the
            next, shape (k, l); infinite where nothing gets there.
    """
    cost, before = first, []
    for number, step in enumerate(steps):
        onward = cost[:, None] + step
        if not np.isfinite(onward).any():
            return Chain(np.inf, [], number, np.isfinite(cost))
        before.append(np.argmin(onward, axis=0))
        cost = np.min(onward, axis=0)
    taken = [int(np.argmin(cost))]
    for choice in reversed(before):
        taken.append(int(choice[taken[-1]]))
    return Chain(float(cost.min()), taken[::-1], len(steps), np.isfinite(cost))
