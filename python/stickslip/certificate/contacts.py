"""Gaps, forces and cones of the contacts of a frame, from positions and nodal forces alone."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.bulges import Bulges, straight
from stickslip.result import Result

BEYOND = 1.0
"""A node belongs to the line of a segment as far as this part of a length beyond its ends, and as far
as it moves in an increment: the law extends segments at corners (docs/theory/geometry.md, Contact targets)."""

CORNER = 2e-5
"""Nodes that pass the end of a segment within this part of its length have the gap (10.3)."""

PAIRS = 2_000_000
"""Pairs of nodes and segments that are compared at a time."""


EXACT = "NODE TO SURFACE"
"""Discretisation that keeps every slave node out; others keep means out."""


@dataclass(frozen=True)
class Disc:
    """A rigid disc that is a slave surface, with the arcs of its master."""

    radius: float
    arm: int
    """The node that takes its turning."""
    arcs: Integers
    """First chord of each arc, and the one after the last [A, 2]."""
    centres: Array
    """Centres in the undeformed configuration [A, 2]."""


@dataclass(frozen=True)
class Law:
    """Friction of a contact in a step, eqs (3.10), (3.12) and (3.14)."""

    decay: Array
    """Coefficients at rest and of fast slip, and the decay from the one to the other; NaN of a table."""
    rows: Array
    """Rows of a table: pressure, slip rate, coefficient."""
    limit: float
    """Largest shear stress."""
    ramps: bool
    """Whether another friction gives way to it."""

    @property
    def depends_on_pressure(self) -> bool:
        """Whether the coefficient depends on the pressure."""
        return bool(np.isfinite(self.limit)) or len(np.unique(self.rows[:, 0])) > 1

    @property
    def is_constant(self) -> bool:
        """Whether the coefficient is always the same."""
        at_rest, sliding, decay = self.decay
        return (at_rest == sliding or decay == 0.0) and not self.ramps and not self.depends_on_pressure

    def at(self, rate: float, pressure: float) -> float:
        """Coefficient of friction at a slip rate and a pressure."""
        if np.isfinite(self.decay).all():
            at_rest, sliding, decay = self.decay
            moves = at_rest != sliding and decay != 0.0
            mu = sliding + (at_rest - sliding) * np.exp(-decay * rate) if moves else at_rest
        else:
            curves = np.unique(self.rows[:, 0])
            of_curves = [np.interp(rate, *self.rows[self.rows[:, 0] == p][:, 1:].T) for p in curves]
            mu = np.interp(pressure, curves, of_curves)
        return float(min(mu, self.limit / pressure) if mu * pressure > self.limit else mu)

    def bounds(self, slip: float, noise: float, pressure: float, dt: float) -> tuple[float, float]:
        """The smallest and the largest coefficient for a slip that is known up to `noise`; the smallest coefficient is
        0 if the slip may be only noise."""
        slower, faster = (self.at(max(s, 0.0) / dt, pressure) for s in (slip - noise, slip + noise))
        if slip <= noise:
            return 0.0, max(self.at(0.0, pressure), faster)
        return min(slower, faster), max(slower, faster)

    def most(self, pressure: float) -> float:
        """The largest coefficient of friction at any slip rate."""
        rates = [0.0, np.inf, *self.rows[:, 1]]
        return max(self.at(rate, pressure) for rate in rates)


@dataclass(frozen=True)
class Contact:
    """A contact of the deck."""

    name: str
    slaves: Integers
    segments: Integers
    """[S, 2], the master body on the left."""
    friction: Array
    """Coefficients at rest and of fast slip; or two others, the larger first, where they vary."""
    acts: Integers
    """Whether it acts in each step."""
    body: Integers
    """Body of each node, -1 for those of rigid surfaces [N]."""
    faces: Integers
    """Slave faces [F, 2], their body on the left; none of a surface of nodes."""
    has_means: bool = False
    """Whether it keeps means over faces out, and corners, in place of every slave node."""
    disc: Disc | None = None
    """Set where the slave is a disc."""
    laws: tuple[Law, ...] = ()
    """Friction in each step; none in a file of an older program."""
    heat: float = 0.0
    """Part of what friction dissipates that heats the nodes."""
    bulges: Bulges = straight(0)
    """Of the segments."""
    face_bulges: Bulges = straight(0)
    """Of the slave faces."""

    @property
    def is_constant(self) -> bool:
        """Whether friction is the same in all steps and at all slip rates."""
        return bool(self.friction[0] == self.friction[1])


def contacts(result: Result) -> list[Contact]:
    """All contacts of a result."""
    at = "model/contacts"
    with result.reading(at):
        names = list(result.file[at])
    body = result.read("model/bodies/node")
    found = []
    for name in names:
        parts = ("slaves", "segments", "friction", "acts")
        slaves, segments, friction, acts = (result.read(f"{at}/{name}/{part}") for part in parts)
        disc = None
        if f"{at}/{name}/disc_radius" in result.file:
            radius, arm, arcs, centres = (
                result.read(f"{at}/{name}/{part}")
                for part in ("disc_radius", "disc_arm", "arcs", "arc_centres")
            )
            disc = Disc(float(radius), int(arm), arcs, centres)
        kind = result.file[f"history/contact/{name}"].attrs["formulation"]
        if f"{at}/{name}/slave_faces" in result.file:
            faces = result.read(f"{at}/{name}/slave_faces")
        else:  # a file of an older program
            faces = result.boundary[np.isin(result.boundary, slaves).all(axis=1)]
        heat = float(result.read(f"{at}/{name}/heat")) if f"{at}/{name}/heat" in result.file else 0.0
        laws = _laws(result, f"{at}/{name}")
        has_means = kind != EXACT
        bulges, face_bulges = straight(len(segments)), straight(len(faces))
        if f"{at}/{name}/bulges" in result.file:
            bulges, face_bulges = (Bulges(result.read(f"{at}/{name}/{part}")) for part in ("bulges", "face_bulges"))
        found.append(
            Contact(name, slaves, segments, friction, acts, body, faces, has_means, disc, laws, heat, bulges, face_bulges)
        )
    return found


def _laws(result: Result, at: str) -> tuple[Law, ...]:
    """Friction of a contact in each step."""
    if f"{at}/friction_decay" not in result.file:
        return ()
    parts = ("friction_coefficients", "friction_decay", "shear_limit", "friction_ramps")
    coefficients, decay, limits, ramps = (result.read(f"{at}/{part}") for part in parts)
    decays = np.column_stack((coefficients, decay))
    columns = ("table_steps", "table_pressures", "table_slip_rates", "table_coefficients")
    of_step, *points = (result.read(f"{at}/{column}") for column in columns)
    rows = np.column_stack(points)
    return tuple(
        Law(decay, rows[of_step == step + 1], float(limit), bool(ramp))
        for step, (decay, limit, ramp) in enumerate(zip(decays, limits, ramps, strict=True))
    )


def disc_gap(contact: Contact, disc: Disc, start: Array, x: Array) -> float:
    """Distance of the circle of a disc from its master, in radii; `start` holds the undeformed positions [N, 2]."""
    (centre,) = contact.slaves
    s = x[centre]
    is_chord = np.zeros(len(contact.segments), np.bool_)
    least = np.inf
    for (first, end), middle in zip(disc.arcs, disc.centres, strict=True):
        is_chord[first:end] = True
        p, q = contact.segments[first, 0], contact.segments[end - 1, 1]
        # the centre keeps its place along and across the chord of the whole arc
        e0, e1 = (complex(*(at[q] - at[p])) for at in (start, x))
        place = (complex(*(middle - start[p])) / e0).imag
        now = complex(*x[p]) + (0.5 + 1j * place) * e1
        radius = abs(e0) * np.hypot(0.5, place)
        arm = complex(*s) - now
        low, high = complex(*x[p]) - now, complex(*x[q]) - now
        part = np.angle(arm / low) / np.angle(high / low)
        if 0.0 <= part <= 1.0:
            least = min(least, np.sign(place) * (abs(arm) - radius))
    a, b = (x[contact.segments[~is_chord, end]] for end in (0, 1))
    along = b - a
    xi = np.clip(np.einsum("si,si->s", s - a, along) / np.einsum("si,si->s", along, along), 0.0, 1.0)
    reach = np.linalg.norm(s - a - xi[:, None] * along, axis=1)
    return float((min(least, reach.min(initial=np.inf)) - disc.radius) / disc.radius)


@dataclass(frozen=True)
class Places:
    """Positions of n nodes relative to each of the S segments of a contact [n, S]."""

    nodes: Integers
    gap: Array
    """Distance from the line of the segment, or from its curved face, positive outside, in lengths."""
    distance: Array
    """Distance from the line where the node belongs to it, else from the segment, in lengths."""
    reach: Array
    """Distance from the segment itself, in lengths."""
    ends: Array
    """Distance from the nearer end of the segment, in lengths."""
    way: Array
    """How far node and segment have moved in the increment, in lengths."""
    length: Array
    """[S]"""


def places(x: Array, way: Array, nodes: Integers, contact: Contact) -> Iterator[Places]:
    """Yields the positions of nodes relative to segments, some nodes at a time; a segment that ends in a node counts as
    infinitely far from this node.

    `way` [N] holds the distances by which nodes have moved in the increment.
    """
    segments = contact.segments
    if len(segments) == 0:
        return
    a, b = x[segments[:, 0]], x[segments[:, 1]]
    along = b - a
    length = np.linalg.norm(along, axis=1)
    tangent = along / length[:, None]
    far = np.maximum(way[segments[:, 0]], way[segments[:, 1]])
    step = max(1, PAIRS // len(segments))
    for first in range(0, len(nodes), step):
        some = nodes[first : first + step]
        arm = x[some][:, None] - a
        gap = (arm[..., 0] * tangent[:, 1] - arm[..., 1] * tangent[:, 0]) / length
        xi = np.einsum("nsi,si->ns", arm, tangent) / length
        gap -= contact.bulges.height(slice(None), xi) / length
        off = np.maximum(np.maximum(-xi, xi - 1.0), 0.0)
        moved = (far + way[some][:, None]) / length
        reach = np.hypot(gap, off)
        ends = np.hypot(gap, np.minimum(np.abs(xi), np.abs(xi - 1.0)))
        # lines of the node's own body are not extended: its neighbours lie on them
        other = contact.body[segments[:, 0]] != contact.body[some][:, None]
        distance = np.where((off <= BEYOND + moved) & other, np.abs(gap), reach)
        distance = np.where(ends <= CORNER, 0.0, distance)
        own = (segments[:, 0] == some[:, None]) | (segments[:, 1] == some[:, None])
        gap, distance, reach, ends = (
            np.where(own, np.inf, each) for each in (gap, distance, reach, ends)
        )
        yield Places(some, gap, distance, reach, ends, moved, length)


@dataclass(frozen=True)
class Touch:
    """A slave node that lies on a segment."""

    contact: Contact
    node: int
    segment: tuple[int, int]
    number: int
    """Of the segment among those of the contact."""


def touching(
    x: Array, way: Array, found: list[Contact], nodes: Integers, limit: float
) -> tuple[list[Touch], Array, Array, set[int]]:
    """Returns four results: the slave nodes among `nodes` that are on segments; the smallest distance of each node from
    a line [N]; the smallest distance of each slave node from a segment, less its way in the increment [N]; and the
    nodes of corners that other slave nodes meet."""
    nearest = np.full(len(x), np.inf)
    reached = np.full(len(x), np.inf)
    touches = []
    corners: set[int] = set()
    for contact in found:
        for near in places(x, way, np.intersect1d(contact.slaves, nodes), contact):
            least = near.distance.min(axis=1)
            for row in np.flatnonzero(least > limit):
                least[row], ends = _at_corner(x, way, contact, int(near.nodes[row]), least[row])
                if least[row] <= limit:
                    corners |= ends
                for end in ends:
                    nearest[end] = min(nearest[end], least[row])
            nearest[near.nodes] = np.minimum(nearest[near.nodes], least)
            beyond = np.maximum(near.reach - near.way, 0.0).min(axis=1)
            reached[near.nodes] = np.minimum(reached[near.nodes], beyond)
            for row, segment in zip(*np.nonzero(near.distance <= limit)):
                one, two = contact.segments[segment]
                touches.append(Touch(contact, int(near.nodes[row]), (int(one), int(two)), int(segment)))
                for end in (one, two):
                    nearest[end] = min(nearest[end], near.distance[row, segment])
    return touches, nearest, reached, corners


def _at_corner(
    x: Array, way: Array, contact: Contact, node: int, least: float
) -> tuple[float, set[int]]:
    """The smaller of a distance and the distance from a corner, with the nodes of the segments of this corner."""
    error, ends = corner_error(x, way, contact, node, 0.0)
    return (error, ends) if error < least else (least, set())


def corner_error(
    x: Array, way: Array, contact: Contact, node: int, gap: float
) -> tuple[float, set[int]]:
    """Distance of a gap from the range that eq. (10.3) allows at the nearest corner, in segment lengths.

    The node must be in front of neither segment, or in front of one segment by no more than its way in the increment.
    If the normal lies between the normals of the segments i and j, the gap lies between g_i and g_j, or reaches up to
    the distance from the corner if the node is in front of neither segment. The second returned value holds the nodes
    of both segments.
    """
    before, after = contact.segments[:, 1], contact.segments[:, 0]
    corners = np.setdiff1d(np.intersect1d(before, after), [node])
    if len(corners) == 0:
        return np.inf, set()
    arms = x[node] - x[corners]
    nearest = int(np.linalg.norm(arms, axis=1).argmin())
    arm, corner = arms[nearest], corners[nearest]
    gaps, over, length = [], [], 0.0
    ends_of: set[int] = set()
    for ends, sign in ((before, 1.0), (after, -1.0)):
        segment = int(np.flatnonzero(ends == corner)[0])
        a, b = contact.segments[segment]
        ends_of |= {int(a), int(b)}
        along = x[b] - x[a]
        own = float(np.linalg.norm(along))
        length = max(length, own)
        tangent = along / own
        xi = float((x[node] - x[a]) @ tangent) / own
        gaps.append(float(arm[0] * tangent[1] - arm[1] * tangent[0] - contact.bulges.height(segment, xi)))
        over.append(max(-sign * float(arm @ tangent), 0.0))
    if min(over) > 0.0 or max(over) > way[node] + way[corner] + CORNER * length:
        return np.inf, ends_of
    high = max(gaps) if any(over) else float(np.linalg.norm(arm))
    return max(min(gaps) - gap, gap - high, 0.0) / length, ends_of


@dataclass(frozen=True)
class Split:
    """Contact force and slip of a slave node on a segment in an increment."""

    normal: float
    tangential: float
    slip: float
    """Dt, in lengths of the segment."""
    has_slid_on: bool
    """Whether the node was over another segment at the start."""


def split(x0: Array, x1: Array, force: Array, touch: Touch, halfway: bool) -> Split:
    """Forces Pn and Pt and slip Dt of the node; with `halfway`, the force rows have the energy-momentum form, eqs (7.2)
    and (7.3). On a curved face the returned Pn is the normal force s Pn, and eq. (3.30) gives the force rows."""
    a, b = touch.segment
    e0, e1 = x0[b] - x0[a], x1[b] - x1[a]
    r0, r1 = x0[touch.node] - x0[a], x1[touch.node] - x1[a]
    l0, l1 = np.linalg.norm(e0), np.linalg.norm(e1)
    xi0, xi1 = r0 @ e0 / l0**2, r1 @ e1 / l1**2
    bulges, number = touch.contact.bulges, touch.number
    if halfway:
        mean, length = 0.5 * (e0 + e1), 0.5 * (l0 + l1)
        alpha = 0.5 * (1.0 / l0 + 1.0 / l1)
        gamma = 0.5 * length * (1.0 / l0**2 + 1.0 / l1**2)
        slip = length * (xi1 - xi0)
        beta = bulges.secant(number, xi0, xi1) / length
        away = (r1[0] * e1[1] - r1[1] * e1[0]) / l1 - (r0[0] * e0[1] - r0[1] * e0[0]) / l0
    else:
        mean, alpha, gamma = e1, 1.0 / l1, 1.0 / l1
        tangent = e1 / l1
        d = [x1[node] - x0[node] for node in (touch.node, a, b)]
        w = d[0] - (1.0 - xi1) * d[1] - xi1 * d[2]
        beta = bulges.slope(number, xi1) / l1
        across = np.array([tangent[1], -tangent[0]])
        away = across @ w
        # at the height of the face over the chord, eq. (3.4)
        slip = tangent @ w + bulges.height(number, xi1) / l1 * (across @ (d[2] - d[1]))
    normal = np.array([mean[1], -mean[0]])
    square = mean @ mean
    slid = not -1e-9 <= xi0 <= 1.0 + 1e-9
    # forces of the rows of the chord, Pn + beta Pt/s and Pt/s - beta Pn
    pn, pt = force @ normal / (square * alpha), force @ mean / (square * gamma)
    s = np.hypot(1.0, beta)
    return Split(
        float((pn - beta * pt) / s),
        float((pt + beta * pn) / s),
        float((slip + beta * away) / s / l1),
        slid,
    )
