"""Elements in the displacement formulation and with mean dilatation: masses, energies, stresses and forces from displacements.

Equation numbers are those in docs/theory. Arrays of tensors at integration points have the shape
[E, G, 2, 2], E elements of one kind with G points each.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from oracle.tensors import cofactor_of, determinant_of, identity_times, mean_of, trace_of
from stickslip.arrays import Array, Integers

PATH, PATH_WEIGHTS = np.polynomial.legendre.leggauss(5)
"""Gauss points on the way from the start to the end of an increment."""

SAINT_VENANT_KIRCHHOFF, NEO_HOOKE, POLYNOMIAL = range(3)
"""Laws of /model/materials/law whose stresses follow from the displacements; the last one is that of eq. (2.23)."""

COMPLEX_STEP = 1e-170
"""Imaginary part of a stretch, by which the derivative of a stress is told; its square is zero."""

MOST_STEPS = 60
"""Steps of Newton's method for the stretch across."""

REST = 1e-5
"""A change of the strains so small beside them that what it adds to the stress of the middle is less than round-off."""

LAST_STEP = 1e-9
"""A step of Newton's method so small beside the strain leaves an error of round-off."""


@dataclass
class Block:
    """Elements of one type and material."""

    elements: Integers
    nodes: Integers
    """[E, k]"""
    gradient: Array
    """dN_a/dX_j at the points [E, G, k, 2]."""
    weight: Array
    """Reference volume of the points [E, G]."""
    mass: Array
    """Consistent mass between the nodes of an element [E, k, k], eq. (2.7)."""
    plane_stress: bool
    mean_dilatation: bool
    law: int
    young: float
    poisson: float
    density: float
    alpha: float
    beta: float
    shape: Array
    """C10, C20, C30, C01."""
    compressibility: Array
    """D1, D2, D3; zero for no term."""
    heat: Array | None = field(default=None, init=False)
    """Thermal strain e = theta - 1 at the points [E, G], eq. (2.52); none without a temperature."""
    material: int = field(default=-1, init=False)
    """Index of the material."""
    at_points: Array = field(default_factory=lambda: np.zeros(0), init=False)
    """Shape functions at the points [G, k]."""

    def temperature(self, of_nodes: Array) -> Array:
        """Temperatures at the points [E, G]: the mean of linear elements, the field between the corners of quadratic ones."""
        nodal = of_nodes[self.nodes]
        count = nodal.shape[1]
        if count <= 4:
            return np.broadcast_to(nodal.mean(axis=1, keepdims=True), self.weight.shape)
        corners = nodal[:, : count // 2]
        middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
        return np.concatenate([corners, middles], axis=1) @ self.at_points.T

    # Constants of the material.

    @property
    def shear(self) -> float:
        """mu."""
        return self.young / (2.0 * (1.0 + self.poisson))

    @property
    def bulk(self) -> float:
        """K."""
        return self.young / (3.0 * (1.0 - 2.0 * self.poisson))

    @property
    def lame(self) -> float:
        """lambda of the plane."""
        if self.plane_stress:
            return self.young * self.poisson / (1.0 - self.poisson**2)
        return self.bulk - 2.0 / 3.0 * self.shear

    @property
    def area_modulus(self) -> float:
        """kappa of eq. (4.17)."""
        if self.plane_stress:
            return self.young / (2.0 * (1.0 - self.poisson))
        return self.bulk + self.shear / 3.0

    @property
    def diagonal(self) -> Array:
        """Upper bounds of what undeformed elements add to the diagonal of K at their nodes [E, k]."""
        sizes = np.einsum("eg,egaj->ea", self.weight, self.gradient**2)
        return (self.lame + 2.0 * self.shear) * sizes

    # Kinematics.

    def displacement_gradient(self, u: Array) -> Array:
        """H = du/dX, eq. (2.1)."""
        return np.einsum("eai,egaj->egij", u[self.nodes], self.gradient)

    def strain(self, h: Array) -> Array:
        """E, eq. (2.2)."""
        turned = h.swapaxes(2, 3)
        return 0.5 * (h + turned + turned @ h)

    @property
    def softening(self) -> Array | float:
        """theta of elements with one point, which divides their hourglass stiffness."""
        return 1.0 if self.heat is None else 1.0 + self.heat[:, :1]

    @property
    def doubled_heat(self) -> Array | float:
        """2 E_theta = theta^2 - 1 of eq. (2.53) from the thermal strain, whose digits it keeps."""
        return 0.0 if self.heat is None else self.heat * (2.0 + self.heat)

    def mechanical(self, e: Array) -> tuple[Array, Array]:
        """E_m of eq. (2.53) in the plane, and theta."""
        if self.heat is None:
            return e, np.ones(e.shape[:2])
        theta = 1.0 + self.heat
        return (e - identity_times(0.5 * self.doubled_heat)) / theta[..., None, None] ** 2, theta

    def energy_density(self, e: Array) -> Array:
        """W(E) = theta^3 W_m(E_m), eq. (2.54)."""
        own, theta = self.mechanical(e)
        return theta**3 * self.density_at(own)

    def stress(self, e: Array) -> Array:
        """S(E) = theta S_m(E_m), eq. (2.54)."""
        own, theta = self.mechanical(e)
        return theta[..., None, None] * self.own_stress(own)

    def density_at(self, e: Array) -> Array:
        """W(E), eqs (2.13), (2.14) and (2.23)."""
        z = self.across(e)
        if self.law == SAINT_VENANT_KIRCHHOFF:
            around = 0.0 if self.plane_stress else 0.5 * z
            trace = trace_of(e) + around
            return 0.5 * self.lame * trace**2 + self.shear * (np.einsum("egij,egij->eg", e, e) + around**2)
        trace, determinant = trace_of(e), determinant_of(e)
        if self.is_polynomial:
            _, _, x, y, grown = self.invariants(e, z)
            c10, c20, c30, c01 = self.shape
            volume = sum(k * grown ** (2 * i) for i, k in enumerate(self.stiffnesses, 1))
            return c10 * x + c20 * x**2 + c30 * x**3 + c01 * y + volume
        t, q = 2.0 * trace, 4.0 * determinant
        b = np.expm1(np.log1p(t + q) / 3.0)
        jump = np.expm1(np.log1p(t + q) / 2.0)
        shape = (b * b * (b + 3.0) - q) / (1.0 + b)
        return 0.5 * self.shear * shape + 0.5 * self.bulk * jump**2

    def own_stress(self, e: Array) -> Array:
        """S(E), eqs (2.13), (2.15), (2.16) and (2.24)."""
        z = self.across(e)
        if self.law == SAINT_VENANT_KIRCHHOFF:
            around = 0.0 if self.plane_stress else 0.5 * z
            return self.lame * identity_times(trace_of(e) + around) + 2.0 * self.shear * e
        trace = trace_of(e)
        if self.is_polynomial:
            return self.polynomial_stress(e, z)[0]
        t, q = 2.0 * trace, 4.0 * determinant_of(e)
        square = 1.0 + t + q
        jump = np.expm1(np.log1p(t + q) / 2.0)
        shape = identity_times(2.0 * t / 3.0 + q) - 2.0 * (1.0 + t / 3.0)[..., None, None] * cofactor_of(e)
        deviator = self.shear * square ** (-1.0 / 3.0) / square
        pressure = self.bulk * jump / np.sqrt(square)
        cofactor = identity_times(np.ones_like(t)) + 2.0 * cofactor_of(e)
        return deviator[..., None, None] * shape + pressure[..., None, None] * cofactor

    # Polynomials of the invariants.

    @property
    def is_polynomial(self) -> bool:
        """Whether the law is one of eq. (2.23), as a neo-Hookean one in plane stress is, or at a temperature."""
        is_general = self.plane_stress or self.heat is not None
        return self.law == POLYNOMIAL or (self.law == NEO_HOOKE and is_general)

    @property
    def stiffnesses(self) -> list[float]:
        """1/D1, 1/D2, 1/D3."""
        return [1.0 / d if d > 0.0 else 0.0 for d in self.compressibility]

    def invariants(self, e: Array, z: Any) -> tuple[Any, ...]:
        """(i, m, n, s), b, x, y and J - 1 of eq. (2.24) from E in the plane and z = 2 E_33."""
        t, q = 2.0 * trace_of(e), 4.0 * determinant_of(e)
        i, m, n = t + z, q + z * t, z * q
        s = i + m + n
        b = np.expm1(np.log1p(s) / 3.0)
        x = (b**2 * (b + 3.0) - m - n) / (1.0 + b)
        y = (b**2 * (2.0 * b + 3.0) - m - 2.0 * n) / (1.0 + b) ** 2
        return (i, m, n, s), b, x, y, np.expm1(np.log1p(s) / 2.0)

    def polynomial_stress(self, e: Array, z: Any) -> tuple[Any, Any]:
        """S in the plane and S_33, eq. (2.24)."""
        (i, m, n, s), b, x, _, grown = self.invariants(e, z)
        c10, c20, c30, c01 = self.shape
        of_x = 2.0 * (c10 + 2.0 * c20 * x + 3.0 * c30 * x**2) / ((1.0 + b) * (1.0 + s))
        of_y = 2.0 * c01 / ((1.0 + b) ** 2 * (1.0 + s))
        terms = enumerate(self.stiffnesses, 1)
        p = sum(2.0 * k * power * grown ** (2 * power - 1) for power, k in terms) / (1.0 + grown)
        t, q = 2.0 * trace_of(e), 4.0 * determinant_of(e)
        one = identity_times(np.ones(e.shape[:2]))

        def assemble(g: Any, identity: Any, cof_g: Any, cof_c: Any, wide: Any) -> Any:
            """One part of S from those of G, I, cof G and cof C."""
            first = g + wide(m + n) * identity - cof_g - wide(i / 3.0) * cof_c
            second = g - wide(i) * identity - 2.0 * cof_g
            second = second + wide(s) * (wide(2.0 + i) * identity - g)
            second = second - wide(2.0 / 3.0 * (2.0 * i + m)) * cof_c
            return wide(of_x) * first + wide(of_y) * second + wide(p) * cof_c

        cofactor = 2.0 * cofactor_of(e)
        in_plane = assemble(
            2.0 * e,
            one,
            np.asarray(z)[..., None, None] * cofactor,
            np.asarray(1.0 + z)[..., None, None] * (one + cofactor),
            lambda value: np.asarray(value)[..., None, None],
        )
        return in_plane, assemble(z, 1.0, q, 1.0 + t + q, lambda value: value)

    def across(self, e: Array) -> Array:
        """2 (E_m)_33: that of E_33 = 0 in plane strain, and with S_33 = 0 in plane stress, eq. (2.25)."""
        trace = trace_of(e)
        if not self.plane_stress:
            return np.zeros_like(trace) if self.heat is None else -self.doubled_heat / (1.0 + self.heat) ** 2
        if self.law == SAINT_VENANT_KIRCHHOFF:
            return -2.0 * self.poisson / (1.0 - self.poisson) * trace
        squared = 2.0 * trace + 4.0 * determinant_of(e)
        stretch = -self.poisson / (1.0 - self.poisson) * 0.5 * np.log1p(squared)
        size = np.abs(e).max(axis=(2, 3))
        for _ in range(MOST_STEPS):
            z = np.expm1(2.0 * (stretch + 1j * COMPLEX_STEP))
            slope = self.polynomial_stress(e, z)[1] * (1.0 + z)
            step = slope.real / (slope.imag / COMPLEX_STEP)
            stretch = stretch - step
            if (np.abs(step) <= LAST_STEP * size).all():
                break
        return np.expm1(2.0 * stretch)

    def discrete_gradient(self, e0: Array, e1: Array) -> Array:
        """S_m of eq. (4.8); W1 - W0 is the integral of S along the way."""
        middle, change = 0.5 * (e0 + e1), e1 - e0
        stress = self.stress(middle)
        if self.law == SAINT_VENANT_KIRCHHOFF:
            return stress
        square = np.einsum("egij,egij->eg", change, change)
        f = np.zeros_like(square)
        for place, weight in zip(PATH, PATH_WEIGHTS):
            off = self.stress(middle + 0.5 * place * change) - stress
            f += 0.5 * weight * np.einsum("egij,egij->eg", off, change)
        ratio = np.divide(f, square, out=np.zeros_like(f), where=square > 0.0)
        return stress + ratio[..., None, None] * change

    def viscous(self, e0: Array, e1: Array, dt: float) -> Array:
        """S_d of eq. (4.17)."""
        if self.beta == 0.0 or dt == 0.0:
            return np.zeros_like(e0)
        one = identity_times(np.ones(e0.shape[:2]))
        c0, c1 = one + 2.0 * e0, one + 2.0 * e1
        j0, j1 = np.sqrt(determinant_of(c0)), np.sqrt(determinant_of(c1))
        mean = 0.5 * (j0 + j1)
        g = cofactor_of(0.5 * (c0 + c1)) / mean[..., None, None]
        change = e1 - e0
        volume = np.einsum("egij,egij->eg", g, change)
        shape = g @ change @ g - 0.5 * volume[..., None, None] * g
        factor = (self.beta / (dt * mean))[..., None, None]
        kappa = self.area_modulus * volume[..., None, None]
        return factor * (2.0 * self.shear * shape + kappa * g)

    # Mean dilatation.

    def dilatation(self, h: Array) -> tuple[Array, Array]:
        """J and theta [E, G] of eq. (2.9)."""
        j = determinant_of(identity_times(np.ones(h.shape[:2])) + h)
        theta = (self.weight * j).sum(axis=1) / self.weight.sum(axis=1)
        return j, np.broadcast_to(theta[:, None], j.shape)

    def enhanced(self, h: Array) -> Array:
        """The strain that the material sees: E, or Ebar of eq. (2.10)."""
        e = self.strain(h)
        if not self.mean_dilatation:
            return e
        j, theta = self.dilatation(h)
        r = theta / j
        return r[..., None, None] * e + identity_times(0.5 * (r - 1.0))

    def effective(self, stress: Array, h0: Array, h1: Array) -> Array:
        """S_eff of eq. (2.11) from the stress of the material."""
        if not self.mean_dilatation:
            return stress
        (j0, theta0), (j1, theta1) = self.dilatation(h0), self.dilatation(h1)
        one = identity_times(np.ones(h0.shape[:2]))
        c = one + self.strain(h0) + self.strain(h1)
        j_m, theta_m = 0.5 * (j0 + j1), 0.5 * (theta0 + theta1)
        r_m = 0.5 * (theta0 / j0 + theta1 / j1)
        f = one + 0.5 * (h0 + h1)
        k = determinant_of(f)[..., None, None] * np.linalg.inv(f.swapaxes(2, 3) @ f)
        a = np.einsum("egij,egij->eg", stress, c) / (2.0 * j0 * j1)
        mean = ((self.weight * a * j_m).sum(axis=1) / self.weight.sum(axis=1))[:, None]
        return r_m[..., None, None] * stress + (mean - a * theta_m)[..., None, None] * k

    # Sums.

    def energy(self, u: Array) -> Array:
        """Strain energy of each element."""
        return (
            self.weight * self.energy_density(self.enhanced(self.displacement_gradient(u)))
        ).sum(axis=1)

    def stress_of(self, u: Array) -> Array:
        """S at the displacements, the one that does work on their strains."""
        h = self.displacement_gradient(u)
        return self.effective(self.stress(self.enhanced(h)), h, h)

    def thickness_strain(self, u: Array) -> Array:
        """The strains that the thickness follows in plane stress."""
        return self.strain(self.displacement_gradient(u))

    def means(self, u: Array) -> tuple[Array, Array]:
        """Cauchy stress, eq. (2.8), and Green-Lagrange strain of the elements [E, 3] as xx yy xy."""
        h = self.displacement_gradient(u)
        stress = self.stress_of(u)
        f = identity_times(np.ones(h.shape[:2])) + h
        e = self.strain(h)
        j = determinant_of(f)
        if self.plane_stress:
            own, theta = self.mechanical(self.thickness_strain(u))
            j = j * theta * np.sqrt(1.0 + self.across(own))
        cauchy = f @ stress @ f.swapaxes(2, 3) / j[..., None, None]
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        return mean_of(part, cauchy), mean_of(part, e)

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        h0, h1 = self.displacement_gradient(u0), self.displacement_gradient(u1)
        if halfway:
            stress = self.discrete_gradient(self.enhanced(h0), self.enhanced(h1))
        else:
            stress = self.stress(self.enhanced(h1))
            h0 = h1
        stress = self.effective(stress, h0, h1)
        self._add(total, stress, 0.5 * (h0 + h1))

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        if dt == 0.0:
            return
        if self.beta != 0.0:
            h0, h1 = self.displacement_gradient(u0), self.displacement_gradient(u1)
            stress = self.viscous(self.enhanced(h0), self.enhanced(h1), dt)
            self._add(total, self.effective(stress, h0, h1), 0.5 * (h0 + h1))
        if self.alpha != 0.0:
            self.add_mass(total, (self.alpha / dt) * (u1 - u0))

    def _add(self, total: Array, stress: Array, h: Array) -> None:
        """Adds the forces of a stress S in a configuration: eq. (2.5) with B_L^T S = F S grad N."""
        f = identity_times(np.ones(h.shape[:2])) + h
        each = np.einsum("eg,egij,egaj->eai", self.weight, f @ stress, self.gradient)
        np.add.at(total, self.nodes, each)

    def add_mass(self, total: Array, values: Array) -> None:
        """Adds M times nodal values [N, ...]."""
        np.add.at(total, self.nodes, np.einsum("eab,ebi->eai", self.mass, values[self.nodes]))
