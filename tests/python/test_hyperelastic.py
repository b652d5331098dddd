"""Hyperelastic materials in plane strain and plane stress against closed forms, in flight and in contact."""

import itertools
from pathlib import Path

import numpy as np
import pytest
from bodies import (
    IMPACTS,
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
)
from stickslip.deck import Deck

LAWS = {
    "neo-Hooke": NEO_HOOKE,
    "elastic neo-Hooke": "*ELASTIC, TYPE=NEO HOOKE\n1000., 0.3",
    "Hencky": "*ELASTIC, TYPE=HENCKY\n1000., 0.3",
    "Mooney-Rivlin": "*HYPERELASTIC, MOONEY-RIVLIN\n150., 50., 2.E-3",
    "Yeoh": "*HYPERELASTIC, YEOH\n200., -20., 5., 2.E-3, 1.E-2, 3.E-2",
}
KINDS = ("CPE3", "CPE4", "CPE6", "CPE8", "CPE8R", "CPS3", "CPS4", "CPS6", "CPS8", "CPS8R")


def with_law(deck: Deck, law: str) -> Deck:
    """The deck with another law."""
    card, row = law.split("\n")
    for old in deck.find("ELASTIC"):
        old.keyword, old.head, old.rows = card[1:].split(",")[0], card, [row.split(", ")]
    return deck


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_free_body_keeps_energy_and_momenta(
    tmp_path: Path, kind: str, law: str, scheme: str
) -> None:
    damping = "*DAMPING, BETA=0.002\n" if kind[3] == "4" else ""
    deck = bodies(kind, laws=(LAWS[law],), damping=damping)
    keeps_energy_and_momenta(tmp_path, deck, scheme, damping)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("pair", "friction"),
    [(("CPS4", "CPS8R"), 0.0), (("CPE4", "CPE6"), 0.3), (("CPS3", "CPS4"), 0.3), (("CPE8", "CPE3"), 0.0)],
)
def test_unlike_bodies_in_contact_never_gain_energy(
    tmp_path: Path, pair: tuple[str, str], friction: float, scheme: str
) -> None:
    deck = falling(*pair, laws=(LAWS["Yeoh"], LAWS["Mooney-Rivlin"]), friction=friction)
    gains_no_energy(tmp_path, deck, scheme, impacts=("", IMPACTS[2]))


def tension(
    tmp_path: Path, law: str, stretch: float, width: float | None = None, kind: str = "CPS4"
) -> float:
    """Nominal stress of a square with a stretch, and with its width kept or free."""
    deck = with_law(body(kind, grid(kind, 2, 2, lambda x, y: (x, y)), 1.0, 0.3), law)
    deck.extend("*BOUNDARY\nNLEFT, 1\nNBOTTOM, 2\n")
    top = "" if width is None else f"NTOP, 2, 2, {width - 1.0!r}\n"
    deck.extend("*STEP, NLGEOM\n*STATIC\n0.1, 1.\n")
    deck.extend(f"*BOUNDARY\nNRIGHT, 1, 1, {stretch - 1.0!r}\n{top}")
    deck.extend("*NODE PRINT, NSET=NRIGHT, TOTALS=ONLY\nRF\n*END STEP\n")
    return float(solved(tmp_path, deck).history.nodes.NRIGHT["sum/RF"][-1, 0])


@pytest.mark.parametrize("stretch", [0.5, 0.8, 1.5, 3.0])
@pytest.mark.parametrize("law", ["neo-Hooke", "Mooney-Rivlin", "Yeoh"])
def test_tension_of_a_nearly_incompressible_sheet(tmp_path: Path, law: str, stretch: float) -> None:
    """Beside the closed form of an incompressible one, 2 (w' + C01/l) (l - 1/l^2) of a strip.

    K/mu = 1e4 leaves 2e-3 of the force of Yeoh's material, which is four times stiffer at a stretch of 3; 1e6 leaves 2e-5.
    """
    c10, c01, c20, c30 = {
        "neo-Hooke": (200.0, 0.0, 0.0, 0.0),
        "Mooney-Rivlin": (150.0, 50.0, 0.0, 0.0),
        "Yeoh": (200.0, 0.0, -20.0, 5.0),
    }[law]
    ratio, part = (1e6, 5e-5) if stretch == 3.0 else (1e4, 5e-4)
    d1 = 2.0 / (ratio * 400.0)
    row = {
        "neo-Hooke": f"*HYPERELASTIC, NEO HOOKE\n{c10}, {d1!r}",
        "Mooney-Rivlin": f"*HYPERELASTIC, MOONEY-RIVLIN\n{c10}, {c01}, {d1!r}",
        "Yeoh": f"*HYPERELASTIC, YEOH\n{c10}, {c20}, {c30}, {d1!r}, 0., 0.",
    }[law]

    def slope(x: float) -> float:
        return c10 + 2.0 * c20 * x + 3.0 * c30 * x * x

    x = stretch**2 + 2.0 / stretch - 3.0
    strip = 2.0 * (slope(x) + c01 / stretch) * (stretch - stretch**-2)
    assert tension(tmp_path, row, stretch) == pytest.approx(strip, rel=part)
    if stretch in (0.8, 1.5):
        x = 2.0 * stretch**2 + stretch**-4 - 3.0
        both = 2.0 * (slope(x) + c01 * stretch**2) * (stretch - stretch**-5)
        assert tension(tmp_path, row, stretch, stretch) == pytest.approx(both, rel=part)


@pytest.mark.parametrize("kind", ["CPS4", "CPE8R", "CPS6"])
def test_tension_of_henckys_material(tmp_path: Path, kind: str) -> None:
    """E' ln(l)/l with E' = E in plane stress and E/(1 - nu^2) in plane strain; the deck is that of `Deck.hencky`."""
    material = Deck.titled("").hencky("M", 1000.0, 0.3, 1.0).find("ELASTIC")[0]
    law = f"{material.head}\n{', '.join(map(str, material.rows[0]))}"
    modulus = 1000.0 / (1.0 - 0.3**2 if kind.startswith("CPE") else 1.0)
    for stretch in (0.6, 0.8, 1.5, 2.5):
        force = tension(tmp_path, law, stretch, kind=kind)
        assert force == pytest.approx(modulus * np.log(stretch) / stretch, rel=1e-8)


@pytest.mark.parametrize(
    "law",
    [
        "*HYPERELASTIC\n150., 50., {d1}",
        "*HYPERELASTIC, POLYNOMIAL, N=1\n150., 50., {d1}",
        "*HYPERELASTIC, NEO HOOKE\n200., {d1}",
        "*HYPERELASTIC, YEOH\n200., 0., 0., {d1}",
    ],
)
def test_d1_of_zero_is_all_but_incompressible(tmp_path: Path, law: str) -> None:
    """D1 = 0 is D1 = 2/(1e4 mu); in plane strain the nominal stress is mu (l - l^-3) with mu = 2 (C10 + C01)."""
    of_zero, given = (law.format(d1=d1) for d1 in ("0.", "5.E-7"))
    for kind, stretch in itertools.product(("CPE4H", "CPE8R"), (0.7, 1.4)):
        force = tension(tmp_path, of_zero, stretch, kind=kind)
        assert force == pytest.approx(400.0 * (stretch - stretch**-3), rel=3e-4)
    assert tension(tmp_path, of_zero, 1.4) == pytest.approx(tension(tmp_path, given, 1.4), rel=1e-12)


def test_young_and_poisson_give_the_neo_hookean_material(tmp_path: Path) -> None:
    """E = 9 K mu/(3 K + mu), nu = (3 K - 2 mu)/(6 K + 2 mu): the same motion for C10, D1."""
    k, mu = 1000.0, 400.0
    young, poisson = 9.0 * k * mu / (3.0 * k + mu), (3.0 * k - 2.0 * mu) / (6.0 * k + 2.0 * mu)
    ends = []
    for law in (NEO_HOOKE, f"*ELASTIC, TYPE=NEO HOOKE\n{young!r}, {poisson!r}"):
        deck = bodies("CPS4", laws=(law,)).support("NBOTTOMB0")
        deck.extend("*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*DLOAD\n, GRAV, 60., 0., -1.\n*END STEP\n")
        ends.append(end(solved(tmp_path, deck)))
    assert np.abs(ends[0]).max() > 0.02
    assert np.abs(ends[1] - ends[0]).max() < 1e-10 * np.abs(ends[0]).max()
