"""Shape functions of triangles and quadrilaterals, their integration rules and gradients."""

import numpy as np

from oracle.tensors import determinant_of
from stickslip.arrays import Array

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
"""Corners of the reference square."""

DUNAVANT = ((0.44594849091596489, 0.22338158967801147), (0.09157621350977074, 0.10995174365532187))
"""Place a of the points (a, a), (1 - 2 a, a) and (a, 1 - 2 a) of a triangle and their weight, of degree 4."""


def integration_rule(count: int, reduced: bool) -> tuple[Array, Array]:
    """Natural coordinates [G, 2] and weights [G] of the points of an element with so many nodes."""
    if count == 3:
        return np.full((1, 2), 1.0 / 3.0), np.array([0.5])
    if count == 6:
        return np.array([[1.0, 1.0], [4.0, 1.0], [1.0, 4.0]]) / 6.0, np.full(3, 1.0 / 6.0)
    if count == 4 or reduced:
        return CORNERS / np.sqrt(3.0), np.ones(4)
    at, weight = np.polynomial.legendre.leggauss(3)
    points = np.array([[r, s] for s in at for r in at])
    return points, np.outer(weight, weight).ravel()


def mass_rule(count: int, is_ring: bool) -> tuple[Array, Array]:
    """As integration_rule, exact for the mass of elements with straight sides."""
    if count not in (3, 6):
        return integration_rule(8 if is_ring else count, False)
    points = [p for a, _ in DUNAVANT for p in ((a, a), (1.0 - 2.0 * a, a), (a, 1.0 - 2.0 * a))]
    return np.array(points), np.repeat([0.5 * weight for _, weight in DUNAVANT], 3)


def shape_functions(count: int, points: Array) -> tuple[Array, Array]:
    """Shape functions [G, k] and their natural derivatives [G, k, 2] at points [G, 2]."""
    r, s = points[:, :1], points[:, 1:]
    if count in (3, 6):
        corner = np.hstack([1.0 - r - s, r, s])
        slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        if count == 3:
            return corner, np.broadcast_to(slope, (len(points), 3, 2))
        after = np.roll(corner, -1, axis=1)
        value = np.hstack([corner * (2.0 * corner - 1.0), 4.0 * corner * after])
        mixed = after[..., None] * slope + corner[..., None] * np.roll(slope, -1, axis=0)
        return value, np.hstack([(4.0 * corner - 1.0)[..., None] * slope, 4.0 * mixed])
    a, b = CORNERS.T
    x, y = 1.0 + a * r, 1.0 + b * s
    if count == 4:
        return 0.25 * x * y, 0.25 * np.stack([a * y, b * x], axis=2)
    value = 0.25 * x * y * (a * r + b * s - 1.0)
    natural = 0.25 * np.stack(
        [a * y * (2.0 * a * r + b * s), b * x * (a * r + 2.0 * b * s)], axis=2
    )
    # between the corners: along the sides 0 and 2, then 1 and 3
    p, q = 1.0 - r * r, 1.0 - s * s
    along = np.stack([-r * y, 0.5 * b * p], axis=2)
    up = np.stack([0.5 * a * q, -s * x], axis=2)
    is_along = np.array([True, False, True, False])
    between = np.where(is_along, 0.5 * p * y, 0.5 * q * x)
    slope = np.where(is_along[:, None], along, up)
    return np.hstack([value, between]), np.hstack([natural, slope])


def gradients(nodes: Array, rule: tuple[Array, Array]) -> tuple[Array, Array]:
    """dN_a/dX_j [E, G, k, 2] and the areas of the points [E, G] of a rule for nodes [E, k, 2]."""
    points, weight = rule
    _, natural = shape_functions(nodes.shape[1], points)
    jacobian = np.einsum("eai,gar->egir", nodes, natural)
    gradient = np.einsum("gar,egrj->egaj", natural, np.linalg.inv(jacobian))
    return gradient, weight * determinant_of(jacobian)
