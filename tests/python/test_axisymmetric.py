"""Elements of bodies of revolution against closed forms, in free flight, in contact and under their loads."""

import subprocess
from math import pi
from pathlib import Path

import numpy as np
import pytest
from bodies import (
    ELASTIC,
    NEO_HOOKE,
    SCHEMES,
    body,
    end,
    gains_no_energy,
    grid,
    solved,
    with_section,
)
from oracle.checks import assert_holds
from oracle.shapes import gradients, integration_rule, shape_functions
from stickslip import Deck, program
from stickslip.result import Result

KINDS = ("CAX3", "CAX4", "CAX6", "CAX8", "CAX8R")
ALL_KINDS = (*KINDS, "CAX4H", "CAX4I", "CAX4R", "CAX8H", "CAX8RH")


@pytest.mark.parametrize(
    ("kind", "count", "error"),
    [
        ("CAX3", 16, 2e-3),
        ("CAX4", 16, 1e-3),
        ("CAX6", 8, 1e-4),
        ("CAX8", 8, 1e-4),
        ("CAX8R", 8, 1e-4),
    ],
)
def test_a_thick_cylinder_under_pressure(tmp_path: Path, kind: str, count: int, error: float) -> None:
    """Lame: u(a) of a long cylinder, a = 1, b = 2, held at its ends, pressure p inside.

    u(a) = p a (1 + nu)/E ((1 - 2 nu) a^2 + b^2)/(b^2 - a^2); sigma_rr(a) = -p
    """
    young, poisson, pressure = 1000.0, 0.3, 1e-4
    mesh = grid(kind, count, 2, lambda x, y: (1.0 + x, 0.25 * y))
    deck = body(kind, mesh, young, poisson)
    deck.extend("*BOUNDARY\nNBOTTOM, 2\nNTOP, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
    deck.add("DSLOAD", ("LEFT", "P", pressure))
    u = end(solved(tmp_path, deck.extend("*END STEP\n")))
    exact = pressure * (1.0 + poisson) / young * ((1.0 - 2.0 * poisson) + 4.0) / 3.0
    assert u[mesh.node_sets["NLEFT"], 0].mean() == pytest.approx(exact, rel=error)


@pytest.mark.parametrize("kind", ALL_KINDS)
def test_the_displacements_of_a_cylinder_are_of_second_and_third_order(tmp_path: Path, kind: str) -> None:
    """In L2, against Lame, on distorted meshes."""
    young, poisson, pressure = 1.0, 0.3, 1e-9
    errors = []
    for count in (4, 8, 16):
        place = lambda x, y: (1.0 + x + 0.05 * np.sin(pi * x) * np.sin(6.0 * y), 0.5 * y)  # noqa: E731
        mesh = grid(kind, count, count, place)
        deck = body(kind, mesh, young, poisson)
        deck.extend("*BOUNDARY\nNBOTTOM, 2\nNTOP, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
        deck.add("DSLOAD", ("LEFT", "P", pressure)).extend("*END STEP\n")
        u = end(solved(tmp_path, deck))
        of_nodes = np.array(mesh.elements)
        rule = integration_rule({3: 6, 4: 8}.get(of_nodes.shape[1], of_nodes.shape[1]), False)
        shape, _ = shape_functions(of_nodes.shape[1], rule[0])
        area = gradients(mesh.points[of_nodes], rule)[1]
        at, found = (np.einsum("ga,eai->egi", shape, v[of_nodes]) for v in (mesh.points, u))
        r = at[..., 0]
        radial = (1.0 + poisson) * pressure / (3.0 * young) * ((1.0 - 2.0 * poisson) * r + 4.0 / r)
        square = (found[..., 0] - radial) ** 2 + found[..., 1] ** 2
        errors.append(np.sqrt((area * r * square).sum()))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] > (1.9 if kind[3] in "34" else 2.85), orders


@pytest.mark.parametrize("kind", ALL_KINDS)
def test_patch_of_distorted_rings(tmp_path: Path, kind: str) -> None:
    """All of a disc on its axis is stretched alike: u = a x has one stress everywhere, also at large strains.

    Enhanced strains are unstable from a stretch of 1.099 on.
    """
    part = 0.05 if kind == "CAX4I" else 0.1
    bent = lambda x, y: (2.0 * x, y + 0.08 * np.sin(5.0 * x) * (0.0 < y < 1.0))  # noqa: E731
    mesh = grid(kind, 4, 3, bent, curved=kind[3] in "34")
    deck = Deck.titled(kind)
    deck.add_mesh(mesh)
    for card in deck.find("ELEMENT"):
        card.head = card.head.replace("CPE" + kind[3], kind)
    deck.extend(f"*MATERIAL, NAME=M\n{NEO_HOOKE}\n*DENSITY\n1.\n")
    with_section(deck, kind, "BODY", "M")
    moved = f"NRIGHT, 1, 1, {2.0 * part}\nNTOP, 2, 2, {part}\n"
    deck.extend("*BOUNDARY\nNLEFT, 1\nNBOTTOM, 2\n")
    deck.extend(f"*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*BOUNDARY\n{moved}*END STEP\n")
    path = deck.write(tmp_path / "patch.inp")
    result = program.run(path, tmp_path)
    u = end(result)
    assert u == pytest.approx(mesh.points * part, abs=1e-11)
    # F = s I: sigma = 2 (J - 1)/D1 I, W = (J - 1)^2/D1
    grown = (1.0 + part) ** 3 - 1.0
    p = 2.0 * grown / 2e-3
    stress = result.frames[-1]["S"]
    assert np.abs(stress[:, :2] - p).max() < 1e-9 * p and np.abs(stress[:, 2]).max() < 1e-9 * p
    energy = grown**2 / 2e-3 * pi * 4.0 * 1.0
    assert result.history.energy.strain[-1] == pytest.approx(energy, rel=1e-12)
    reaction = result.frames[-1]["RF"][mesh.node_sets["NTOP"], 1].sum()
    assert reaction == pytest.approx(p * pi * (2.0 * (1.0 + part)) ** 2, rel=1e-9)


def ring(kind: str, law: str, damping: str = "") -> Deck:
    """A distorted ring off the axis."""
    mesh = grid(kind, 4, 3, lambda x, y: (1.0 + x + 0.1 * y, y + 0.05 * np.sin(6.0 * x)))
    deck = Deck.titled(kind)
    deck.add_mesh(mesh)
    for card in deck.find("ELEMENT"):
        card.head = card.head.replace("CPE" + kind[3], kind)
    deck.extend(f"*MATERIAL, NAME=M\n{law}\n*DENSITY\n1.\n{damping}")
    return with_section(deck, kind, "BODY", "M")


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_free_ring_keeps_energy_and_momentum(tmp_path: Path, kind: str, scheme: str) -> None:
    for law, damping in ((ELASTIC, ""), (NEO_HOOKE, "*DAMPING, BETA=0.002\n")):
        deck = ring(kind, law, damping)
        nodes = [(int(row[0]), float(row[1]), float(row[2])) for row in deck.one("NODE").rows]
        rows = [(n, 1, 3.0 * x * y - 2.0) for n, x, y in nodes]
        rows += [(n, 2, 5.0 + 3.0 * x - 4.0 * y * y) for n, x, y in nodes]
        deck.add("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)
        deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.6\n")
        deck.extend(f"*STICKSLIP, SCHEME={scheme}\n*END STEP\n")
        result = solved(tmp_path, deck)
        history = result.history
        axial = history.momentum.linear[:, 1]
        assert np.abs(axial - axial[0]).max() < 1e-10 * abs(axial[0])
        assert (history.momentum.linear[:, 0] == 0.0).all()
        total = history.energy.kinetic + history.energy.strain
        if scheme == "ENERGY-MOMENTUM":
            assert np.diff(total).max() < 1e-10 * total[0]
            if not damping:
                assert np.abs(total - total[0]).max() < 1e-10 * total[0]
        assert_holds(result)


def blocks(kind: str, other: str, friction: float) -> Deck:
    """A puck on a plate, both on the axis, in general contact; the puck starts above the plate and grows and shrinks."""
    deck = Deck.titled("puck")
    places = (
        lambda x, y: (2.0 * x, 0.5 * y - 0.5),
        lambda x, y: (1.0 * x, 0.6 * y + 0.01),
    )
    for number, (name, place) in enumerate(zip((kind, other), places)):
        mesh = grid(name, 5 - number, 2, place)
        key = f"B{number}"
        mesh.element_sets = {key: v for v in mesh.element_sets.values()}
        mesh.node_sets = {k + key: v for k, v in mesh.node_sets.items()}
        mesh.sides = {}
        before = len(deck.find("ELEMENT"))
        deck.add_mesh(mesh)
        for card in deck.find("ELEMENT")[before:]:
            card.head = card.head.replace("CPE" + name[3], name)
        deck.extend(f"*MATERIAL, NAME=M{key}\n{(ELASTIC, NEO_HOOKE)[number]}\n*DENSITY\n1.\n")
        with_section(deck, name, key, f"M{key}")
    deck.general_contact(friction)
    deck.support("NBOTTOMB0", 2).support("NLEFTB0", 1).support("NLEFTB1", 1)
    return deck.velocity("B1", 0.0, -2.0)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("pair", "friction"),
    [(("CAX4", "CAX3"), 0.3), (("CAX8R", "CAX6"), 0.0), (("CAX4R", "CAX4I"), 0.3), (("CAX4H", "CAX8RH"), 0.0)],
)
def test_bodies_of_revolution_in_contact_never_gain_energy(
    tmp_path: Path, pair: tuple[str, str], friction: float, scheme: str
) -> None:
    gains_no_energy(tmp_path, blocks(*pair, friction), scheme, "0.005, 0.2")


@pytest.mark.parametrize("kind", ALL_KINDS)
def test_loads_are_totals_around_the_axis(tmp_path: Path, kind: str) -> None:
    """Weight, pressure on a cone, traction, force per volume: their resultants along the axis."""
    radius, height, density = 2.0, 1.5, 3.0
    mesh = grid(kind, 3, 2, lambda x, y: (radius * x, height * y + 0.5 * x))
    deck = Deck.titled(kind)
    deck.add_mesh(mesh)
    for card in deck.find("ELEMENT"):
        card.head = card.head.replace("CPE" + kind[3], kind)
    deck.extend(f"*MATERIAL, NAME=M\n*ELASTIC\n1.E9, 0.3\n*DENSITY\n{density}\n")
    with_section(deck, kind, "BODY", "M")
    deck.extend("*BOUNDARY\nNLEFT, 1\nNBOTTOM, 2\n")
    area = pi * radius**2
    slant = pi * radius * np.hypot(radius, 0.5)
    loads = {
        "*DLOAD\n, GRAV, 9.81, 0., -1.\n": 9.81 * density * area * height,
        "*DLOAD\n, BZ, -7.\n": 7.0 * area * height,
        "*DSLOAD\nTOP, P, 4.\n": 4.0 * area,
        "*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 4., 0., -1.\n": 4.0 * slant,
        f"*CLOAD\n{mesh.node_sets['NTOP'][1] + 1}, 2, -5.\n": 5.0,
    }
    for load, total in loads.items():
        path = tmp_path / "load.inp"
        path.write_text(deck.text() + f"*STEP, NLGEOM\n*STATIC\n1., 1.\n{load}*END STEP\n")
        result = program.run(path, tmp_path)
        reaction = result.frames[-1]["RF"][mesh.node_sets["NBOTTOM"], 1].sum()
        assert reaction == pytest.approx(total, rel=1e-6), load


def test_a_press_fit_of_rings(tmp_path: Path) -> None:
    """A ring on a hollow shaft of the same material with the overlap d, ends held (Lame): p = d/(c (A + B)),

    A = (1 + nu)/E ((1 - 2 nu) c^2 + a^2)/(c^2 - a^2), B alike with b outside
    """
    young, poisson, overlap = 1000.0, 0.3, 1e-5
    a, c, b = 0.5, 1.0, 2.0
    deck = Deck.titled("press fit")
    for key, (inside, outside), count in (("S", (a, c + overlap), 8), ("R", (c, b), 12)):
        mesh = grid("CAX8", count, 1, lambda x, y: (inside + (outside - inside) * x, 0.1 * y))
        mesh.element_sets = {key: v for v in mesh.element_sets.values()}
        mesh.node_sets = {k + key: v for k, v in mesh.node_sets.items()}
        mesh.sides = {k + key: v for k, v in mesh.sides.items()}
        before = len(deck.find("ELEMENT"))
        deck.add_mesh(mesh)
        for card in deck.find("ELEMENT")[before:]:
            card.head = card.head.replace("CPE8", "CAX8")
    deck.elastic("M", young, poisson, 1.0)
    for key in "SR":
        with_section(deck, "CAX8", key, "M")
        deck.support(f"NBOTTOM{key}", 2).support(f"NTOP{key}", 2)
    deck.contact("RIGHTS", "LEFTR")
    deck.extend("*STEP, NLGEOM\n*STATIC\n1., 1.\n*CONTACT INTERFERENCE, SHRINK\nRIGHTS, LEFTR\n*END STEP\n")
    result = solved(tmp_path, deck)
    inner = (1.0 - 2.0 * poisson) * c**2 + a**2
    outer = (1.0 - 2.0 * poisson) * c**2 + b**2
    compliance = (1.0 + poisson) / young * (inner / (c**2 - a**2) + outer / (b**2 - c**2))
    pressure = overlap / (c * compliance)
    (contact,) = result.contact.values()
    total = np.hypot(*np.abs(contact["force"][-1]))
    assert total == pytest.approx(pressure * 2.0 * pi * c * 0.1, rel=2e-3)
    found = result.frames[-1]["CONTACT_PRESSURE"]
    found = found[np.isfinite(found) & (found > 0.0)]
    assert found == pytest.approx(pressure, rel=2e-3)


def test_an_inflated_tube_of_rubber(tmp_path: Path) -> None:
    """Nearly incompressible neo-Hooke, a = 1.5 A, ends held: p = int (sigma_tt - sigma_rr) dr/r, r² - a² = R² - A²."""
    shear, bulk = 400.0, 4e6
    mesh = grid("CAX8R", 6, 1, lambda x, y: (1.0 + x, 0.2 * y))
    deck = Deck.titled("tube")
    deck.add_mesh(mesh)
    for card in deck.find("ELEMENT"):
        card.head = card.head.replace("CPE8", "CAX8R")
    deck.extend(f"*MATERIAL, NAME=M\n*HYPERELASTIC, NEO HOOKE\n{shear / 2}, {2.0 / bulk}\n*DENSITY\n1.\n")
    with_section(deck, "CAX8R", "BODY", "M")
    deck.extend("*BOUNDARY\nNBOTTOM, 2\nNTOP, 2\n")
    deck.extend("*STEP, NLGEOM\n*STATIC\n0.1, 1.\n*BOUNDARY\nNLEFT, 1, 1, 0.5\n*END STEP\n")
    result = solved(tmp_path, deck)
    radius = np.linspace(1.0, 2.0, 20001)
    now = np.sqrt(1.5**2 + radius**2 - 1.0)
    stretch = now / radius
    integrand = shear * (stretch**2 - stretch**-2) / now**2 * radius
    pressure = float(np.sum(0.5 * (integrand[1:] + integrand[:-1]) * np.diff(radius)))
    force = result.frames[-1]["RF"][mesh.node_sets["NLEFT"], 0].sum()
    assert force == pytest.approx(pressure * 2.0 * pi * 1.5 * 0.2, rel=2e-3)


FAULTS = {
    "D322": [
        ("CAX4", "*NODE\n900, -1., 0.\n901, -0.5, 0.\n902, -0.5, 1.\n*ELEMENT, TYPE=CAX3, ELSET=BODY\n900, 900, 901, 902\n"),
        ("CAX4", "*NODE\n900, 5., 0.\n901, 6., 0.\n902, 6., 1.\n*ELEMENT, TYPE=CPE3, ELSET=BODY\n900, 900, 901, 902\n"),
    ],
    "D323": [("CAX4", "")],
}


@pytest.mark.parametrize("code", FAULTS)
def test_what_is_wrong_around_an_axis_is_told(tmp_path: Path, code: str) -> None:
    for kind, cards in FAULTS[code]:
        mesh = grid(kind, 2, 2, lambda x, y: (x, y))
        deck = Deck.titled(kind)
        deck.add_mesh(mesh)
        for card in deck.find("ELEMENT"):
            card.head = card.head.replace("CPE4", "CAX4")
        deck.extend(cards + "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n")
        with_section(deck, kind, "BODY", "M")
        deck.extend("*BOUNDARY\nNBOTTOM, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*END STEP\n")
        path = deck.write(tmp_path / "fault.inp")
        told = subprocess.run(
            [program.binary(), "check", path], capture_output=True, text=True, check=False
        )
        assert code in told.stdout + told.stderr, told.stdout + told.stderr
