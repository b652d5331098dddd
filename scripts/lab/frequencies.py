"""Elastic frequencies of free rings, beams and discs with redistributed mass beside those with the
consistent mass (docs/theory/elements.md, Redistributed mass).

Matrices and weights are computed here on their own, for linear elasticity in plane strain; all
edges are without mass, but for the inner ones of rings. Changes in per cent.
"""

import sys
from collections.abc import Sequence
from math import pi

import numpy as np
from stickslip.arrays import Array
from stickslip.decks import GridMesh, disc, ring

YOUNG, POISSON, DENSITY = 1000.0, 0.3, 1.0
MODES = 8
"""Elastic modes shown."""
MOST_WEIGHT = 6.0
"""Largest sum of |w|."""

GAUSS = (-(3**-0.5), 3**-0.5)


def element_matrices(x: Array) -> tuple[Array, Array]:
    """Stiffness (8 x 8) and mass per direction (4 x 4) of a quadrilateral."""
    factor = YOUNG / ((1 + POISSON) * (1 - 2 * POISSON))
    shear = (1 - 2 * POISSON) / 2
    law = factor * np.array([[1 - POISSON, POISSON, 0], [POISSON, 1 - POISSON, 0], [0, 0, shear]])
    stiffness, mass = np.zeros((8, 8)), np.zeros((4, 4))
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    for xi in GAUSS:
        for eta in GAUSS:
            point = np.array((xi, eta))
            shape = 0.25 * np.prod(1 + signs * point, axis=1)
            slopes = 0.25 * signs * (1 + signs * point)[:, ::-1]
            jacobian = slopes.T @ x
            gradient = np.linalg.solve(jacobian, slopes.T)
            strain = np.zeros((3, 8))
            strain[0, 0::2] = strain[2, 1::2] = gradient[0]
            strain[1, 1::2] = strain[2, 0::2] = gradient[1]
            volume = float(np.linalg.det(jacobian))
            stiffness += strain.T @ law @ strain * volume
            mass += DENSITY * np.outer(shape, shape) * volume
    return stiffness, mass


def weights(x: Array, donors: Array) -> Array | None:
    """Affine weights of donors for a node, eq. (2.18)."""
    arms = donors - x
    distances = np.hypot(*arms.T)
    h = distances.min()
    p = np.column_stack((np.ones(len(arms)), arms / h))
    phi = (h / distances) ** 2
    g = p.T @ (phi[:, None] * p)
    if len(donors) < 3 or np.linalg.cond(g) > 1e10:
        return None
    w = phi * (p @ np.linalg.solve(g, np.array((1.0, 0.0, 0.0))))
    return w if np.abs(w).sum() <= MOST_WEIGHT else None


def redistribution(mesh: GridMesh, skin: Sequence[int]) -> tuple[Array, list[int]]:
    """P over the nodes, and the nodes without mass."""
    x = np.array(mesh.nodes)
    around: list[set[int]] = [set() for _ in mesh.nodes]
    for element in mesh.elements:
        for node in element:
            around[node].update(element)
    massless = sorted(skin)
    while True:
        found = {}
        for node in massless:
            near = set().union(*(around[other] for other in around[node]))
            for _ in range(2):
                donors = sorted(near.difference(massless))
                w = weights(x[node], x[donors])
                if w is not None:
                    found[node] = donors, w
                    break
                near = near.union(*(around[other] for other in near))
        if len(found) == len(massless):
            break
        massless = sorted(found)
    p = np.eye(len(x))
    for node, (donors, w) in found.items():
        p[node] = 0.0
        p[node, donors] = w
    return p, massless


def frequencies(mesh: GridMesh, skin: Sequence[int]) -> tuple[Array, int]:
    """Elastic frequencies, lowest first, of a free body; number of nodes without mass."""
    x, n = np.array(mesh.nodes), len(mesh.nodes)
    stiffness, mass = np.zeros((2 * n, 2 * n)), np.zeros((n, n))
    for element in mesh.elements:
        k, m = element_matrices(x[list(element)])
        dofs = [2 * node + i for node in element for i in range(2)]
        stiffness[np.ix_(dofs, dofs)] += k
        mass[np.ix_(element, element)] += m
    p, massless = redistribution(mesh, skin)
    mass = p.T @ mass @ p
    inner = np.setdiff1d(np.arange(n), massless)
    i = np.sort(np.concatenate((2 * np.array(massless, int), 2 * np.array(massless, int) + 1)))
    j = np.sort(np.concatenate((2 * inner, 2 * inner + 1)))
    # nodes without mass follow in equilibrium
    k = stiffness[np.ix_(j, j)]
    k -= stiffness[np.ix_(j, i)] @ np.linalg.solve(stiffness[np.ix_(i, i)], stiffness[np.ix_(i, j)])
    root = np.linalg.cholesky(np.kron(mass[np.ix_(inner, inner)], np.eye(2)))
    half = np.linalg.solve(root, k)
    squares = np.linalg.eigvalsh(np.linalg.solve(root, half.T))
    return np.sqrt(squares[3 : 3 + MODES]) / (2 * pi), len(massless)


def beam(nx: int, ny: int) -> GridMesh:
    """A beam of 10 x 1."""
    nodes = [(10 * i / nx, j / ny) for j in range(ny + 1) for i in range(nx + 1)]
    row = nx + 1
    corners = [j * row + i for j in range(ny) for i in range(nx)]
    return GridMesh("BEAM", nodes, [(a, a + 1, a + row + 1, a + row) for a in corners])


def rim(mesh: GridMesh, has: int = 1) -> list[int]:
    """Nodes of the sides of one element; with `has` 2 without those of the inner half of a ring."""
    sides: dict[frozenset[int], int] = {}
    for element in mesh.elements:
        for a, b in zip(element, element[1:] + element[:1]):
            side = frozenset((a, b))
            sides[side] = sides.get(side, 0) + 1
    nodes = {node for side, count in sides.items() if count == 1 for node in side}
    if has == 2:
        radii = {node: float(np.hypot(*mesh.nodes[node])) for node in nodes}
        middle = 0.5 * (max(radii.values()) + min(radii.values()))
        nodes = {node for node in nodes if radii[node] > middle}
    return sorted(nodes)


def main() -> int:
    """Prints the table."""
    bodies = [
        *((f"ring {a} x {b}", ring("R", (0, 0), (0.8, 1.0), a, b), 2) for a, b in RINGS),
        *((f"beam {a} x {b}", beam(a, b), 1) for a, b in BEAMS),
        *((f"disc {a + 2 * b}", disc("D", (0, 0), 1.0, 0.0, a, b), 1) for a, b in DISCS),
    ]
    print("| body | without mass | " + " | ".join(f"f{k + 1}" for k in range(MODES)) + " |")
    print("|" + "---|" * (MODES + 2))
    for name, mesh, has in bodies:
        consistent, _ = frequencies(mesh, [])
        redistributed, count = frequencies(mesh, rim(mesh, has))
        changes = 100 * (redistributed / consistent - 1)
        print(f"| {name} | {count} | " + " | ".join(f"{c:+.2f}" for c in changes) + " |")
    return 0


RINGS = ((60, 2), (120, 4))
BEAMS = ((40, 4), (80, 8))
DISCS = ((6, 2), (12, 4), (24, 8))
"""Elements along a side of the square, and rings around it: both together across the disc."""

if __name__ == "__main__":
    sys.exit(main())
