"""Elements with one strain and hourglass stiffness (CPE4R, CPS4R), eqs (2.42) and (2.43)."""

import numpy as np

from oracle.block import Block
from oracle.enhanced import patterns
from stickslip.arrays import Array


class ReducedBlock(Block):
    """Elements with the strain of their mean gradients and a potential of their hourglass modes."""

    gamma: Array
    """[E, 4]"""
    hourglass: Array
    """Kh [E, 2, 2]."""

    def condense(self) -> None:
        """Replaces the points of the quadrilaterals by one, with the hourglass stiffness that they give."""
        self.gamma, slope, modes = patterns(self.weight, self.gradient)
        rows = np.zeros((*slope.shape[:2], 3, 2))
        rows[:, :, 0, 0] = rows[:, :, 2, 1] = slope[..., 0]
        rows[:, :, 1, 1] = rows[:, :, 2, 0] = slope[..., 1]
        columns = np.stack(
            [modes[..., 0, 0], modes[..., 1, 1], 2.0 * modes[..., 0, 1]], axis=2
        )
        all_columns = np.concatenate([rows, columns], axis=3)
        direct = self.lame + 2.0 * self.shear
        moduli = np.array([[direct, self.lame, 0.0], [self.lame, direct, 0.0], [0.0, 0.0, self.shear]])
        k = np.einsum("eg,egim,ij,egjn->emn", self.weight, all_columns, moduli, all_columns)
        mixed, own = k[:, :2, 2:], k[:, 2:, 2:]
        self.hourglass = k[:, :2, :2] - mixed @ np.linalg.solve(own, mixed.swapaxes(1, 2))
        volume = self.weight.sum(axis=1, keepdims=True)
        part = self.weight / volume
        self.gradient = np.einsum("eg,egai->eai", part, self.gradient)[:, None]
        self.weight = volume

    @property
    def diagonal(self) -> Array:
        """As that of a block, with the part of the hourglass modes."""
        return super().diagonal + np.einsum("eii,ea->ea", self.hourglass, self.gamma**2)

    def modes(self, u: Array) -> tuple[Array, Array, Array]:
        """F0 [E, 2, 2], q and H = F0^T q [E, 2]."""
        f = np.eye(2) + self.displacement_gradient(u)[:, 0]
        q = np.einsum("ea,eai->ei", self.gamma, u[self.nodes])
        return f, q, np.einsum("eij,ei->ej", f, q)

    def energy(self, u: Array) -> Array:
        """Strain energy of each element, eq. (2.42)."""
        h = self.modes(u)[2]
        return super().energy(u) + 0.5 * np.einsum("ei,eij,ej->e", h, self.hourglass, h / self.softening)

    def add_forces(self, total: Array, u0: Array, u1: Array, halfway: bool) -> None:
        """Adds F of eq. (4.5); `halfway`: the energy-momentum form, else that of u1."""
        super().add_forces(total, u0, u1, halfway)
        h0, h1 = self.modes(u0)[2], self.modes(u1)[2]
        h = 0.5 * (h0 + h1) if halfway else h1
        self._add_hourglass(total, h / self.softening, 0.5 * (u0 + u1) if halfway else u1)

    def add_damping(self, total: Array, u0: Array, u1: Array, dt: float) -> None:
        """Adds F_d of eq. (4.16)."""
        super().add_damping(total, u0, u1, dt)
        if dt != 0.0 and self.beta != 0.0:
            change = self.modes(u1)[2] - self.modes(u0)[2]
            self._add_hourglass(total, (self.beta / dt) * change, 0.5 * (u0 + u1))

    def _add_hourglass(self, total: Array, h: Array, u: Array) -> None:
        """Adds the forces of f = Kh h at the displacements u, eq. (2.43)."""
        f, q, _ = self.modes(u)
        stress = np.einsum("eij,ej->ei", self.hourglass, h)
        along = np.einsum("eai,ei->ea", self.gradient[:, 0], stress)
        own = np.einsum("eij,ej->ei", f, stress)
        force = np.einsum("ea,ei->eai", along, q) + np.einsum("ea,ei->eai", self.gamma, own)
        np.add.at(total, self.nodes, force)
