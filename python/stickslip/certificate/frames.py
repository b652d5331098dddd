"""Checks of every frame: energies, momenta, stresses, equilibrium and the contact law, recomputed."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.certificate.check import Checks
from stickslip.certificate.contacts import (
    BEYOND,
    Contact,
    Touch,
    contacts,
    corner_error,
    disc_gap,
    places,
    split,
    touching,
)
from stickslip.certificate.elements import EPS, SAINT_VENANT_KIRCHHOFF, Elements, is_axisymmetric
from stickslip.certificate.means import Mean, Means
from stickslip.certificate.rings import RingBlock
from stickslip.certificate.fits import REASON, Fits
from stickslip.frame import Frame
from stickslip.result import OPEN, STICK, Array, Flags, Integers, Result

ENERGY = 1e-11
"""Energies, momenta and masses: error as a part of the largest of the run."""

FORCES = 1e-10
"""Unbalanced forces, as a part of the largest force of the body; the solver stops at 1e-11."""

STRESS = 1e-11
"""Stresses and strains, as a part of the largest."""

GAP = 1e-9
"""Gap of a closed pair in lengths of its segment; the solver stops at 1e-10."""

DISC_GAP = 1e-9
"""Gap of a disc that touches, in radii."""

TOUCH = 1e-8
"""Nodes nearer to a segment than this part of its length are on it."""

SLIP = 1e-8
"""Slip of a node that sticks, in lengths of the segment."""

CONE = 1e-8
"""Forces outside of the cone, as a part of the largest force of the frame."""

HEAT = 1e-10
"""Difference of sums over nodes from sums over pairs that is round-off."""

EULER = 3
"""The backward Euler rule among the schemes of /model/steps."""

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


@dataclass(frozen=True)
class Increment:
    """The increment that ends with a frame."""

    row: int
    """Of the history."""
    step: int
    """Index of its step."""
    scheme: int
    theta: Array
    dt: float
    start: Array | None
    """Displacements at its start; none where the file does not tell them."""
    exact: bool
    """Whether the start is that of a frame, and not what velocities and accelerations tell."""


@dataclass(frozen=True)
class ReadOnce(Frame):
    """A frame whose fields are read once, though many checks ask for them; none may change them."""

    kept: dict[str, NDArray[Any]] = field(default_factory=dict)

    __hash__ = object.__hash__

    def full(self, name: str) -> NDArray[Any]:
        """A field as it stands in the file."""
        if name not in self.kept:
            self.kept[name] = super().full(name)
            self.kept[name].flags.writeable = False
        return self.kept[name]


class Frames:
    """What the checks of the frames share."""

    def __init__(self, result: Result, checks: Checks) -> None:
        self.result = result
        self.checks = checks
        self.elements = Elements(result)
        self.contacts = contacts(result)
        middles = self.elements.middles()
        self.middles = np.array(list(middles), np.int64)
        """Nodes between the corners of sides."""
        self.means = {
            contact.name: Means(contact, contact.faces, result.coordinates, middles, is_axisymmetric(result))
            for contact in self.contacts
            if contact.has_means and not np.array_equal(contact.faces, contact.segments)
        }
        self.time = result.history["time"]
        self.step, self.dt = result.history["step"], result.history["dt"]
        self.largest = result.history.energy.largest or 1.0
        self.fits = Fits(result)
        self.supported = result.read("model/supported_nodes")
        self.constrained = result.read("model/constrained_nodes")
        self.loaded = result.read("model/loaded_nodes")
        self.patterns = self.elements.load_patterns(result.read("model/load_groups"))
        self.scheme = result.read("model/steps/scheme")
        self.theta = result.read("model/steps/theta")
        self.is_redistributed = "CONTACT_MASS" in result.frames.fields
        self.returned: set[int] = set()
        if "returns" in result.file["history"]:
            self.returned = set(result.complete_rows("history/returns/increment").tolist())
        self.rigid = _whole_bodies(self.elements, self.constrained)
        self.weighted = self._weighted_bodies()
        self.partly_rigid = self._partly_rigid_bodies()
        self.impelled = self._impelled_nodes()
        self.flows = np.zeros(self.elements.bodies, np.bool_)
        self.flows[self.elements.body[self.elements.is_metal]] = True
        if self.flows.any():
            for name in ("strain energy", "stresses", "equilibrium"):
                self.checks[name].skip("metals are left out: the file has no internal variables")
        self.force_scale = max(
            (float(np.abs(frame["CONTACT_FORCE"]).max()) for frame in result.frames), default=0.0
        )
        self.spring_force = np.zeros(len(self.time))
        if "connectors" in result.history:
            force = np.abs(result.history["connectors"].force)
            self.spring_force = force.max(axis=1, initial=0.0)
        self.stiffness = np.zeros(self.elements.bodies)
        for block in self.elements.blocks:
            np.maximum.at(self.stiffness, self.elements.body[block.elements], block.stiffness)
        energy = result.history.energy.largest
        self.reach = np.sqrt(2.0 * energy / np.where(self.stiffness > 0.0, self.stiffness, np.inf))
        """Largest displacement of every body in the frames so far, at least the one that would store the
        largest energy of the run: the round-off of a load stays when it is taken off. Mean dilatations, and
        the invariants of hyperelastic laws, are computed beside 1, as positions are."""
        for block in self.elements.blocks:
            if block.mean_dilatation or block.law != SAINT_VENANT_KIRCHHOFF:
                size = 1.0 / np.abs(block.gradient).max(axis=(1, 2, 3))
                np.maximum.at(self.reach, self.elements.body[block.elements], size)

    def check(self) -> None:
        """All checks of all frames."""
        stored = self.result.read("model/bodies/mass")
        error = np.abs(self.elements.mass() - stored)[~self.weighted] / stored.max(initial=0.0)
        self.checks["mass"].add(error, ENERGY, "body {}")
        if self.weighted.any():
            for name in ("mass", "kinetic energy", "momenta"):
                self.checks[name].skip("bodies with point masses at rigid parts are left out")
        last: tuple[int, Array] | None = None
        for index in range(len(self.result.frames)):
            frame = ReadOnce(self.result, index)
            rows = np.flatnonzero(self.time == frame.time)
            if len(rows) == 0:
                self.checks["time"].add(1.0, 0.0, f"frame {frame.index} has no increment")
                continue
            row = int(rows[-1])
            u = frame["U"]
            increment = self._increment(frame, row, last)
            self._finite(frame)
            self._energies(frame, row)
            self._stresses(frame)
            self._actions(frame, increment)
            if row > 0:
                self._equilibrium(frame, increment)
            self._law(frame, increment)
            self._sets(frame, row)
            self._heat(frame, row)
            last = (row, u)

    def _bodies_with_rigid_parts(self) -> Flags:
        """Bodies some of whose nodes move as rigid parts [B]."""
        has_rigid = np.zeros(self.elements.bodies, np.bool_)
        if "rigid" in self.result.file["history"]:
            parts = self.elements.of_node[self.constrained]
            has_rigid[parts[parts >= 0]] = True
        return has_rigid

    def _impelled_nodes(self) -> Integers:
        """Nodes whose velocity and acceleration the impulse (11.12) changes: U0 does not follow from them."""
        impelled = np.append(self._bodies_with_rigid_parts(), False)
        return np.flatnonzero(impelled[self.elements.of_node])

    def _weighted_bodies(self) -> Flags:
        """Bodies with rigid parts that have more mass than their elements: that of point elements [B]."""
        stored = self.result.read("model/bodies/mass")
        return self._bodies_with_rigid_parts() & (stored - self.elements.mass() > ENERGY * stored.max(initial=0.0))

    def _partly_rigid_bodies(self) -> Flags:
        """Bodies of elements that deform and of others that move with a rigid body [B].

        V of the nodes between them leaves the rigid motion by second order in dt.
        """
        partly = np.zeros(self.elements.bodies, np.bool_)
        if "rigid" not in self.result.file["history"]:
            return partly
        constrained = np.zeros(self.elements.nodes, np.bool_)
        constrained[self.constrained] = True
        for block in self.elements.blocks:
            moved = block.elements[constrained[block.nodes].all(axis=1)]
            partly[self.elements.body[moved]] = True
        return partly & ~self.rigid

    def _finite(self, frame: Frame) -> None:
        """No field of motion and force is NaN."""
        for name in ("U", "V", "A", "RF", "CONTACT_FORCE"):
            bad = ~np.isfinite(frame.full(name)).all()
            self.checks["time"].add(float(bad), 0.0, f"{name} of frame {frame.index} is no number")

    def _increment(self, frame: Frame, row: int, last: tuple[int, Array] | None) -> Increment:
        """The increment of a frame; where it starts by the last frame, or by (4.1) and (4.2)."""
        step = int(self.step[row]) - 1
        scheme, theta = int(self.scheme[step]), self.theta[step]
        dt = float(self.dt[row])
        start, exact = None, False
        if last is not None and last[0] == row - 1:
            start, exact = last[1], True
        elif scheme != 0 and row not in self.returned and not self.is_redistributed:
            # d = dt V1, or d = dt V1 - dt² A/2, from V1 = V0+ + dt A
            start = frame["U"] - dt * frame["V"]
            if scheme != EULER:
                start += 0.5 * dt * dt * frame["A"]
        return Increment(row, step, scheme, theta, dt, start, exact)

    def _energies(self, frame: Frame, row: int) -> None:
        """Energies and momenta of the bodies, of all of them and each."""
        history, u, v = self.result.history, frame["U"], frame["V"]
        place = f"body {{}}, t = {frame.time:g}"
        largest = self.largest
        elastic = ~self.rigid
        noise = EPS * (self.stiffness * np.abs(u).max() ** 2) / largest
        strain = self.elements.strain_energy(u)
        told = elastic & ~self.flows
        error = np.abs(strain - history.bodies["strain"][row])[told] / largest
        self.checks["strain energy"].add(error, ENERGY + noise[told], place)
        if told.all() and "connectors" not in self.result.file["history"]:
            total = abs(strain.sum() - history.energy["strain"][row]) / largest
            self.checks["strain energy"].add(total, ENERGY + noise.sum(), f"t = {frame.time:g}")
        elif not elastic.all():
            self.checks["strain energy"].skip("bodies that move as a whole are left out")
        if self.is_redistributed:
            for name in ("kinetic energy", "momenta", "equilibrium"):
                self.checks[name].skip("the mass of the contact surfaces is redistributed")
            return
        x = frame.positions
        elastic = ~self.rigid & ~self.weighted & ~self.partly_rigid
        p = self.elements.momentum(v)
        kinetic = self._sum(0.5 * np.einsum("ni,ni->n", v, p))
        error = np.abs(kinetic - history.bodies["kinetic"][row])[elastic] / largest
        self.checks["kinetic energy"].add(error, ENERGY, place)
        mass = self.elements.momentum(np.ones_like(v))[:, 0]
        body_mass = self._sum(mass)
        centre = self._sum(mass[:, None] * x) / body_mass[:, None] * self.elements.keeps
        momentum = self._sum(p) * self.elements.keeps
        size = (
            np.abs(history.momentum["linear"]).max()
            + np.abs(body_mass[:, None] * history.bodies["velocity"]).max(initial=0.0)
        )
        if size > 0.0:
            stored = body_mass[:, None] * history.bodies["velocity"][row]
            error = np.abs(momentum - stored).max(axis=1)[elastic] / size
            self.checks["momenta"].add(error, ENERGY, place)
        extent = np.abs(x[self.result.in_cells]).max(initial=0.0)
        error = np.abs(centre - history.bodies["center"][row]).max(axis=1)[elastic] / extent
        self.checks["momenta"].add(error, ENERGY, "centre of " + place)
        if self.rigid.any():
            self.checks["momenta"].skip("bodies that move as a whole are left out")
        if self.partly_rigid.any():
            for name in ("kinetic energy", "momenta"):
                self.checks[name].skip("bodies with rigid parts are left out")
        if not elastic.all():
            return
        moving = []
        if "rigid" in self.result.file["history"]:
            moving = [each["kinetic"][row] for each in history.rigid.values() if "kinetic" in each]
        if moving and not self.elements.count:
            total = abs(sum(moving) - history.energy["kinetic"][row]) / largest
            self.checks["kinetic energy"].add(total, ENERGY, f"rigid bodies, t = {frame.time:g}")
        if moving:
            return
        total = abs(kinetic.sum() - history.energy["kinetic"][row]) / largest
        self.checks["kinetic energy"].add(total, ENERGY, f"t = {frame.time:g}")
        whole = p.sum(axis=0) * self.elements.keeps
        linear = np.abs(whole - history.momentum["linear"][row]).max()
        angular = float((x[:, 0] * p[:, 1] - x[:, 1] * p[:, 0]).sum() * self.elements.keeps[0])
        error = abs(angular - history.momentum["angular"][row])
        if size > 0.0:
            self.checks["momenta"].add(linear / size, ENERGY, f"t = {frame.time:g}")
            at = f"angular, t = {frame.time:g}"
            self.checks["momenta"].add(error / (size * extent), ENERGY, at)

    def _sets(self, frame: Frame, row: int) -> None:
        """Histories of sets are those of the frames."""
        check, place = self.checks["accounts"], f"t = {frame.time:g}"
        groups = (
            (self.result.history.nodes, self.result.node_labels, ("U", "V", "RF")),
            (self.result.history.elements, self.result.element_labels, ("S", "E", "MISES")),
        )
        for group, labels, names in groups:
            for name, members in group.items():
                at = np.flatnonzero(np.isin(labels, members["labels"]))
                at = at[np.argsort(labels[at])][np.argsort(np.argsort(members["labels"]))]
                for field in names:
                    if field in members:
                        differ = (members[field][row] != frame[field][at]).any()
                        check.add(float(differ), 0.0, f"{field} of the set {name}, {place}")

    def _heat(self, frame: Frame, row: int) -> None:
        """Heat of all nodes is that of the contacts."""
        if "FRICTION_HEAT" not in self.result.frames.fields:
            return
        work = {one.name: self.result.contact[one.name]["friction_dissipation"] for one in self.contacts}
        largest = sum(one.heat * float(np.abs(work[one.name]).max(initial=0.0)) for one in self.contacts)
        told = sum(one.heat * float(work[one.name][row]) for one in self.contacts)
        error = abs(float(np.nansum(frame["FRICTION_HEAT"])) - told)
        if largest > 0.0:
            place = f"FRICTION_HEAT of all nodes, t = {frame.time:g}"
            self.checks["accounts"].add(error / largest, HEAT, place)

    def _sum(self, values: Array) -> Array:
        """Sums of nodal values over the bodies."""
        inside = self.elements.of_node >= 0
        total = np.zeros((self.elements.bodies, *values.shape[1:]))
        np.add.at(total, self.elements.of_node[inside], values[inside])
        return total

    def _stresses(self, frame: Frame) -> None:
        """Stresses and strains of the elements."""
        stress, strain = self.elements.stresses(frame["U"])
        moduli = np.zeros(self.elements.count)
        gradient = np.zeros(self.elements.count)
        way = max(np.abs(frame["U"]).max(), self.reach.max(initial=0.0))
        reach = np.full(self.elements.count, way)
        constrained = np.zeros(self.elements.nodes, np.bool_)
        constrained[self.constrained] = True
        for block in self.elements.blocks:
            moduli[block.elements] = block.lame + 2.0 * block.shear
            gradient[block.elements] = np.abs(block.gradient).max(axis=(1, 2, 3))
            # the nodes of rigid parts are placed by their arms
            placed = block.elements[constrained[block.nodes].all(axis=1)]
            reach[placed] += np.abs(self.result.coordinates).max()
        noise = 16 * EPS * gradient * reach
        elastic = ~self.rigid[self.elements.body]
        metal = self.elements.is_metal
        stress[metal] = frame["S"][metal]
        place = f"element {{}}, t = {frame.time:g}"
        for found, name, factor in ((stress, "S", moduli), (strain, "E", np.ones_like(moduli))):
            stored = frame[name]
            check = self.checks["stresses" if name == "S" else "strains"]
            size = float(np.abs(found[elastic]).max(initial=0.0))
            check.scale = max(check.scale, size)
            error = np.abs(found - stored).max(axis=1)[elastic]
            check.add(error, (STRESS * size + factor * noise)[elastic], f"{name} of {place}")
        if "E33" in self.result.frames.fields:
            self._around(frame, place)
        across = frame["S33"]
        mises = np.sqrt(
            0.5
            * (
                (stress[:, 0] - stress[:, 1]) ** 2
                + (stress[:, 1] - across) ** 2
                + (across - stress[:, 0]) ** 2
            )
            + 3.0 * stress[:, 2] ** 2
        )
        size = float(np.abs(stress[elastic]).max(initial=0.0))
        mean = (stress[:, 0] + stress[:, 1]) / 2.0
        half = np.hypot((stress[:, 0] - stress[:, 1]) / 2.0, stress[:, 2])
        principal = np.sort([mean - half, mean + half, across], axis=0)
        bound = (STRESS * size + 4.0 * moduli * noise)[elastic]
        derived = zip(
            ("MISES", "SP1", "SP2", "SP3", "PRESS"),
            (mises, *principal, -(2.0 * mean + across) / 3.0),
            strict=True,
        )
        for name, values in derived:
            if name in self.result.frames.fields:
                error = np.abs(values - frame[name])[elastic]
                self.checks["stresses"].add(error, bound, f"{name} of {place}")

    def _around(self, frame: Frame, place: str) -> None:
        """Strains around the axis."""
        noise = 64 * EPS * max(np.abs(frame["U"]).max(), self.reach.max(initial=0.0))
        for block in self.elements.blocks:
            if isinstance(block, RingBlock):
                found = block.mean_around(frame["U"])
                error = np.abs(found - frame["E33"][block.elements])
                bound = STRESS * np.abs(found).max(initial=0.0) + noise * block.around.max()
                self.checks["strains"].add(error, bound, f"E33 of {place}")

    def _actions(self, frame: Frame, increment: Increment) -> None:
        """Contact forces of a frame have no resultant and no moment."""
        force = frame["CONTACT_FORCE"]
        size = np.abs(force).sum()
        if size == 0.0:
            return
        check = self.checks["action"]
        place = f"t = {frame.time:g}"
        check.add(np.abs(force.sum(axis=0)).max() / size, ENERGY, place)
        for contact in self.contacts:
            others = [one for one in self.contacts if one is not contact]
            alone = np.concatenate(
                [
                    contact.segments.ravel(),
                    *(np.append(o.slaves, o.segments.ravel()) for o in others),
                ]
            )
            slaves = contact.slaves if contact.disc is None else np.append(contact.slaves, contact.disc.arm)
            if not np.isin(slaves, alone).any():
                total = force[slaves].sum(axis=0)
                stored = self.result.contact[contact.name]["force"][increment.row]
                check.add(
                    np.abs(total - stored).max() / size,
                    ENERGY,
                    f"{contact.name}, t = {frame.time:g}",
                )
        x = self.result.coordinates + frame["U"]
        loaded = np.abs(force).max(axis=1) > 0.0
        if increment.scheme == 1:
            # discrete gradients act halfway
            if increment.start is None or not self._start_is_told(frame, increment)[loaded].all():
                return
            x = self.result.coordinates + 0.5 * (increment.start + frame["U"])
        moment = x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0]
        arm = np.abs(x[loaded]).max()
        check.add(abs(moment.sum()) / (size * arm), 1e-9, f"moment, t = {frame.time:g}")

    def _start_is_told(self, frame: Frame, increment: Increment) -> Flags:
        """Nodes whose place at the start of the increment is known [N]."""
        told = np.ones(len(frame["U"]), np.bool_)
        if not increment.exact:
            a = np.abs(frame["A"]).max(axis=1) * increment.dt**2
            size = np.abs(self.result.coordinates + frame["U"]).max()
            driven = np.concatenate([self.supported, self.constrained, self.impelled])
            told[driven[a[driven] > 4 * EPS * size]] = False
        return told

    def _equilibrium(self, frame: Frame, increment: Increment) -> None:
        """Unbalanced forces of free nodes, eq. (4.5) or (12.1)."""
        check = self.checks["equilibrium"]
        if self.is_redistributed:
            return
        u1, a, v1 = frame["U"], frame["A"], frame["V"]
        force = frame["CONTACT_FORCE"]
        start, dt = increment.start, increment.dt
        if increment.scheme == 0:
            internal = self.elements.forces(0, u1, u1, u1, dt)
            inertia = np.zeros_like(u1)
        elif start is None:
            check.skip("frames of increments with a landing return are left out")
            return
        else:
            d = u1 - start
            theta1, theta2 = increment.theta
            at = start + theta2 * d + (theta1 - theta2) * dt * (v1 - dt * a)
            internal = self.elements.forces(increment.scheme, start, u1, at, dt)
            inertia = self.elements.momentum(a)
        residual = inertia + internal - force - frame["RF"]
        told = self._start_is_told(frame, increment)
        if not told[self.impelled].all():
            check.skip("bodies with rigid parts are left out between frames far apart")
        for block in self.elements.blocks:
            unknown = ~told[block.nodes].all(axis=1)
            told[block.nodes[unknown]] = False
        told[self.constrained] = told[self.loaded] = False
        told[np.isin(self.elements.of_node, np.flatnonzero(self.flows))] = False
        told &= self.elements.of_node >= 0
        told[self._fading(residual, frame, increment)] = False
        residual = self._without_weight(residual, told)
        size = np.abs(residual).max(axis=1)
        largest = np.maximum(np.abs(internal), np.maximum(np.abs(inertia), np.abs(force)))
        scale = np.full(self.elements.bodies, self.spring_force[increment.row])
        inside = self.elements.of_node >= 0
        bodies = self.elements.of_node[inside]
        np.maximum.at(scale, bodies, largest.max(axis=1)[inside])
        way = np.abs(u1) + dt * np.abs(v1) + dt * dt * np.abs(a)
        way += np.abs(force).any(axis=1)[:, None] * np.abs(self.result.coordinates)
        np.maximum.at(self.reach, bodies, way.max(axis=1)[inside])
        noise = 32 * EPS * self.stiffness * self.reach
        nodes = np.flatnonzero(told)
        body = self.elements.of_node[nodes]
        check.scale = max(check.scale, float(scale.max(initial=0.0)))
        place = f"{{}} of {len(nodes)} nodes, t = {frame.time:g}"
        check.add(size[nodes], FORCES * scale[body] + noise[body], place)
        if not len(nodes):
            check.skip("no node is free of supports and loads")

    def _fading(self, residual: Array, frame: Frame, increment: Increment) -> Flags:
        """Nodes with forces of removed supports and contacts, which fade until the end of a static or quasi-static step."""
        fade = np.zeros(len(residual), np.bool_)
        row, step = increment.row, self.step
        is_end = row + 1 == len(step) or step[row + 1] != step[row]
        if increment.step == 0 or is_end or increment.scheme not in (0, EULER):
            return fade
        free = (frame["RF"][self.supported] == 0.0) & (residual[self.supported] != 0.0)
        if free.any():
            fade[self.supported[free.any(axis=1)]] = True
            self.checks["equilibrium"].skip("reactions of supports that a step removes fade until its end")
        for contact in self.contacts:
            if contact.acts[increment.step - 1] and not contact.acts[increment.step]:
                fade[contact.slaves] = fade[contact.segments.ravel()] = True
                self.checks["equilibrium"].skip("forces of contacts that a step removes fade until its end")
        return fade

    def _without_weight(self, residual: Array, told: Flags) -> Array:
        """Takes out the body forces: the accelerations of their patterns that fit best."""
        if not self.patterns:
            return residual
        residual = residual.copy()
        for body in sorted({body for body, _ in self.patterns}):
            nodes = told & (self.elements.of_node == body)
            columns = [pattern[nodes] for number, pattern in self.patterns if number == body]
            matrix = np.stack(columns, axis=1)
            fit = np.linalg.lstsq(matrix, residual[nodes], rcond=None)[0]
            residual[nodes] -= matrix @ fit
        self.checks["equilibrium"].skip("body forces are fitted, an acceleration for each load")
        return residual

    def _law(self, frame: Frame, increment: Increment) -> None:
        """Gaps, complementarity, friction cones and slips of the contacts."""
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
        for contact in others:
            if contact.has_means:
                nodes = np.append(contact.slaves, contact.segments.ravel())
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
        """Mean gaps, cones and slips from surface to surface; the other contacts."""
        x1 = self.result.coordinates + frame["U"]
        start = increment.start
        x0 = x1 if start is None else self.result.coordinates + start
        told = start is not None and bool(self._start_is_told(frame, increment).all())
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
            found = list(means.means(x0, x1, asked, told and increment.scheme == 1))
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
                is_corner = node in means.corners or on_master.is_corner
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
            if not told and increment.scheme != 0:
                self.checks["cone"].skip("frames whose start the file does not tell are left out")
                continue
            if self._is_shared(contact):
                self.checks["cone"].skip("nodes of means that are in several contacts are left out")
                continue
            self._mean_cones(means, closed, frame, increment, told)
        return [contact for contact in contacts if not contact.has_means]

    def _is_shared(self, contact: Contact) -> bool:
        """Whether the slave nodes of a contact are in other contacts too."""
        others = [one for one in self.contacts if one is not contact]
        nodes = [np.append(one.slaves, one.segments.ravel()) for one in others]
        return bool(nodes) and bool(np.isin(contact.slaves, np.concatenate(nodes)).any())

    def _mean_cones(
        self, means: Means, closed: list[Mean], frame: Frame, increment: Increment, told: bool
    ) -> None:
        """The forces of closed means: what nodal forces they leave, the cone, and slips."""
        forces, is_told, left = means.forces(closed, frame["CONTACT_FORCE"])
        place = f"{means.contact.name}, t = {frame.time:g}"
        self.checks["cone"].add(left / self.force_scale, MEANS, f"forces of no mean, {place}")
        friction = float(means.contact.friction.max())
        x = np.abs(self.result.coordinates + frame["U"]).max()
        noise = 64 * EPS * x / self._edge
        for mean, (normal, tangential), one in zip(closed, forces, is_told, strict=True):
            if not one:
                continue
            at = f"mean at node {self.result.node_labels[mean.node]}, t = {frame.time:g}"
            slip = (mean.slip, (SLIP + noise) * self._edge) if told and not mean.moved else None
            self._cone(frame, increment, means.contact, mean.node, (normal, tangential), slip, MEANS, at)
            if not told or not means.contact.is_constant or friction == 0.0:
                continue
            room = friction * normal - abs(tangential)
            if room > 1e-6 * self.force_scale:
                self.checks["slip"].add(abs(mean.slip) / self._edge, SLIP + noise, at)
            elif abs(mean.slip) / self._edge > SLIP + noise:
                self.checks["slip"].add(float(mean.slip * tangential > 0.0), 0.0, at)

    def _discs(
        self, contacts: list[Contact], x: Array, status: Integers, place: str
    ) -> tuple[list[Contact], Integers]:
        """Gaps of discs; the other contacts, and the nodes whose forces may be those of discs."""
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
        """GAP is the distance from the line of some segment."""
        asked = opened[np.isfinite(gaps[opened])]
        off = np.full(len(x), np.inf)
        bound = 1e-8 + noise
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
        """Friction of a node or mean beside that of the law at its slip, which may be off by a noise, and its pressure."""
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
        """The change of the area of a node against a force along n, eq. (9.8), from displacements to others, as a part of it."""
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
            if is_axisymmetric(self.result):
                sizes *= (place * ends[:, :, 0]).sum(axis=1)
            return float(sizes.sum())

        sizes = [area(displacements) for displacements in u]
        return max(sizes) / min(sizes) - 1.0 if min(sizes) > 0.0 else np.inf

    def _cones(
        self, frame: Frame, increment: Increment, touches: list[Touch], corners: set[int]
    ) -> None:
        """Cone and slip of the nodes that touch one segment, and are no end of a touched one nor at a touched corner."""
        if increment.start is None and increment.scheme != 0:
            return
        x1 = self.result.coordinates + frame["U"]
        halfway = increment.scheme == 1
        known = increment.start is not None
        x0 = x1 if increment.start is None else self.result.coordinates + increment.start
        ends = corners | {node for touch in touches for node in touch.segment}
        count: dict[int, int] = {}
        for touch in touches:
            count[touch.node] = count.get(touch.node, 0) + 1
        told = self._start_is_told(frame, increment)
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
        """The length by which gaps are measured."""
        return self.result.edge_length


@dataclass
class AtMaster:
    """The means that act on a master node."""

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
        """Their mean gap, eq. (9.16)."""
        return self.weighted / self.whole if self.whole > 0.0 else np.inf


def _elsewhere(contact: Contact, contacts: list[Contact], with_means: set[str]) -> set[int]:
    """Nodes that are also in contacts whose means are not known, or slaves of another contact."""
    others = [one for one in contacts if one is not contact]
    nodes = [one.slaves for one in others]
    nodes += [one.segments.ravel() for one in others if one.name not in with_means]
    return set(np.concatenate(nodes).tolist()) if nodes else set()


def _at_masters(found: list[tuple[Means, list[Mean]]]) -> dict[int, AtMaster]:
    """What means have at their master nodes."""
    at: dict[int, AtMaster] = {}
    for means, some in found:
        for mean in some:
            for node, part in means.master_parts(mean).items():
                own = at.setdefault(node, AtMaster())
                own.weighted += part * mean.gap
                own.whole += part
                own.least = min(own.least, mean.gap)
                own.moved |= mean.moved
        for node in means.master_corners:
            at.setdefault(node, AtMaster()).is_corner = True
    return at


def _whole_bodies(elements: Elements, constrained: Integers) -> Flags:
    """Bodies all of whose nodes are constrained, as those of rigid bodies are [B]."""
    free = np.ones(elements.nodes, np.bool_)
    free[constrained] = False
    has_free = np.zeros(elements.bodies, np.bool_)
    inside = elements.of_node >= 0
    np.logical_or.at(has_free, elements.of_node[inside], free[inside])
    return ~has_free
