"""Symmetric tensors of the plane at the points of elements [E, G, 2, 2]."""

import numpy as np

from stickslip.arrays import Array

EPS = float(np.finfo(np.float64).eps)


def mean_of(part: Array, values: Array) -> Array:
    """Means of symmetric tensors over the elements, as xx yy xy."""
    mean = np.einsum("eg,egij->eij", part, values)
    return np.stack([mean[:, 0, 0], mean[:, 1, 1], mean[:, 0, 1]], axis=1)


def trace_of(a: Array) -> Array:
    """Trace of the part in the plane."""
    return a[..., 0, 0] + a[..., 1, 1]


def determinant_of(a: Array) -> Array:
    """Determinant of the part in the plane."""
    return a[..., 0, 0] * a[..., 1, 1] - a[..., 0, 1] * a[..., 1, 0]


def identity_times(factor: Array) -> Array:
    """The unit tensor, times a factor at each point."""
    return factor[..., None, None] * np.eye(2)


def cofactor_of(a: Array) -> Array:
    """Cofactor of symmetric tensors."""
    result = -a.copy()
    result[..., 0, 0], result[..., 1, 1] = a[..., 1, 1], a[..., 0, 0]
    return result
