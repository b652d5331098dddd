"""Oblique impact of an elastic disc on a rigid plane by an explicit code of its own: prints the rows of reference.csv.

Four-node elements of St. Venant-Kirchhoff's material with 2 x 2 points, lumped mass, central differences. A node that would
sink in is put on the plane by the force that this takes, and Coulomb's law cuts the force that would hold it there. Nothing of
the program is used but the mesh.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import meshes  # noqa: E402, F401  (it finds the modules of python/)
from stickslip.decks import disc  # noqa: E402

RADIUS, YOUNG, POISSON, DENSITY, FRICTION, FALL = 0.5, 1e4, 0.3, 1.0, 0.3, 0.1


class Body:
    """Shape functions, mass and law of a mesh."""

    def __init__(self, side: int) -> None:
        mesh = disc("DISC", (0.0, RADIUS + 0.001), RADIUS, 0.0, side, side // 4)
        self.place, self.cells = np.array(mesh.nodes), np.array(mesh.elements)
        point = 1 / np.sqrt(3)
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        gradients, weights = [], []
        self.mass = np.zeros(len(self.place))
        for xi, eta in corners * point:
            local = 0.25 * np.stack([corners[:, 0] * (1 + corners[:, 1] * eta), corners[:, 1] * (1 + corners[:, 0] * xi)])
            shape = 0.25 * (1 + corners[:, 0] * xi) * (1 + corners[:, 1] * eta)
            jacobian = np.einsum("ia,eaj->eij", local, self.place[self.cells])
            weight = np.linalg.det(jacobian)
            gradients.append(np.einsum("eji,ia->eaj", np.linalg.inv(jacobian), local))
            weights.append(weight)
            np.add.at(self.mass, self.cells, DENSITY * weight[:, None] * shape)
        self.gradient, self.weight = np.stack(gradients), np.stack(weights)
        self.shear = YOUNG / 2 / (1 + POISSON)
        self.bulk = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)

    def force(self, moved: np.ndarray) -> np.ndarray:
        """Internal forces of the nodes."""
        f = np.eye(2) + np.einsum("eai,qeaj->qeij", moved[self.cells], self.gradient)
        strain = 0.5 * (np.einsum("qeki,qekj->qeij", f, f) - np.eye(2))
        stress = self.bulk * np.trace(strain, axis1=2, axis2=3)[..., None, None] * np.eye(2) + 2 * self.shear * strain
        first = np.einsum("qeij,qejk->qeik", f, stress)
        local = np.einsum("qe,qeik,qeak->eai", self.weight, first, self.gradient)
        total = np.zeros_like(moved)
        np.add.at(total, self.cells, local)
        return total


def impact(share: float, side: int) -> tuple[float, float, float]:
    """Speeds along and across the plane and spin after the impact, with share = v_t/(mu v_n) before."""
    body = Body(side)
    speed = np.sqrt((body.bulk + 2 * body.shear) / DENSITY)
    edges = np.linalg.norm(body.place[body.cells] - np.roll(body.place[body.cells], 1, axis=1), axis=2)
    dt = 0.3 * edges.min() / speed
    moved = np.zeros_like(body.place)
    v = np.tile([share * FRICTION * FALL, -FALL], (len(moved), 1))
    mass = body.mass[:, None]
    for _ in range(round(0.06 / dt)):
        force = -body.force(moved)
        trial = v + dt * force / mass
        low = body.place[:, 1] + moved[:, 1] + dt * trial[:, 1]
        pushed = low < 0
        press = np.where(pushed, -low / dt, 0.0)
        hold = np.where(pushed, np.clip(-trial[:, 0], -FRICTION * press, FRICTION * press), 0.0)
        v = trial + np.stack([hold, press], axis=1)
        moved += dt * v
    momentum = (mass * v).sum(axis=0)
    now = body.place + moved
    centre = (mass * now).sum(axis=0) / body.mass.sum()
    arm = now - centre
    spin = (body.mass * (arm[:, 0] * v[:, 1] - arm[:, 1] * v[:, 0])).sum() / (body.mass * (arm**2).sum(axis=1)).sum()
    along, across = momentum / body.mass.sum()
    return float(along), float(across), float(spin)


def main() -> None:
    """Prints the rows."""
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 16
    for share in (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0):
        along, across, spin = impact(share, side)
        after = (along + RADIUS * spin) / (FRICTION * FALL)
        print(f"after,{share},{after!r},C,explicit.py with {side} elements along a side,", flush=True)
        print(f"rebound,{share},{across / FALL!r},C,explicit.py with {side} elements along a side,", flush=True)


if __name__ == "__main__":
    main()
