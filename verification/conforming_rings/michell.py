"""Contact pressure of two rings without friction under the pressure p0 + p1 cos(2 theta): prints the rows of reference.csv.

Michell's functions phi = (A r^2 + B r^4 + C r^-2 + D) cos 2 theta give for each ring

    srr = -(2 A + 6 C r^-4 + 4 D r^-2) cos 2 theta,
    srt = (2 A + 6 B r^2 - 6 C r^-4 - 2 D r^-2) sin 2 theta,
    2 G ur = (-2 A r + (kappa - 3) B r^3 + 2 C r^-3 + (kappa + 1) D r^-1) cos 2 theta.
"""

import numpy as np

OUTER, MIDDLE, INNER = 1.0, 0.6, 0.2
POISSON = 0.2


def waves() -> float:
    """q1/p1: amplitude of the contact pressure over that of the load; like rings in plane strain."""
    kappa = 3 - 4 * POISSON

    def radial(r: float) -> list[float]:
        return [-2.0, 0.0, -6 / r**4, -4 / r**2]

    def shear(r: float) -> list[float]:
        return [2.0, 6 * r**2, -6 / r**4, -2 / r**2]

    def move(r: float) -> list[float]:
        return [-2 * r, (kappa - 3) * r**3, 2 / r**3, (kappa + 1) / r]

    none = [0.0] * 4
    rows = [
        radial(OUTER) + none,
        shear(OUTER) + none,
        shear(MIDDLE) + none,
        none + shear(MIDDLE),
        none + radial(INNER),
        none + shear(INNER),
        radial(MIDDLE) + [-x for x in radial(MIDDLE)],
        move(MIDDLE) + [-x for x in move(MIDDLE)],
    ]
    solved = np.linalg.solve(np.array(rows), np.array([-1.0] + [0.0] * 7))
    return float(-np.dot(radial(MIDDLE), solved[:4]))


def uniform(stress: bool) -> float:
    """q0/p0 by Lame; in plane stress or in plane strain, whose constants are E/(1-nu^2) and nu/(1-nu)."""
    nu = POISSON if stress else POISSON / (1 - POISSON)
    a, b, c = OUTER**2, MIDDLE**2, INNER**2
    return 2 * a / (b * (1 - nu) + a * (1 + nu) + (a - b) / (b - c) * (b * (1 - nu) + c * (1 + nu)))


def main() -> None:
    """Prints the rows."""
    print(f"uniform,,{uniform(True)!r},D,\"Lame, plane stress (Code_Aster SSNP152 has the same formula)\",")
    for k in range(19):
        angle = 5.0 * k
        value = uniform(False) + 0.1 * waves() * np.cos(np.radians(2 * angle))
        print(f"waves,{angle},{float(value)!r},D,Lame and Michell: michell.py,")


if __name__ == "__main__":
    main()
