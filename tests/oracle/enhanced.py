"""Elements with enhanced strains (CPE4I, CPS4I): energies, stresses and forces from displacements, eqs (2.26) to (2.30)."""

from collections.abc import Callable
from functools import cached_property

import numpy as np

from oracle.block import LAST_STEP, PATH, PATH_WEIGHTS, REST, SAINT_VENANT_KIRCHHOFF, Block
from oracle.shapes import CORNERS
from oracle.tensors import EPS
from stickslip.arrays import Array

PATTERN = np.array([1.0, -1.0, 1.0, -1.0])
"""Hourglass pattern of the nodes."""

MOST_STEPS = 60
"""Steps of Newton's method for alpha, and halvings of one."""

DIFFERENCE = 1e-6
"""Change of alpha by which the derivative of a stress is told."""


def patterns(weight: Array, gradient: Array) -> tuple[Array, Array, Array]:
    """gamma [E, 4], grad h [E, G, 2] and M [E, G, 4, 2, 2] of quadrilaterals."""
    part = weight / weight.sum(axis=1)[:, None]
    center = np.einsum("eg,egai->eai", part, gradient)
    slope = np.einsum("a,egai->egi", PATTERN, gradient)
    away = gradient - center[:, None]
    gamma = np.einsum("egai,egi->ea", away, slope) / (slope**2).sum(axis=(1, 2))[:, None]
    inverse = np.einsum("ai,eaj->eij", CORNERS, center)
    shapes = np.zeros((4, 4, 2, 2))
    shapes[:, 0, 0, 0] = shapes[:, 2, 0, 1] = shapes[:, 2, 1, 0] = CORNERS[:, 0]
    shapes[:, 1, 1, 1] = shapes[:, 3, 0, 1] = shapes[:, 3, 1, 0] = CORNERS[:, 1]
    strains = np.einsum("eik,gmij,ejl,eg->egmkl", inverse, shapes, inverse, 1.0 / part)
    size = np.sqrt(np.einsum("eg,egmij->em", part, strains**2))
    return gamma, slope, strains / size[:, None, :, None, None]


class Beside:
    """Strains beside the mean of each element, in the measure in which the energy of its law is convex, eq. (2.28)."""

    def __init__(self, strain: Array, part: Array, law: int) -> None:
        self.part = part
        self.mean = self._mean_of(strain)
        one = np.eye(strain.shape[-1])
        self.inverse = np.zeros_like(self.mean)
        """Cbar^-1, or 0 in the measure of Green and Lagrange."""
        if law != SAINT_VENANT_KIRCHHOFF:
            self.inverse = np.linalg.inv(one + 2.0 * self.mean)

    def _mean_of(self, strain: Array) -> Array:
        return np.einsum("eg,egij->eij", self.part, strain)[:, None]

    def strain(self, linear: Array) -> Array:
        """E_g of E + M alpha."""
        a, q, w = self._beside(linear)
        return linear + a @ w @ q

    def on_modes(self, linear: Array, stress: Array) -> Array:
        """T = W S W^T, which does work on E + M alpha."""
        _, _, w = self._beside(linear)
        return w @ stress @ w.swapaxes(2, 3)

    def on_displacements(self, linear: Array, stress: Array) -> Array:
        """T less the mean of R = T - S + 2 Q T Q^T, which does work on E."""
        _, q, _ = self._beside(linear)
        t = self.on_modes(linear, stress)
        return t - self._mean_of(t - stress + 2.0 * q @ t @ q.swapaxes(2, 3))

    def _beside(self, linear: Array) -> tuple[Array, Array, Array]:
        """A, Q = Cbar^-1 A and W = (1 - Q)^-1."""
        a = linear - self.mean
        q = self.inverse @ a
        return a, q, np.linalg.inv(np.eye(a.shape[-1]) - q)


class EnhancedBlock(Block):
    """Elements whose stored energy is least in four strains of their own."""

    def beside(self, e: Array, law: int) -> Beside:
        """The measure of a law at strains of the displacements."""
        return Beside(e, self.weight / self.weight.sum(axis=1, keepdims=True), law)

    @cached_property
    def modes(self) -> tuple[Array, Array, Array]:
        """gamma [E, 4], grad h [E, G, 2] and M [E, G, 4, 2, 2]."""
        return patterns(self.weight, self.gradient)

    def compatible(self, u: Array) -> Array:
        """Strains of the displacements, eq. (2.27)."""
        gamma, slope, _ = self.modes
        q = np.einsum("ea,eai->ei", gamma, u[self.nodes])
        half = 0.5 * (q**2).sum(axis=1)[:, None, None, None]
        return self.strain(self.displacement_gradient(u)) - half * np.einsum("egi,egj->egij", slope, slope)

    def own(self, e: Array, stress: Callable[[Array], Array], law: int) -> Array:
        """E + M alpha, so that the stress does no work on the element's own strains, eq. (2.28)."""
        _, _, modes = self.modes
        beside = self.beside(e, law)
        alpha = np.zeros((len(e), 4))

        def slope(alpha: Array) -> Array:
            linear = e + np.einsum("em,egmij->egij", alpha, modes)
            s = beside.on_modes(linear, stress(beside.strain(linear)))
            return np.einsum("eg,egmij,egij->em", self.weight, modes, s)

        found = slope(alpha)
        for _ in range(MOST_STEPS):
            columns = [
                slope(alpha + step) - slope(alpha - step) for step in DIFFERENCE * np.eye(4)
            ]
            stiffness = np.stack(columns, axis=2) / (2.0 * DIFFERENCE)
            step = -np.linalg.solve(stiffness, found[..., None])[..., 0]
            for _ in range(MOST_STEPS):
                following = slope(alpha + step)
                bad = ~np.isfinite(following).all(axis=1)
                if not bad.any():
                    break
                step[bad] *= 0.5
            alpha, found = alpha + step, following
            if (np.abs(step).max(axis=1) <= LAST_STEP * np.abs(e).max(axis=(1, 2, 3)) + EPS**2).all():
                break
        return e + np.einsum("em,egmij->egij", alpha, modes)

    def least(self, e: Array) -> Array:
        """Strains of the material at those of the displacements."""
        return self.beside(e, self.law).strain(self.own(e, self.stress, self.law))

    def conjugate(self, e: Array) -> Array:
        """The stress that does work on the strains of the displacements, at these."""
        beside, linear = self.beside(e, self.law), self.own(e, self.stress, self.law)
        return beside.on_displacements(linear, self.stress(beside.strain(linear)))

    def energy(self, u: Array) -> Array:
        """Strain energy of each element."""
        return (self.weight * self.energy_density(self.least(self.compatible(u)))).sum(axis=1)

    def stress_of(self, u: Array) -> Array:
        """S of the material at the displacements."""
        return self.stress(self.least(self.compatible(u)))

    def thickness_strain(self, u: Array) -> Array:
        """The strains that the thickness follows."""
        return self.least(self.compatible(u))

    def condensed_gradient(self, u0: Array, u1: Array) -> Array:
        """S_m of eq. (2.29); Phi(E1) - Phi(E0) is the integral of S along a way."""
        c0, c1 = self.compatible(u0), self.compatible(u1)
        middle = 0.5 * (c0 + c1)
        e0, e1 = self.least(c0), self.least(c1)
        of_material, stress = self.stress(self.least(middle)), self.conjugate(middle)
        change, own = c1 - c0, e1 - e0
        f = np.einsum("eg,egij,egij->e", self.weight, of_material - stress, change)
        f -= np.einsum("eg,egij,egij->e", self.weight, of_material, change - own)
        for place, weight in zip(PATH, PATH_WEIGHTS):
            off = self.stress(0.5 * (e0 + e1) + 0.5 * place * own) - of_material
            f += 0.5 * weight * np.einsum("eg,egij,egij->e", self.weight, off, own)
        square, size = (np.einsum("eg,egij,egij->e", self.weight, c, c) for c in (change, c1))
        ratio = np.divide(f, square, out=np.zeros_like(f), where=square > REST**2 * size)
        return stress + ratio[:, None, None, None] * change

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        if halfway:
            self._add_at(total, self.condensed_gradient(u0, u1), 0.5 * (u0 + u1))
        else:
            self._add_at(total, self.conjugate(self.compatible(u1)), u1)

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        if dt != 0.0 and self.beta != 0.0:
            c0, c1 = self.compatible(u0), self.compatible(u1)
            end = self.own(c1, lambda e: self.viscous(c0, e, dt), SAINT_VENANT_KIRCHHOFF)
            self._add_at(total, self.viscous(c0, end, dt), 0.5 * (u0 + u1))
        if dt != 0.0 and self.alpha != 0.0:
            self.add_mass(total, (self.alpha / dt) * (u1 - u0))

    def _add_at(self, total: Array, stress: Array, u: Array) -> None:
        """Adds the forces of a stress S at the displacements u: F S grad N - (grad h . S grad h) gamma q."""
        self._add(total, stress, self.displacement_gradient(u))
        gamma, slope, _ = self.modes
        q = np.einsum("ea,eai->ei", gamma, u[self.nodes])
        along = np.einsum("eg,egi,egij,egj->e", self.weight, slope, stress, slope)
        np.add.at(total, self.nodes, -np.einsum("e,ea,ei->eai", along, gamma, q))
