"""Looks for nodes inside bodies and obstacles, in every frame, from the deformed meshes alone.

The contact search of the solver is not used. A body is the region that its outline (the edges that belong to one
element only) winds around; a node of another outline is inside if the winding number at its place is positive. Signs
are exact. A node is compared with every body. For a node in its own body the two edges that meet at the node are left
out, and the node counts as inside if the body covers its place a second time. The depth of a node is the distance to
the nearest other edge of the body, relative to the length of this edge. Edges that cross are counted as well.

Rigid surfaces are also compared with all bodies, with or without a contact in the deck: their corners with the bodies,
and the nodes of the bodies with the obstacles behind the surfaces (see profiles.py). The depth of a node in an obstacle
is relative to the longer edge at the node. Contact keeps the nodes of bodies out of obstacles; corners of an obstacle
that is finer than the mesh, or convex, can still lie behind the edge between two nodes.

The exit code is 1 if a node is deeper than 1e-9 element sizes or if edges cross.
"""

import argparse
from collections.abc import Set
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.bulges import Bulges
from stickslip.penetration.outlines import (
    LIMIT,
    Outline,
    between_chord_and_curve,
    closed_hollow,
    distances,
    outlines,
    ray_starts_inside,
    winding,
)
from stickslip.penetration.profiles import Profile, nearest, passed, profiles, sunk
from stickslip.result import Result

TIE = 1e-9
"""Part of a distance by which others are the same."""

Gone = Set[tuple[int, int]]
"""Bodies that have gone through obstacles: numbers of both."""


@dataclass(frozen=True)
class Intrusion:
    """A node inside a body or an obstacle."""

    depth: float
    """In lengths of the body's edge that is nearest, or that is the longer one at the node."""
    distance: float
    """To the nearest edge."""
    node: int
    """Index of the node."""
    body: int | None
    """Number of the body that it is in; none for the obstacle behind a rigid surface."""
    edge: tuple[int, int]
    """Indices of the ends of the nearest edge."""


@dataclass(frozen=True)
class Overlap:
    """Outcome for one frame."""

    deepest: Intrusion | None
    """The deepest node of a body."""
    inside: int
    """How many nodes of bodies are deeper than LIMIT."""
    crossings: int
    """Pairs of edges that cross, with all four ends further than LIMIT from the other edge."""
    corner: Intrusion | None = None
    """The deepest corner of a rigid surface in a body."""
    crossing: float = 0.0
    """Deepest crossing of edges of bodies: how far the nearest of the four ends is behind the other
    edge, in lengths of that edge."""

    @property
    def depth(self) -> float:
        """Depth of the deepest node or corner, 0 if no node or corner is inside."""
        return max((found.depth for found in (self.deepest, self.corner) if found), default=0.0)


def intrusions(position: Array, host: Outline, guests: Integers, number: int) -> list[Intrusion]:
    """Finds which of the nodes `guests` are inside the outline `host` of the body `number`, which may be their own
    body."""
    start, end = position[host.nodes], position[host.after]
    own = guests is host.nodes
    point = position[guests]
    box, bulge = _box(start), np.abs(host.bulges.coefficients).sum(axis=1).max(initial=0.0)
    near = own | ((point >= box[0] - bulge) & (point <= box[1] + bulge)).all(axis=1)
    nodes, point = guests[near], point[near]
    counted = (host.nodes != nodes[:, None]) & (host.after != nodes[:, None])
    turns = winding(point, start, end, counted)
    if own:
        turns -= ray_starts_inside(point, position[host.before], end)
    turns += (counted * between_chord_and_curve(point, start, end, host.bulges)).sum(axis=1)
    covered = turns > 0
    nodes, point, counted = nodes[covered], point[covered], counted[covered]
    distance = np.where(counted, distances(point, start, end, host.bulges), np.inf)
    lengths = np.linalg.norm(end - start, axis=1)
    # nearest to a vertex, either edge there may be the one: the longer is taken
    is_nearest = distance <= distance.min(axis=1, initial=np.inf)[:, None] * (1.0 + TIE)
    edge = np.where(is_nearest, lengths, 0.0).argmax(axis=1) if len(nodes) else np.empty(0, np.int64)
    distance = distance[np.arange(len(nodes)), edge]
    if own:
        closed = closed_hollow(point, position[host.before[covered]], end[covered])
        distance = np.minimum(distance, closed)
    depth = distance / lengths[edge]
    return [
        Intrusion(float(a), float(b), int(node), number, (int(host.nodes[e]), int(host.after[e])))
        for a, b, node, e in zip(depth, distance, nodes, edge)
    ]


def in_obstacle(position: Array, body: Outline, obstacle: Profile, gone: bool) -> list[Intrusion]:
    """Nodes of a body inside the obstacle behind a rigid surface; `gone` says that the whole body has gone through the
    surface."""
    inside = sunk(position, body, obstacle) | gone
    if obstacle.bulges.coefficients.any():
        places = position[body.nodes], position[obstacle.nodes], position[obstacle.after]
        curved = between_chord_and_curve(*places, obstacle.bulges).sum(axis=1)
        inside = (inside | (curved > 0)) & (curved >= 0)
    ways = (position[ends] - position[body.nodes] for ends in (body.after, body.before))
    edges = [np.linalg.norm(way, axis=1) for way in ways]
    nodes, size = body.nodes[inside], np.maximum(*edges)[inside]
    distance, segment, left = nearest(position, nodes, obstacle)
    if obstacle.bulges.coefficients.any():
        curved = distances(position[nodes], position[obstacle.nodes], position[obstacle.after], obstacle.bulges)
        of_nearest = curved[np.arange(len(nodes)), segment]
        left |= of_nearest != distance
        distance = of_nearest
    found = np.flatnonzero(left)
    ends = np.stack([obstacle.nodes[segment], obstacle.after[segment]], axis=1)
    return [
        Intrusion(
            float(distance[i] / size[i]),
            float(distance[i]),
            int(nodes[i]),
            None,
            (int(ends[i, 0]), int(ends[i, 1])),
        )
        for i in found
    ]


def compare(
    position: Array,
    bodies: list[Outline],
    obstacles: list[Profile] | None = None,
    gone: Gone = frozenset(),
) -> Overlap:
    """Compares the nodes of all outlines with all bodies and with the obstacles."""
    found: list[Intrusion] = []
    corners: list[Intrusion] = []
    of_bodies: list[Array] = [np.empty(0)]
    of_profiles = 0
    boxes = [_box(position[outline.nodes]) for outline in bodies]
    for number, host in enumerate(bodies):
        for other, guest in enumerate(bodies):
            if _apart(boxes[number], boxes[other]):
                continue
            found += intrusions(position, host, guest.nodes, number)
            if other <= number:
                of_bodies.append(crossings(position, host, guest))
        for other, obstacle in enumerate(obstacles or []):
            corners += intrusions(position, host, obstacle.corners, number)
            found += in_obstacle(position, host, obstacle, (number, other) in gone)
            of_profiles += len(crossings(position, host, obstacle))
    inside = sum(intrusion.depth > LIMIT for intrusion in found)
    crossed = np.concatenate(of_bodies)
    deepest = float(crossed.max(initial=0.0))
    count = len(crossed) + of_profiles
    return Overlap(_deepest(found), inside, count, _deepest(corners), deepest)


def _deepest(found: list[Intrusion]) -> Intrusion | None:
    deepest = max(found, key=lambda intrusion: intrusion.depth, default=None)
    return deepest if deepest and deepest.depth > 0.0 else None


def crossings(
    position: Array,
    one: Outline | Profile,
    two: Outline | Profile,
    vertex: Integers | None = None,
) -> Array:
    """Depths of the edges that cross by more than LIMIT; within one outline each pair counts once.

    The depth of a crossing is the smallest distance of one of the four ends from the other edge, relative to the length
    of this other edge. Edges with a common vertex do not cross; `vertices` gives the vertex number of each node. For
    curved edges, the curve and not its chord decides on which side a point lies.
    """
    a, b = position[one.nodes], position[one.after]
    c, d = position[two.nodes], position[two.after]
    low = (np.minimum(a, b)[:, None] < np.maximum(c, d)[None]).all(axis=2)
    high = (np.maximum(a, b)[:, None] > np.minimum(c, d)[None]).all(axis=2)
    rows, columns = np.nonzero(low & high)
    if one is two:
        apart = (one.nodes[rows] != two.after[columns]) & (one.after[rows] != two.nodes[columns])
        keep = (rows < columns) & apart
        rows, columns = rows[keep], columns[keep]
    if vertex is not None:
        ends = [vertex[nodes] for nodes in (one.nodes, one.after)]
        others = [vertex[nodes] for nodes in (two.nodes, two.after)]
        keep = np.all([end[rows] != other[columns] for end in ends for other in others], axis=0)
        rows, columns = rows[keep], columns[keep]
    a, b, c, d = a[rows], b[rows], c[columns], d[columns]
    of_one, of_two = one.bulges.of(rows), two.bulges.of(columns)
    depth = np.minimum(_heights(a, b, c, d, of_one), _heights(c, d, a, b, of_two))
    return depth[depth > LIMIT]


def _heights(a: Array, b: Array, c: Array, d: Array, bulges: Bulges) -> Array:
    """Distance of the nearer of c and d from the line a, b, relative to the length of a, b.

    The distance is zero if c and d are on the same side.
    """
    along = b - a
    square = np.einsum("ei,ei->e", along, along)
    one, two = (along[:, 0] * (p - a)[:, 1] - along[:, 1] * (p - a)[:, 0] for p in (c, d))
    if bulges.coefficients.any():
        # the left is inside
        places = (np.einsum("ei,ei->e", p - a, along) / square for p in (c, d))
        one, two = (
            area + np.sqrt(square) * bulges.height(slice(None), np.clip(xi, 0.0, 1.0))
            for area, xi in zip((one, two), places)
        )
    return np.where(np.sign(one) != np.sign(two), np.minimum(abs(one), abs(two)) / square, 0.0)


def _box(point: Array) -> tuple[Array, Array]:
    return point.min(axis=0), point.max(axis=0)


def _apart(one: tuple[Array, Array], two: tuple[Array, Array]) -> bool:
    return bool((one[0] > two[1]).any() or (two[0] > one[1]).any())


def follow(results: Result) -> list[Overlap]:
    """Outcome of the comparison in every frame."""
    bodies, obstacles = outlines(results), profiles(results)
    found: list[Overlap] = []
    gone: Gone = frozenset()
    before = results.frames[0].positions
    for frame in range(len(results.frames)):
        position = results.frames[frame].positions
        gone = still_gone(before, position, bodies, obstacles, gone)
        found.append(compare(position, bodies, obstacles, gone))
        before = position
    return found


def still_gone(
    before: Array, position: Array, bodies: list[Outline], obstacles: list[Profile], gone: Gone
) -> Gone:
    """Bodies that have passed through open profiles as a whole and have not come back."""
    return {
        (number, other)
        for number, body in enumerate(bodies)
        for other, obstacle in enumerate(obstacles)
        if passed(before, position, body, obstacle)
        or ((number, other) in gone and nearest(position, body.nodes, obstacle)[2].any())
    }


def describe(results: Result, frame: int, overlap: Overlap) -> str:
    """The outcome for a frame in words."""
    text = f"frame {frame:4}, t = {results.frames[frame].time:<10.6g} "
    parts = []
    if overlap.deepest is not None:
        parts.append(f"node {_words(overlap.deepest, results, frame)}")
        parts.append(f"{overlap.inside} nodes deeper than {LIMIT:g}")
    else:
        parts.append("no node inside")
    if overlap.corner is not None:
        parts.append(f"rigid corner {_words(overlap.corner, results, frame)}")
    if overlap.crossings:
        deep = f", up to {overlap.crossing:.3g} of an edge deep" if overlap.crossing else ""
        parts.append(f"{overlap.crossings} crossings of edges{deep}")
    return text + "; ".join(parts)


def _words(found: Intrusion, results: Result, frame: int) -> str:
    x, y = results.frames[frame].positions[found.node]
    return (
        f"{results.node_labels[found.node]} at ({x:.6g}, {y:.6g}) is {found.depth:.3g} element"
        f" sizes ({found.distance:.3g}) behind {_place(found, results)}"
    )


def _place(found: Intrusion, results: Result) -> str:
    one, two = (results.node_labels[node] for node in found.edge)
    if found.body is None:
        return f"rigid segment {one}-{two}"
    return f"edge {one}-{two} of body {found.body + 1}"


def run() -> int:
    """Runs the command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="stickslip penetration", description=__doc__)
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument("--all", action="store_true", help="every frame, not only the deepest")
    arguments = parser.parse_args()
    limit_holds = True
    for path in arguments.result:
        with Result(path) as results:
            found = follow(results)
            worst = max(range(len(found)), key=lambda frame: found[frame].depth)
            crossings = sum(frame.crossings > 0 for frame in found)
            limit_holds &= found[worst].depth < LIMIT and not crossings
            frames = range(len(found)) if arguments.all else (worst,)
            print(f"{results.job}: {len(found)} frames, edges cross in {crossings} of them")
            for frame in frames:
                print("  " + describe(results, frame, found[frame]))
    return 0 if limit_holds else 1
