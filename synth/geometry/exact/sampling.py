"""Designs through fewer targets than fix one: a sample of the family."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.errors import GeometryError
from synth.geometry.exact.exact_arms import TOLERANCE, ExactArms, arms_through_five, arms_through_four
from synth.geometry.exact.newton import misses

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.arrays import FloatArray

# One drawn set in seven has a pair of designs through five targets, one in three through four.
_SETS_PER_DESIGN = 8
_ROUNDS = 16


def sample_exact_arms(
    targets: ArrayLike,
    count: int,
    *,
    reach: float,
    radius: float | None = None,
    seed: int | np.random.Generator = 0,
    tolerance: float = TOLERANCE,
) -> ExactArms:
    """Return designs through one to four targets, or one to three with R known.

    The targets are completed to five (four) by points drawn uniformly in the half-plane of (rho, z) over
    [0, reach] x [-reach, reach], and all designs through the set are kept. So every design returned passes
    every target within the tolerance, and every generic design whose surface has a part in that region may
    be drawn. Those of parallel or meeting axes are not: see `planes_through` and `spheres_through`.

    Args:
        targets: Shape (n, 3), m; of those on one circle about axis 1 only one counts.
        count: How many designs to return.
        reach: Extent of the region that the missing targets are drawn from, m.
        radius: A known R, m; or any.
        seed: Seed or generator of the draws; the same seed gives the same designs.
        tolerance: Largest distance of a target from the surface of a design, m.

    Returns:
        One set with `count` designs in the order of the draws: values (count, 5) and misses (count,). There
        are fewer, possibly none, if 128 draws for each have not sufficed: the targets may then be too far
        apart for R.

    Raises:
        GeometryError: If there are no targets, or too many, or they are not finite; or if the reach or R
            is not positive.
    """
    array = np.asarray(targets, dtype=np.float64)
    needed = 5 if radius is None else 4
    if array.ndim != 2 or array.shape[1] != 3 or not np.all(np.isfinite(array)) or not reach > 0.0:
        raise GeometryError("A sample needs targets of three finite numbers and a positive reach.")
    rho, z = np.hypot(array[:, 0], array[:, 1]), array[:, 2]
    given = _distinct(rho, z, tolerance)
    if not 1 <= len(given) < needed:
        raise GeometryError(
            f"A sample needs 1 to {needed - 1} targets on distinct circles, not {len(given)}."
        )
    rng = np.random.default_rng(seed)
    values, worst = np.empty((0, 5)), np.empty(0)
    for _ in range(_ROUNDS):
        sets = np.zeros((_SETS_PER_DESIGN * count, needed, 3))
        sets[:, : len(given)] = given
        drawn = sets[:, len(given) :]
        drawn[..., 0] = rng.uniform(0.0, reach, drawn.shape[:-1])
        drawn[..., 2] = rng.uniform(-reach, reach, drawn.shape[:-1])
        designs = arms_through_five(sets) if radius is None else arms_through_four(sets, radius)
        rows = designs.values[designs.found]
        miss = misses(rows, rho, z)
        values = np.concatenate([values, rows[miss <= tolerance]])
        worst = np.concatenate([worst, miss[miss <= tolerance]])
        if len(values) >= count:
            break
    return ExactArms(values[:count], worst[:count])


def _distinct(rho: FloatArray, z: FloatArray, tolerance: float) -> FloatArray:
    """Return one point (rho, 0, z) of each circle about axis 1 that targets lie on, shape (m, 3), m."""
    points = np.stack([rho, np.zeros_like(rho), z], axis=-1)
    apart = np.linalg.norm(points[:, None] - points[None], axis=-1) > tolerance
    first = (apart | (np.arange(len(points))[:, None] <= np.arange(len(points)))).all(axis=1)
    return np.asarray(points[first])
