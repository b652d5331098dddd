"""Pressure under a round flat punch with a rounded edge, from Sneddon's integrals (Ciavarella 1999): prints the rows of reference.csv.

With the profile f'(r) = (r - b)/R beyond the flat radius b,

    h(t) = t int_0^t f'(r)/sqrt(t^2-r^2) dr = t (sqrt(t^2-b^2) - b arccos(b/t))/R,
    approach = h(a),   F = 2 E* int_0^a (h(a) - h(t)) dt,   p(r) = E*/pi int_r^a h'(t)/sqrt(t^2-r^2) dt.
"""

import numpy as np

FLAT, CONTACT, ROUND = 10.0, 10.0 / 0.7, 100.0
MODULUS = 100e3 / (2 * (1 - 0.3**2))
"""E* of two like bodies."""


def slope(t: np.ndarray) -> np.ndarray:
    """h'(t)."""
    t = np.maximum(t, FLAT)
    return (2 * np.sqrt(t**2 - FLAT**2) - FLAT * np.arccos(FLAT / t)) / ROUND


def approach(t: np.ndarray) -> np.ndarray:
    """h(t)."""
    t = np.maximum(t, FLAT)
    return t * (np.sqrt(t**2 - FLAT**2) - FLAT * np.arccos(FLAT / t)) / ROUND


def force() -> float:
    """F, as a = CONTACT gives it."""
    t = np.linspace(0.0, CONTACT, 200001)
    return float(2 * MODULUS * np.trapezoid(approach(np.array(CONTACT)) - approach(t), t))


def pressure(r: float) -> float:
    """p(r); t^2 = r^2 + u^2 takes the singularity out of the integral."""
    start = np.sqrt(max(FLAT**2 - r**2, 0.0))
    end = np.sqrt(CONTACT**2 - r**2)
    u = start + (end - start) * np.linspace(0.0, 1.0, 20001) ** 2
    t = np.sqrt(r**2 + u**2)
    return float(MODULUS / np.pi * np.trapezoid(slope(t) / t, u))


def main() -> None:
    """Prints the rows: mean pressure, then p over the mean pressure."""
    mean = force() / (np.pi * CONTACT**2)
    print(f"# F = {force():.6g}, approach {approach(np.array(CONTACT)):.6g}")
    print(f"mean,,{mean!r},D,F/(pi a^2) with Sneddon's F,")
    for k in range(1, 20):
        x = k / 20
        print(f"p,{x},{pressure(x * CONTACT) / mean!r},D,\"Ciavarella 1999, by Sneddon's integrals: sneddon.py\",")


if __name__ == "__main__":
    main()
