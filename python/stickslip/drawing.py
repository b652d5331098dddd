"""The mesh for drawing: vertices, outlines of elements with curved sides, and triangles that fill them.

Vertices are the places of `nodal`, and three more points on each half of a side of a quadratic element, which lie on
the parabola through its corners and the node between them.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.nodal import Recovery, around_element

PARABOLA = np.array([3.0, 6.0, -1.0]) / 8.0
"""Weights of three vertices at equal distances along a parabola for the point in the middle of the first two."""
STRAIGHT = np.array([0.5, 0.5])
"""The same along a straight line."""


@dataclass(frozen=True)
class Drawing:
    """Vertices, and the lines and triangles between these vertices."""

    nodes: int
    """The first vertices are the N nodes."""
    ends: tuple[int, int, int]
    """Vertices up to the first end are places, which have values of their own; those up to the next ends are between them."""
    after: Integers
    """The vertices behind the nodes [V - N, 3]: each is in the middle between the first two of three earlier ones on a
    parabola, or at the node that is there three times."""
    rings: list[Integers]
    """Vertices around each element, in the order of `Result.outlines`."""
    outline: Integers
    """Lines between vertices along `Result.boundary` [., 2], the body on the left."""
    inner: Integers
    """Those between elements, each once [., 2]."""

    @classmethod
    def of(cls, recovery: Recovery, boundary: Integers) -> "Drawing":
        """The drawing of the elements of a recovery with their outlines (`Result.boundary`)."""
        nodes = recovery.places - len(recovery.twins)
        node = np.concatenate([np.arange(nodes), recovery.twins])
        after = [(n, n, n) for n in recovery.twins.tolist()]
        quarters = [half for a, m, b in recovery.middles.tolist() for half in ((a, m, b), (b, m, a))]
        first = nodes + len(after)
        eighths = [way for i, (a, m, _) in enumerate(quarters) for way in ((a, first + i, m), (m, first + i, a))]
        halves: dict[tuple[int, int], list[int]] = {}
        second = first + len(quarters)
        for i, (a, m, _) in enumerate(quarters):
            between = [second + 2 * i, first + i, second + 2 * i + 1]
            halves |= {(a, m): between, (m, a): between[::-1]}
        rings: list[Integers] = []
        outer = set(map(tuple, boundary.tolist()))
        seen: set[tuple[int, int]] = set()
        lines: dict[bool, list[tuple[int, int]]] = {True: [], False: []}
        for around in map(around_element, recovery.cells):
            ring: list[int] = []
            for a, b in zip(around.tolist(), np.roll(around, -1).tolist()):
                way = [a, *halves.get((a, b), ()), b]
                ring += way[:-1]
                ends = int(node[a]), int(node[b])
                if ends[::-1] not in seen:
                    seen.add(ends)
                    lines[ends in outer] += zip(way[:-1], way[1:])
            rings.append(np.array(ring))
        table = np.array([*after, *quarters, *eighths], np.int64).reshape(-1, 3)
        outline, inner = (np.array(lines[is_outer], np.int64).reshape(-1, 2) for is_outer in (True, False))
        return cls(nodes, (recovery.places, second, second + len(eighths)), table, rings, outline, inner)

    def positions(self, nodes: Array) -> Array:
        """Positions of the vertices [V, 2], computed from the positions of the nodes [N, 2]."""
        return self._filled(nodes, PARABOLA)

    def values(self, places: Array) -> Array:
        """Values at the vertices [V], interpolated linearly from values at the places [P] or at the nodes [N]."""
        return self._filled(places, STRAIGHT)

    def _filled(self, known: Array, weights: Array) -> Array:
        """Numbers at all vertices [V, ...], computed from the numbers at the places, which are the first vertices."""
        for end in self.ends:
            between = self.after[len(known) - self.nodes : end - self.nodes]
            known = np.concatenate([known, np.einsum("vk...,k->v...", known[between[:, : len(weights)]], weights)])
        return known

    @cached_property
    def triangles(self) -> Integers:
        """Triangles that fill the elements [T, 3]; the triangles of an element meet at its middle; these middles count
        as further vertices behind all others."""
        middle = self.nodes + len(self.after)
        fans = [
            np.stack([ring, np.roll(ring, -1), np.full(len(ring), middle + element)], axis=1)
            for element, ring in enumerate(self.rings)
        ]
        return np.concatenate([np.empty((0, 3), np.int64), *fans])

    def with_middles(self, vertices: Array) -> Array:
        """Numbers at the vertices [V, ...], followed by their means at the middles of the elements: [V + E, ...]."""
        middles = [vertices[ring].mean(axis=0, keepdims=True) for ring in self.rings]
        return np.concatenate([vertices, *middles])
