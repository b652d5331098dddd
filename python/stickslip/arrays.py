"""Names for annotations of numpy arrays, by the type of their numbers."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers."""
Integers = NDArray[np.int64]
"""Indices, labels and counts."""
Flags = NDArray[np.bool_]
"""Truth values."""
