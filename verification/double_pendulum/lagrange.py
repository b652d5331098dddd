"""The double pendulum by Lagrange's equations and the method of Runge and Kutta: prints the rows of reference.csv.

With m, L, I = m (L^2 + d^2)/12 of each rod and the angles a, b from the vertical,

    (I + 5/4 m L^2) a'' + m L^2/2 cos(a-b) b'' + m L^2/2 sin(a-b) b'^2 + 3/2 m g L sin a = 0,
    m L^2/2 cos(a-b) a'' + (I + m L^2/4) b'' - m L^2/2 sin(a-b) a'^2 + 1/2 m g L sin b = 0.
"""

import numpy as np

LENGTH, DEPTH, GRAVITY, ANGLES = 1.0, 0.1, 9.81, (1.2, 0.6)


def rates(state: np.ndarray) -> np.ndarray:
    """Time derivative of angles and angular velocities; m = 1."""
    a, b, p, q = state
    inertia = (LENGTH**2 + DEPTH**2) / 12
    half = LENGTH**2 / 2
    mass = np.array(
        [[inertia + 1.25 * LENGTH**2, half * np.cos(a - b)], [half * np.cos(a - b), inertia + LENGTH**2 / 4]]
    )
    load = [
        -half * np.sin(a - b) * q**2 - 1.5 * GRAVITY * LENGTH * np.sin(a),
        half * np.sin(a - b) * p**2 - 0.5 * GRAVITY * LENGTH * np.sin(b),
    ]
    return np.array([p, q, *np.linalg.solve(mass, load)])


def main() -> None:
    """Prints the rows."""
    state, dt = np.array([*ANGLES, 0.0, 0.0]), 1e-4
    for k in range(1, 20001):
        one = rates(state)
        two = rates(state + dt / 2 * one)
        three = rates(state + dt / 2 * two)
        four = rates(state + dt * three)
        state = state + dt / 6 * (one + 2 * two + 2 * three + four)
        if k % 1000 == 0:
            a, b = state[:2]
            x = LENGTH * (np.sin(a) + np.sin(b) - np.sin(ANGLES[0]) - np.sin(ANGLES[1]))
            print(f"end,{k * dt:.1f},{float(x)!r},C,Lagrange's equations by Runge and Kutta: lagrange.py,")
    print(f"last,,{float(x)!r},C,Lagrange's equations by Runge and Kutta: lagrange.py,")


if __name__ == "__main__":
    main()
