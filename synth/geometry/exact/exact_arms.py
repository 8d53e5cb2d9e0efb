"""All arms whose workspace surface passes exactly through five targets, or four with R known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.errors import GeometryError
from synth.geometry.exact.conics import Conics
from synth.geometry.exact.newton import folded, misses, polish, sorted_without_twins
from synth.geometry.exact.pencil import members_of_radius
from synth.geometry.invariants import Invariants

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from synth.geometry.exact.conics import BoolArray

# Largest miss of an answer, m: far above rounding (1e-15), far below any hardware.
TOLERANCE = 1e-9


@frozen_value
class ExactArms:
    """The designs through each of many target sets, as arrays.

    A design stands for four arms: its mirror image has the same invariants, and (pi - alpha, -h) is the
    same axis 2 turned round. The representative has alpha <= pi/2, and h >= 0 where alpha = pi/2.

    Attributes:
        values: a, alpha, z0, h, R of up to k designs of each set, shape (..., k, 5), m and rad; by rising
            a, and nan where there are fewer.
        misses: Largest distance of a target from the surface, shape (..., k), m; nan where none is.
    """

    values: FloatArray
    misses: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values))
        object.__setattr__(self, "misses", frozen(self.misses))

    @property
    def found(self) -> BoolArray:
        """Which of the k places hold a design, shape (..., k)."""
        return ~np.isnan(self.misses)

    def of(self, *index: int) -> tuple[Invariants, ...]:
        """Return the designs of one set: no index for a single set, else its place among the sets."""
        values, found = self.values[index], self.found[index]
        if found.ndim != 1:
            raise GeometryError(f"There are {self.found.shape[:-1]} target sets: name one by its index.")
        return tuple(Invariants(*row) for row in values[found].tolist())


def is_generic(targets: ArrayLike) -> BoolArray:
    """Return whether sets of four or five targets have finitely many designs, and so are answered.

    Args:
        targets: Shape (..., 4, 3) or (..., 5, 3), m.

    Returns:
        Shape (...); false for targets in one plane z, on a sphere about a point of axis 1, or with two on
        one circle about it.
    """
    flat, sets = _target_sets(targets, np.shape(targets)[-2])
    return Conics.through(flat).generic.reshape(sets)


def arms_through_five(targets: ArrayLike, *, tolerance: float = TOLERANCE) -> ExactArms:
    """Return all designs through five targets: none, or two, each the `cognate` of the other (k = 2).

    Five points of the plane of (z, N) fix a conic. If it is an ellipse, a cubic has the two arms with this
    surface as its roots, or none: see `conics`. The two are one where the circle meets axis 1.

    Only generic sets are answered. Targets in one plane z, on a sphere about a point of axis 1, or with
    two on one circle about it have infinitely many designs: see `planes_through`, `spheres_through`
    and `sample_exact_arms`.

    Args:
        targets: Shape (..., 5, 3), m; only sqrt(x^2 + y^2) and z matter.
        tolerance: Largest distance of a target from the surface of an answer, m.

    Raises:
        GeometryError: If the targets are not finite or not five.
    """
    flat, sets = _target_sets(targets, 5)
    conics = Conics.through(flat)
    # A conic that is no ellipse becomes nan, which no comparison accepts.
    with np.errstate(all="ignore"):
        ellipses = conics.ellipses(conics.basis)
        squared_normals, real = ellipses.squared_normals()
        starts, possible = ellipses.designs(squared_normals)
    return _answers(flat, sets, starts, possible & real & conics.generic[:, None], tolerance)


def arms_through_four(targets: ArrayLike, radius: ArrayLike, *, tolerance: float = TOLERANCE) -> ExactArms:
    """Return all designs with a known R through four targets: none, two, four or six (k = 6).

    The conics through four points of the plane of (z, N) form a pencil, in which those of arms with the
    radius R are the roots of a sextic: see `pencil`.

    Only generic sets are answered, as in `arms_through_five`.

    Args:
        targets: Shape (..., 4, 3), m; only sqrt(x^2 + y^2) and z matter.
        radius: R, m; one number, or one for each set, shape (...).
        tolerance: Largest distance of a target from the surface of an answer, m.

    Raises:
        GeometryError: If the targets are not finite or not four, or R is not positive.
    """
    flat, sets = _target_sets(targets, 4)
    r = np.broadcast_to(np.asarray(radius, dtype=np.float64), sets).reshape(-1, 1)
    if not (np.all(np.isfinite(r)) and np.all(r > 0.0)):
        raise GeometryError("A known radius must be a positive number.")
    conics = Conics.through(flat)
    members, nearly_real = members_of_radius(conics, r)
    with np.errstate(all="ignore"):
        ellipses = conics.ellipses(members)
        starts, possible = ellipses.designs(ellipses.P / r**2)
    starts[..., 4] = r
    possible &= nearly_real & conics.generic[:, None]
    return _answers(flat, sets, starts, possible, tolerance, fixed_radius=True)


def _target_sets(targets: ArrayLike, count: int) -> tuple[FloatArray, tuple[int, ...]]:
    """Return targets as a list of sets, shape (S, count, 3), m, and the shape of the sets."""
    array = np.asarray(targets, dtype=np.float64)
    if array.shape[-2:] != (count, 3) or not np.all(np.isfinite(array)):
        raise GeometryError(f"A target set must be {count} points of three finite numbers.")
    return array.reshape(-1, count, 3), array.shape[:-2]


def _answers(
    targets: FloatArray,
    sets: tuple[int, ...],
    starts: FloatArray,
    possible: BoolArray,
    tolerance: float,
    *,
    fixed_radius: bool = False,
) -> ExactArms:
    """Return what becomes of the possible starts, shape (S, k, 5), once polished, checked and folded."""
    rho, z = np.hypot(targets[..., 0], targets[..., 1]), targets[..., 2]
    places = starts.shape[1]
    of_set, place = np.nonzero(possible)
    values, worst = np.full(starts.shape, np.nan), np.full(possible.shape, np.nan)
    with np.errstate(all="ignore"):
        polished = polish(starts[of_set, place], rho[of_set], z[of_set], fixed_radius=fixed_radius)
        miss = misses(polished, rho[of_set], z[of_set])
    hit = miss <= tolerance
    values[of_set[hit], place[hit]] = folded(polished[hit])
    worst[of_set[hit], place[hit]] = miss[hit]
    values, order = sorted_without_twins(values)
    worst = np.where(np.isnan(values[..., 0]), np.nan, np.take_along_axis(worst, order, axis=-1))
    return ExactArms(values.reshape(*sets, places, 5), worst.reshape(*sets, places))
