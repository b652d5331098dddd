"""Elements with a pressure of their own (CPE8H, CPE8RH) and rings with it, with enhanced strains and with one point."""

from itertools import product
from math import pi
from pathlib import Path

import numpy as np
import pytest
from bodies import (
    ELASTIC,
    NEO_HOOKE,
    SCHEMES,
    bodies,
    body,
    end,
    falling,
    gains_no_energy,
    grid,
    keeps_energy_and_momenta,
    solved,
    with_section,
)
from oracle.checks import assert_holds
from stickslip import Deck
from test_quadratic import DEPTH, FORCE, LENGTH, bent

PLANE = ("CPE8H", "CPE8RH")
RINGS = ("CAX4H", "CAX4I", "CAX4R", "CAX8H", "CAX8RH")
METAL = "*ELASTIC\n1000., 0.3\n*PLASTIC\n20., 0.\n40., 1."


@pytest.mark.parametrize(("kind", "poisson", "expected"), [("CPE8H", 0.3, 0.994), ("CPE8H", 0.499, 0.971), ("CPE8RH", 0.499, 0.973)])
def test_a_cantilever_does_not_lock(tmp_path: Path, kind: str, poisson: float, expected: float) -> None:
    """20 x 2 elements; clamped meshes with nu = 0.499 tend to 0.983 of Timoshenko's beam, CPE8 has 0.953 and CPE8R 0.957."""
    mesh = grid(kind, 20, 2, lambda x, y: (LENGTH * x, DEPTH * y))
    u = bent(tmp_path, kind, mesh, FORCE, 1000.0, poisson, 1.0, DEPTH)
    tip = np.argmin(np.hypot(*(mesh.points - (LENGTH, DEPTH / 2.0)).T))
    stiff, shear = 1000.0 / (1.0 - poisson**2), 1000.0 / (2.0 * (1.0 + poisson)) * DEPTH * 5.0 / 6.0
    beam = FORCE * (LENGTH**3 / (3.0 * stiff * DEPTH**3 / 12.0) + LENGTH / shear)
    assert u[tip, 1] / beam == pytest.approx(expected, abs=0.001)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", PLANE)
def test_a_free_body_keeps_energy_and_momenta(tmp_path: Path, kind: str, scheme: str) -> None:
    for law, damping in ((ELASTIC, ""), (NEO_HOOKE, ""), (NEO_HOOKE, "*DAMPING, BETA=0.002\n")):
        keeps_energy_and_momenta(tmp_path, bodies(kind, laws=(law,), damping=damping), scheme, damping)


def flying(kind: str, law: str, damping: str = "") -> Deck:
    """A distorted ring off the axis that flies and swings."""
    mesh = grid(kind, 2, 2, lambda x, y: (1.0 + x + 0.1 * y, y + 0.05 * np.sin(6.0 * x)))
    deck = Deck.titled(kind)
    deck.add_mesh(mesh)
    for card in deck.find("ELEMENT"):
        card.head = card.head.replace("CPE" + kind[3], kind)
    deck.extend(f"*MATERIAL, NAME=M\n{law}\n*DENSITY\n1.\n{damping}")
    with_section(deck, kind, "BODY", "M")
    nodes = [(n, *x) for n, x in enumerate(mesh.points.tolist(), 1)]
    rows = [(n, 1, 3.0 * x * y - 2.0) for n, x, y in nodes]
    rows += [(n, 2, 5.0 + 3.0 * x - 4.0 * y * y) for n, x, y in nodes]
    return deck.add("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)


FLIGHTS = [
    (kind, law)
    for kind, law in product(RINGS, (ELASTIC, NEO_HOOKE, "*HYPERELASTIC, YEOH\n150., 10., 2., 2.E-3, 0., 0.", METAL))
    if (kind, law) != ("CAX4R", METAL)
]


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(("kind", "law"), FLIGHTS + [(kind, METAL) for kind in PLANE])
def test_a_free_ring_keeps_energy_and_momentum(tmp_path: Path, kind: str, law: str, scheme: str) -> None:
    damped = "*DAMPING, BETA=0.002\n" if law == NEO_HOOKE else ""
    for damping in {"", damped}:
        deck = flying(kind, law, damping)
        deck.extend(f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.3\n*STICKSLIP, SCHEME={scheme}\n*END STEP\n")
        result = solved(tmp_path, deck)
        energy, axial = result.history.energy, result.history.momentum.linear[:, 1]
        assert np.abs(axial - axial[0]).max() < 1e-10 * abs(axial[0])
        total = energy.kinetic + energy.strain + energy.material_dissipation
        assert (energy.material_dissipation[-1] > 0.0) == (law == METAL)
        assert np.diff(energy.material_dissipation).min() >= 0.0
        if scheme == "ENERGY-MOMENTUM":
            assert np.diff(total).max() < 1e-10 * total[0]
            assert damping or np.abs(total - total[0]).max() < 1e-10 * total[0]
        assert_holds(result)


@pytest.mark.parametrize("kind", RINGS)
def test_a_thick_cylinder_of_a_nearly_incompressible_material(tmp_path: Path, kind: str) -> None:
    """Lame: u(a) = p a (1 + nu)/E ((1 - 2 nu) a² + b²)/(b² - a²), a = 1, b = 2, nu = 0.4999; CAX4 has a third of it."""
    poisson, pressure = 0.4999, 1e-4
    mesh = grid(kind, 8, 1, lambda x, y: (1.0 + x, 0.125 * y))
    deck = body(kind, mesh, 1000.0, poisson)
    deck.extend("*BOUNDARY\nNBOTTOM, 2\nNTOP, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
    u = end(solved(tmp_path, deck.add("DSLOAD", ("LEFT", "P", pressure)).extend("*END STEP\n")))
    exact = pressure * (1.0 + poisson) / 1000.0 * ((1.0 - 2.0 * poisson) + 4.0) / 3.0
    assert u[mesh.node_sets["NLEFT"], 0].mean() == pytest.approx(exact, rel=5e-3)


@pytest.mark.parametrize(("kind", "within"), [("CAX4I", 0.01), ("CAX4R", 0.01), ("CAX8RH", 0.01)])
def test_a_thin_washer_of_one_layer_tilts(tmp_path: Path, kind: str, within: float) -> None:
    """A flat ring a = 10, b = 11, t = 0.5 under a moment m per length all around turns by m r/(E t³ ln(b/a)/12 r)."""
    young, inner, outer, thick = 1000.0, 10.0, 11.0, 0.5
    mesh = grid(kind, 2, 1, lambda x, y: (inner + (outer - inner) * x, thick * y))
    deck = body(kind, mesh, young, 0.0)
    force = 1e-5
    deck.extend("*BOUNDARY\nNLEFT, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
    total = force
    deck.add("DSLOAD, FOLLOWER=NO", ("RIGHT", "TRVEC", total / (2.0 * pi * outer * thick), 0.0, 1.0))
    u = end(solved(tmp_path, deck.extend("*END STEP\n")))
    turn = u[mesh.node_sets["NRIGHT"], 1].mean() / (outer - inner)
    # rigid section: E int (y theta/r)² r dA 2 pi = F (b - a)/theta
    exact = total * (outer - inner) / (2.0 * pi * young * thick**3 / 12.0 * np.log(outer / inner))
    assert turn == pytest.approx(exact, rel=within + 0.02)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("pair", [("CPE8H", "CPE8RH")])
def test_bodies_in_contact_never_gain_energy(tmp_path: Path, pair: tuple[str, str], scheme: str) -> None:
    deck = falling(*pair, laws=(ELASTIC, NEO_HOOKE), friction=0.3)
    gains_no_energy(tmp_path, deck, scheme, "0.01, 0.3")
