"""Checks of the contact law in every frame: gaps, complementarity, friction cones and slips, from positions and nodal forces alone."""

from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.certificate.check import Checks
from stickslip.certificate.contacts import (
    BEYOND,
    Contact,
    Touch,
    corner_error,
    disc_gap,
    places,
    split,
    touching,
)
from stickslip.certificate.fits import REASON, Fits
from stickslip.certificate.increments import ENERGY_MOMENTUM, EPS, STATIC, Increment, Increments
from stickslip.certificate.means import Mean, Means
from stickslip.frame import Frame
from stickslip.result import OPEN, STICK

GAP = 1e-9
"""Gap of a closed pair in lengths of its segment; the solver stops at 1e-10."""

DISC_GAP = 1e-9
"""Gap of a disc that touches, in radii."""

TOUCH = 1e-8
"""Nodes nearer to a segment than this part of its length are on it."""

FIELD = 2e-8
"""Error of `GAP` of open nodes in lengths: the field is that of the last pass, whose correction the tolerance of the increment bounds."""

SLIP = 1e-8
"""Slip of a node that sticks, in lengths of the segment."""

CONE = 1e-8
"""Forces outside of the cone, as a part of the largest force of the frame."""

MEANS = 1e-7
"""The same of the forces of means, which a matrix of hat functions tells from the nodal forces."""

NEAR = 0.5
"""Mean gaps up to these lengths are compared: the search for contacts decides which segments further ones reach."""

LEFT = 0.02
"""Mean gap that the motion of points may leave, in lengths; and what corners have means for."""

MOVED = 1e-6
"""Error of `GAP` of means whose points have changed their segment, in lengths."""

FORCE = 1e-9
"""Contact forces below this part of the largest one are none."""


class ContactLaw:
    """Data that the checks of the contact law share."""

    def __init__(self, increments: Increments, contacts: list[Contact], checks: Checks) -> None:
        self.result, self.increments = increments.result, increments
        self.contacts, self.checks = contacts, checks
        self.middles = np.array(list(self.result.middles), np.int64)
        """Nodes between the corners of sides."""
        self.means = {
            contact.name: Means(
                contact, contact.faces, self.result.coordinates, self.result.middles, self.result.is_axisymmetric
            )
            for contact in contacts
            if contact.has_means and not np.array_equal(contact.faces, contact.segments)
        }
        self.fits = Fits(self.result)
        self.force_scale = max(
            (float(np.abs(frame["CONTACT_FORCE"]).max()) for frame in self.result.frames), default=0.0
        )

    def check(self, frame: Frame, increment: Increment) -> None:
        """Checks gaps, complementarity, friction cones and slips of the contacts in a frame."""
        if not self.contacts or not self.force_scale:
            return
        if self.fits.changes(frame):
            for name in ("gap", "reach", "complementarity", "cone", "slip"):
                self.checks[name].skip(REASON)
            return
        x = self.result.coordinates + frame["U"]
        force = np.linalg.norm(frame["CONTACT_FORCE"], axis=1)
        status, gaps = frame["CONTACT_STATUS"], frame["GAP"]
        closed = np.flatnonzero(status >= STICK)
        active = np.union1d(closed, np.flatnonzero(force > FORCE * self.force_scale))
        dt = increment.dt
        way = np.abs(dt * frame["V"]).sum(axis=1) + np.abs(dt * dt * frame["A"]).sum(axis=1)
        if increment.start is not None:
            way = np.abs(frame["U"] - increment.start).sum(axis=1)
        contacts = [contact for contact in self.contacts if contact.acts[increment.step]]
        contacts, others = self._means(frame, increment, contacts), contacts
        nodes = _in_means(others)
        if len(nodes):
            closed, active = np.setdiff1d(closed, nodes), np.setdiff1d(active, nodes)
            status = status.copy()
            status[nodes] = 0
            force[nodes] = 0.0
        contacts, discs = self._discs(contacts, x, status, f"t = {frame.time:g}")
        closed, active = np.setdiff1d(closed, discs), np.setdiff1d(active, discs)
        touches, nearest, reached, corners = touching(x, way, contacts, active, TOUCH)
        noise = 16 * EPS * np.abs(x).max() / self._edge
        place = f"t = {frame.time:g}"
        self.checks["gap"].add(
            nearest[closed], GAP + noise, f"{{}} of {len(closed)} closed nodes, {place}"
        )
        self.checks["gap"].add(
            np.abs(gaps[closed]) / self._edge,
            GAP + noise,
            f"GAP, {{}} of the closed nodes, {place}",
        )
        self.checks["reach"].add(
            reached[closed], BEYOND, f"{{}} of {len(closed)} closed nodes, {place}"
        )
        opened = np.setdiff1d(np.flatnonzero(status == OPEN), discs)
        self.checks["gap"].add(
            np.nan_to_num(-gaps[opened]) / self._edge,
            GAP + noise,
            f"GAP, {{}} of the open nodes, {place}",
        )
        self._gap_field(x, way, opened, gaps, noise, contacts, place)
        loaded = np.setdiff1d(np.flatnonzero(force > FORCE * self.force_scale), discs)
        self.checks["complementarity"].add(
            nearest[loaded], TOUCH + noise, f"{{}} of {len(loaded)} loaded nodes, {place}"
        )
        self._cones(frame, increment, touches, corners)

    def _means(
        self, frame: Frame, increment: Increment, contacts: list[Contact]
    ) -> list[Contact]:
        """Checks mean gaps, cones and slips of surface-to-surface contacts; returns the other contacts."""
        x1 = self.result.coordinates + frame["U"]
        start = increment.start
        x0 = x1 if start is None else self.result.coordinates + start
        told = start is not None and bool(self.increments.start_is_told(frame, increment).all())
        status, gaps = frame["CONTACT_STATUS"], frame["GAP"]
        noise = 16 * EPS * np.abs(x1).max() / self._edge
        all_found: list[tuple[Contact, Means, list[Mean]]] = []
        for contact in contacts:
            if not contact.has_means:
                continue
            means = self.means.get(contact.name)
            if means is None:
                for name in ("gap", "complementarity", "cone", "slip"):
                    self.checks[name].skip("means of surfaces that touch themselves are left out")
                continue
            asked = contact.slaves[np.isfinite(gaps[contact.slaves])]
            found = list(means.means(x0, x1, asked, told and increment.scheme == ENERGY_MOMENTUM))
            all_found.append((contact, means, found))
        for contact, means, found in all_found:
            # the file tells the least gap and the state of all contacts that a node is in
            elsewhere = _elsewhere(contact, contacts, {other.name for other, _, _ in all_found})
            # of nodes that are master too the file tells one gap and one state for both, eq. (9.16)
            of_master = _at_masters([(other, more) for _, other, more in all_found if other is not means])
            closed = []
            least: dict[int, Mean] = {}
            for mean in found:
                if mean.node not in least or mean.gap < least[mean.node].gap:
                    least[mean.node] = mean
            for node, mean in least.items():
                label = self.result.node_labels[node]
                at = f"mean at node {label}, t = {frame.time:g}"
                on_master = of_master.get(node, AtMaster())
                is_corner = node in means.held or on_master.is_corner
                nearest = min(mean.gap, on_master.gap)
                if not is_corner and gaps[node] <= NEAR * self._edge and (told or not on_master.whole):
                    beyond = gaps[node] - nearest
                    stored = (beyond if node in elsewhere else abs(beyond)) / self._edge
                    bound = MOVED if mean.moved or on_master.moved else TOUCH
                    self.checks["gap"].add(stored, bound + noise, f"GAP, {at}")
                # what is left at the ends of masters, eq. (7.9)
                is_exact = told and not mean.moved and node not in means.corners
                bound = GAP if is_exact else LEFT
                self.checks["gap"].add(-mean.gap / self._edge, bound + noise, at)
                if status[node] >= STICK and not is_corner and node not in elsewhere:
                    open_by = min(mean.gap, on_master.least)
                    bound = LEFT if on_master.moved else bound
                    self.checks["gap"].add(open_by / self._edge, bound + noise, at)
            for mean in found:
                is_near = abs(mean.gap) <= (GAP + noise if not mean.moved else LEFT) * self._edge
                is_least = mean is least[mean.node] and mean.node not in elsewhere
                if status[mean.node] >= STICK and (is_near or is_least):
                    closed.append(mean)
            if not closed:
                continue
            if not told and increment.scheme != STATIC:
                self.checks["cone"].skip("frames whose start the file does not tell are left out")
                continue
            if self._is_shared(contact):
                self.checks["cone"].skip("nodes of means that are in several contacts are left out")
                continue
            self._mean_cones(means, closed, frame, increment, told)
        return [contact for contact in contacts if not contact.has_means]

    def _is_shared(self, contact: Contact) -> bool:
        """Whether slave nodes of a contact are also in other contacts."""
        others = [one for one in self.contacts if one is not contact]
        nodes = [np.append(one.slaves, one.segments.ravel()) for one in others]
        return bool(nodes) and bool(np.isin(contact.slaves, np.concatenate(nodes)).any())

    def _mean_cones(
        self, means: Means, closed: list[Mean], frame: Frame, increment: Increment, told: bool
    ) -> None:
        """Checks the forces of closed mean gaps: the nodal forces that these do not explain, the friction cone, and
        slips."""
        forces, is_told, left = means.forces(closed, frame["CONTACT_FORCE"])
        place = f"{means.contact.name}, t = {frame.time:g}"
        self.checks["cone"].add(left / self.force_scale, MEANS, f"forces of no mean, {place}")
        friction = float(means.contact.friction.max())
        x = np.abs(self.result.coordinates + frame["U"]).max()
        noise = 64 * EPS * x / self._edge
        for mean, (normal, tangential), one in zip(closed, forces, is_told, strict=True):
            if not one:
                continue
            normal *= mean.stretch
            at = f"mean at node {self.result.node_labels[mean.node]}, t = {frame.time:g}"
            slip = (mean.slip, (SLIP + noise) * self._edge) if told and not mean.moved else None
            self._cone(frame, increment, means.contact, mean.node, (normal, tangential), slip, MEANS, at)
            if not told or not means.contact.is_constant or friction == 0.0:
                continue
            room = friction * normal - abs(tangential)
            if room > 1e-6 * self.force_scale:
                self.checks["slip"].add(abs(mean.slip) / self._edge, SLIP + noise, at)
            # where the corner of the node carries alone its mean has no force but round-off
            elif friction * normal > 1e-6 * self.force_scale and abs(mean.slip) / self._edge > SLIP + noise:
                self.checks["slip"].add(float(mean.slip * tangential > 0.0), 0.0, at)

    def _discs(
        self, contacts: list[Contact], x: Array, status: Integers, place: str
    ) -> tuple[list[Contact], Integers]:
        """Checks the gaps of discs; returns the other contacts, and the nodes whose forces may come from discs."""
        nodes: set[int] = set()
        for contact in contacts:
            if contact.disc is None:
                continue
            gap = disc_gap(contact, contact.disc, self.result.coordinates, x)
            error = abs(gap) if status[contact.slaves[0]] >= STICK else max(-gap, 0.0)
            self.checks["gap"].add(error, DISC_GAP, f"disc of {contact.name}, {place}")
            nodes.update(contact.slaves.tolist(), contact.segments.ravel().tolist(), [contact.disc.arm])
        others = [contact for contact in contacts if contact.disc is None]
        return others, np.array(sorted(nodes), np.int64)

    def _gap_field(
        self,
        x: Array,
        way: Array,
        opened: Integers,
        gaps: Array,
        noise: float,
        contacts: list[Contact],
        place: str,
    ) -> None:
        """Checks that GAP is the distance from the line of some segment."""
        asked = opened[np.isfinite(gaps[opened])]
        off = np.full(len(x), np.inf)
        bound = FIELD + noise
        for contact in contacts:
            for near in places(x, way, np.intersect1d(contact.slaves, asked), contact):
                error = np.abs(near.gap - gaps[near.nodes][:, None] / near.length).min(axis=1)
                for row in np.flatnonzero(error > bound):
                    node = int(near.nodes[row])
                    error[row] = min(error[row], corner_error(x, way, contact, node, gaps[node])[0])
                off[near.nodes] = np.minimum(off[near.nodes], error)
        self.checks["gap"].add(
            off[asked], bound, f"GAP of {{}} of {len(asked)} open nodes, {place}"
        )

    def _cone(
        self,
        frame: Frame,
        increment: Increment,
        contact: Contact,
        node: int,
        force: tuple[float, float],
        slip: tuple[float, float] | None,
        bound: float,
        at: str,
    ) -> None:
        """Compares the friction of a node or mean gap with the law at its pressure and at its slip, which is known up
        to a noise."""
        normal, tangential = force
        least, most, law = 0.0, float(contact.friction.max()), None
        if contact.laws and not contact.laws[increment.step].ramps:
            law = contact.laws[increment.step]
            pressure = float(frame["CONTACT_PRESSURE"][node]) if law.depends_on_pressure else 0.0
            if np.isfinite(pressure):
                most = law.most(pressure)
                if slip is not None and increment.dt > 0.0:
                    least, most = law.bounds(abs(slip[0]), slip[1], pressure, increment.dt)
        if law is not None and law.depends_on_pressure:
            if increment.start is None:
                self.checks["cone"].skip("friction that depends on pressure is left out where the file does not tell the start")
                return
            # the pressure of the law is that of the area at the start, the file's that of the end
            f = frame["CONTACT_FORCE"][node]
            n = normal * f - tangential * np.array([-f[1], f[0]])
            change = self._stretch((increment.start, frame["U"]), contact, node, n)
            bound += change * most * normal / self.force_scale
        outside = max(abs(tangential) - most * normal, least * normal - abs(tangential), -normal)
        self.checks["cone"].add(outside / self.force_scale, bound, at)

    def _stretch(self, u: tuple[Array, Array], contact: Contact, node: int, n: Array) -> float:
        """Relative change of the area of a node against a force along n, eq. (9.8), between two displacements."""
        faces = contact.faces if len(contact.faces) else self.result.boundary
        faces = faces[(faces == node).any(axis=1)]
        if not len(faces):
            return 0.0
        own, other = faces == node, faces != node
        # the radius at a third of the face, on a side with a node between its corners at the node
        is_curved = np.isin(faces, self.middles).any(axis=1)[:, None]
        place = np.where(is_curved, own, (2.0 * own + other) / 3.0)

        def area(u: Array) -> float:
            ends = (self.result.coordinates + u)[faces]
            e = ends[:, 1] - ends[:, 0]
            sizes = np.maximum(n[1] * e[:, 0] - n[0] * e[:, 1], 0.0)
            if self.result.is_axisymmetric:
                sizes *= (place * ends[:, :, 0]).sum(axis=1)
            return float(sizes.sum())

        sizes = [area(displacements) for displacements in u]
        return max(sizes) / min(sizes) - 1.0 if min(sizes) > 0.0 else np.inf

    def _cones(
        self, frame: Frame, increment: Increment, touches: list[Touch], corners: set[int]
    ) -> None:
        """Checks friction cone and slip of the nodes that touch exactly one segment and are neither an end of a touched
        segment nor at a touched corner."""
        if increment.start is None and increment.scheme != STATIC:
            return
        x1 = self.result.coordinates + frame["U"]
        halfway = increment.scheme == ENERGY_MOMENTUM
        known = increment.start is not None
        x0 = x1 if increment.start is None else self.result.coordinates + increment.start
        ends = corners | {node for touch in touches for node in touch.segment}
        count: dict[int, int] = {}
        for touch in touches:
            count[touch.node] = count.get(touch.node, 0) + 1
        told = self.increments.start_is_told(frame, increment)
        force = frame["CONTACT_FORCE"]
        place = f"t = {frame.time:g}"
        for touch in touches:
            nodes = (touch.node, *touch.segment)
            if count[touch.node] > 1 or touch.node in ends or not told[list(nodes)].all():
                continue
            own = split(x0, x1, force[touch.node], touch, halfway)
            if own.has_slid_on:
                continue
            label = self.result.node_labels[touch.node]
            at = f"node {label}, {place}"
            noise = 64 * EPS * np.abs(x1).max() / self._edge
            length = float(np.linalg.norm(x1[touch.segment[1]] - x1[touch.segment[0]]))
            slip = (own.slip * length, (SLIP + noise) * length) if known else None
            self._cone(frame, increment, touch.contact, touch.node, (own.normal, own.tangential), slip, CONE, at)
            friction = float(touch.contact.friction.max())
            if not known or not touch.contact.is_constant or friction == 0.0:
                continue
            # inside of the cone nothing slips, on it friction opposes the slip
            room = friction * own.normal - abs(own.tangential)
            if room > 1e-6 * self.force_scale:
                self.checks["slip"].add(abs(own.slip), SLIP + noise, at)
            elif abs(own.slip) > SLIP + noise:
                self.checks["slip"].add(float(own.slip * own.tangential > 0.0), 0.0, at)

    @property
    def _edge(self) -> float:
        """The length by which gaps are divided."""
        return self.result.edge_length


@dataclass
class AtMaster:
    """The mean gaps that act on a master node."""

    weighted: float = 0.0
    """Sum of their gaps by the parts of their normal forces that the node takes."""
    whole: float = 0.0
    """Sum of these parts."""
    least: float = np.inf
    moved: bool = False
    is_corner: bool = False
    """Whether it is a corner, which is held by itself too."""

    @property
    def gap(self) -> float:
        """The average of the mean gaps that act on a master node, eq. (9.16)."""
        return self.weighted / self.whole if self.whole > 0.0 else np.inf


def _in_means(contacts: list[Contact]) -> Integers:
    """Nodes whose forces come partly from mean gaps: nodes of surface-to-surface contacts, and masters that such nodes
    meet as single nodes."""
    of_means = [np.append(one.slaves, one.segments.ravel()) for one in contacts if one.has_means]
    nodes = np.unique(np.concatenate(of_means)) if of_means else np.empty(0, np.int64)
    shared = [one for one in contacts if not one.has_means and np.isin(one.slaves, nodes).any()]
    return np.unique(np.concatenate([nodes, *(one.segments.ravel() for one in shared)]))


def _elsewhere(contact: Contact, contacts: list[Contact], with_means: set[str]) -> set[int]:
    """Nodes that are also in contacts whose mean gaps are unknown, or are slaves of another contact."""
    others = [one for one in contacts if one is not contact]
    nodes = [one.slaves for one in others]
    nodes += [one.segments.ravel() for one in others if one.name not in with_means]
    return set(np.concatenate(nodes).tolist()) if nodes else set()


def _at_masters(found: list[tuple[Means, list[Mean]]]) -> dict[int, AtMaster]:
    """The mean gaps that act on each master node."""
    at: dict[int, AtMaster] = {}
    for means, some in found:
        for mean in some:
            for node, part in means.master_parts(mean).items():
                own = at.setdefault(node, AtMaster())
                own.weighted += part * mean.gap
                own.whole += part
                own.least = min(own.least, mean.gap)
                own.moved |= mean.moved
        for node in means.held_of_master:
            at.setdefault(node, AtMaster()).is_corner = True
    return at
