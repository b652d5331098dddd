"""Elements with all components of the strain and a formulation of their own: a pressure of the element (CAX4H, CPE8H, CPE8RH,
CAX8H, CAX8RH), enhanced strains (CAX4I), hourglass modes (CAX4R), eqs (2.44) to (2.46)."""

from functools import cached_property

import numpy as np

from oracle.block import LAST_STEP, PATH, PATH_WEIGHTS, REST, SAINT_VENANT_KIRCHHOFF
from oracle.enhanced import DIFFERENCE, MOST_STEPS, PATTERN, Beside
from oracle.rings import RingBlock, Strain, work_of
from oracle.shapes import CORNERS
from oracle.tensors import EPS, cofactor_of, determinant_of, identity_times, mean_of, trace_of
from stickslip.arrays import Array


def _plus(a: Strain, b: Strain, factor: float = 1.0) -> Strain:
    return a[0] + factor * b[0], a[1] + factor * b[1]


def _times(a: Strain, factor: float) -> Strain:
    return factor * a[0], factor * a[1]


def _whole(section: Array, around: Array) -> Array:
    """Tensors [E, G, 3, 3] of those of the section and the component 33."""
    whole = np.zeros((*around.shape, 3, 3))
    whole[..., :2, :2], whole[..., 2, 2] = section, around
    return whole


def _parts(whole: Array) -> Strain:
    """The section of tensors [E, G, 3, 3] and their component 33."""
    return whole[..., :2, :2], whole[..., 2, 2]


def _strain(whole: Array) -> Strain:
    """The same of strains, of which 2 E_33 is kept."""
    section, around = _parts(whole)
    return section, 2.0 * around


class CondensedBlock(RingBlock):
    """Elements whose stress is the discrete gradient of a potential of all their points, eq. (2.29)."""

    def compatible(self, u: Array) -> Strain:
        """Strains of the displacements."""
        return self.strains(u)

    def of_material(self, strain: Strain) -> Strain:
        """Strains that the material has."""
        raise NotImplementedError

    def energy(self, u: Array) -> Array:
        """Strain energy of each element."""
        return (self.weight * self.density_of(self.of_material(self.compatible(u)))).sum(axis=1)

    def conjugate(self, strain: Strain) -> Strain:
        """S that does work on the strains of the displacements, at these."""
        raise NotImplementedError

    def stress_of(self, u: Array) -> Strain:
        """S of the output at the displacements."""
        return self.conjugate(self.compatible(u))

    def _sum(self, stress: Strain, change: Strain) -> Array:
        return (self.weight * work_of(stress, change)).sum(axis=1)

    def _square(self, strain: Strain) -> Array:
        """sum v E:E."""
        return (self.weight * (np.einsum("egij,egij->eg", strain[0], strain[0]) + 0.25 * strain[1] ** 2)).sum(axis=1)

    def doing(self, stress: Strain, change: Strain, work: Array, least: Array | float = 0.0) -> Strain:
        """S + f/(sum v dE:dE) dE where the sum is more than the least that is no round-off."""
        square = self._square(change)
        f = work - self._sum(stress, change)
        ratio = np.divide(f, square, out=np.zeros_like(f), where=square > least)[:, None]
        return stress[0] + ratio[..., None, None] * change[0], stress[1] + 0.5 * ratio * change[1]

    def means(self, u: Array) -> tuple[Array, Array]:
        """Cauchy stress and Green-Lagrange strain of the elements [E, 3] as xx yy xy."""
        strain, stretch = self.strains(u), self.stretch(u)
        f = identity_times(np.ones_like(strain[1])) + self.displacement_gradient(u)
        j = determinant_of(f) * (1.0 + stretch)
        cauchy = f @ self.stress_of(u)[0] @ f.swapaxes(2, 3) / j[..., None, None]
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        return mean_of(part, cauchy), mean_of(part, strain[0])

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        if not halfway:
            self._add_at(total, self.conjugate(self.compatible(u1)), u1)
            return
        c0, c1 = self.compatible(u0), self.compatible(u1)
        middle = _times(_plus(c0, c1), 0.5)
        e0, e1 = self.of_material(c0), self.of_material(c1)
        own = _plus(e1, e0, -1.0)
        work = np.zeros(len(self.elements))
        for place, weight in zip(PATH, PATH_WEIGHTS):
            at = _plus(_times(_plus(e0, e1), 0.5), own, 0.5 * place)
            work += 0.5 * weight * self._sum(self.stress_at(at), own)
        stress = self.doing(self.conjugate(middle), _plus(c1, c0, -1.0), work, REST**2 * self._square(c1))
        self._add_at(total, stress, 0.5 * (u0 + u1))

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        if dt != 0.0 and self.beta != 0.0:
            c0, c1 = self.compatible(u0), self.compatible(u1)
            self._add_at(total, self.viscous_of(c0, c1, dt), 0.5 * (u0 + u1))
        if dt != 0.0 and self.alpha != 0.0:
            self.add_mass(total, (self.alpha / dt) * (u1 - u0))

    def viscous_of(self, c0: Strain, c1: Strain, dt: float) -> Strain:
        """Viscous stress on the strains of the displacements."""
        raise NotImplementedError


class PressureBlock(CondensedBlock):
    """Elements with the volume ratio of eq. (2.45), whose stress between two displacements is that of eq. (2.11)."""

    functions: int
    """Number of functions of the volume ratio: 1 or 3."""
    place: Array
    """Places of the points [E, G, 2]."""

    @cached_property
    def psi(self) -> Array:
        """Orthonormal functions at the points [E, G, k]."""
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        arm = self.place - np.einsum("eg,egi->ei", part, self.place)[:, None]
        arm = np.concatenate([np.ones((*arm.shape[:2], 1)), arm], axis=2)[..., : self.functions]
        root = np.sqrt(self.weight)[..., None]
        return np.linalg.qr(root * arm)[0] / root

    def project(self, values: Array) -> Array:
        """sum psi_k int psi_k f."""
        return np.einsum("egk,ek->eg", self.psi, np.einsum("eg,egk,eg->ek", self.weight, self.psi, values))

    def volumes(self, strain: Strain) -> tuple[Array, Array]:
        """J - 1 and theta - 1."""
        e, z = strain
        q = 2.0 * trace_of(e) + 4.0 * determinant_of(e)
        own = np.expm1(0.5 * (np.log1p(q) + np.log1p(z)))
        return own, self.project(own)

    def of_material(self, strain: Strain) -> Strain:
        """Ebar of eq. (2.45)."""
        (own, whole), (e, z) = self.volumes(strain), strain
        excess = np.expm1(2.0 / 3.0 * np.log1p((whole - own) / (1.0 + own)))
        half = identity_times(np.full_like(z, 0.5)) + e
        return e + excess[..., None, None] * half, z + excess * (1.0 + z)

    def conjugate(self, strain: Strain) -> Strain:
        """S of eq. (2.11) at one strain, K being J C^-1."""
        own, _ = self.volumes(strain)
        c = identity_times(np.ones_like(own)) + 2.0 * strain[0]
        k = cofactor_of(c) * ((1.0 + own) / determinant_of(c))[..., None, None], (1.0 + own) / (1.0 + strain[1])
        return self._effective((strain, strain), k, self.stress_at(self.of_material(strain)))

    def between(self, u0: Array, u1: Array, stress: Strain) -> Strain:
        """S of eq. (2.11) between two displacements with K of eq. (2.46), from that of the material."""
        halfway = 0.5 * (u0 + u1)
        section = [
            determinant_of(identity_times(np.ones(self.weight.shape)) + self.displacement_gradient(u))
            for u in (u0, halfway, u1)
        ]
        f = identity_times(np.ones(self.weight.shape)) + self.displacement_gradient(halfway)
        around = 1.0 + self.stretch(halfway)
        k = cofactor_of(f.swapaxes(2, 3) @ f) * (around / section[1])[..., None, None]
        both = self.strains(u0), self.strains(u1)
        return self._effective(both, (k, 0.5 * (section[0] + section[2]) / around), stress)

    def _effective(self, both: tuple[Strain, Strain], k: Strain, stress: Strain) -> Strain:
        """r_m S + (A - a theta_m) K."""
        j, theta = ([1.0 + grown for grown in ends] for ends in zip(*(self.volumes(strain) for strain in both)))
        root = [np.cbrt(t / own) for own, t in zip(j, theta)]
        slope = (root[0] + root[1]) / (root[0] ** 2 + root[0] * root[1] + root[1] ** 2)
        e, z = _plus(*both)
        of_c = np.einsum("egij,egij->eg", stress[0], identity_times(np.full_like(z, 0.5)) + 0.5 * e)
        a = slope * (of_c + stress[1] * (0.5 + 0.25 * z)) / (j[0] * j[1])
        pressure = self.project(a * 0.5 * (j[0] + j[1])) - a * 0.5 * (theta[0] + theta[1])
        ratio = 0.5 * (root[0] ** 2 + root[1] ** 2)
        return (
            ratio[..., None, None] * stress[0] + pressure[..., None, None] * k[0],
            ratio * stress[1] + pressure * k[1],
        )

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        if not halfway:
            super().add_forces(total, u0, u1, halfway)
            return
        e0, e1 = (self.of_material(self.strains(u)) for u in (u0, u1))
        self._add_at(total, self.between(u0, u1, self.mean_stress(e0, e1)), 0.5 * (u0 + u1))

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        if dt != 0.0 and self.beta != 0.0:
            e0, e1 = (self.of_material(self.strains(u)) for u in (u0, u1))
            self._add_at(total, self.between(u0, u1, self.viscous_stress(e0, e1, dt)), 0.5 * (u0 + u1))
        if dt != 0.0 and self.alpha != 0.0:
            self.add_mass(total, (self.alpha / dt) * (u1 - u0))


class Patterns:
    """gamma [E, 4], grad h [E, G, 2] and M [E, G, 5] as (section, 2*33) of rings with quadrilaterals."""

    def __init__(self, weight: Array, area: Array, gradient: Array) -> None:
        part = area / area.sum(axis=1)[:, None]
        center = np.einsum("eg,egai->eai", part, gradient)
        self.slope = np.einsum("a,egai->egi", PATTERN, gradient)
        away = gradient - center[:, None]
        squares = (self.slope**2).sum(axis=(1, 2))[:, None]
        self.gamma = np.einsum("egai,egi->ea", away, self.slope) / squares
        inverse = np.einsum("ai,eaj->eij", CORNERS, center)
        r, s = CORNERS.T
        shapes = np.zeros((4, 5, 2, 2))
        shapes[:, 0, 0, 0] = shapes[:, 2, 0, 1] = shapes[:, 2, 1, 0] = r
        shapes[:, 1, 1, 1] = shapes[:, 3, 0, 1] = shapes[:, 3, 1, 0] = s
        share = weight / weight.sum(axis=1)[:, None]
        section = np.einsum("eik,gmij,ejl,eg->egmkl", inverse, shapes, inverse, 1.0 / share)
        around = np.zeros(section.shape[:3])
        around[..., 4] = 2.0 * r * s / share
        size = np.einsum("eg,egmij->em", share, section**2) + 0.25 * np.einsum("eg,egm->em", share, around**2)
        size = np.sqrt(size)[:, None]
        self.section, self.around = section / size[..., None, None], around / size

    def q(self, own: Array) -> Array:
        """q of displacements [E, 4, 2] of the nodes."""
        return np.einsum("ea,eai->ei", self.gamma, own)


class EnhancedRingBlock(CondensedBlock):
    """Elements whose stored energy is least in five strains of their own."""

    area: Array
    """Areas of the points [E, G]."""

    @cached_property
    def patterns(self) -> Patterns:
        """Those of the elements."""
        return Patterns(self.weight, self.area, self.gradient)

    def compatible(self, u: Array) -> Strain:
        """Strains of the displacements, eq. (2.27)."""
        e, z = self.strains(u)
        slope, q = self.patterns.slope, self.patterns.q(u[self.nodes])
        half = 0.5 * (q**2).sum(axis=1)[:, None, None, None]
        return e - half * np.einsum("egi,egj->egij", slope, slope), z

    def beside(self, strain: Strain, law: int) -> Beside:
        """The measure of a law at strains of the displacements."""
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        return Beside(_whole(strain[0], 0.5 * strain[1]), part, law)

    def own(self, strain: Strain, stress, law: int) -> Array:  # noqa: ANN001
        """E + M alpha, so that the stress does no work on the element's own strains, eq. (2.28)."""
        modes, beside = self.patterns, self.beside(strain, law)
        alpha = np.zeros((len(self.elements), 5))

        def at(alpha: Array) -> Array:
            section = np.einsum("em,egmij->egij", alpha, modes.section)
            around = strain[1] + np.einsum("em,egm->eg", alpha, modes.around)
            return _whole(strain[0] + section, 0.5 * around)

        def slope(alpha: Array) -> Array:
            linear = at(alpha)
            s, around = _parts(beside.on_modes(linear, _whole(*stress(_strain(beside.strain(linear))))))
            work = np.einsum("egmij,egij->egm", modes.section, s) + 0.5 * modes.around * around[..., None]
            return np.einsum("eg,egm->em", self.weight, work)

        found = slope(alpha)
        size = np.maximum(np.abs(strain[0]).max(axis=(1, 2, 3)), np.abs(strain[1]).max(axis=1))
        for _ in range(MOST_STEPS):
            columns = [slope(alpha + d) - slope(alpha - d) for d in DIFFERENCE * np.eye(5)]
            stiffness = np.stack(columns, axis=2) / (2.0 * DIFFERENCE)
            step = -np.linalg.solve(stiffness, found[..., None])[..., 0]
            for _ in range(MOST_STEPS):
                following = slope(alpha + step)
                bad = ~np.isfinite(following).all(axis=1)
                if not bad.any():
                    break
                step[bad] *= 0.5
            alpha, found = alpha + step, following
            if (np.abs(step).max(axis=1) <= LAST_STEP * size + EPS**2).all():
                break
        return at(alpha)

    def of_material(self, strain: Strain) -> Strain:
        """Strains at which the energy is least."""
        return _strain(self.beside(strain, self.law).strain(self.own(strain, self.stress_at, self.law)))

    def conjugate(self, strain: Strain) -> Strain:
        """T less the mean of R."""
        beside, linear = self.beside(strain, self.law), self.own(strain, self.stress_at, self.law)
        stress = _whole(*self.stress_at(_strain(beside.strain(linear))))
        return _parts(beside.on_displacements(linear, stress))

    def stress_of(self, u: Array) -> Strain:
        """S of the material."""
        return self.stress_at(self.of_material(self.compatible(u)))

    def viscous_of(self, c0: Strain, c1: Strain, dt: float) -> Strain:
        """Viscous stress on the strains of the displacements."""
        end = self.own(c1, lambda e: self.viscous_stress(c0, e, dt), SAINT_VENANT_KIRCHHOFF)
        return self.viscous_stress(c0, _strain(end), dt)

    def _add_at(self, total: Array, stress: Strain, u: Array) -> None:
        """As that of rings, less (grad h . S grad h) gamma q."""
        super()._add_at(total, stress, u)
        modes = self.patterns
        along = np.einsum("eg,egi,egij,egj->e", self.weight, modes.slope, stress[0], modes.slope)
        force = -np.einsum("e,ea,ei->eai", along, modes.gamma, modes.q(u[self.nodes]))
        np.add.at(total, self.nodes, force)


class ReducedRingBlock(RingBlock):
    """Elements with one point and the hourglass modes of eq. (2.44)."""

    area: Array
    """Areas of the points [E, G]."""

    def condense(self) -> None:
        """Replaces the points by one, with the hourglass stiffness that they give."""
        self.patterns = Patterns(self.weight, self.area, self.gradient)
        self.part = self.weight / self.weight.sum(axis=1, keepdims=True)
        self.of_points = self.around
        slope = self.patterns.slope
        slope = slope - np.einsum("eg,egi->ei", self.part, slope)[:, None]
        count = slope.shape[1]
        rows = np.zeros((*slope.shape[:2], 4, 2 + count))
        rows[:, :, 0, 0] = rows[:, :, 3, 1] = slope[..., 0]
        rows[:, :, 1, 1] = rows[:, :, 3, 0] = slope[..., 1]
        rows[:, np.arange(count), 2, 2 + np.arange(count)] = 1.0
        section = self.patterns.section
        own = [section[..., 0, 0], section[..., 1, 1], 0.5 * self.patterns.around, 2.0 * section[..., 0, 1]]
        columns = np.concatenate([rows, np.stack(own, axis=2)], axis=3)
        moduli = np.diag([2.0 * self.shear] * 3 + [self.shear])
        moduli[:3, :3] += self.lame
        k = np.einsum("eg,egim,ij,egjn->emn", self.weight, columns, moduli, columns)
        n = 2 + count
        self.hourglass = k[:, :n, :n] - k[:, :n, n:] @ np.linalg.solve(k[:, n:, n:], k[:, n:, :n])
        self.gradient = np.einsum("eg,egai->eai", self.part, self.gradient)[:, None]
        self.around = np.einsum("eg,ega->ea", self.part, self.around)[:, None]
        self.weight = self.weight.sum(axis=1, keepdims=True)

    def modes(self, u: Array) -> tuple[Array, Array, Array, Array]:
        """F0, q, h at the points, and y."""
        f = np.eye(2) + self.displacement_gradient(u)[:, 0]
        q = self.patterns.q(u[self.nodes])
        h = np.einsum("ea,ega->eg", u[self.nodes][..., 0], self.of_points)
        strain = h + 0.5 * h**2
        away = strain - (self.part * strain).sum(axis=1, keepdims=True)
        return f, q, h, np.concatenate([np.einsum("eij,ei->ej", f, q), away], axis=1)

    def energy(self, u: Array) -> Array:
        """Strain energy of each element."""
        y = self.modes(u)[3]
        return super().energy(u) + 0.5 * np.einsum("ei,eij,ej->e", y, self.hourglass, y / self.softening)

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        super().add_forces(total, u0, u1, halfway)
        y0, y1 = self.modes(u0)[3], self.modes(u1)[3]
        y = 0.5 * (y0 + y1) if halfway else y1
        self._add_hourglass(total, y / self.softening, 0.5 * (u0 + u1) if halfway else u1)

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        super().add_damping(total, u0, u1, dt)
        if dt != 0.0 and self.beta != 0.0:
            change = self.modes(u1)[3] - self.modes(u0)[3]
            self._add_hourglass(total, (self.beta / dt) * change, 0.5 * (u0 + u1))

    def _add_hourglass(self, total: Array, y: Array, u: Array) -> None:
        """Adds the forces of Kh y at the displacements u."""
        f, q, h, _ = self.modes(u)
        gamma = self.patterns.gamma
        stress = np.einsum("eij,ej->ei", self.hourglass, y)
        along = np.einsum("eai,ei->ea", self.gradient[:, 0], stress[:, :2])
        own = np.einsum("eij,ej->ei", f, stress[:, :2])
        force = np.einsum("ea,ei->eai", along, q) + np.einsum("ea,ei->eai", gamma, own)
        hoop = stress[:, 2:] - self.part * stress[:, 2:].sum(axis=1, keepdims=True)
        force[..., 0] += np.einsum("eg,eg,ega->ea", hoop, 1.0 + h, self.of_points)
        np.add.at(total, self.nodes, force)
