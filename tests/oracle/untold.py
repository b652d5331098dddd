"""Elements whose stresses the oracle does not know: masses and strains.

Of metals (`*PLASTIC`) they follow from a history that the file does not have; of other laws the oracle has no equation.
"""

import numpy as np

from oracle.block import Block
from oracle.tensors import mean_of
from stickslip.arrays import Array


class UntoldBlock(Block):
    """Elements whose stresses are not known from the displacements."""

    def condense(self) -> None:
        """Replaces the points of elements with one strain by one."""
        volume = self.weight.sum(axis=1, keepdims=True)
        self.gradient = np.einsum("eg,egai->eai", self.weight / volume, self.gradient)[:, None]
        self.weight = volume

    def energy(self, u: Array) -> Array:
        """Nothing that is known."""
        return np.zeros(len(self.elements))

    def means(self, u: Array) -> tuple[Array, Array]:
        """No stress that is known, and the Green-Lagrange strain."""
        part = self.weight / self.weight.sum(axis=1, keepdims=True)
        strain = mean_of(part, self.strain(self.displacement_gradient(u)))
        return np.zeros_like(strain), strain

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds nothing that is known."""

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds nothing that is known."""
