"""Arrays of numpy by what they hold, as annotations name them."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers."""
Integers = NDArray[np.int64]
"""Indices, labels and counts."""
Flags = NDArray[np.bool_]
"""Truth values."""
