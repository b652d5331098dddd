"""Looks for nodes inside bodies, in every frame of a result, from the deformed meshes alone.

Nothing of the solver's contact search is used: each body is the region that its outline (the edges
that belong to one element only) winds around, and a node of an outline is inside when the winding
number there is positive, decided by exact signs. A node is compared with every body, its own
included: there the two edges that meet in it are left out, and what counts is whether the body
covers the place once more. The depth is the distance to the nearest other edge of that body, in
lengths of that edge. Edges that cross are counted besides.

The exit code is 1 when a node is deeper than 1e-9 element sizes or edges cross.
"""

import argparse
import sys
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from results import Array, Results

Integers = NDArray[np.int64]

LIMIT = 1e-9
"""Depth in element sizes from which a node counts as inside."""


@dataclass(frozen=True)
class Intrusion:
    """A node inside a body."""

    depth: float
    """In lengths of the nearest edge."""
    distance: float
    """To the nearest edge."""
    node: int
    """Index of the node."""
    body: int
    """Number of the body that it is in."""
    edge: tuple[int, int]
    """Indices of the ends of the nearest edge."""


@dataclass(frozen=True)
class Overlap:
    """What was found in one frame."""

    deepest: Intrusion | None
    inside: int
    """How many nodes are deeper than LIMIT."""
    crossings: int
    """Pairs of edges that cross, with all four ends further than LIMIT from the other edge."""

    @property
    def depth(self) -> float:
        """Depth of the deepest node, 0 when there is none."""
        return self.deepest.depth if self.deepest else 0.0


@dataclass(frozen=True)
class Outline:
    """The edges around one body, body on the left; every node is the start of one edge."""

    nodes: Integers
    after: Integers
    before: Integers
    """Next and last node along the outline."""

    @classmethod
    def of(cls, edges: Integers) -> "Outline":
        """Takes [edges, 2] node indices in any order."""
        nodes = np.unique(edges)
        one, two = edges[np.argsort(edges[:, 0])], edges[np.argsort(edges[:, 1])]
        if not (np.array_equal(one[:, 0], nodes) and np.array_equal(two[:, 1], nodes)):
            raise ValueError("an outline touches itself in a node")
        return cls(nodes, one[:, 1], two[:, 0])


def outlines(results: Results) -> list[Outline]:
    """The outlines of all bodies, in the order of `Results.body`."""
    body = results.body[results.boundary[:, 0]]
    return [Outline.of(results.boundary[body == number]) for number in np.unique(body)]


def side(start: Array, end: Array, point: Array) -> Integers:
    """Sign of the area of the triangles start, end, point: 1 when it turns left; exact."""
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


def winding(point: Array, start: Array, end: Array, counted: NDArray[np.bool_]) -> Integers:
    """How often edges wind around points, by the crossings of a ray to the right of each point.

    `counted` [points, edges] says which edges count for which point. For points on an edge it is
    the number of either side.
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


def ray_starts_inside(point: Array, before: Array, after: Array) -> NDArray[np.bool_]:
    """Whether the ray to the right of an outline's node starts in the body's angle there.

    The ray lies above the node by less than anything: its direction is (1, 0+).
    """
    one, two = after - point, before - point

    def rising(direction: Array) -> NDArray[np.bool_]:
        """Whether the ray is to the right of a direction."""
        level = direction[:, 1] == 0.0
        return np.where(level, direction[:, 0] < 0.0, direction[:, 1] > 0.0)

    left_of_one, right_of_two = ~rising(one), rising(two)
    convex = side(before, point, after) > 0
    return np.where(convex, left_of_one & right_of_two, left_of_one | right_of_two)


def distances(point: Array, start: Array, end: Array) -> Array:
    """Distances of points from edges [points, edges]."""
    along = end - start
    offset = point[:, None] - start
    length = np.einsum("ei,ei->e", along, along)
    at = np.clip(np.einsum("pei,ei->pe", offset, along) / np.where(length > 0, length, 1), 0, 1)
    return np.linalg.norm(offset - at[..., None] * along, axis=2)


def closed_hollow(point: Array, before: Array, after: Array) -> Array:
    """How deep the legs of closed hollows lie in each other; infinite where a node has other legs.

    At a hollow whose legs lie on each other the angle is zero but for round-off. When it is
    negative by that much, the node itself is covered once more, and far from all other edges.
    """
    one, two = before - point, after - point
    lengths = np.linalg.norm(one, axis=1), np.linalg.norm(two, axis=1)
    area = np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    alike = np.einsum("ni,ni->n", one, two) > 0.0
    return np.where(alike, area / np.maximum(*lengths), np.inf)


def intrusions(position: Array, host: Outline, guest: Outline, number: int) -> list[Intrusion]:
    """The guest's nodes inside the host, body `number`; the guest may be the host itself."""
    start, end = position[host.nodes], position[host.after]
    own = guest is host
    point = position[guest.nodes]
    box = _box(start)
    near = own | ((point >= box[0]) & (point <= box[1])).all(axis=1)
    nodes, point = guest.nodes[near], point[near]
    counted = (host.nodes != nodes[:, None]) & (host.after != nodes[:, None])
    turns = winding(point, start, end, counted)
    if own:
        turns -= ray_starts_inside(point, position[host.before], end)
    covered = turns > 0
    nodes, point, counted = nodes[covered], point[covered], counted[covered]
    distance = np.where(counted, distances(point, start, end), np.inf)
    edge = distance.argmin(axis=1) if len(nodes) else np.empty(0, np.int64)
    distance = distance[np.arange(len(nodes)), edge]
    if own:
        closed = closed_hollow(point, position[host.before[covered]], end[covered])
        distance = np.minimum(distance, closed)
    depth = distance / np.linalg.norm(end - start, axis=1)[edge]
    return [
        Intrusion(float(a), float(b), int(node), number, (int(host.nodes[e]), int(host.after[e])))
        for a, b, node, e in zip(depth, distance, nodes, edge)
    ]


def compare(position: Array, bodies: list[Outline]) -> Overlap:
    """Compares the nodes of all outlines with all bodies."""
    found: list[Intrusion] = []
    crossings = 0
    boxes = [_box(position[outline.nodes]) for outline in bodies]
    for number, host in enumerate(bodies):
        for other, guest in enumerate(bodies):
            if _apart(boxes[number], boxes[other]):
                continue
            found += intrusions(position, host, guest, number)
            if other <= number:
                crossings += count_crossings(position, host, guest)
    inside = sum(intrusion.depth > LIMIT for intrusion in found)
    deepest = max(found, key=lambda intrusion: intrusion.depth, default=None)
    return Overlap(deepest if deepest and deepest.depth > 0.0 else None, inside, crossings)


def count_crossings(position: Array, one: Outline, two: Outline) -> int:
    """Pairs of edges that cross by more than LIMIT; within one outline each pair counts once."""
    a, b = position[one.nodes], position[one.after]
    c, d = position[two.nodes], position[two.after]
    low = (np.minimum(a, b)[:, None] < np.maximum(c, d)[None]).all(axis=2)
    high = (np.maximum(a, b)[:, None] > np.minimum(c, d)[None]).all(axis=2)
    rows, columns = np.nonzero(low & high)
    if one is two:
        apart = (one.nodes[rows] != two.after[columns]) & (one.after[rows] != two.nodes[columns])
        keep = (rows < columns) & apart
        rows, columns = rows[keep], columns[keep]
    a, b, c, d = a[rows], b[rows], c[columns], d[columns]
    return int((_separates(a, b, c, d) & _separates(c, d, a, b)).sum())


def _separates(a: Array, b: Array, c: Array, d: Array) -> NDArray[np.bool_]:
    """Whether c and d are on different sides of the line a, b and further than LIMIT from it."""
    along = b - a
    square = np.einsum("ei,ei->e", along, along)
    heights = [(along[:, 0] * (p - a)[:, 1] - along[:, 1] * (p - a)[:, 0]) for p in (c, d)]
    far = np.minimum(*map(np.abs, heights)) > LIMIT * square
    return far & (np.sign(heights[0]) != np.sign(heights[1]))


def _box(point: Array) -> tuple[Array, Array]:
    return point.min(axis=0), point.max(axis=0)


def _apart(one: tuple[Array, Array], two: tuple[Array, Array]) -> bool:
    return bool((one[0] > two[1]).any() or (two[0] > one[1]).any())


def follow(results: Results) -> list[Overlap]:
    """The overlap in every frame."""
    bodies = outlines(results)
    return [compare(results.positions(frame), bodies) for frame in range(len(results.frame_times))]


def describe(results: Results, frame: int, overlap: Overlap) -> str:
    """What was found in a frame in words."""
    text = f"frame {frame:4}, t = {results.frame_times[frame]:<10.6g} "
    found = overlap.deepest
    if found is None:
        text += "no node inside"
    else:
        label = results.node_labels
        x, y = results.positions(frame)[found.node]
        text += (
            f"node {label[found.node]} at ({x:.6g}, {y:.6g}) is {found.depth:.3g} element sizes"
            f" ({found.distance:.3g}) behind edge {label[found.edge[0]]}-{label[found.edge[1]]}"
            f" of body {found.body + 1}; {overlap.inside} nodes deeper than {LIMIT:g}"
        )
    return text + (f"; {overlap.crossings} crossings of edges" if overlap.crossings else "")


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument("--all", action="store_true", help="every frame, not only the deepest")
    arguments = parser.parse_args()
    limit_holds = True
    for path in arguments.result:
        with Results(path) as results:
            found = follow(results)
            worst = max(range(len(found)), key=lambda frame: found[frame].depth)
            crossings = sum(frame.crossings > 0 for frame in found)
            limit_holds &= found[worst].depth < LIMIT and not crossings
            frames = range(len(found)) if arguments.all else (worst,)
            print(f"{results.job}: {len(found)} frames, edges cross in {crossings} of them")
            for frame in frames:
                print("  " + describe(results, frame, found[frame]))
    return 0 if limit_holds else 1


if __name__ == "__main__":
    sys.exit(main())
