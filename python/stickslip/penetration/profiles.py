"""Nodes inside the obstacles behind rigid surfaces, from their profiles and the outlines of bodies.

A profile is a chain of segments with the obstacle on the left of the direction from a to b. A closed profile is the
boundary of a region, and winding numbers tell inside from outside. An open profile bounds no region. A node is inside
if it lies on the left of the nearest place of the profile, and if the outline of its body crosses the profile to reach
the node, or the whole body has passed through the profile since the last frame. A node that has come around the ends of
an open profile is not inside.
"""

from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array, Flags, Integers
from stickslip.bulges import Bulges, curves, of_edges
from stickslip.penetration.outlines import LIMIT, Outline, distances, side, winding
from stickslip.result import Result


@dataclass(frozen=True)
class Profile:
    """A chain of rigid segments with the obstacle on the left."""

    nodes: Integers
    after: Integers
    """First and second nodes of the segments, in the order of the chain."""
    bulges: Bulges
    """Of the segments."""

    @property
    def closed(self) -> bool:
        """Whether the chain comes back to its first node."""
        return bool(self.nodes[0] == self.after[-1])

    @property
    def corners(self) -> Integers:
        """All nodes."""
        return np.unique(np.concatenate([self.nodes, self.after]))

    def turns(self, position: Array) -> Integers:
        """Sign of the turn at the first node of each segment; 1 where the obstacle is convex.

        The sign is 1 at the first node of an open profile, where the first segment alone decides.
        """
        place = position[self.nodes]
        turn = side(np.roll(place, 1, axis=0), place, position[self.after])
        if not self.closed:
            turn[0] = 1
        return turn


def profiles(results: Result) -> list[Profile]:
    """The chains of all rigid surfaces."""
    following, found = {int(a): int(b) for a, b in results.rigid}, curves(results)
    reached = set(following.values())
    starts = [node for node in following if node not in reached]
    chains = []
    while following:
        node = starts.pop(0) if starts else next(iter(following))
        chain = []
        while node in following:
            chain.append((node, following.pop(node)))
            node = chain[-1][1]
        nodes, after = np.array(chain).T
        chains.append(Profile(nodes, after, of_edges(nodes, after, found)))
    return chains


def crossings(start: Array, end: Array, first: Array, second: Array) -> Integers:
    """Number of times that paths from `start` to `end` [n, 2] cross the segments from `first` to `second`, towards
    their left.

    A crossing in the other direction (from left to right) counts -1. A point that is on the left of a segment by less
    than LIMIT times the path touches the segment, and counts as in front of the segment.
    """
    low = (np.minimum(start, end)[:, None] <= np.maximum(first, second)[None]).all(axis=2)
    high = (np.maximum(start, end)[:, None] >= np.minimum(first, second)[None]).all(axis=2)
    rows, columns = np.nonzero(low & high)
    a, b, c, d = start[rows], end[rows], first[columns], second[columns]
    touching = LIMIT * np.linalg.norm(b - a, axis=1)
    before, behind = (height(c, d, point) > touching for point in (a, b))
    through = (before != behind) & ((side(a, b, c) > 0) != (side(a, b, d) > 0))
    total = np.zeros(len(start), np.int64)
    np.add.at(total, rows[through], np.where(behind[through], 1, -1))
    return total


def height(first: Array, second: Array, point: Array) -> Array:
    """Distances of points from the lines through segments, positive on the left."""
    along, offset = second - first, point - first
    area = along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
    return area / np.linalg.norm(along, axis=1)


def nearest(position: Array, nodes: Integers, profile: Profile) -> tuple[Array, Integers, Flags]:
    """Distance of nodes from a profile, the nearest segment, and whether the nodes are on the left of this segment."""
    point, first, second = position[nodes], position[profile.nodes], position[profile.after]
    distance = distances(point, first, second)
    segment = distance.argmin(axis=1) if len(nodes) else np.empty(0, np.int64)
    rows, count = np.arange(len(nodes)), len(profile.nodes)
    left = side(first[segment], second[segment], point) > 0
    least = distance[rows, segment]
    turn = profile.turns(position)
    # At a corner both segments are equally near. A point inside a convex obstacle is left of both.
    inside = left.copy()
    for step in (-1, 1):
        other = (segment + step) % count
        tied = distance[rows, other] <= least * (1.0 + 1e-12)
        if not profile.closed:
            tied &= other == segment + step
        beside = side(first[other], second[other], point) > 0
        convex = turn[segment if step < 0 else other] > 0
        inside = np.where(tied, np.where(convex, left & beside, left | beside), inside)
    return least, segment, inside


def passed(before: Array, after: Array, body: Outline, profile: Profile) -> bool:
    """Whether all nodes of a body have passed through a profile between two frames."""
    shift = after[profile.nodes[0]] - before[profile.nodes[0]]  # rigid surfaces do not turn
    first, second = after[profile.nodes], after[profile.after]
    through = crossings(before[body.nodes] + shift, after[body.nodes], first, second)
    return bool((through > 0).all())


def sunk(position: Array, body: Outline, profile: Profile) -> Flags:
    """Nodes of the outline of a body that are inside the obstacle, as far as one frame can show."""
    first, second = position[profile.nodes], position[profile.after]
    start, end = position[body.nodes], position[body.after]
    if profile.closed:
        counted = np.ones((len(start), len(first)), np.bool_)
        lowest = np.lexsort(position[profile.nodes].T)[0]
        around = 1 if profile.turns(position)[lowest] > 0 else 0
        return winding(start, first, second, counted) == around
    return _along_outline(body, crossings(start, end, first, second))


def _along_outline(body: Outline, through: Integers) -> Flags:
    """Nodes between an edge that enters an obstacle and the next edge that crosses its surface."""
    index = {int(node): i for i, node in enumerate(body.nodes)}
    after = np.array([index[int(node)] for node in body.after])
    before = np.array([index[int(node)] for node in body.before])
    inside = np.zeros(len(body.nodes), np.bool_)
    for edge in np.flatnonzero(through):
        # edge i goes from node i to after[i]; forwards from one that enters, else backwards
        node = after[edge] if through[edge] > 0 else edge
        while not inside[node]:
            inside[node] = True
            last = node if through[edge] > 0 else before[node]
            if through[last]:
                break
            node = after[node] if through[edge] > 0 else before[node]
    return inside
