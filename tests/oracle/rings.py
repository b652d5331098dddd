"""Elements of bodies of revolution (CAX): energies, stresses and forces from displacements, eqs (2.31) to (2.36).

A strain is E in the section [E, G, 2, 2] and z = 2 E_33 around the axis [E, G].
"""

import numpy as np

from oracle.block import NEO_HOOKE, PATH, PATH_WEIGHTS, POLYNOMIAL, SAINT_VENANT_KIRCHHOFF, Block
from oracle.tensors import cofactor_of, determinant_of, identity_times, mean_of, trace_of
from stickslip.arrays import Array

Strain = tuple[Array, Array]


class RingBlock(Block):
    """Elements that go around the axis x = 0."""

    around: Array
    """N_a/R at the points [E, G, k]."""

    @property
    def is_polynomial(self) -> bool:
        """Whether the law is one of eq. (2.23)."""
        return self.law in (NEO_HOOKE, POLYNOMIAL)

    def stretch(self, u: Array) -> Array:
        """h = u_r/R [E, G]."""
        return np.einsum("ea,ega->eg", u[self.nodes][..., 0], self.around)

    def strains(self, u: Array) -> Strain:
        """E and 2 E_33 = 2 h + h^2, eq. (2.31)."""
        h = self.stretch(u)
        return self.strain(self.displacement_gradient(u)), h * (2.0 + h)

    def own_strain(self, strain: Strain) -> tuple[Strain, Array]:
        """E_m of eq. (2.53) and theta."""
        e, z = strain
        own, theta = self.mechanical(e)
        return (own, (z - self.doubled_heat) / theta**2), theta

    def density_of(self, strain: Strain) -> Array:
        """W = theta^3 W_m, eq. (2.54), with eqs (2.13) and (2.23)."""
        (e, z), theta = self.own_strain(strain)
        return theta**3 * self._density(e, z)

    def _density(self, e: Array, z: Array) -> Array:
        if not self.is_polynomial:
            trace = trace_of(e) + 0.5 * z
            squares = np.einsum("egij,egij->eg", e, e) + 0.25 * z**2
            return 0.5 * self.lame * trace**2 + self.shear * squares
        _, _, x, y, grown = self.invariants(e, z)
        c10, c20, c30, c01 = self.shape
        volume = sum(k * grown ** (2 * i) for i, k in enumerate(self.stiffnesses, 1))
        return c10 * x + c20 * x**2 + c30 * x**3 + c01 * y + volume

    def stress_at(self, strain: Strain) -> Strain:
        """S = theta S_m in the section and S_33, eq. (2.54)."""
        (e, z), theta = self.own_strain(strain)
        in_plane, around = self._stress(e, z)
        return theta[..., None, None] * in_plane, theta * around

    def _stress(self, e: Array, z: Array) -> Strain:
        if self.is_polynomial:
            in_plane, around = self.polynomial_stress(e, z)
            return in_plane, around
        trace = self.lame * (trace_of(e) + 0.5 * z)
        return identity_times(trace) + 2.0 * self.shear * e, trace + self.shear * z

    def mean_stress(self, start: Strain, end: Strain) -> Strain:
        """S_m of eq. (4.8) with all components."""
        (e0, z0), (e1, z1) = start, end
        middle = 0.5 * (e0 + e1), 0.5 * (z0 + z1)
        change = e1 - e0, z1 - z0
        stress = self.stress_at(middle)
        if self.law == SAINT_VENANT_KIRCHHOFF:
            return stress
        f = np.zeros_like(z0)
        for place, weight in zip(PATH, PATH_WEIGHTS):
            at = middle[0] + 0.5 * place * change[0], middle[1] + 0.5 * place * change[1]
            off, around = self.stress_at(at)
            f += 0.5 * weight * work_of((off - stress[0], around - stress[1]), change)
        square = np.einsum("egij,egij->eg", change[0], change[0]) + 0.25 * change[1] ** 2
        ratio = np.divide(f, square, out=np.zeros_like(f), where=square > 0.0)
        return stress[0] + ratio[..., None, None] * change[0], stress[1] + 0.5 * ratio * change[1]

    def viscous_stress(self, start: Strain, end: Strain, dt: float) -> Strain:
        """S_d of eq. (4.17) with G of eq. (2.36)."""
        (e0, z0), (e1, z1) = start, end
        ones = np.ones_like(z0)
        c, around = identity_times(ones) + e0 + e1, 1.0 + 0.5 * (z0 + z1)
        change, along = e1 - e0, 0.5 * (z1 - z0)
        j0, j1 = (np.sqrt(determinant_of(identity_times(ones) + 2.0 * e) * (1.0 + z)) for e, z in (start, end))
        over = 2.0 / (j0 + j1)
        g = cofactor_of(c) * around[..., None, None] + cofactor_of(change) * (along / 3.0)[..., None, None]
        g, hoop = g * over[..., None, None], (determinant_of(c) + determinant_of(change) / 3.0) * over
        wide = self.lame * (np.einsum("egij,egij->eg", g, change) + hoop * along)
        factor = self.beta / dt * over
        return (
            factor[..., None, None] * (2.0 * self.shear * (g @ change @ g) + wide[..., None, None] * g),
            factor * (2.0 * self.shear * hoop * along * hoop + wide * hoop),
        )

    def energy(self, u: Array) -> Array:
        """Strain energy of each element."""
        return (self.weight * self.density_of(self.strains(u))).sum(axis=1)

    def means(self, u: Array) -> tuple[Array, Array]:
        """Cauchy stress and Green-Lagrange strain of the elements [E, 3] as xx yy xy."""
        strain = self.strains(u)
        f = identity_times(np.ones_like(strain[1])) + self.displacement_gradient(u)
        j = determinant_of(f) * (1.0 + self.stretch(u))
        cauchy = f @ self.stress_at(strain)[0] @ f.swapaxes(2, 3) / j[..., None, None]
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        return mean_of(part, cauchy), mean_of(part, strain[0])

    def mean_around(self, u: Array) -> Array:
        """Mean of E_33 over the elements [E]."""
        return (self.weight * 0.5 * self.strains(u)[1]).sum(axis=1) / self.weight.sum(axis=1)

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (2.33); `halfway`: the energy-momentum form, else that of u1."""
        if halfway:
            stress = self.mean_stress(self.strains(u0), self.strains(u1))
            self._add_at(total, stress, 0.5 * (u0 + u1))
        else:
            self._add_at(total, self.stress_at(self.strains(u1)), u1)

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        if dt != 0.0 and self.beta != 0.0:
            stress = self.viscous_stress(self.strains(u0), self.strains(u1), dt)
            self._add_at(total, stress, 0.5 * (u0 + u1))
        if dt != 0.0 and self.alpha != 0.0:
            self.add_mass(total, (self.alpha / dt) * (u1 - u0))

    def _add_at(self, total: Array, stress: Strain, u: Array) -> None:
        """Adds the forces of a stress at the displacements u, eq. (2.33)."""
        self._add(total, stress[0], self.displacement_gradient(u))
        ring = self.weight * (1.0 + self.stretch(u)) * stress[1]
        each = np.einsum("eg,ega->ea", ring, self.around)
        np.add.at(total, self.nodes, np.stack([each, np.zeros_like(each)], axis=2))


def work_of(stress: Strain, change: Strain) -> Array:
    """S:dE with all components, change of z being twice that of E_33."""
    return np.einsum("egij,egij->eg", stress[0], change[0]) + 0.5 * stress[1] * change[1]
