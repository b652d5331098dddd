"""CPE4I, CPS4I, CPE4R, CPS4R against closed forms and published beams, in free flight and in contact."""

from pathlib import Path

import numpy as np
import pytest
from bodies import (
    ELASTIC,
    NEO_HOOKE,
    SCHEMES,
    bodies,
    falling,
    gains_no_energy,
    grid,
    keeps_energy_and_momenta,
)
from test_quadratic import DEPTH, FORCE, LENGTH, bent


LETTERS = ("I", "R")
"""Both bend alike: the hourglass modes of the second kind have the stiffness of the enhanced strains of the first."""


@pytest.mark.parametrize("letter", LETTERS)
@pytest.mark.parametrize(
    ("plane", "poisson", "count", "expected"),
    [
        ("CPS", 0.3, (10, 1), 0.996),
        ("CPE", 0.3, (20, 2), 0.992),
        ("CPE", 0.499, (20, 2), 0.961),
        ("CPE", 0.499, (10, 1), 0.996),
    ],
)
def test_a_cantilever_bends_as_timoshenko_says(
    tmp_path: Path, plane: str, letter: str, poisson: float, count: tuple[int, int], expected: float
) -> None:
    """`expected`: computed before by another program."""
    kind = f"{plane}4{letter}"
    young, inertia = 1000.0, DEPTH**3 / 12.0
    mesh = grid(kind, *count, lambda x, y: (LENGTH * x, DEPTH * y))
    u = bent(tmp_path, kind, mesh, FORCE, young, poisson, 1.0, DEPTH)
    stiff = young / (1.0 - poisson**2) if kind[2] == "E" else young
    shear = young / (2.0 * (1.0 + poisson)) * DEPTH * 5.0 / 6.0
    beam = FORCE * (LENGTH**3 / (3.0 * stiff * inertia) + LENGTH / shear)
    assert u[mesh.node_sets["NRIGHT"], 1].mean() / beam == pytest.approx(expected, abs=0.002)


@pytest.mark.parametrize("letter", LETTERS)
def test_the_beams_of_macneal_and_harder(tmp_path: Path, letter: str) -> None:
    """Tip under shear, by 0.1081: rectangles, parallelograms, trapezoids (MacNeal & Harder 1985)."""
    tilts = (lambda k: 0.0, lambda k: 0.1, lambda k: 0.1 * (-1) ** k)
    for tilt, part in zip(tilts, (0.993, 0.632, 0.052)):

        def place(x: float, y: float) -> tuple[float, float]:
            k = round(6.0 * x)
            return 6.0 * x + (tilt(k) if 0 < k < 6 else 0.0) * (2.0 * y - 1.0), 0.2 * y

        mesh = grid(f"CPS4{letter}", 6, 1, place)
        u = bent(tmp_path, f"CPS4{letter}", mesh, 1e-3, 1e7, 0.3, 0.1, 0.2)
        assert u[mesh.node_sets["NRIGHT"], 1].mean() / 1.081e-4 == pytest.approx(part, abs=0.003)


@pytest.mark.parametrize("letter", LETTERS)
@pytest.mark.parametrize(("count", "expected"), [(4, 23.02), (16, 23.88)])
def test_cook_s_membrane(tmp_path: Path, count: int, letter: str, expected: float) -> None:
    """Of the middle of the end; 23.96 is the limit of fine meshes (Cook et al., 48 x 44 x 16, E = 1, nu = 1/3, F = 1)."""
    kind = f"CPS4{letter}"
    mesh = grid(kind, count, count, lambda x, y: (48.0 * x, 44.0 * x + y * (44.0 - 28.0 * x)))
    u = bent(tmp_path, kind, mesh, 1e-4, 1.0, 1.0 / 3.0, 1.0, 16.0)
    middle = np.argmin(np.hypot(*(mesh.points - (48.0, 52.0)).T))
    assert u[middle, 1] / 1e-4 == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", ["CPE4I", "CPS4I", "CPE4R", "CPS4R"])
def test_a_free_body_keeps_energy_and_momenta(tmp_path: Path, kind: str, scheme: str) -> None:
    for law, damping in ((ELASTIC, ""), (NEO_HOOKE, ""), (NEO_HOOKE, "*DAMPING, BETA=0.002\n")):
        deck = bodies(kind, laws=(law,), damping=damping)
        keeps_energy_and_momenta(tmp_path, deck, scheme, damping)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("pair", "friction"),
    [(("CPE4I", "CPE3"), 0.3), (("CPE8R", "CPE4I"), 0.0), (("CPE4R", "CPE3"), 0.0), (("CPE4I", "CPE4R"), 0.3)],
)
def test_unlike_bodies_in_contact_never_gain_energy(
    tmp_path: Path, pair: tuple[str, str], friction: float, scheme: str
) -> None:
    gains_no_energy(tmp_path, falling(*pair, laws=(ELASTIC, NEO_HOOKE), friction=friction), scheme)
