"""Ties of unlike meshes: patch tests, a tie along a circle, momenta and energy."""

from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest
from bodies import ELASTIC, grid
from stickslip import Deck, program
from stickslip.arrays import Array
from stickslip.result import Result
from test_surface_to_surface import (
    PRESSED,
    QUADRATIC,
    SHEARED,
    UNLIKE,
    Place,
    add_body,
    patch,
    uneven,
)

SURFACES = "TYPE=SURFACE TO SURFACE"
NODES = "TYPE=NODE TO SURFACE"
BOTH_COUNTS = [(16, 7), (7, 16)]


@pytest.mark.parametrize("kinds", UNLIKE + QUADRATIC)
@pytest.mark.parametrize(("counts", "degrees"), [((16, 7), 0.0), ((7, 16), 0.0), ((7, 16), 30.0), ((16, 7), 30.0)])
def test_unlike_meshes_pass_the_patch_test(
    tmp_path: Path, kinds: tuple[str, str], counts: tuple[int, int], degrees: float
) -> None:
    """The nodes at the ends of the tie are held on both sides."""
    for gradient in (PRESSED, SHEARED):
        assert patch(tmp_path, kinds, counts, gradient, degrees, 0.0, tie="ADJUST=NO") < 1e-11


def test_nodes_on_segments_do_not(tmp_path: Path) -> None:
    """The patch test sees the difference."""
    errors = [patch(tmp_path, ("CPE4", "CPE4"), counts, PRESSED, 0.0, 0.0, tie=NODES) for counts in BOTH_COUNTS]
    assert min(errors) > 3e-3


@pytest.mark.parametrize("counts", BOTH_COUNTS)
@pytest.mark.parametrize("kinds", [("CAX4", "CAX4"), ("CAX3", "CAX4"), ("CAX8", "CAX4"), ("CAX4", "CAX8")])
@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_discs_of_unlike_mesh_pass_the_patch_test(
    tmp_path: Path, kinds: tuple[str, str], counts: tuple[int, int], slope: float
) -> None:
    assert patch(tmp_path, kinds, counts, PRESSED, 0.0, 0.0, slope=slope, tie="ADJUST=NO") < 1e-11


def joined(kinds: tuple[str, str], places: tuple[Place, Place], counts: tuple[int, int], tie: str) -> Deck:
    """Two bodies of three layers, the bottom of the second, SB, tied to the top of the first, SA."""
    deck = Deck.titled("tied")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    for name, kind, place, count in zip("AB", kinds, places, counts):
        mesh = grid(kind, count, 3, place)
        add_body(deck, name, kind, mesh, TOP="TOP" + name, BOTTOM="BOTTOM" + name)
    return deck.extend(f"*TIE, NAME=BOND, {tie}\nBOTTOMB, TOPA\n")


def last_stress(deck: Deck, tmp_path: Path) -> tuple[Result, Array]:
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    energy = result.history.energy
    assert np.abs(energy.balance).max() < 1e-11 * energy.largest
    return result, result.frames[-1]["S"]


@pytest.mark.parametrize("kinds", UNLIKE + QUADRATIC)
@pytest.mark.parametrize("counts", BOTH_COUNTS)
def test_free_ends_stretch_alike(tmp_path: Path, kinds: tuple[str, str], counts: tuple[int, int]) -> None:
    """Uniform stress along the axis, with no support at the tie."""

    def lower(x: float, y: float) -> tuple[float, float]:
        return uneven(x), y

    def upper(x: float, y: float) -> tuple[float, float]:
        return x, 1.0 + y

    deck = joined(kinds, (lower, upper), counts, "ADJUST=NO")
    deck.extend("*STEP, NLGEOM\n*STATIC, DIRECT\n1., 1.\n*STICKSLIP, TOLERANCE=1.E-13\n")
    deck.extend("*BOUNDARY\nNBOTTOMA, 2\n1, 1\n*DSLOAD\nTOPB, P, 50.\n*END STEP\n")
    result, stress = last_stress(deck, tmp_path)
    force = result.history.ties.BOND.force[-1]
    pressure, width = 50.0, 1.0 + result.frames[-1]["U"][:, 0].max() - result.frames[-1]["U"][:, 0].min()
    assert np.abs(force - [0.0, pressure * width]).max() < 1e-9
    assert np.abs(stress - stress.mean(axis=0)).max() < 1e-11 * np.abs(stress).max()


@pytest.mark.parametrize("kinds", [("CPE4",) * 3, ("CPE8", "CPE4", "CPE8"), ("CPE4", "CPE8", "CPE8")])
def test_three_blocks_meet_at_a_point(tmp_path: Path, kinds: tuple[str, str, str]) -> None:
    """A block on two blocks that are tied to each other: the node over their seam belongs to the first of its two ties."""
    deck = Deck.titled("seam")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    places: tuple[Place, ...] = (
        lambda x, y: (0.5 * x, y - 1.0),
        lambda x, y: (0.5 + 0.5 * x, y - 1.0),
        lambda x, y: (x, y),
    )
    sides = ("TOP", "BOTTOM", "LEFT", "RIGHT")
    for name, kind, place, count in zip("ACB", kinds, places, [(5, 3), (4, 4), (8, 3)]):
        add_body(deck, name, kind, grid(kind, *count, place), **{side: side + name for side in sides})
    for pair in ("LEFTC, RIGHTA", "BOTTOMB, TOPA", "BOTTOMB, TOPC"):
        deck.extend(f"*TIE, ADJUST=NO\n{pair}\n")
    deck.extend("*STEP, NLGEOM\n*STATIC, DIRECT\n1., 1.\n*STICKSLIP, TOLERANCE=1.E-13\n")
    deck.extend("*BOUNDARY\nNBOTTOMA, 2\nNBOTTOMC, 2\n1, 1\n*DSLOAD\nTOPB, P, 50.\n*END STEP\n")
    _, stress = last_stress(deck, tmp_path)
    assert np.abs(stress - stress.mean(axis=0)).max() < 1e-11 * np.abs(stress).max()


INNER, MIDDLE, OUTER, PRESSURE = 1.0, 1.5, 2.0, 1e-4


def quarter(inner: float, outer: float) -> Place:
    """A quarter of a ring; its bottom is the inner side."""

    def place(x: float, y: float) -> tuple[float, float]:
        angle, radius = 0.5 * pi * (1.0 - x), inner + (outer - inner) * y
        # exactly on the axes at both ends
        return (0.0 if x == 0.0 else radius * cos(angle)), (0.0 if x == 1.0 else radius * sin(angle))

    return place


def radial_stress(tmp_path: Path, counts: tuple[int, int], kind: str) -> tuple[float, float]:
    """Mean error of the radial stress beside a tie along a circle, and its scatter, in the pressure there (Lame).

    The meshes of both rings are the same all around, so that without the tie the elements of a layer are loaded alike.
    """
    places = (quarter(INNER, MIDDLE), quarter(MIDDLE, OUTER))
    deck = joined(("CPE4", "CPE4"), places, counts, kind)
    ends = "*NSET, NSET=ONX\nNRIGHTA, NRIGHTB\n*NSET, NSET=ONY\nNLEFTA, NLEFTB\n"
    deck.extend(ends + "*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nONX, 2\nONY, 1\n")
    deck.extend(f"*DSLOAD\nBOTTOMA, P, {PRESSURE}\n*END STEP\n")
    result, stress = last_stress(deck, tmp_path)
    # supports and tie balance on the slave, with the part of the tie that its supports bear
    held = result.frames[-1]["RF"][result.node_set("NB")].sum(axis=0)
    assert np.abs(held + result.history.ties.BOND.force[-1]).max() < 1e-12 * np.abs(held).max()
    square = INNER**2 / (OUTER**2 - INNER**2)
    at_tie = PRESSURE * square * (OUTER**2 / MIDDLE**2 - 1.0)
    first, means, scatter = 0, [], 0.0
    for count, layer in zip(counts, (2, 0)):
        errors = []
        for element in range(first + layer * count, first + (layer + 1) * count):
            x, y = result.coordinates[result.cells[element]].mean(axis=0)[:2]
            n = np.array([x, y]) / np.hypot(x, y)
            sxx, syy, sxy = stress[element][:3]
            radial = sxx * n[0] ** 2 + syy * n[1] ** 2 + 2.0 * sxy * n[0] * n[1]
            exact = PRESSURE * square * (1.0 - OUTER**2 / (x * x + y * y))
            errors.append((radial - exact) / at_tie)
        means.append(np.mean(errors))
        scatter = max(scatter, np.ptp(errors))
        first += 3 * count
    return float(np.mean(means)), float(scatter)


@pytest.mark.parametrize("counts", BOTH_COUNTS)
def test_a_tie_along_a_circle_carries_the_pressure(tmp_path: Path, counts: tuple[int, int]) -> None:
    """The ends of the slave are held as the master is there, on the axes of symmetry."""
    mean, scatter = radial_stress(tmp_path, counts, SURFACES)
    of_nodes = radial_stress(tmp_path, counts, NODES)
    assert abs(mean) < 0.035 and scatter < min(0.055, of_nodes[1])
    # nodes of the coarser surface follow every second or third node of the finer one
    assert counts[0] < counts[1] or of_nodes[1] > 0.3


@pytest.mark.parametrize("counts", BOTH_COUNTS)
@pytest.mark.parametrize("adjust", ["ADJUST=NO", "ADJUST=YES"])
def test_quarters_of_rings_fly_with_their_energy_and_momenta(
    tmp_path: Path, counts: tuple[int, int], adjust: str
) -> None:
    """A tie along a circle, with distances between the surfaces where nodes keep their places."""
    deck = joined(("CPE4", "CPE8"), (quarter(1.0, 1.5), quarter(1.5, 2.0)), counts, adjust)
    deck.extend(
        "*NSET, NSET=ALL\nNA, NB\n*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\nALL, 3., 0.2, -0.1, 0.\n"
        "1., 1., 0., 1., 1., 1.\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 2.\n*END STEP\n"
    )
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    energy, momentum = result.history.energy, result.history.momentum
    total = energy.kinetic + energy.strain
    assert np.abs(total - total[0]).max() < 1e-12 * total[0]
    for values in (momentum.linear, momentum.angular):
        assert np.abs(values - values[0]).max() < 1e-12 * np.abs(values).max()
