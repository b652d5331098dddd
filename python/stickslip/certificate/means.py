"""Mean gaps of surface-to-surface contact, eqs (3.18) to (3.20), and the forces of their constraints, from positions
alone."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.bulges import Bulges
from stickslip.certificate.contacts import Contact

CORNER = 0.866
"""Cosine of the turn from which on a surface has a corner."""

VERTEX = 0.94
"""Cosine of the turn from which on a convex vertex is held by itself too."""

CORNER_DEPTH = 3e-5
"""Overlap that such a vertex may have, in lengths of the shortest face at it and of the other surface."""

CLOSED = 1e-9
"""Gap of a vertex that is closed, in lengths of the segment."""

BEYOND = 0.5
"""Lengths of a face beyond its end up to which a closed vertex may be on its line."""

SLIVER = 1e-2
"""Part of the largest mean of a node below which a mean beyond a convex vertex is left out."""

FACING = np.sqrt(0.5)
"""Cosine of the angle up to which a face takes part against a segment."""

REACH = 4.0
"""Lengths of a face up to which it takes part."""

DEPTH = 0.5
"""Lengths of a segment up to which a face behind it has come in through it."""

TILT = 0.3
"""Tilt that is not bounded, eq. (7.8)."""

COVER = 1e-6
"""Part of the weight of a node that must be covered."""

ROUND_OFF = 1e-9
"""Part of forces that is none."""

TWO = ((-np.sqrt(1.0 / 12.0), 0.5), (np.sqrt(1.0 / 12.0), 0.5))
THREE = ((-np.sqrt(3.0 / 20.0), 5.0 / 18.0), (0.0, 8.0 / 18.0), (np.sqrt(3.0 / 20.0), 5.0 / 18.0))
"""Gauss points of a cell: places from its middle, in its lengths, and weights."""

Vertex = tuple[tuple[int, float], ...]
"""Nodes with their parts in the place of the end of a face, eq. (3.21)."""

Column = dict[int, Array]
"""What a unit force does to nodes."""


@dataclass
class Point:
    """A point of a face over a segment."""

    face: int
    eta: float
    weight: float
    segment: int
    before: int | None
    """The segment at the start, none of a point that has come in."""
    gap: float
    slip: float
    rows: tuple[Array, Array]
    """What a unit normal and a unit tangential force are there."""
    on_end: Array
    """What the unit normal force is on the end of the segment."""
    turn: float = 0.0
    """Of end rows, the turn of the segment."""
    stretch: float = 1.0
    """Normal force of a unit of Pn, eq. (3.31)."""
    chord_gap: float = 0.0
    """Gap between the chords of both faces."""
    lean: Array = field(default_factory=lambda: np.zeros(2))
    """Of end rows, what a unit normal force adds to that on the end of the segment for each unit of height."""


@dataclass
class Mean:
    """The constraint of one side of a slave node over a run of the master."""

    node: int
    gap: float = 0.0
    slip: float = 0.0
    stretch: float = 1.0
    """Normal force of a unit of Pn, eq. (3.31)."""
    moved: bool = False
    """Whether points have changed their segment, or the covered part has."""
    points: list[tuple[float, Point]] = field(default_factory=list)
    """With their weights, which sum to one."""


def _turned(e: Array) -> Array:
    """The normal on the right of a direction."""
    return np.array([e[1], -e[0]])


def _cross(a: Array, b: Array) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _along_axes(node: int) -> list[Column]:
    """Force rows of a node for unit forces along both axes."""
    return [{node: axis} for axis in np.eye(2)]


def _halfway(r: list[Array], e: list[Array]) -> list[tuple[Array, Array]]:
    """Force rows of a unit normal and a unit tangential force at a point and at the end of a segment, eqs (7.2) and
    (7.3). The vector e is the segment, and r leads from the start of the segment to the point; both are given at the
    start and at the end of an increment."""
    length = [float(np.linalg.norm(one)) for one in e]
    gaps = [_cross(r[k], e[k]) / length[k] for k in (0, 1)]
    mean, arm = (e[0] + e[1]) / 2.0, (r[0] + r[1]) / 2.0
    long, square = (length[0] + length[1]) / 2.0, (length[0] * length[1]) ** 2
    alpha = (1.0 / length[0] + 1.0 / length[1]) / 2.0
    beta = -(gaps[0] * length[0] + gaps[1] * length[1]) / 4.0 / (length[0] * length[1] * long)
    gamma = long * (1.0 / length[0] ** 2 + 1.0 / length[1] ** 2) / 2.0
    delta = -long * float(r[0] @ e[0] + r[1] @ e[1]) / 2.0 / square
    return [
        (alpha * _turned(mean), alpha * np.array([-arm[1], arm[0]]) + 2.0 * beta * mean),
        (gamma * mean, gamma * arm + 2.0 * delta * mean),
    ]


class Means:
    """The mean gaps of a contact between two surfaces."""

    def __init__(self, contact: Contact, faces: Integers, x: Array, middles: dict[int, tuple[int, int]], rings: bool) -> None:
        self.contact = contact
        self.faces, self.segments = faces, contact.segments
        self.x, self.middles, self.rings = x, middles, rings
        self.bulges = contact.bulges.of_points(self.segments, middles)
        self.face_bulges = contact.face_bulges.of_points(faces, middles)
        self.starting = {int(a): i for i, (a, _) in enumerate(self.segments)}
        self.ending = {int(b): i for i, (_, b) in enumerate(self.segments)}
        tangents = self._tangents(self.segments, x)
        self.run = np.arange(len(self.segments))
        for _ in self.segments:
            before = self.run.copy()
            for i, (_, b) in enumerate(self.segments):
                j = self.starting.get(int(b))
                if j is not None and tangents[i] @ tangents[j] >= CORNER:
                    self.run[i] = self.run[j] = min(self.run[i], self.run[j])
            if (before == self.run).all():
                break
        own = self._tangents(faces, x)
        self.sides: dict[int, list[list[tuple[int, int]]]] = {int(n): [] for n in contact.slaves}
        for face, ends in enumerate(faces):
            for end, node in enumerate(ends):
                if int(node) in self.sides:
                    self.sides[int(node)].append([(face, end)])
        self.corners: set[int] = set()
        for node, sides in self.sides.items():
            if len(sides) == 2 and own[sides[0][0][0]] @ own[sides[1][0][0]] >= CORNER:
                self.sides[node] = [sides[0] + sides[1]]
            else:
                self.corners.add(node)
        self.master_corners = [
            int(b)
            for i, (_, b) in enumerate(self.segments)
            if (j := self.starting.get(int(b))) is None or tangents[i] @ tangents[j] < CORNER
        ] + [int(a) for a, _ in self.segments if int(a) not in self.ending]
        sides = (self.faces, contact.face_bulges), (self.segments, contact.bulges)
        self.vertices = [(self._vertices(side[0], other[0], x), other) for side, other in (sides, sides[::-1])]
        """Convex vertices of the slave and of the master with the overlap that each may have, and what they meet."""
        (slave, _), (master, _) = self.vertices
        self.held = self.corners | slave.keys()
        self.held_of_master = set(self.master_corners) | master.keys()
        """Nodes that are held by themselves too, or have several means."""

    def _vertices(self, faces: Integers, against: Integers, x: Array) -> dict[int, float]:
        """Allowed overlap of each end of a face, and of each convex vertex that turns by more than 20 degrees."""
        e = x[faces[:, 1]] - x[faces[:, 0]]
        tangents = e / np.linalg.norm(e, axis=1)[:, None]
        starting = {int(a): k for k, (a, _) in enumerate(faces)}
        ending = {int(b) for _, b in faces}
        found = [int(a) for a, _ in faces if int(a) not in ending]
        for k, (_, b) in enumerate(faces):
            e, f = tangents[k], tangents[starting.get(int(b), k)]
            if int(b) not in starting or (e @ f < VERTEX and _cross(e, f) > 0.0):
                found.append(int(b))
        own, other = (np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1) for pairs in (faces, against))
        return {
            node: CORNER_DEPTH * float(min(own[(faces == node).any(axis=1)].min(), other.min())) for node in found
        }

    def _closed_vertices(self) -> Iterator[list[Column]]:
        """Force rows on the slave of vertices that are closed at the end of the increment, along two directions for
        each vertex. Closed vertices touch the straight lines between the nodes."""
        x, noise = self.at[1][0], 16 * np.finfo(float).eps * np.abs(self.at[1][0]).max()
        for (vertices, (faces, bulges)), is_slave in zip(self.vertices, (True, False), strict=True):
            a = x[faces[:, 0]]
            e = x[faces[:, 1]] - a
            length = np.linalg.norm(e, axis=1)
            for node, depth in vertices.items():
                r = x[node] - a
                gap = (r[:, 0] * e[:, 1] - r[:, 1] * e[:, 0]) / length
                eta = (r * e).sum(axis=1) / length**2
                gap -= bulges.height(slice(None), eta)
                closed = (gap + depth <= CLOSED * length + noise) & (gap >= -0.05 * length)
                closed &= ~(faces == node).any(axis=1)
                meets = closed & (eta >= -1e-3) & (eta <= 1.0 + 1e-3)
                if not meets.any():
                    meets = closed & (eta >= -BEYOND) & (eta <= 1.0 + BEYOND)
                if is_slave and meets.any():
                    yield _along_axes(node)
                elif not is_slave:
                    yield from (self._under_face(node, int(k)) for k in np.flatnonzero(meets))

    def _under_face(self, node: int, face: int) -> list[Column]:
        """Force rows of a normal and a tangential force of a vertex of the master at the ends of a slave face."""
        r, e = [], []
        for x, *_ in self.at:
            p, q = x[self.faces[face]]
            r.append(x[node] - p)
            e.append(q - p)
        if self.halfway:
            rows = _halfway(r, e)
        else:
            eta = float(r[1] @ e[1] / (e[1] @ e[1]))
            rows = [(along, -eta * along) for along in (_turned(e[1]), e[1])]
        a, b = (int(end) for end in self.faces[face])
        return [{a: -own - on_end, b: on_end} for own, on_end in rows]

    def vertex(self, node: int) -> Vertex:
        """The nodes that determine the position of an end of a face, with their weights."""
        ends = self.middles.get(node)
        if ends is None:
            return ((node, 1.0),)
        return ((node, 4.0 / 3.0), (ends[0], -1.0 / 6.0), (ends[1], -1.0 / 6.0))

    def _place(self, node: int, x: Array) -> Array:
        return sum((part * x[n] for n, part in self.vertex(int(node))), np.zeros(2))

    def _ends(self, pairs: Integers, x: Array) -> tuple[Array, Array]:
        a, b = (np.array([self._place(node, x) for node in pairs[:, k]]).reshape(-1, 2) for k in (0, 1))
        return a, b

    def _tangents(self, pairs: Integers, x: Array) -> Array:
        a, b = self._ends(pairs, x)
        return (b - a) / np.linalg.norm(b - a, axis=1)[:, None]

    def means(self, x0: Array, x1: Array, nodes: Integers, halfway: bool) -> Iterator[Mean]:
        """The mean gaps of some slave nodes between two positions; with `halfway`, the force rows have the
        energy-momentum form."""
        self.at = [(x, *self._ends(self.segments, x), self._tangents(self.segments, x)) for x in (x0, x1)]
        self.halfway = halfway
        points: dict[int, list[Point]] = {}
        for node in nodes:
            of_node: list[tuple[float, float, Mean]] = []
            for side in self.sides[int(node)]:
                found: dict[int, Mean] = {}
                whole = 0.0
                for face, end in side:
                    if face not in points:
                        points[face] = list(self._points(face, halfway))
                    whole += self._weight(face, 0.5, 0.5)
                    for q in points[face]:
                        hat = (1.0 - q.eta, q.eta)[end]
                        mean = found.setdefault(int(self.run[q.segment]), Mean(int(node)))
                        mean.points.append((q.weight * hat, q))
                for mean in found.values():
                    covered = sum(weight for weight, _ in mean.points)
                    if covered > COVER * whole:
                        of_node.append((covered, whole, mean))
            for covered, whole, mean in self._without_slivers(of_node):
                mean.points = [(weight / covered, q) for weight, q in mean.points]
                mean.gap = sum(weight * q.gap for weight, q in mean.points)
                # at the height of a point when the mean is closed, eq. (3.4)
                mean.slip = sum(weight * (q.slip + (q.chord_gap - mean.gap) * q.turn) for weight, q in mean.points)
                mean.stretch = sum(weight * q.stretch for weight, q in mean.points)
                mean.moved = any(q.before != q.segment for _, q in mean.points)
                mean.moved |= abs(covered - whole) > 1e-9 * whole
                yield mean

    def _without_slivers(self, means: list[tuple[float, float, Mean]]) -> list[tuple[float, float, Mean]]:
        """The mean gaps of a node with their weights; a mean gap beyond a convex vertex is left out if its weight is
        small compared with the largest."""
        largest = max((covered for covered, _, _ in means), default=0.0)
        if all(covered >= SLIVER * largest for covered, _, _ in means):
            return means
        most = next(mean for covered, _, mean in means if covered == largest)
        x, a, b, t = self.at[0]
        # the segment where the hat function of the node is largest
        nearest = max(most.points, key=lambda point: point[0] / point[1].weight)[1].segment

        def gap(place: Array) -> float:
            return _cross(place - a[nearest], t[nearest])

        def is_beyond(q: Point) -> bool:
            if q.segment == nearest:
                ends = [gap(self._place(node, x)) for node in self.faces[q.face]]
                near, far = ends if q.eta < 0.5 else ends[::-1]
                return far >= near
            length = float(np.linalg.norm(b[q.segment] - a[q.segment]))
            return max(gap(a[q.segment]), gap(b[q.segment])) <= 1e-3 * length

        return [
            (covered, whole, mean)
            for covered, whole, mean in means
            if covered >= SLIVER * largest or not all(is_beyond(q) for _, q in mean.points)
        ]

    def _weight(self, face: int, eta: float, part: float) -> float:
        a, b = (self._place(node, self.x) for node in self.faces[face])
        radius = (1.0 - eta) * a[0] + eta * b[0] if self.rings else 1.0
        return float(np.linalg.norm(b - a) * part * radius)

    def _points(self, face: int, halfway: bool) -> Iterator[Point]:
        """The points of a face, two in each cell; cells end at the bisectors at the start and at the end of the
        increment."""
        faced = self._faced(face)
        for run in sorted({int(self.run[i]) for i in faced}):
            own = [i for i in faced if self.run[i] == run]
            cells = [self._cells(face, own, k) for k in (0, 1)]
            cuts = sorted({c for of in (cells if halfway else cells[1:]) for low, high, _ in of for c in (low, high)})
            for low, high in zip(cuts, cuts[1:]):
                middle = (low + high) / 2.0
                j, i = (self._over(face, cells[k], middle, k) for k in (1, 0))
                if high - low <= 1e-13 or j is None:
                    continue
                for place, share in self._gauss(face, {i, j} - {None}):
                    eta = middle + place * (high - low)
                    weight = self._weight(face, eta, (high - low) * share)
                    yield self._point(face, eta, weight, i, j, halfway)

    def _gauss(self, face: int, segments: set[int]) -> tuple[tuple[float, float], ...]:
        """Points of a cell, which integrate the gap over the cell, also for curved faces."""
        cubics = [self.face_bulges.coefficients[face], *(self.bulges.coefficients[i] for i in segments)]
        return THREE if any(c[3] or (self.rings and c.any()) for c in cubics) else TWO

    def _faced(self, face: int) -> list[int]:
        """Segments that a face faces at the start, and that are within reach and not behind the face."""
        x, a, b, t = self.at[0]
        p, q = (self._place(node, x) for node in self.faces[face])
        e = (q - p) / np.linalg.norm(q - p)
        length = np.linalg.norm(b - a, axis=1)
        gaps = np.stack([(r - a)[:, 0] * t[:, 1] - (r - a)[:, 1] * t[:, 0] for r in (p, q)])
        near = (np.abs(gaps).min(axis=0) <= REACH * np.maximum(length, np.linalg.norm(q - p))) | (gaps[0] * gaps[1] < 0.0)
        front = gaps.max(axis=0) >= -DEPTH * length
        apart = ~np.isin(self.segments, self.faces[face]).any(axis=1)
        xi = np.stack([((r - a) * t).sum(axis=1) / length for r in (p, q)])
        beside = (xi.max(axis=0) > -2.0) & (xi.min(axis=0) < 3.0)
        return [int(i) for i in np.flatnonzero((t @ e < -FACING) & near & front & apart & beside)]

    def _cells(self, face: int, segments: list[int], k: int) -> list[tuple[float, float, int]]:
        """Parts of a face over segments, eq. (3.19)."""
        x, a, b, t = self.at[k]
        p, q = (self._place(node, x) for node in self.faces[face])
        start = self.at[0]
        e = self._place(self.faces[face][1], start[0]) - self._place(self.faces[face][0], start[0])
        e = e / np.linalg.norm(e)

        def eta(i: int, v: Array, other: int | None) -> float:
            m = _turned(t[i])
            if other is not None and self.run[other] == self.run[i] and start[3][other] @ e < -FACING:
                if not np.isin(self.segments[other], self.faces[face]).any():
                    m = m + _turned(t[other])
            return -_cross(p - v, m) / _cross(q - p, m)

        cells = []
        for i in segments:
            low = max(eta(i, b[i], self.starting.get(int(self.segments[i, 1]))), 0.0)
            high = min(eta(i, a[i], self.ending.get(int(self.segments[i, 0]))), 1.0)
            if low < high:
                cells.append((low, high, i))
        return cells

    def _over(self, face: int, cells: list[tuple[float, float, int]], eta: float, k: int) -> int | None:
        """The nearest segment that faces a given place of a slave face."""
        x, a, _, t = self.at[k]
        p, q = (self._place(node, x) for node in self.faces[face])
        at = (1.0 - eta) * p + eta * q
        over = [i for low, high, i in cells if low <= eta <= high]
        return min(over, key=lambda i: abs(_cross(at - a[i], t[i])), default=None)

    def _point(self, face: int, eta: float, weight: float, i: int | None, j: int, halfway: bool) -> Point:
        """A point with its gap, slip and force rows, eqs (3.4), (3.30), (3.32), (7.2), (7.3) and (7.8)."""
        s, r, e, length, t = [], [], [], [], []
        for x, a, b, tangents in self.at:
            p, q = (self._place(node, x) for node in self.faces[face])
            s.append((1.0 - eta) * p + eta * q)
            r.append(s[-1] - a[j])
            e.append(b[j] - a[j])
            length.append(float(np.linalg.norm(e[-1])))
            t.append(tangents[j])
        of_chord = [_cross(r[k], t[k]) for k in (0, 1)]
        xi = [float(r[k] @ t[k]) / length[k] for k in (0, 1)]
        rise = float(self.face_bulges.height(face, eta))
        gaps = [of_chord[k] - float(self.bulges.height(j, xi[k])) - rise for k in (0, 1)]
        if not halfway:
            x0, x1 = self.at[0], self.at[1]
            d = s[1] - s[0] - (1.0 - xi[1]) * (x1[1][j] - x0[1][j]) - xi[1] * (x1[2][j] - x0[2][j])
            normal, bend = _turned(t[1]), self.bulges.slope(j, xi[1]) / length[1]
            stretch = float(np.hypot(1.0, bend))
            turn = float(normal @ (e[1] - e[0])) / length[1] / stretch
            slip = float(t[1] @ d + bend * (normal @ d)) / stretch
            bent = normal - bend * t[1]
            rows = (bent, (t[1] + bend * normal) / stretch)
            lean = -bend * normal / length[1]
            return Point(
                face, eta, weight, j, i, gaps[1], slip, rows, -xi[1] * bent, turn, stretch, of_chord[1], lean
            )
        long = (length[0] + length[1]) / 2.0
        slip_of_chord = long * (xi[1] - xi[0])
        (normal, on_end), (along, along_end) = _halfway(r, e)
        bend = self.bulges.secant(j, xi[0], xi[1]) / long
        stretch = float(np.hypot(1.0, bend))
        tangential, slip = (along + bend * normal) / stretch, (slip_of_chord + bend * (of_chord[1] - of_chord[0])) / stretch
        normal, on_end = normal - bend * along, on_end - bend * along_end
        if i != j:
            before, most = max(gaps[0], 0.0), TILT
            if i is not None:
                _, a, _, tangents = self.at[0]
                from_a = s[0] - a[i]
                xi_before = float(from_a @ tangents[i]) / float(np.linalg.norm(self.at[0][2][i] - a[i]))
                before = _cross(from_a, tangents[i]) - float(self.bulges.height(i, xi_before)) - rise
                most = max(TILT, 2.0 * abs(_cross(tangents[i], tangents[j])))
            step = gaps[0] - before
            if abs(step) <= most * abs(slip_of_chord):
                kappa = step / slip_of_chord if step else 0.0
            else:
                kappa = most**2 * slip_of_chord / step
            normal = normal + kappa * along
            on_end = on_end + kappa * along_end
        rows = (normal, tangential)
        return Point(face, eta, weight, j, i, gaps[1], slip, rows, on_end, 0.0, stretch, of_chord[1])

    def master_parts(self, mean: Mean) -> dict[int, float]:
        """The parts |Bn_jm| of the normal force of a mean gap that act on its master nodes, eq. (9.16)."""
        rows: dict[int, Array] = {}
        for weight, q in mean.points:
            on_end = q.on_end + (q.chord_gap - mean.gap) * q.lean
            for end, row in zip(self.segments[q.segment], (-q.rows[0] - on_end, on_end)):
                for node, share in self.vertex(int(end)):
                    rows[node] = rows.get(node, np.zeros(2)) + weight * share * row
        return {node: float(np.linalg.norm(row)) for node, row in rows.items()}

    def forces(self, means: list[Mean], force: Array) -> tuple[Array, Array, float]:
        """Returns, from the nodal forces on the slave, normal and tangential forces [J, 2] of the mean gaps, whether
        each force is determined [J], and the nodal forces that remain unexplained.

        Closed vertices of slave and master have forces of their own, in any direction. If the forces of closed vertices
        and of mean gaps do not explain the nodal forces, all corners get forces. Forces of mean gaps that would change
        with the forces of vertices count as not determined.
        """
        rows: dict[tuple[int, int], dict[int, float]] = {}
        own: set[int] = set()
        for k, mean in enumerate(means):
            for weight, q in mean.points:
                for end, part in zip(self.faces[q.face], (1.0 - q.eta, q.eta)):
                    for node, share in self.vertex(int(end)):
                        own.add(node)
                        for c, row in enumerate(q.rows):
                            for d in (0, 1):
                                column = rows.setdefault((node, d), {})
                                column[2 * k + c] = column.get(2 * k + c, 0.0) + weight * part * share * row[d]
        nodes = sorted(own)
        place = {node: k for k, node in enumerate(nodes)}
        right = force[nodes].ravel()

        def fit(free: list[Column]) -> tuple[Array, Array, float]:
            """Forces of the mean gaps, together with forces of some corners."""
            count = 2 * len(means)
            matrix = np.zeros((2 * len(nodes), count + len(free)))
            for (node, d), columns in rows.items():
                for column, value in columns.items():
                    matrix[2 * place[node] + d, column] = value
            for k, forces in enumerate(free, count):
                for node, row in forces.items():
                    matrix[2 * place[node] : 2 * place[node] + 2, k] += row
            found, left = _fit(matrix, right)
            # what corners may add to the forces of means
            _, values, vectors = np.linalg.svd(matrix)
            rank = int((values > ROUND_OFF * values.max(initial=0.0)).sum())
            open_to = np.abs(vectors[rank:, :count]).max(axis=0, initial=0.0).reshape(-1, 2).max(axis=1)
            is_told = open_to <= ROUND_OFF if free else np.ones(len(means), np.bool_)
            return found[:count].reshape(-1, 2), is_told, left

        closed = [column for columns in self._closed_vertices() for column in columns if column.keys() <= own]
        found, is_told, left = fit(closed)
        if left <= ROUND_OFF * np.abs(right).max(initial=0.0):
            return found, is_told, left
        free = [column for node in sorted(self.corners & own) for column in _along_axes(node)]
        x = self.at[1][0]
        for corner in self.master_corners:
            for face in {q.face for mean in means for _, q in mean.points}:
                p, q = (self._place(node, x) for node in self.faces[face])
                e = q - p
                eta = float((x[corner] - p) @ e / (e @ e))
                if 0.0 <= eta <= 1.0 and abs(_cross(x[corner] - p, e)) <= 0.05 * float(e @ e):
                    free += self._under_face(corner, face)
        return fit(free + closed)


def _fit(matrix: Array, right: Array) -> tuple[Array, float]:
    """The solution with the smallest residual, and this residual."""
    found = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return found, float(np.abs(matrix @ found - right).max(initial=0.0))
