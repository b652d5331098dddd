"""Outlines of bodies and the position of points relative to outlines; signs of areas are exact."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from stickslip.arrays import Array, Flags, Integers
from stickslip.bulges import Bulges, Curves, curves, of_edges
from stickslip.errors import Fault
from stickslip.result import Result

LIMIT = 1e-9
"""Depth in element sizes from which a node counts as inside."""


@dataclass(frozen=True)
class Outline:
    """The edges around one body, with the body on their left; every node is the start of one edge."""

    nodes: Integers
    after: Integers
    before: Integers
    """Next and last node along the outline."""
    bulges: Bulges
    """Of the edges."""

    @classmethod
    def of(cls, edges: Integers, found: Curves | None = None) -> "Outline":
        """An outline from edges [edges, 2], given by node indices in any order."""
        nodes = np.unique(edges)
        one, two = edges[np.argsort(edges[:, 0])], edges[np.argsort(edges[:, 1])]
        return cls(nodes, one[:, 1], two[:, 0], of_edges(nodes, one[:, 1], found or {}))


def outlines(results: Result) -> list[Outline]:
    """The outlines of all bodies, in the order of `Result.body`.

    If elements touch only with their corners at a node, a Fault names the node, because the inside is not defined
    there.
    """
    starts, count = np.unique(results.boundary[:, 0], return_counts=True)
    pinched = results.node_labels[starts[count > 1]]
    if len(pinched):
        raise Fault(
            f"{results.path}: elements of a body touch in corners only, at node"
            f" {', '.join(map(str, pinched[:5]))}: its outline has no inside there"
        )
    body, found = results.body[results.boundary[:, 0]], curves(results)
    return [Outline.of(results.boundary[body == number], found) for number in np.unique(body)]


def side(start: Array, end: Array, point: Array) -> Integers:
    """Sign of the area of the triangles start, end, point: 1 when the triangle turns left; the sign is exact."""
    one, two = np.broadcast_arrays(
        (start[..., 0] - point[..., 0]) * (end[..., 1] - point[..., 1]),
        (start[..., 1] - point[..., 1]) * (end[..., 0] - point[..., 0]),
    )
    area = one - two
    sign = np.sign(area).astype(np.int64)
    doubtful = np.abs(area) <= 4e-16 * (np.abs(one) + np.abs(two))
    if doubtful.any():
        shape = (*area.shape, 2)
        corners = [np.broadcast_to(x, shape)[doubtful] for x in (start, end, point)]
        sign[doubtful] = [_exact_side(*map(tuple, x)) for x in zip(*corners)]
    return sign


def _exact_side(start: tuple[float, ...], end: tuple[float, ...], at: tuple[float, ...]) -> int:
    (ax, ay), (bx, by), (x, y) = ([Fraction(float(v)) for v in p] for p in (start, end, at))
    area = (ax - x) * (by - y) - (ay - y) * (bx - x)
    return (area > 0) - (area < 0)


def winding(point: Array, start: Array, end: Array, counted: Flags) -> Integers:
    """Winding number of edges around points, from the crossings of a ray to the right of each point.

    `counted` [points, edges] says which edges count for each point. For a point on an edge, the result is the winding
    number of either side.
    """
    y, low, high = point[:, None, 1], start[None, :, 1], end[None, :, 1]
    up, down = (low <= y) & (y < high), (high <= y) & (y < low)
    right = np.maximum(start[:, 0], end[:, 0])[None] > point[:, None, 0]
    rows, columns = np.nonzero((up | down) & right & counted)
    turn = side(start[columns], end[columns], point[rows])
    step = np.where(up[rows, columns], turn > 0, -1 * (turn < 0))
    total = np.zeros(len(point), np.int64)
    np.add.at(total, rows, step)
    return total


def ray_starts_inside(point: Array, before: Array, after: Array) -> Flags:
    """Whether the ray to the right of a node of an outline starts inside the body.

    The ray is turned infinitesimally upwards: its direction is (1, 0+).
    """
    one, two = after - point, before - point

    def rising(direction: Array) -> Flags:
        """Whether the ray is to the right of a direction."""
        level = direction[:, 1] == 0.0
        return np.where(level, direction[:, 0] < 0.0, direction[:, 1] > 0.0)

    left_of_one, right_of_two = ~rising(one), rising(two)
    convex = side(before, point, after) > 0
    return np.where(convex, left_of_one & right_of_two, left_of_one | right_of_two)


def distances(point: Array, start: Array, end: Array, bulges: Bulges | None = None) -> Array:
    """Distances of points from edges [points, edges]; distances from curved edges are measured across the chords."""
    along = end - start
    offset = point[:, None] - start
    length = np.einsum("ei,ei->e", along, along)
    at = np.clip(np.einsum("pei,ei->pe", offset, along) / np.where(length > 0, length, 1), 0, 1)
    found = np.linalg.norm(offset - at[..., None] * along, axis=2)
    if bulges is None or not bulges.coefficients.any():
        return found
    gap, height, over = _across(point, start, end, bulges)
    return np.where(over & bulges.coefficients.any(axis=1), np.abs(gap - height), found)


def between_chord_and_curve(point: Array, start: Array, end: Array, bulges: Bulges) -> Integers:
    """Winding number of curved edges around points minus the winding number of their chords [points, edges]. The result
    is 1 for a point between a chord and a curve outside of it, and -1 if the curve is inside."""
    if not bulges.coefficients.any():
        return np.zeros((len(point), len(start)), np.int64)
    gap, height, over = _across(point, start, end, bulges)
    out, within = (0.0 <= gap) & (gap < height), (height <= gap) & (gap < 0.0)
    return np.where(over & out, 1, np.where(over & within, -1, 0))


def _across(point: Array, start: Array, end: Array, bulges: Bulges) -> tuple[Array, Array, Flags]:
    """Distances of points from chords, outward from the body, distances of the curves from chords at the same places,
    and whether the points are over the edges [points, edges]."""
    along = end - start
    length = np.linalg.norm(along, axis=1)
    offset = point[:, None] - start
    gap = (offset[..., 0] * along[:, 1] - offset[..., 1] * along[:, 0]) / length
    xi = np.einsum("pei,ei->pe", offset, along) / length**2
    return gap, bulges.height(slice(None), xi), (xi >= 0.0) & (xi <= 1.0)


def closed_hollow(point: Array, before: Array, after: Array) -> Array:
    """Overlap of the legs of closed concave corners; infinite at other nodes.

    At a concave corner whose legs lie on each other, the angle is zero up to round-off. If round-off makes the angle
    negative, the body covers the node itself a second time, although the node is far from all other edges.
    """
    one, two = before - point, after - point
    lengths = np.linalg.norm(one, axis=1), np.linalg.norm(two, axis=1)
    area = np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    alike = np.einsum("ni,ni->n", one, two) > 0.0
    return np.where(alike, area / np.maximum(*lengths), np.inf)
