"""Bulges of curved faces: distances of a face from the chords of its segments, eqs (3.26) to (3.32)."""

from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.result import Result


@dataclass(frozen=True)
class Bulges:
    """Bulges of the segments of a surface."""

    coefficients: Array
    """c0 to c3 of each [S, 4]."""
    goes_straight_on: bool = True
    """Whether they go on as straight lines beyond the ends of the segments: for nodes, not for points of faces."""

    def height(self, segment: int | slice, xi: Array | float) -> Array:
        """b(xi)."""
        c = self.coefficients[segment].T
        end = self._end(xi)
        return c[0] + end * (c[1] + end * (c[2] + end * c[3])) + self._slope(c, end) * (xi - end)

    def slope(self, segment: int, xi: float) -> float:
        """b'(xi)."""
        return float(self._slope(self.coefficients[segment], self._end(xi)))

    def secant(self, segment: int, before: float, now: float) -> float:
        """Slope D = (b(y) - b(x))/(y - x) of the bulge, eq. (3.29)."""
        if abs(now - before) > 1e-4:
            change = self.height(segment, now) - self.height(segment, before)
            return float(change / (now - before))
        c = self.coefficients[segment]
        p, q = self._end(before), self._end(now)
        if p == before and q == now:
            return float(c[1] + c[2] * (p + q) + c[3] * (p * p + p * q + q * q))
        return self.slope(segment, (before + now) / 2.0)

    def of(self, rows: Integers) -> "Bulges":
        """Bulges of a selection of segments."""
        return Bulges(self.coefficients[rows], self.goes_straight_on)

    def of_points(self, pairs: Integers, middles: dict[int, tuple[int, int]]) -> "Bulges":
        """Bulges for points of faces; on a side with a node between its corners, bulges are measured from the lines to
        the vertex x_v of eq. (3.21)."""
        found = self.coefficients.copy()
        for row, (a, b) in enumerate(pairs.tolist()):
            rise = found[row, 1]
            if (a in middles) != (b in middles):
                found[row] = [0.0, 2 * rise / 3, -rise, 0.0] if b in middles else [-rise / 3, 4 * rise / 3, -rise, 0.0]
        return Bulges(found, goes_straight_on=False)

    def _end(self, xi: Array | float) -> Array | float:
        return np.clip(xi, 0.0, 1.0) if self.goes_straight_on else xi

    @staticmethod
    def _slope(c: Array, xi: Array | float) -> Array:
        return c[1] + xi * (2.0 * c[2] + xi * 3.0 * c[3])


def straight(count: int) -> Bulges:
    """Bulges of straight faces, which are zero."""
    return Bulges(np.zeros((count, 4)))


Curves = dict[tuple[int, int], Array]
"""Coefficients of the bulges of curved faces, by the nodes at their ends."""


def curves(result: Result) -> Curves:
    """Coefficients of the bulges of all curved faces of the contacts of a result, by the nodes of the faces."""
    found: Curves = {}
    for name in result.file.get("model/contacts", ()):
        at = f"model/contacts/{name}"
        if f"{at}/bulges" not in result.file:
            continue
        for faces, bulges in (("segments", "bulges"), ("slave_faces", "face_bulges")):
            rows = zip(result.read(f"{at}/{faces}").tolist(), result.read(f"{at}/{bulges}"))
            found.update(((a, b), c) for (a, b), c in rows if c.any())
    return found


def of_edges(starts: Integers, ends: Integers, found: Curves) -> Bulges:
    """Bulges of edges, which are given by their nodes."""
    none = np.zeros(4)
    rows = [found.get((int(a), int(b)), none) for a, b in zip(starts, ends)]
    return Bulges(np.array(rows).reshape(-1, 4))
