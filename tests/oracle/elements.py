"""All elements of a result: blocks of one type and material each, and sums over bodies."""

from collections.abc import Callable

import numpy as np

from oracle.block import NEO_HOOKE, POLYNOMIAL, SAINT_VENANT_KIRCHHOFF, Block
from oracle.shapes import gradients, integration_rule, mass_rule, shape_functions
from oracle.types import TYPES
from oracle.untold import UntoldBlock
from stickslip.arrays import Array, Flags, Integers
from stickslip.result import Result

PLASTICITY = 3
"""Law of metals among those of /model/materials/law."""

LAWS = (SAINT_VENANT_KIRCHHOFF, NEO_HOOKE, POLYNOMIAL)
"""Laws whose stresses follow from the displacements."""

CONSTANTS = ("law", "young", "poisson", "density", "alpha", "beta", "shape", "compressibility")
"""Datasets of /model/materials."""


class Elements:
    """All elements of a result, in blocks of one type and material each."""

    def __init__(self, result: Result) -> None:
        self.nodes = len(result.coordinates)
        self.body = result.read("model/bodies/element")
        self.bodies = len(result.read("model/bodies/mass"))
        self.of_node = result.read("model/bodies/node")
        self.blocks = blocks(result)
        self.count = len(result.cells)
        self.unknown_laws = sorted({int(block.law) for block in self.blocks} - {*LAWS})
        """Numbers of laws whose stresses the displacements, or the equations here, do not tell."""
        self.is_untold = np.zeros(self.count, np.bool_)
        """Elements whose stresses the displacements do not tell [E]."""
        for block in self.blocks:
            self.is_untold[block.elements] = isinstance(block, UntoldBlock)
        self.expansions = expansions(result)
        self.initial = result.frames[0]["TEMPERATURE"] if "TEMPERATURE" in result.frames.fields else None
        """Temperatures of the nodes at the start [N], where there are any."""
        self.keeps = np.array([0.0, 1.0]) if result.is_axisymmetric else np.ones(2)
        """Directions in which the momentum of a body may differ from zero."""

    def heat(self, temperature: Array, rigid: Flags) -> None:
        """Heats the elements to temperatures of the nodes [N], but for those of rigid bodies [E]."""
        for block in self.blocks:
            if block.material in self.expansions:
                strain = self.expansions[block.material]
                ends = block.temperature(temperature), block.temperature(self.initial)
                block.heat = strain(ends[0]) - strain(ends[1])
                block.heat[rigid[block.elements]] = 0.0

    @property
    def heated(self) -> Integers:
        """Nodes of elements that are heated."""
        nodes = [block.nodes.ravel() for block in self.blocks if block.heat is not None]
        return np.unique(np.concatenate(nodes)) if nodes else np.zeros(0, np.int64)

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


def expansions(result: Result) -> dict[int, Callable[[Array], Array]]:
    """alpha(T) (T - T0) of the materials that expand, by their indices."""
    if "expansion" not in result.file["model/materials"]:
        return {}
    zeros, rows = result.read("model/materials/expansion_zero"), result.read("model/materials/expansion")
    found: dict[int, Callable[[Array], Array]] = {}
    for material in np.unique(rows[:, 0]).astype(int).tolist():
        _, temperature, alpha = rows[rows[:, 0] == material].T

        def strain(t: Array, temperature: Array = temperature, alpha: Array = alpha, zero: float = zeros[material]) -> Array:
            return np.interp(t, temperature, alpha) * (t - zero)

        found[material] = strain
    return found


def unknown_types(result: Result) -> list[int]:
    """Numbers of element types of a result that the oracle does not know."""
    return sorted(set(result.read("model/element_types").tolist()) - set(TYPES))


def blocks(result: Result) -> list[Block]:
    """The blocks of a result."""
    types = result.read("model/element_types").astype(np.int64)
    materials = result.read("model/element_materials")
    thickness = result.read("model/thickness")
    constants = {name: result.read(f"model/materials/{name}") for name in CONSTANTS}
    keys = np.stack([types, materials], axis=1)
    found = []
    for kind, material in np.unique(keys[materials >= 0], axis=0):
        elements = np.flatnonzero((types == kind) & (materials == material))
        of_material = {
            name: values[material] if values.ndim > 1 else values[material].item()
            for name, values in constants.items()
        }
        found.append(_block(result, int(kind), elements, thickness[elements], of_material))
        found[-1].material = int(material)
    return found


def _block(
    result: Result, kind: int, elements: Integers, thickness: Array, constants: dict[str, Array | float]
) -> Block:
    """The block of some elements of one type and material."""
    of_kind = TYPES[kind]
    nodes = np.array([result.cells[e] for e in elements]).reshape(-1, of_kind.nodes)
    place, thick = result.coordinates[nodes], thickness[:, None]
    points = integration_rule(of_kind.nodes, of_kind.is_reduced)
    gradient, area = gradients(place, points)
    rule = mass_rule(of_kind.nodes, of_kind.is_ring)
    shape, _ = shape_functions(of_kind.nodes, rule[0])
    at_points, _ = shape_functions(of_kind.nodes, points[0])
    radius = place[..., 0] @ at_points.T
    volume = area * 2.0 * np.pi * radius if of_kind.is_ring else area * thick
    if of_kind.is_ring:
        thick = 2.0 * np.pi * place[..., 0] @ shape.T
    mass = constants["density"] * thick * gradients(place, rule)[1]
    block = (of_kind.block if constants["law"] in LAWS else UntoldBlock)(
        elements,
        nodes,
        gradient,
        volume,
        np.einsum("eg,ga,gb->eab", mass, shape, shape),
        of_kind.plane_stress,
        of_kind.mean_dilatation,
        **constants,
    )
    block.area = area
    block.at_points = at_points
    if of_kind.is_ring:
        block.around = at_points / radius[..., None]
    elif of_kind.functions:
        block.around = np.zeros((*area.shape, of_kind.nodes))
    if of_kind.functions:
        block.place = np.einsum("ga,eai->egi", at_points, place)
        block.functions = of_kind.functions
    if of_kind.has_hourglass_modes:
        block.condense()
    return block
