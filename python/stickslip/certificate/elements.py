"""Masses, energies, stresses and forces of the elements of a result, from `/model` and displacements.

Equation numbers are those of docs/theory.md. Arrays of tensors at integration points have the shape
[E, G, 2, 2], E elements of one kind with G points each.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.result import Array, Integers, Result

EPS = float(np.finfo(np.float64).eps)

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
"""Corners of the reference square."""

PATH, PATH_WEIGHTS = np.polynomial.legendre.leggauss(5)
"""Gauss points on the way from the start to the end of an increment."""

SAINT_VENANT_KIRCHHOFF, NEO_HOOKE, PLASTICITY = 0, 1, 3
"""Laws of /model/materials/law; the other is a polynomial of the invariants."""

COMPLEX_STEP = 1e-170
"""Imaginary part of a stretch, by which the derivative of a stress is told; its square is zero."""

MOST_STEPS = 60
"""Steps of Newton's method for the stretch across."""

REST = 1e-5
"""A change of the strains so small beside them that what it adds to the stress of the middle is less than round-off."""

LAST_STEP = 1e-9
"""A step of Newton's method so small beside the strain leaves an error of round-off."""

KINDS = (
    (3, False, False, False),
    (4, False, False, False),
    (3, True, False, False),
    (4, True, False, False),
    (4, False, True, False),
    (6, False, False, False),
    (6, True, False, False),
    (8, False, False, False),
    (8, True, False, False),
    (8, False, False, True),
    (8, True, False, True),
)
"""Nodes, plane stress, mean dilatation and reduced integration of each of the element types."""

ENHANCED = {16: (4, False, False, False), 17: (4, True, False, False)}
"""The same of the element types with enhanced strains."""

REDUCED = {18: (4, False, False, False), 19: (4, True, False, False)}
"""The same of the element types with one strain and hourglass stiffness."""

RINGS = {
    11: (3, False, False, False),
    12: (4, False, False, False),
    13: (6, False, False, False),
    14: (8, False, False, False),
    15: (8, False, False, True),
    22: (4, False, False, False),
    23: (4, False, False, False),
    24: (4, False, False, False),
    25: (8, False, False, False),
    26: (8, False, False, True),
}
"""The same of the element types of bodies of revolution."""

PRESSURES = {20: 3, 21: 3, 22: 1, 25: 3, 26: 3}
"""Number of functions of the volume ratio of the element types with one of their own."""

HYBRID = {20: (8, False, False, False), 21: (8, False, False, True)}
"""The same as of KINDS of those in plane strain."""

ENHANCED_RING, REDUCED_RING = 23, 24
"""Rings with enhanced strains, and with one strain and hourglass stiffness."""

DUNAVANT = ((0.44594849091596489, 0.22338158967801147), (0.09157621350977074, 0.10995174365532187))
"""Place a of the points (a, a), (1 - 2 a, a) and (a, 1 - 2 a) of a triangle and their weight, of degree 4."""


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
    def stiffness(self) -> float:
        """An upper bound of an entry of K on the diagonal, of undeformed elements."""
        each = (self.lame + 2.0 * self.shear) * np.einsum(
            "eg,egaj->ea", self.weight, self.gradient**2
        )
        return float(each.max(initial=0.0))

    # Kinematics.

    def displacement_gradient(self, u: Array) -> Array:
        """H = du/dX, eq. (2.1)."""
        return np.einsum("eai,egaj->egij", u[self.nodes], self.gradient)

    def strain(self, h: Array) -> Array:
        """E, eq. (2.2)."""
        turned = h.swapaxes(2, 3)
        return 0.5 * (h + turned + turned @ h)

    def energy_density(self, e: Array) -> Array:
        """W(E), eqs (2.13), (2.14) and (2.23)."""
        trace, determinant = _trace(e), _determinant(e)
        if self.is_polynomial:
            _, _, x, y, grown = self.invariants(e, self.across(e))
            c10, c20, c30, c01 = self.shape
            volume = sum(k * grown ** (2 * i) for i, k in enumerate(self.stiffnesses, 1))
            return c10 * x + c20 * x**2 + c30 * x**3 + c01 * y + volume
        if self.law != NEO_HOOKE:
            return 0.5 * self.lame * trace**2 + self.shear * np.einsum("egij,egij->eg", e, e)
        t, q = 2.0 * trace, 4.0 * determinant
        b = np.expm1(np.log1p(t + q) / 3.0)
        jump = np.expm1(np.log1p(t + q) / 2.0)
        shape = (b * b * (b + 3.0) - q) / (1.0 + b)
        return 0.5 * self.shear * shape + 0.5 * self.bulk * jump**2

    def stress(self, e: Array) -> Array:
        """S(E), eqs (2.13), (2.15), (2.16) and (2.24)."""
        trace = _trace(e)
        if self.is_polynomial:
            return self.polynomial_stress(e, self.across(e))[0]
        if self.law != NEO_HOOKE:
            return self.lame * _identity(trace) + 2.0 * self.shear * e
        t, q = 2.0 * trace, 4.0 * _determinant(e)
        square = 1.0 + t + q
        jump = np.expm1(np.log1p(t + q) / 2.0)
        shape = _identity(2.0 * t / 3.0 + q) - 2.0 * (1.0 + t / 3.0)[..., None, None] * _cofactor(e)
        deviator = self.shear * square ** (-1.0 / 3.0) / square
        pressure = self.bulk * jump / np.sqrt(square)
        cofactor = _identity(np.ones_like(t)) + 2.0 * _cofactor(e)
        return deviator[..., None, None] * shape + pressure[..., None, None] * cofactor

    # Polynomials of the invariants.

    @property
    def is_polynomial(self) -> bool:
        """Whether the law is one of eq. (2.23), as a neo-Hookean one in plane stress is."""
        return self.law > NEO_HOOKE or (self.law == NEO_HOOKE and self.plane_stress)

    @property
    def stiffnesses(self) -> list[float]:
        """1/D1, 1/D2, 1/D3."""
        return [1.0 / d if d > 0.0 else 0.0 for d in self.compressibility]

    def invariants(self, e: Array, z: Any) -> tuple[Any, ...]:
        """(i, m, n, s), b, x, y and J - 1 of eq. (2.24) from E in the plane and z = 2 E_33."""
        t, q = 2.0 * _trace(e), 4.0 * _determinant(e)
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
        t, q = 2.0 * _trace(e), 4.0 * _determinant(e)
        one = _identity(np.ones(e.shape[:2]))

        def assemble(g: Any, identity: Any, cof_g: Any, cof_c: Any, wide: Any) -> Any:
            """One part of S from those of G, I, cof G and cof C."""
            first = g + wide(m + n) * identity - cof_g - wide(i / 3.0) * cof_c
            second = g - wide(i) * identity - 2.0 * cof_g
            second = second + wide(s) * (wide(2.0 + i) * identity - g)
            second = second - wide(2.0 / 3.0 * (2.0 * i + m)) * cof_c
            return wide(of_x) * first + wide(of_y) * second + wide(p) * cof_c

        cofactor = 2.0 * _cofactor(e)
        in_plane = assemble(
            2.0 * e,
            one,
            np.asarray(z)[..., None, None] * cofactor,
            np.asarray(1.0 + z)[..., None, None] * (one + cofactor),
            lambda value: np.asarray(value)[..., None, None],
        )
        return in_plane, assemble(z, 1.0, q, 1.0 + t + q, lambda value: value)

    def across(self, e: Array) -> Array:
        """2 E_33: zero in plane strain, and with S_33 = 0 in plane stress, eq. (2.25)."""
        trace = _trace(e)
        if not self.plane_stress:
            return np.zeros_like(trace)
        squared = 2.0 * trace + 4.0 * _determinant(e)
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
        one = _identity(np.ones(e0.shape[:2]))
        c0, c1 = one + 2.0 * e0, one + 2.0 * e1
        j0, j1 = np.sqrt(_determinant(c0)), np.sqrt(_determinant(c1))
        mean = 0.5 * (j0 + j1)
        g = _cofactor(0.5 * (c0 + c1)) / mean[..., None, None]
        change = e1 - e0
        volume = np.einsum("egij,egij->eg", g, change)
        shape = g @ change @ g - 0.5 * volume[..., None, None] * g
        factor = (self.beta / (dt * mean))[..., None, None]
        kappa = self.area_modulus * volume[..., None, None]
        return factor * (2.0 * self.shear * shape + kappa * g)

    # Mean dilatation.

    def dilatation(self, h: Array) -> tuple[Array, Array]:
        """J and theta [E, G] of eq. (2.9)."""
        j = _determinant(_identity(np.ones(h.shape[:2])) + h)
        theta = (self.weight * j).sum(axis=1) / self.weight.sum(axis=1)
        return j, np.broadcast_to(theta[:, None], j.shape)

    def enhanced(self, h: Array) -> Array:
        """The strain that the material sees: E, or Ebar of eq. (2.10)."""
        e = self.strain(h)
        if not self.mean_dilatation:
            return e
        j, theta = self.dilatation(h)
        r = theta / j
        return r[..., None, None] * e + _identity(0.5 * (r - 1.0))

    def effective(self, stress: Array, h0: Array, h1: Array) -> Array:
        """S_eff of eq. (2.11) from the stress of the material."""
        if not self.mean_dilatation:
            return stress
        (j0, theta0), (j1, theta1) = self.dilatation(h0), self.dilatation(h1)
        one = _identity(np.ones(h0.shape[:2]))
        c = one + self.strain(h0) + self.strain(h1)
        j_m, theta_m = 0.5 * (j0 + j1), 0.5 * (theta0 + theta1)
        r_m = 0.5 * (theta0 / j0 + theta1 / j1)
        f = one + 0.5 * (h0 + h1)
        k = _determinant(f)[..., None, None] * np.linalg.inv(f.swapaxes(2, 3) @ f)
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
        f = _identity(np.ones(h.shape[:2])) + h
        e = self.strain(h)
        j = _determinant(f)
        if self.plane_stress and self.is_polynomial:
            j = j * np.sqrt(1.0 + self.across(self.thickness_strain(u)))
        elif self.plane_stress:
            across = -self.poisson / (1.0 - self.poisson) * _trace(self.thickness_strain(u))
            j = j * np.sqrt(1.0 + 2.0 * across)
        cauchy = f @ stress @ f.swapaxes(2, 3) / j[..., None, None]
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        return _mean(part, cauchy), _mean(part, e)

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
        f = _identity(np.ones(h.shape[:2])) + h
        each = np.einsum("eg,egij,egaj->eai", self.weight, f @ stress, self.gradient)
        np.add.at(total, self.nodes, each)

    def add_mass(self, total: Array, values: Array) -> None:
        """Adds M times nodal values [N, ...]."""
        np.add.at(total, self.nodes, np.einsum("eab,ebi->eai", self.mass, values[self.nodes]))


class Elements:
    """All elements of a result, in blocks of one type and material each."""

    def __init__(self, result: Result) -> None:
        self.nodes = len(result.coordinates)
        self.body = result.read("model/bodies/element")
        self.bodies = len(result.read("model/bodies/mass"))
        self.of_node = result.read("model/bodies/node")
        self.blocks = list(_blocks(result))
        self.count = len(result.cells)
        self.is_metal = np.zeros(self.count, np.bool_)
        """Elements whose stresses the displacements do not tell [E]."""
        for block in self.blocks:
            self.is_metal[block.elements] = block.law == PLASTICITY
        self.keeps = np.array([0.0, 1.0]) if is_axisymmetric(result) else np.ones(2)
        """Directions in which the momentum of a body may differ from zero."""

    def middles(self) -> dict[int, tuple[int, int]]:
        """The ends of the sides that have a node between them, by this node."""
        found = {}
        for block in self.blocks:
            corners = block.nodes.shape[1] // 2
            if block.nodes.shape[1] not in (6, 8):
                continue
            for k in range(corners):
                ends = block.nodes[:, [k, (k + 1) % corners]]
                rows = zip(block.nodes[:, corners + k].tolist(), ends.tolist(), strict=True)
                found.update({middle: (a, b) for middle, (a, b) in rows})
        return found

    def mass(self) -> Array:
        """Mass of each body."""
        return self._of_bodies([block.mass.sum(axis=(1, 2)) for block in self.blocks])

    def strain_energy(self, u: Array) -> Array:
        """Strain energy of each body."""
        return self._of_bodies([block.energy(u) for block in self.blocks])

    def _of_bodies(self, values: list[Array]) -> Array:
        total = np.zeros(self.bodies)
        for block, each in zip(self.blocks, values):
            np.add.at(total, self.body[block.elements], each)
        return total

    def momentum(self, v: Array) -> Array:
        """M V at the nodes [N, 2]."""
        total = np.zeros((self.nodes, 2))
        for block in self.blocks:
            block.add_mass(total, v)
        return total

    def load_patterns(self, groups: Integers) -> list[tuple[int, Array]]:
        """Mass at the nodes [N] of the elements of one body, material and group of loads, with the body.

        All body forces are accelerations of these patterns.
        """
        found = []
        for block in self.blocks:
            keys = np.stack([self.body[block.elements], groups[block.elements]], axis=1)
            for body, group in np.unique(keys[keys[:, 1] >= 0], axis=0):
                inside = (keys == (body, group)).all(axis=1)
                total = np.zeros(self.nodes)
                np.add.at(total, block.nodes[inside], block.mass[inside].sum(axis=2))
                found.append((int(body), total))
        return found

    def stresses(self, u: Array) -> tuple[Array, Array]:
        """Mean Cauchy stress and strain of all elements [E, 3]."""
        both = np.zeros((2, self.count, 3))
        for block in self.blocks:
            both[0, block.elements], both[1, block.elements] = block.means(u)
        return both[0], both[1]

    def forces(self, scheme: int, u0: Array, u1: Array, at: Array, dt: float) -> Array:
        """Internal and damping forces of an increment at the nodes [N, 2], on the side of the inertia.

        `at` is U_theta of SS22 and of static steps.
        """
        total = np.zeros((self.nodes, 2))
        halfway = scheme == 1
        for block in self.blocks:
            block.add_forces(total, u0, u1 if halfway else at, halfway)
            if scheme != 0:
                block.add_damping(total, u0, u1, dt)
        return total


def _blocks(result: Result) -> list[Block]:
    """The blocks of a result."""
    types = result.read("model/element_types")
    materials = result.read("model/element_materials")
    thickness = result.read("model/thickness")
    constants = {
        name: result.read(f"model/materials/{name}")
        for name in ("law", "young", "poisson", "density", "alpha", "beta", "shape", "compressibility")
    }
    from stickslip.certificate.enhanced import EnhancedBlock
    from stickslip.certificate.metals import MetalBlock
    from stickslip.certificate.reduced import ReducedBlock
    from stickslip.certificate.rings import RingBlock
    from stickslip.certificate.whole import EnhancedRingBlock, PressureBlock, ReducedRingBlock

    found = []
    keys = np.stack([types.astype(np.int64), materials], axis=1)
    for kind, material in np.unique(keys[materials >= 0], axis=0):
        elements = np.flatnonzero((types == kind) & (materials == material))
        families = (
            (ENHANCED, EnhancedBlock),
            (REDUCED, ReducedBlock),
            (PRESSURES, PressureBlock),
            ({ENHANCED_RING}, EnhancedRingBlock),
            ({REDUCED_RING}, ReducedRingBlock),
            (RINGS, RingBlock),
        )
        of_kind = next((block for family, block in families if kind in family), Block)
        if constants["law"][material] == PLASTICITY:
            of_kind = MetalBlock
        others = ENHANCED | REDUCED | HYBRID | RINGS
        count, plane_stress, mean, reduced = others[kind] if kind in others else KINDS[kind]
        nodes = np.array([result.cells[e] for e in elements]).reshape(-1, count)
        place, thick = result.coordinates[nodes], thickness[elements][:, None]
        points = _points(count, reduced)
        gradient, of_section = _gradients(place, points)
        area = of_section
        rule = _mass_points(count, kind in RINGS)
        shape, _ = _shape(count, rule[0])
        at_points, _ = _shape(count, points[0])
        around = place[..., 0] @ at_points.T
        if kind in RINGS:
            area, thick = area * 2.0 * np.pi * around, 2.0 * np.pi * place[..., 0] @ shape.T
        weight = constants["density"][material] * thick * _gradients(place, rule)[1]
        found.append(
            of_kind(
                elements,
                nodes,
                gradient,
                area if kind in RINGS else area * thick,
                np.einsum("eg,ga,gb->eab", weight, shape, shape),
                plane_stress,
                mean,
                **{
                    name: values[material] if values.ndim > 1 else values[material].item()
                    for name, values in constants.items()
                },
            )
        )
        if kind in RINGS:
            found[-1].around = at_points / around[..., None]
        elif kind in HYBRID:
            found[-1].around = np.zeros((*area.shape, count))
        found[-1].area = of_section
        if kind in PRESSURES:
            found[-1].place = np.einsum("ga,eai->egi", at_points, place)
            found[-1].functions = PRESSURES[kind]
        if kind in REDUCED or kind == REDUCED_RING:
            found[-1].condense()
    return found


def is_axisymmetric(result: Result) -> bool:
    """Whether the bodies are bodies of revolution."""
    return bool(np.isin(result.read("model/element_types"), list(RINGS)).any())


def _points(count: int, reduced: bool) -> tuple[Array, Array]:
    """Natural coordinates [G, 2] and weights [G] of the points of an element with so many nodes."""
    if count == 3:
        return np.full((1, 2), 1.0 / 3.0), np.array([0.5])
    if count == 6:
        return np.array([[1.0, 1.0], [4.0, 1.0], [1.0, 4.0]]) / 6.0, np.full(3, 1.0 / 6.0)
    if count == 4 or reduced:
        return CORNERS / np.sqrt(3.0), np.ones(4)
    at, weight = np.polynomial.legendre.leggauss(3)
    points = np.array([[r, s] for s in at for r in at])
    return points, np.outer(weight, weight).ravel()


def _mass_points(count: int, is_ring: bool) -> tuple[Array, Array]:
    """As _points, exact for the mass of elements with straight sides."""
    if count not in (3, 6):
        return _points(8 if is_ring else count, False)
    points = [p for a, _ in DUNAVANT for p in ((a, a), (1.0 - 2.0 * a, a), (a, 1.0 - 2.0 * a))]
    return np.array(points), np.repeat([0.5 * weight for _, weight in DUNAVANT], 3)


def _shape(count: int, points: Array) -> tuple[Array, Array]:
    """Shape functions [G, k] and their natural derivatives [G, k, 2] at points [G, 2]."""
    r, s = points[:, :1], points[:, 1:]
    if count in (3, 6):
        corner = np.hstack([1.0 - r - s, r, s])
        slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        if count == 3:
            return corner, np.broadcast_to(slope, (len(points), 3, 2))
        after = np.roll(corner, -1, axis=1)
        value = np.hstack([corner * (2.0 * corner - 1.0), 4.0 * corner * after])
        mixed = after[..., None] * slope + corner[..., None] * np.roll(slope, -1, axis=0)
        return value, np.hstack([(4.0 * corner - 1.0)[..., None] * slope, 4.0 * mixed])
    a, b = CORNERS.T
    x, y = 1.0 + a * r, 1.0 + b * s
    if count == 4:
        return 0.25 * x * y, 0.25 * np.stack([a * y, b * x], axis=2)
    value = 0.25 * x * y * (a * r + b * s - 1.0)
    natural = 0.25 * np.stack(
        [a * y * (2.0 * a * r + b * s), b * x * (a * r + 2.0 * b * s)], axis=2
    )
    # between the corners: along the sides 0 and 2, then 1 and 3
    p, q = 1.0 - r * r, 1.0 - s * s
    along = np.stack([-r * y, 0.5 * b * p], axis=2)
    up = np.stack([0.5 * a * q, -s * x], axis=2)
    is_along = np.array([True, False, True, False])
    between = np.where(is_along, 0.5 * p * y, 0.5 * q * x)
    slope = np.where(is_along[:, None], along, up)
    return np.hstack([value, between]), np.hstack([natural, slope])


def _gradients(nodes: Array, rule: tuple[Array, Array]) -> tuple[Array, Array]:
    """dN_a/dX_j [E, G, k, 2] and the areas of the points [E, G] of a rule for nodes [E, k, 2]."""
    points, weight = rule
    _, natural = _shape(nodes.shape[1], points)
    jacobian = np.einsum("eai,gar->egir", nodes, natural)
    gradient = np.einsum("gar,egrj->egaj", natural, np.linalg.inv(jacobian))
    return gradient, weight * _determinant(jacobian)


def _mean(part: Array, values: Array) -> Array:
    """Means of symmetric tensors over the elements, as xx yy xy."""
    mean = np.einsum("eg,egij->eij", part, values)
    return np.stack([mean[:, 0, 0], mean[:, 1, 1], mean[:, 0, 1]], axis=1)


def _trace(a: Array) -> Array:
    return a[..., 0, 0] + a[..., 1, 1]


def _determinant(a: Array) -> Array:
    return a[..., 0, 0] * a[..., 1, 1] - a[..., 0, 1] * a[..., 1, 0]


def _identity(factor: NDArray[np.float64]) -> Array:
    return factor[..., None, None] * np.eye(2)


def _cofactor(a: Array) -> Array:
    """Cofactor of symmetric tensors."""
    result = -a.copy()
    result[..., 0, 0], result[..., 1, 1] = a[..., 1, 1], a[..., 0, 0]
    return result
