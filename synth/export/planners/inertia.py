"""Mass, centre and inertia of straight pieces, as solid cylinders of one density."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value

if TYPE_CHECKING:
    from synth.export.planners.pieces import Chain

_SHORTEST = 1e-9  # m: a cylinder of no length has no inertia


@frozen_value
class Inertia:
    """The inertia of a rigid body, in its own frame.

    Attributes:
        mass: Its mass, kg.
        centre: Its centre of mass, shape (3,), m.
        moments: Its inertia about that centre, shape (3, 3), kg m^2.
    """

    mass: float
    centre: FloatArray
    moments: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", frozen(self.centre))
        object.__setattr__(self, "moments", frozen(self.moments))


def inertia_of(chain: Chain, density: float) -> Inertia:
    """Return the inertia of all pieces of a chain together.

    Args:
        chain: The pieces.
        density: Mass of what fills them, kg/m^3.
    """
    lengths = np.maximum(np.linalg.norm(chain.chords, axis=1), _SHORTEST)
    along = chain.chords / lengths[:, None]
    masses = density * math.pi * chain.radius**2 * lengths
    mass = float(masses.sum())
    centre = masses @ chain.middles / mass
    axial = 0.5 * masses * chain.radius**2
    across = masses * (3.0 * chain.radius**2 + lengths**2) / 12.0
    off = chain.middles - centre
    projected = np.einsum("ni,nj->nij", along, along)
    own = across[:, None, None] * np.eye(3) + (axial - across)[:, None, None] * projected
    shifted = np.einsum("n,ni,ni->n", masses, off, off)[:, None, None] * np.eye(3)
    shifted = shifted - masses[:, None, None] * np.einsum("ni,nj->nij", off, off)
    moments = (own + shifted).sum(axis=0)
    return Inertia(mass, centre, 0.5 * (moments + moments.T))
