"""CPE6, CPE8, CPE8R and their twins in plane stress against closed forms and published beams."""

from math import cos, pi, sin
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
)
from oracle.shapes import gradients, integration_rule, shape_functions
from stickslip.arrays import Array
from stickslip.mesh import Mesh


def bent(tmp_path: Path, kind: str, mesh: Mesh, force: float, *constants: float) -> Array:
    """Displacements of a body of E, nu, thickness and height held at its left, with a force up along its right end."""
    young, poisson, thickness, height = constants
    deck = body(kind, mesh, young, poisson, thickness)
    deck.extend("*BOUNDARY\nNLEFT, 1, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
    deck.add("DSLOAD, FOLLOWER=NO", ("RIGHT", "TRVEC", force / (thickness * height), 0.0, 1.0))
    return end(solved(tmp_path, deck.extend("*END STEP\n")))


LENGTH, DEPTH, FORCE = 10.0, 1.0, 1e-4


@pytest.mark.parametrize(
    ("kind", "poisson", "count", "expected"),
    [
        ("CPS8", 0.3, (10, 1), 0.991),
        ("CPS8R", 0.3, (10, 1), 0.991),
        ("CPS6", 0.3, (10, 1), 0.991),
        ("CPE8", 0.3, (20, 2), 0.993),
        ("CPE8R", 0.3, (20, 2), 0.994),
        ("CPE8", 0.499, (10, 1), 0.909),
        ("CPE8R", 0.499, (10, 1), 0.913),
        ("CPE8", 0.499, (20, 2), 0.953),
        ("CPE8R", 0.499, (20, 2), 0.957),
    ],
)
def test_a_cantilever_bends_as_timoshenko_says(
    tmp_path: Path, kind: str, poisson: float, count: tuple[int, int], expected: float
) -> None:
    """`expected`: computed before by another program; with nu = 0.499 clamped meshes tend to 0.983."""
    young, inertia = 1000.0, DEPTH**3 / 12.0
    mesh = grid(kind, *count, lambda x, y: (LENGTH * x, DEPTH * y))
    u = bent(tmp_path, kind, mesh, FORCE, young, poisson, 1.0, DEPTH)
    tip = np.argmin(np.hypot(*(mesh.points - (LENGTH, DEPTH / 2.0)).T))
    stiff = young / (1.0 - poisson**2) if kind[2] == "E" else young
    shear = young / (2.0 * (1.0 + poisson)) * DEPTH * 5.0 / 6.0
    beam = FORCE * (LENGTH**3 / (3.0 * stiff * inertia) + LENGTH / shear)
    assert u[tip, 1] / beam == pytest.approx(expected, abs=0.001)


@pytest.mark.parametrize(
    ("kind", "expected"),
    [("CPS8", (0.982, 0.980, 0.899)), ("CPS8R", (0.987, 0.997, 0.967))],
)
def test_the_beams_of_macneal_and_harder(
    tmp_path: Path, kind: str, expected: tuple[float, float, float]
) -> None:
    """Tip under shear, by 0.1081: rectangles, parallelograms, trapezoids (MacNeal & Harder 1985)."""
    for tilt, part in zip((lambda k: 0.0, lambda k: 0.1, lambda k: 0.1 * (-1) ** k), expected):

        def place(x: float, y: float) -> tuple[float, float]:
            k = round(6.0 * x)
            return 6.0 * x + (tilt(k) if 0 < k < 6 else 0.0) * (2.0 * y - 1.0), 0.2 * y

        mesh = grid(kind, 6, 1, place, curved=False)
        u = bent(tmp_path, kind, mesh, 1e-3, 1e7, 0.3, 0.1, 0.2)
        assert u[mesh.node_sets["NRIGHT"], 1].mean() / 1.081e-4 == pytest.approx(part, abs=0.002)


@pytest.mark.parametrize(
    ("kind", "count", "expected"),
    [("CPS8", 4, 23.71), ("CPS8R", 4, 23.73), ("CPS8", 16, 23.93), ("CPS8R", 16, 23.94), ("CPS6", 16, 23.93)],
)
def test_cook_s_membrane(tmp_path: Path, kind: str, count: int, expected: float) -> None:
    """Of the middle of the end; 23.96 is the limit of fine meshes (Cook et al., 48 x 44 x 16, E = 1, nu = 1/3, F = 1)."""
    mesh = grid(kind, count, count, lambda x, y: (48.0 * x, 44.0 * x + y * (44.0 - 28.0 * x)))
    u = bent(tmp_path, kind, mesh, 1e-4, 1.0, 1.0 / 3.0, 1.0, 16.0)
    middle = np.argmin(np.hypot(*(mesh.points - (48.0, 52.0)).T))
    assert u[middle, 1] / 1e-4 == pytest.approx(expected, abs=0.02)


def lame(x: Array, young: float, poisson: float, pressure: float) -> Array:
    """Displacements [N, 2] of a tube between the radii 1 and 2 under a pressure within (Lame), plane strain."""
    r = np.hypot(*x.T)
    radial = (1.0 + poisson) * pressure / (3.0 * young) * ((1.0 - 2.0 * poisson) * r + 4.0 / r)
    return x * (radial / r)[:, None]


@pytest.mark.parametrize(
    ("kind", "order"),
    [("CPE3", 2), ("CPE4", 2), ("CPE4H", 2), ("CPE4I", 2), ("CPE6", 3), ("CPE8", 3), ("CPE8R", 3), ("CPE8H", 3), ("CPE8RH", 3)],
)
def test_the_displacements_of_a_tube_have_the_order_of_the_element(
    tmp_path: Path, kind: str, order: int
) -> None:
    """In L2, against Lame: 2 of linear, 3 of quadratic displacements."""
    young, poisson, pressure = 1.0, 0.3, 1e-9
    errors = []
    for count in (2, 4, 8) if order == 3 else (4, 8, 16):

        def place(x: float, y: float) -> tuple[float, float]:
            r, angle = 1.0 + y, pi / 2.0 * (1.0 - x)
            return r * cos(angle), r * sin(angle)

        mesh = grid(kind, 2 * count, count, place)
        deck = body(kind, mesh, young, poisson)
        deck.extend("*BOUNDARY\nNLEFT, 1\nNRIGHT, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n")
        deck.add("DSLOAD", ("BOTTOM", "P", pressure)).extend("*END STEP\n")
        u = end(solved(tmp_path, deck))
        inner = u[mesh.node_sets["NBOTTOM"]] / lame(np.array([[1.0, 0.0]]), young, poisson, pressure)[0, 0]
        assert np.hypot(*inner.T) == pytest.approx(1.0, abs=(0.02 if order == 3 else 4.0) / count**2)
        of_nodes = np.array(mesh.elements)
        rule = integration_rule({3: 6, 4: 8}.get(of_nodes.shape[1], of_nodes.shape[1]), False)
        shape, _ = shape_functions(of_nodes.shape[1], rule[0])
        area = gradients(mesh.points[of_nodes], rule)[1]
        at, found = (np.einsum("ga,eai->egi", shape, v[of_nodes]) for v in (mesh.points, u))
        exact = lame(at.reshape(-1, 2), young, poisson, pressure).reshape(at.shape)
        errors.append(np.sqrt((area[..., None] * (found - exact) ** 2).sum()))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] > order - (0.15 if order == 3 else 0.1), orders


KINDS = ("CPE6", "CPE8", "CPE8R", "CPS6", "CPS8", "CPS8R")

@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_free_body_keeps_energy_and_momenta(tmp_path: Path, kind: str, scheme: str) -> None:
    for law, damping in ((ELASTIC, ""), (NEO_HOOKE, ""), (NEO_HOOKE, "*DAMPING, BETA=0.002\n")):
        deck = bodies(kind, laws=(law,), damping=damping)
        keeps_energy_and_momenta(tmp_path, deck, scheme, damping)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    ("pair", "friction"),
    [(("CPE8R", "CPE6"), 0.3), (("CPE8", "CPE8R"), 0.0), (("CPE4", "CPE8"), 0.3), (("CPE6", "CPE3"), 0.0)],
)
def test_unlike_bodies_in_contact_never_gain_energy(
    tmp_path: Path, pair: tuple[str, str], friction: float, scheme: str
) -> None:
    gains_no_energy(tmp_path, falling(*pair, laws=(ELASTIC, NEO_HOOKE), friction=friction), scheme)
