"""The array type of the project, and read-only copies for frozen values."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def frozen(values: ArrayLike) -> FloatArray:
    """Return a read-only float copy, so that a frozen dataclass is frozen all the way down."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
