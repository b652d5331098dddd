"""Centrifugal forces (`*DLOAD ..., CENTRIF`) against closed forms, in static steps and in motion."""

from pathlib import Path

import numpy as np
import pytest
from bodies import body, end, grid, solved
from oracle.checks import assert_holds
from oracle.elements import Elements

YOUNG, POISSON = 1000.0, 0.3


@pytest.mark.parametrize(("kind", "count", "error"), [("CAX4I", 16, 2e-3), ("CAX4R", 16, 2e-3), ("CAX8R", 8, 1e-5), ("CAX8H", 8, 1e-5)])
def test_a_turning_cylinder_held_at_its_ends(tmp_path: Path, kind: str, count: int, error: float) -> None:
    """A hollow one, a = 1, b = 2, rho = 1: u(b) by Timoshenko & Goodier, art. 32, for plane strain.

    With E' = E/(1 - nu²), n = nu/(1 - nu): u = rho w² r (3 + n)(1 - n)/(8 E') (a² + b² - (1 + n)/(3 + n) r² + (1 + n)/(1 - n) a² b²/r²)
    """
    square = 1e-6
    mesh = grid(kind, count, 1, lambda x, y: (1.0 + x, 0.1 * y))
    deck = body(kind, mesh, YOUNG, POISSON)
    deck.extend("*BOUNDARY\nNBOTTOM, 2\nNTOP, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
    deck.extend(f"*DLOAD\nBODY, CENTRIF, {square}, 0., 0., 0., 0., 1., 0.\n*END STEP\n")
    u = end(solved(tmp_path, deck))[mesh.node_sets["NRIGHT"], 0].mean()
    stiff, n, r = YOUNG / (1.0 - POISSON**2), POISSON / (1.0 - POISSON), 2.0
    part = 1.0 + 4.0 - (1.0 + n) / (3.0 + n) * r**2 + (1.0 + n) / (1.0 - n) * 4.0 / r**2
    assert u == pytest.approx(square * r * (3.0 + n) * (1.0 - n) / (8.0 * stiff) * part, rel=error)


@pytest.mark.parametrize("kind", ["CPS4", "CPE8R"])
def test_the_resultant_is_that_of_the_centre_of_mass(tmp_path: Path, kind: str) -> None:
    """omega² m (x_c - x_axis), also where the body has moved: the force follows the place of the mass."""
    mesh = grid(kind, 3, 2, lambda x, y: (2.0 * x + 0.1 * y, y + 0.05 * np.sin(5.0 * x)))
    deck = body(kind, mesh, 1e4, POISSON, 0.5)
    deck.extend("*BOUNDARY\nNLEFT, 1, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nNLEFT, 1, 1, 0.25\n")
    deck.extend("*DLOAD\nBODY, CENTRIF, 4., 0.5, -3., 0., 0., 0., 1.\n*END STEP\n")
    result = solved(tmp_path, deck)
    mass = result.read("model/bodies/mass")[0]
    frame = result.frames[-1]
    pulled = frame["RF"][mesh.node_sets["NLEFT"]].sum(axis=0)
    # the mass at the nodes as the oracle computes it
    place = Elements(result).momentum(mesh.points + frame["U"]).sum(axis=0)
    assert pulled == pytest.approx(-4.0 * (place - mass * np.array([0.5, -3.0])), rel=1e-9)
    assert_holds(result)


@pytest.mark.parametrize("kind", ["CPE4", "CAX8R"])
def test_its_work_is_exact_in_motion(tmp_path: Path, kind: str) -> None:
    """The ledger is closed, and energy less omega²/2 int rho x² dOmega is constant."""
    mesh = grid(kind, 3, 2, lambda x, y: (1.0 + x, y))
    deck = body(kind, mesh, YOUNG, POISSON)
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.6\n")
    axis = "0., 1., 0." if kind[1] == "A" else "0., 0., 1."
    deck.extend(f"*DLOAD\nBODY, CENTRIF, 9., 0., 0., 0., {axis}\n*OUTPUT, FIELD, FREQUENCY=1\n*END STEP\n")
    result = solved(tmp_path, deck)
    energy = result.history.energy
    total = energy.kinetic + energy.strain - energy.external_work
    assert energy.strain.max() > 0.0
    assert np.abs(total - total[0]).max() < 1e-10 * energy.largest
    elements, directions = Elements(result), 1 if kind[1] == "A" else 2

    def potential(u: np.ndarray) -> float:
        x = mesh.points + u
        x[:, directions:] = 0.0
        return 4.5 * float((x * elements.momentum(x)).sum())

    work = potential(end(result)) - potential(np.zeros_like(mesh.points))
    assert energy.external_work[-1] == pytest.approx(work, rel=1e-9)
