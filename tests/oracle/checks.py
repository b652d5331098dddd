"""Checks of what a result file tells of its elements: masses, energies, momenta, stresses, strains and equilibrium, computed anew."""

from pathlib import Path

import numpy as np

from oracle.block import SAINT_VENANT_KIRCHHOFF
from oracle.elements import PLASTICITY, Elements, unknown_types
from oracle.rings import RingBlock
from oracle.tensors import EPS
from stickslip.arrays import Array, Flags
from stickslip.certificate.certify import Certificate, certify
from stickslip.certificate.check import Checks
from stickslip.certificate.contacts import contacts
from stickslip.certificate.increments import EULER, STATIC, Increment, Increments
from stickslip.frame import Frame
from stickslip.result import Result

TEXTS = {
    "mass": "masses of the bodies, part of the largest",
    "strain energy": "strain energies from displacements, part of the largest energy",
    "kinetic energy": "kinetic energies from velocities, part of the largest energy",
    "momenta": "momenta and centres of mass from the fields, part of the largest",
    "stresses": "stresses from displacements, part of the largest",
    "strains": "strains from displacements, part of the largest",
    "equilibrium": "unbalanced force of a free node, part of the largest force",
}

ENERGY = 1e-11
"""Energies, momenta and masses: error as a part of the largest of the run."""

FORCES = 1e-10
"""Unbalanced forces, as a part of the largest force of the body; the solver stops at 1e-11."""

STRESS = 1e-11
"""Stresses and strains, as a part of the largest."""


def recompute(result: Result | Path | str) -> Certificate:
    """Computes what a result file tells of its elements anew, from `/model` and the fields of its frames."""
    if not isinstance(result, Result):
        with Result(result) as opened:
            return recompute(opened)
    checks = Checks(TEXTS)
    unknown = unknown_types(result)
    if unknown:
        for name in TEXTS:
            checks[name].skip(f"the oracle does not know the element type {unknown[0]}")
    else:
        with np.errstate(all="ignore"):  # what is no number fails
            Mechanics(result, checks).check()
    shown = ("strain energy", "momenta", "equilibrium")
    return Certificate(result.job, checks.all(), result.rows - 1, len(result.frames), shown, "")


def broken(result: Result | Path | str) -> set[str]:
    """Names of the checks of the certificate and of the oracle that do not hold."""
    return {check.name for found in (certify(result), recompute(result)) for check in found.checks if not check.holds}


def assert_holds(result: Result | Path | str) -> None:
    """A result has a certificate that holds, and its elements are those of the oracle."""
    for found in (certify(result), recompute(result)):
        assert found.holds, "\n".join([found.line, *found.table()])


class Mechanics:
    """What the checks share."""

    def __init__(self, result: Result, checks: Checks) -> None:
        self.result, self.checks = result, checks
        self.increments = Increments(result)
        self.elements = Elements(result)
        self.contacts = contacts(result)
        self.largest = result.history.energy.largest or 1.0
        self.loaded = result.read("model/loaded_nodes")
        self.patterns = self.elements.load_patterns(result.read("model/load_groups"))
        self.constrained = np.zeros(self.elements.nodes, np.bool_)
        self.constrained[self.increments.constrained] = True
        self.has_rigid = "rigid" in result.file["history"]
        self.rigid = self._whole_bodies()
        self.weighted = self._weighted_bodies()
        self.partly_rigid = self._partly_rigid_bodies()
        self.untold = np.zeros(self.elements.bodies, np.bool_)
        """Bodies with elements whose stresses the oracle does not know [B]."""
        self.untold[self.elements.body[self.elements.is_untold]] = True
        for law in self.elements.unknown_laws:
            reason = f"elements of the law {law} are left out: the oracle does not know it"
            if law == PLASTICITY:
                reason = "metals are left out: the file has no internal variables"
            for name in ("strain energy", "stresses", "equilibrium"):
                self.checks[name].skip(reason)
        self.spring_force = np.zeros(len(self.increments.time))
        if "connectors" in result.history:
            force = np.abs(result.history["connectors"].force)
            self.spring_force = force.max(axis=1, initial=0.0)
        self.stiffness, self.diagonal = self._stiffnesses()
        """Largest entry of K on the diagonal of every body, of one element alone and of all, when undeformed [B]."""
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
        for frame, increment in self.increments.frames():
            if increment is None:
                continue
            if self.elements.initial is not None:
                self.elements.heat(frame["TEMPERATURE"], self._rigid_elements(frame))
            self._strain_energies(frame, increment.row)
            self._motion(frame, increment.row)
            self._stresses(frame)
            self._strains(frame)
            if increment.row > 0:
                self._equilibrium(frame, increment)

    # Bodies.

    def _stiffnesses(self) -> tuple[Array, Array]:
        """Largest entries of K of bodies, of one element and of all that meet at a node [B]."""
        alone, whole = np.zeros(self.elements.bodies), np.zeros(self.elements.bodies)
        at_nodes = np.zeros(self.elements.nodes)
        for block in self.elements.blocks:
            np.maximum.at(alone, self.elements.body[block.elements], block.diagonal.max(axis=1))
            np.add.at(at_nodes, block.nodes, block.diagonal)
        inside = self.elements.of_node >= 0
        np.maximum.at(whole, self.elements.of_node[inside], at_nodes[inside])
        return alone, whole

    def _whole_bodies(self) -> Flags:
        """Bodies all of whose nodes are constrained, as those of rigid bodies are [B]."""
        has_free = np.zeros(self.elements.bodies, np.bool_)
        inside = self.elements.of_node >= 0
        np.logical_or.at(has_free, self.elements.of_node[inside], ~self.constrained[inside])
        return ~has_free

    def _weighted_bodies(self) -> Flags:
        """Bodies with rigid parts that have more mass than their elements: that of point elements [B]."""
        stored = self.result.read("model/bodies/mass")
        more = stored - self.elements.mass() > ENERGY * stored.max(initial=0.0)
        return self.increments.has_rigid_parts & more

    def _partly_rigid_bodies(self) -> Flags:
        """Bodies of elements that deform and of others that move with a rigid body [B].

        V of the nodes between them leaves the rigid motion by second order in dt.
        """
        partly = np.zeros(self.elements.bodies, np.bool_)
        if "rigid" not in self.result.file["history"]:
            return partly
        for block in self.elements.blocks:
            moved = block.elements[self.constrained[block.nodes].all(axis=1)]
            partly[self.elements.body[moved]] = True
        return partly & ~self.rigid

    def _rigid_elements(self, frame: Frame) -> Flags:
        """Elements of rigid bodies [E]: without any strain and stress, between nodes that are not free."""
        rigid = np.zeros(self.elements.count, np.bool_)
        if self.has_rigid:
            for block in self.elements.blocks:
                rigid[block.elements] = self.constrained[block.nodes].all(axis=1)
            rigid &= ~frame["S"].any(axis=1) & ~frame["E"].any(axis=1)
        return rigid

    def _sum(self, values: Array) -> Array:
        """Sums of nodal values over the bodies."""
        inside = self.elements.of_node >= 0
        total = np.zeros((self.elements.bodies, *values.shape[1:]))
        np.add.at(total, self.elements.of_node[inside], values[inside])
        return total

    # Energies and momenta.

    def _strain_energies(self, frame: Frame, row: int) -> None:
        """Strain energies of the bodies, of all of them and each."""
        history, u, check = self.result.history, frame["U"], self.checks["strain energy"]
        told = ~self.rigid & ~self.untold
        way = np.abs(u).max()
        noise = EPS * self.stiffness * way * np.maximum(way, self.reach) / self.largest
        energy = self.elements.strain_energy(u)
        error = np.abs(energy - history.bodies["strain"][row])[told] / self.largest
        check.add(error, ENERGY + noise[told], f"body {{}}, t = {frame.time:g}")
        if told.all() and "connectors" not in self.result.file["history"]:
            total = abs(energy.sum() - history.energy["strain"][row]) / self.largest
            check.add(total, ENERGY + noise.sum(), f"t = {frame.time:g}")
        elif self.rigid.any():
            check.skip("bodies that move as a whole are left out")

    def _motion(self, frame: Frame, row: int) -> None:
        """Kinetic energies and momenta of the bodies, of all of them and each."""
        if self.increments.is_redistributed:
            for name in ("kinetic energy", "momenta", "equilibrium"):
                self.checks[name].skip("the mass of the contact surfaces is redistributed")
            return
        history, v, x = self.result.history, frame["V"], frame.positions
        place = f"body {{}}, t = {frame.time:g}"
        elastic = ~self.rigid & ~self.weighted & ~self.partly_rigid
        p = self.elements.momentum(v)
        kinetic = self._sum(0.5 * np.einsum("ni,ni->n", v, p))
        error = np.abs(kinetic - history.bodies["kinetic"][row])[elastic] / self.largest
        self.checks["kinetic energy"].add(error, ENERGY, place)
        mass = self.elements.momentum(np.ones_like(v))[:, 0]
        body_mass, keeps = self._sum(mass), self.elements.keeps
        check = self.checks["momenta"]
        size = float(np.sqrt(2.0 * body_mass * np.maximum(history.bodies["kinetic"], 0.0)).sum(axis=1).max(initial=0.0))
        if size > 0.0:
            stored = body_mass[:, None] * history.bodies["velocity"][row]
            error = np.abs(self._sum(p) * keeps - stored).max(axis=1)[elastic] / size
            check.add(error, ENERGY, place)
        extent = np.abs(x[self.result.in_cells]).max(initial=0.0)
        centre = self._sum(mass[:, None] * x) / body_mass[:, None] * keeps
        error = np.abs(centre - history.bodies["center"][row]).max(axis=1)[elastic] / extent
        check.add(error, ENERGY, "centre of " + place)
        if self.rigid.any():
            check.skip("bodies that move as a whole are left out")
        if self.partly_rigid.any():
            for name in ("kinetic energy", "momenta"):
                self.checks[name].skip("bodies with rigid parts are left out")
        groups = self.result.file["history"]
        turns = "rigid" in groups and any("kinetic" in each for each in history.rigid.values())
        if not elastic.all() or turns:
            return
        total = abs(kinetic.sum() - history.energy["kinetic"][row]) / self.largest
        self.checks["kinetic energy"].add(total, ENERGY, f"t = {frame.time:g}")
        if size > 0.0:
            linear = np.abs(p.sum(axis=0) * keeps - history.momentum["linear"][row]).max()
            check.add(linear / size, ENERGY, f"t = {frame.time:g}")
            angular = float((x[:, 0] * p[:, 1] - x[:, 1] * p[:, 0]).sum() * keeps[0])
            error = abs(angular - history.momentum["angular"][row])
            check.add(error / (size * extent), ENERGY, f"angular, t = {frame.time:g}")

    # Stresses and strains.

    def _noise(self, frame: Frame) -> Array:
        """Round-off of the strains of the elements [E]."""
        gradient = np.zeros(self.elements.count)
        reach = np.full(self.elements.count, self._way(frame))
        for block in self.elements.blocks:
            gradient[block.elements] = np.abs(block.gradient).max(axis=(1, 2, 3))
            # the nodes of rigid parts are placed by their arms
            placed = block.elements[self.constrained[block.nodes].all(axis=1)]
            reach[placed] += np.abs(self.result.coordinates).max()
        return 16 * EPS * gradient * reach

    def _way(self, frame: Frame) -> float:
        """The largest displacement whose round-off counts."""
        return float(max(np.abs(frame["U"]).max(), self.reach.max(initial=0.0)))

    def _stresses(self, frame: Frame) -> None:
        """Stresses and strains in the plane."""
        stress, strain = self.elements.stresses(frame["U"])
        moduli = np.zeros(self.elements.count)
        for block in self.elements.blocks:
            moduli[block.elements] = block.lame + 2.0 * block.shear
        noise = self._noise(frame)
        elastic = ~self.rigid[self.elements.body]
        told = elastic & ~self.elements.is_untold
        for found, name, factor, of in (
            (stress, "S", moduli, told),
            (strain, "E", np.ones_like(moduli), elastic),
        ):
            check = self.checks["stresses" if name == "S" else "strains"]
            size = float(np.abs(found[of]).max(initial=0.0))
            check.scale = max(check.scale, size)
            error = np.abs(found - frame[name]).max(axis=1)[of]
            place = f"{name} of element {{}}, t = {frame.time:g}"
            check.add(error, (STRESS * size + factor * noise)[of], place)

    def _strains(self, frame: Frame) -> None:
        """Strains around the axis."""
        if "E33" not in self.result.frames.fields:
            return
        noise = 64 * EPS * self._way(frame)
        for block in self.elements.blocks:
            if isinstance(block, RingBlock):
                found = block.mean_around(frame["U"])
                error = np.abs(found - frame["E33"][block.elements])
                bound = STRESS * np.abs(found).max(initial=0.0) + noise * block.around.max()
                self.checks["strains"].add(error, bound, f"E33 of element {{}}, t = {frame.time:g}")

    # Equilibrium.

    def _equilibrium(self, frame: Frame, increment: Increment) -> None:
        """Unbalanced forces of free nodes, eq. (4.5) or (12.1)."""
        check = self.checks["equilibrium"]
        if self.increments.is_redistributed:
            return
        u1, a, v1 = frame["U"], frame["A"], frame["V"]
        force = frame["CONTACT_FORCE"]
        start, dt = increment.start, increment.dt
        if increment.scheme == STATIC:
            internal = self.elements.forces(STATIC, u1, u1, u1, dt)
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
        told = self.increments.start_is_told(frame, increment)
        if not told[self.increments.impelled].all():
            check.skip("bodies with rigid parts are left out between frames far apart")
        for block in self.elements.blocks:
            unknown = ~told[block.nodes].all(axis=1)
            told[block.nodes[unknown]] = False
        told[self.constrained] = told[self.loaded] = False
        told[np.isin(self.elements.of_node, np.flatnonzero(self.untold))] = False
        if increment.scheme != STATIC and len(self.elements.heated):
            # forces are those of a temperature between that of the frame and one that is not in the file
            check.skip("heated elements are left out but in static steps")
            told[self.elements.heated] = False
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
        noise = 32 * EPS * self.diagonal * self.reach
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
        row, step = increment.row, self.increments.step
        is_end = row + 1 == len(step) or step[row + 1] != step[row]
        if increment.step == 0 or is_end or increment.scheme not in (STATIC, EULER):
            return fade
        supported = self.increments.supported
        free = (frame["RF"][supported] == 0.0) & (residual[supported] != 0.0)
        if free.any():
            fade[supported[free.any(axis=1)]] = True
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
