"""Checks for slave nodes inside masters and for edges that cross, in every frame, from the deformed meshes alone."""

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.bulges import Bulges
from stickslip.certificate.check import Check, Checks
from stickslip.certificate.contacts import Contact
from stickslip.certificate.fits import REASON, Fits
from stickslip.errors import Fault
from stickslip.penetration.intrusion import (
    Gone,
    Intrusion,
    crossings,
    in_obstacle,
    intrusions,
    still_gone,
)
from stickslip.penetration.outlines import Outline, outlines
from stickslip.penetration.profiles import Profile, profiles
from stickslip.result import Result

DEPTH = 1e-9
"""Depth of a slave node, in lengths of the edge, that is round-off."""

CORNER = 4e-5
"""The same of a corner from surface to surface, which may overlap by 3e-5 lengths."""

TURN = 0.25
"""Depth of a slave node between means, in the turn of the faces near it, along the master of all within the length of a slave face, and
the length of the longest of them. A vertex that lies on a flat
face is 1/6 deep, eq. (10.8); vertices near it on both sides add to that."""

SHARP = np.pi / 3
"""Turn from which on a vertex is a corner, which is kept out by itself."""

EDGES = 500
"""Edges that are compared with others at a time."""


def check_penetration(result: Result, contacts: list[Contact], checks: Checks) -> None:
    """Adds the checks of the frames."""
    if not contacts:
        return
    try:
        bodies = outlines(result)
    except Fault as fault:
        for name in ("penetration", "crossing"):
            checks[name].skip(str(fault).partition(": ")[2])
        return
    obstacles = profiles(result)
    recorded = result.history["time"], result.history.certificate["penetration"]
    gone: Gone = frozenset()
    before = result.frames[0].positions
    fits, vertex = Fits(result), _vertices(result)
    for frame in result.frames:
        if fits.changes(frame):
            for name in ("penetration", "crossing"):
                checks[name].skip(REASON)
            continue
        x = frame.positions
        noise = 64 * np.finfo(np.float64).eps * float(np.abs(x).max()) / result.edge_length
        place = f"t = {frame.time:g}"
        gone = still_gone(before, x, bodies, obstacles, gone)
        before = x
        crossed = 0.0
        for contact in contacts:
            if not contact.acts[fits.step(frame) - 1]:
                continue
            found = _in_bodies(x, bodies, contact, result.body)
            found = [one for one in found if vertex[one.node] not in vertex[list(one.edge)]]
            if contact.has_means:
                crossed = max([crossed, *(one.depth for one in found)])
            found += _in_obstacles(x, bodies, obstacles, contact, gone)
            _compare(x, frame["GAP"], contact, found, noise, checks["penetration"], place)
            if not contact.has_means:
                crossed = max(crossed, _crossed(x, contact, vertex))
        row = np.flatnonzero(recorded[0] == frame.time)
        if len(row) and row[-1] > 0:
            told = float(recorded[1][row[-1]])
            checks["crossing"].add(crossed - told, DEPTH + noise + 1e-6 * told, place)


def _compare(
    x: Array, gap: Array, contact: Contact, found: list[Intrusion], noise: float, check: Check, place: str
) -> None:
    """Compares the depths of slave nodes with the depth that the discretisation of the contact allows: a mean gap that
    overlaps, eq. (7.9), has the GAP of its node."""
    check.add(0.0, DEPTH + noise, place)
    if not contact.has_means:
        check.add([one.depth for one in found], DEPTH + noise, place)
        return
    after, before = ({} for _ in range(2))
    for a, b in np.concatenate((contact.faces, contact.segments)).tolist():
        after[a], before[b] = b, a

    def turn(node: int) -> tuple[float, float]:
        """Angle by which the face turns at a node, and length of the longer edge at the node."""
        if node not in after or node not in before:
            return 0.0, 0.0
        e, f = x[node] - x[before[node]], x[after[node]] - x[node]
        angle = abs(float(np.arctan2(e[0] * f[1] - e[1] * f[0], e @ f)))
        return angle if angle < SHARP else 0.0, float(max(np.hypot(*e), np.hypot(*f)))

    def along(ends: tuple[int, int], reach: float) -> tuple[float, float]:
        """Sum of the angles by which the master turns within reach of an edge, and the longest edge of the master
        within this reach."""
        total, longest = 0.0, 0.0
        for node, ways in ((ends[1], after), (ends[0], before)):
            gone = 0.0
            while gone <= reach and node in ways:
                angle, length = turn(node)
                total, longest = total + angle, max(longest, length)
                gone += float(np.hypot(*(x[ways[node]] - x[node])))
                node = ways[node]
        return total, longest

    for one in found:
        own = [one.node, *(way[one.node] for way in (after, before) if one.node in way)]
        turns, lengths = np.array([turn(node) for node in own]).T
        of_master, longest = along(one.edge, float(lengths.max()))
        angle, length = float(turns.max()) + of_master, max(float(lengths.max()), longest)
        left = max(0.0, float(np.nan_to_num(-gap[one.node])))
        edges = one.depth / one.distance if one.distance > 0.0 else 0.0
        bound = CORNER + (left + TURN * angle * length) * edges
        check.add(one.depth, bound + noise, f"{place}, where faces turn by {np.degrees(angle):.2g} degrees")


def _vertices(result: Result) -> Integers:
    """A vertex number for each node; nodes that equations hold at one place, as at the ends of a pre-tension section,
    have the same number."""
    numbers = np.arange(len(result.coordinates))
    held = result.read("model/constrained_nodes")
    _, first, of_place = np.unique(
        result.coordinates[held], axis=0, return_index=True, return_inverse=True
    )
    numbers[held] = held[first][of_place.ravel()]
    return numbers


def _in_bodies(
    x: Array, bodies: list[Outline], contact: Contact, of_node: Integers
) -> list[Intrusion]:
    """Slave nodes inside the bodies of master segments that are nearest to a master segment."""
    masters = {(int(a), int(b)) for a, b in contact.segments}
    touched = set(of_node[contact.segments.ravel()].tolist())
    found = []
    for host in bodies:
        number = int(of_node[host.nodes[0]])
        if number not in touched:
            continue
        others = np.setdiff1d(contact.slaves, host.nodes)
        inside = intrusions(x, host, others, number)
        if np.isin(host.nodes, contact.slaves).all():
            inside += intrusions(x, host, host.nodes, number)
        found += [one for one in inside if one.edge in masters]
    return found


def _in_obstacles(
    x: Array, bodies: list[Outline], obstacles: list[Profile], contact: Contact, gone: Gone
) -> list[Intrusion]:
    """Slave nodes inside the obstacles of the contact."""
    masters, slaves = set(contact.segments.ravel().tolist()), set(contact.slaves.tolist())
    found = []
    for other, obstacle in enumerate(obstacles):
        if not masters.issuperset(obstacle.corners.tolist()):
            continue
        for number, body in enumerate(bodies):
            inside = in_obstacle(x, body, obstacle, (number, other) in gone)
            found += [one for one in inside if one.node in slaves]
    return found


def _crossed(x: Array, contact: Contact, vertex: Integers) -> float:
    """Depths by which faces of the slave surface cross master segments, eq. (10.6)."""
    masters = Profile(contact.segments[:, 0], contact.segments[:, 1], contact.bulges)
    is_own = np.isin(contact.faces, contact.slaves).all(axis=1)
    own, bulges = contact.faces[is_own], contact.face_bulges.of(np.flatnonzero(is_own))
    worst = 0.0
    for first in range(0, len(own), EDGES):
        some = slice(first, first + EDGES)
        nodes, after = own[some].T
        depth = crossings(x, Profile(nodes, after, Bulges(bulges.coefficients[some])), masters, vertex)
        worst = max(worst, float(depth.max(initial=0.0)))
    return worst
