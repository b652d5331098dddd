"""Cook's membrane, nearly incompressible, by another method: small strains, nine-node elements with linear pressure.

    python mixed.py 8 16 32      deflections of the middle of the right edge over the force
"""

import sys

import numpy as np

YOUNG, POISSON = 1.0, 0.4999
GAUSS = np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 9.0
SIDE = np.array([-1.0, 0.0, 1.0])


def lagrange(t: float) -> tuple[np.ndarray, np.ndarray]:
    """Quadratic shape functions on -1, 0, 1 and their derivatives."""
    return np.array([t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2]), np.array([t - 0.5, -2 * t, t + 0.5])


def element(x: np.ndarray) -> np.ndarray:
    """Stiffness of an element of plane strain, nodes [9, 2], the three pressures condensed."""
    mu = YOUNG / (2 * (1 + POISSON))
    bulk = YOUNG / (3 * (1 - 2 * POISSON))
    k, g, m = np.zeros((18, 18)), np.zeros((18, 3)), np.zeros((3, 3))
    deviator = mu * np.array([[4 / 3, -2 / 3, 0.0], [-2 / 3, 4 / 3, 0.0], [0.0, 0.0, 1.0]])
    centre = x.mean(axis=0)
    for r, wr in zip(*GAUSS):
        for s, ws in zip(*GAUSS):
            (nr, dr), (ns, ds) = lagrange(r), lagrange(s)
            n, local = np.outer(ns, nr).ravel(), np.array([np.outer(ns, dr).ravel(), np.outer(ds, nr).ravel()])
            jacobian = local @ x
            grad = np.linalg.solve(jacobian, local)
            w = wr * ws * np.linalg.det(jacobian)
            b = np.zeros((3, 18))
            b[0, ::2], b[1, 1::2] = grad
            b[2, ::2], b[2, 1::2] = grad[1], grad[0]
            p = np.array([1.0, *(n @ x - centre)])
            k += w * b.T @ deviator @ b
            g += w * np.outer(b[0] + b[1], p)
            m += w * np.outer(p, p) / bulk
    return k + g @ np.linalg.solve(m, g.T)


def deflection(n: int) -> float:
    """Deflection of (48, 52) over the force, n x n elements, solved column by column of nodes."""
    rows = 2 * n + 1
    u = np.linspace(0.0, 1.0, rows)
    x = np.array([[(48 * a, 44 * a + b * (44 - 28 * a)) for b in u] for a in u])
    size = 2 * rows
    # blocks of the columns 2e+1 and 2e+2; column 0 is held
    diagonal = [np.zeros((2 * size, 2 * size)) for _ in range(n)]
    upper = [np.zeros((2 * size, 2 * size)) for _ in range(n - 1)]
    for e in range(n):
        for j in range(n):
            nodes = [(2 * e + a, 2 * j + b) for b in range(3) for a in range(3)]
            k = element(np.array([x[i, l] for i, l in nodes]))
            dofs = [(i, 2 * l + c) for i, l in nodes for c in range(2)]
            for p, (i, f) in enumerate(dofs):
                for q, (h, t) in enumerate(dofs):
                    if i == 0 or h == 0:
                        continue
                    block, other = (i - 1) // 2, (h - 1) // 2
                    row, column = (i - 1) % 2 * size + f, (h - 1) % 2 * size + t
                    if block == other:
                        diagonal[block][row, column] += k[p, q]
                    elif other == block + 1:
                        upper[block][row, column] += k[p, q]
    load = np.zeros(2 * size)
    for j in range(n):  # a uniform shear traction of the sum 1 on the right edge
        for l, part in enumerate((1 / 6, 4 / 6, 1 / 6)):
            load[size + 2 * (2 * j + l) + 1] += part / n
    for e in range(n - 1):
        diagonal[e + 1] -= upper[e].T @ np.linalg.solve(diagonal[e], upper[e])
    return float(np.linalg.solve(diagonal[-1], load)[size + 2 * n + 1])


if __name__ == "__main__":
    for size in map(int, sys.argv[1:]):
        print(size, deflection(size))
