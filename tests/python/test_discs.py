"""Rigid discs: circles that roll, collide and turn without the corners of a polygon. docs/theory/geometry.md, Discs."""

import math
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from oracle.checks import assert_holds
from stickslip.certificate.certify import certify
from stickslip.program import binary

GRAVITY = 9.81
SCHEMES = ["ENERGY-MOMENTUM", "SS22"]
FLOOR = "*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -10., -1.\nLINE, 10., -1."
HOLE = "*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, 3., 0.\n" + "\n".join(
    f"CIRCL, {x}, {y}, 0., 0." for x, y in [("0.", "3."), ("-3.", "0."), ("0.", "-3."), ("3.", "0.")]
)
FIXED = "*NODE\n900, 0., -3.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=900\n*BOUNDARY\n900, 1, 2"


def circle(name: str, x: float, y: float, radius: float) -> str:
    """A closed profile of four arcs, its outside on the left."""
    ends = [(0, -1), (-1, 0), (0, 1), (1, 0)]
    arcs = [f"CIRCL, {x + a * radius!r}, {y + b * radius!r}, {x!r}, {y!r}" for a, b in ends]
    return "\n".join([f"*SURFACE, NAME={name}, TYPE=SEGMENTS", f"START, {x + radius!r}, {y!r}", *arcs])


def disc(number: int, name: str, x: float, y: float, radius: float = 1.0, mass: float = 1.0) -> str:
    """A homogeneous rigid disc whose reference node is its centre."""
    return "\n".join(
        [
            f"*NODE, NSET=N{name}\n{number}, {x!r}, {y!r}",
            f"*ELEMENT, TYPE=MASS, ELSET=M{name}\n{2 * number}, {number}",
            f"*MASS, ELSET=M{name}\n{mass!r}",
            f"*ELEMENT, TYPE=ROTARYI, ELSET=I{name}\n{2 * number + 1}, {number}",
            f"*ROTARY INERTIA, ELSET=I{name}\n0., 0., {mass * radius**2 / 2!r}",
            circle(name, x, y, radius),
            f"*RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE=N{name}",
        ]
    )


def pair(slave: str, master: str, mu: float) -> str:
    """A contact pair."""
    return (
        f"*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{mu!r}\n"
        f"*CONTACT PAIR, INTERACTION=DRY\n{slave}, {master}"
    )


def run(tmp_path: Path, *cards: str, dt: float, end: float, scheme: str, loads: str = "") -> h5py.Group:
    """The history of a deck of these cards."""
    step = f"*STEP, INC=100000, NLGEOM\n*DYNAMIC, DIRECT\n{dt!r}, {end!r}\n*STICKSLIP, SCHEME={scheme}\n"
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([*cards, step + loads + "*END STEP", ""]))
    done = subprocess.run(
        [binary(), "run", deck, "-o", tmp_path, "--overwrite", "-q"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return h5py.File(tmp_path / "deck.vtkhdf")["history"]


def balance(history: h5py.Group) -> float:
    """Largest value of the balance beside the largest energy."""
    energy = history["energy"]
    return float(np.abs(energy["balance"][:]).max() / energy["kinetic"][:].max())


@pytest.mark.parametrize("dt", [0.05, 0.01, 0.002])
def test_a_disc_that_slides_rolls_in_the_end(tmp_path: Path, dt: float) -> None:
    """v = 2 v0/3, omega R = -v, exactly at any increment; a third of the energy is lost to friction."""
    cards = [disc(1, "DISC", 0.0, 0.0), FLOOR, FIXED, pair("DISC", "FLOOR", 0.2)]
    start = "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 1."
    weight = f"*CLOAD\nNDISC, 2, {-GRAVITY!r}\n"
    history = run(tmp_path, *cards, start, dt=dt, end=0.6, scheme="ENERGY-MOMENTUM", loads=weight)
    body = history["rigid/DISC"]
    assert body["V"][-1][0] == pytest.approx(2 / 3, abs=1e-12)
    assert body["angular_velocity"][-1] == pytest.approx(-2 / 3, abs=1e-12)
    assert history["energy/kinetic"][-1] == pytest.approx(1 / 3, abs=1e-12)
    assert balance(history) < 1e-12


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("mu", [0.0, 0.1, 0.5])
def test_a_disc_on_a_slope(tmp_path: Path, scheme: str, mu: float) -> None:
    """It rolls with (2/3) g sin a where mu > tan(a)/3, else it slides with g (sin a - mu cos a)."""
    slope = math.radians(30.0)
    cards = [disc(1, "DISC", 0.0, 0.0), FLOOR, FIXED, pair("DISC", "FLOOR", mu)]
    along, down = GRAVITY * math.sin(slope), GRAVITY * math.cos(slope)
    load = f"*CLOAD\nNDISC, 1, {along!r}\nNDISC, 2, {-down!r}\n"
    history = run(tmp_path, *cards, dt=0.01, end=1.0, scheme=scheme, loads=load)
    rolls = mu > math.tan(slope) / 3
    speed = 2 / 3 * along if rolls else along - mu * down
    body = history["rigid/DISC"]
    assert body["V"][-1][0] == pytest.approx(speed, rel=2e-3 if scheme == "SS22" else 1e-10)
    omega = -speed if rolls else -2 * mu * down
    assert body["angular_velocity"][-1] == pytest.approx(omega, rel=2e-3, abs=1e-10)


@pytest.mark.parametrize("mu", [0.0, 0.4])
def test_discs_that_collide_keep_their_momenta(tmp_path: Path, mu: float) -> None:
    """An oblique impact of two unlike discs, one spinning, in free flight."""
    cards = [disc(1, "A", 0.0, 0.0), disc(2, "B", 2.3, 0.5, radius=0.8, mass=3.0), pair("A", "B", mu)]
    start = "*INITIAL CONDITIONS, TYPE=VELOCITY\nNA, 1, 2.\nNA, 6, 1.5"
    history = run(tmp_path, *cards, start, dt=0.01, end=1.0, scheme="ENERGY-MOMENTUM")
    momentum, energy = history["momentum"], history["energy/kinetic"][:]
    assert np.abs(momentum["linear"][:] - momentum["linear"][0]).max() < 1e-13
    assert np.abs(momentum["angular"][:] - momentum["angular"][0]).max() < 1e-13
    assert energy[-1] < 0.9 * energy[0] and np.diff(energy).max() < 1e-13
    a, b = (history[f"rigid/{name}/position"][:] for name in "AB")
    assert np.linalg.norm(b - a, axis=1).min() > 1.8 - 1e-12


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_disc_swings_in_a_hole(tmp_path: Path, scheme: str) -> None:
    """Without friction the centre is a pendulum of length R - r; energy stays within the energy-momentum scheme."""
    cards = [disc(1, "DISC", 2.0, 0.0), HOLE, FIXED, pair("DISC", "FLOOR", 0.0)]
    weight = f"*CLOAD\nNDISC, 2, {-GRAVITY!r}\n"
    history = run(tmp_path, *cards, dt=0.01, end=3.0, scheme=scheme, loads=weight)
    centre = history["rigid/DISC/U"][:] + [2.0, 0.0]
    # where it turns round at the height of the start it falls freely for an increment
    length = np.linalg.norm(centre, axis=1)
    assert 2.0 - 1e-6 < length.min() and length.max() < 2.0 + 1e-12
    total = history["energy/kinetic"][:] - history["energy/external_work"][:]
    assert np.diff(total).max() < 1e-10
    if scheme == "ENERGY-MOMENTUM":
        assert abs(total[-1]) < 0.02 * history["energy/kinetic"][:].max()


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("mu", [0.0, 0.5])
def test_a_disc_climbs_a_kerb_and_falls_off_an_edge(tmp_path: Path, scheme: str, mu: float) -> None:
    """It meets the vertex of a step, rolls over it, and over another down to the floor; energy never rises."""
    heights = [(2.0, -1.0), (2.0, -0.7), (6.0, -0.7), (6.0, -3.0), (30.0, -3.0)]
    profile = "\n".join(["START, -10., -1.", *(f"LINE, {x}, {y}" for x, y in heights)])
    steps = f"*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n{profile}"
    cards = [disc(1, "DISC", 0.0, 0.0), steps, FIXED, pair("DISC", "FLOOR", mu)]
    start = "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 5.\n" + ("NDISC, 6, -5." if mu else "")
    weight = f"*CLOAD\nNDISC, 2, {-GRAVITY!r}\n"
    history = run(tmp_path, *cards, start.rstrip(), dt=0.01, end=8.0, scheme=scheme, loads=weight)
    centre = history["rigid/DISC/U"][:]
    assert centre[-1] == pytest.approx([centre[-1][0], -2.0], abs=1e-9)
    if scheme == "ENERGY-MOMENTUM":
        total = history["energy/kinetic"][:] - history["energy/external_work"][:]
        assert np.diff(total).max() < 1e-9 * history["energy/kinetic"][:].max()
    # no point of the profile is inside of the disc
    for x, y in heights[:-1]:
        assert np.hypot(centre[:, 0] - x, centre[:, 1] - y).min() > 1.0 - 1e-9
    assert balance(history) < 1e-10


def test_a_cam_lifts_its_follower_as_a_circle_does(tmp_path: Path) -> None:
    """An eccentric disc turns under a flat face: lift e (1 - cos theta), force F + m e omega^2 cos theta."""
    offset, omega, load, n = 0.3, 2 * math.pi, 60.0, 400
    cards = [
        "*NODE\n900, 0., 0.\n901, 0., 2.",
        "*ELEMENT, TYPE=MASS, ELSET=M\n1, 901\n*MASS, ELSET=M\n2.",
        circle("CAM", 0.0, -offset, 1.0),
        "*RIGID BODY, ANALYTICAL SURFACE=CAM, REF NODE=900",
        f"*SURFACE, NAME=FACE, TYPE=SEGMENTS\nSTART, 3., {1 - offset!r}\nLINE, -3., {1 - offset!r}",
        "*RIGID BODY, ANALYTICAL SURFACE=FACE, REF NODE=901",
        pair("CAM", "FACE", 0.1),
        "*AMPLITUDE, NAME=TURN\n0., 0., 1., 1.",
        "*BOUNDARY\n900, 1, 2\n901, 1\n901, 6",
    ]
    turn = f"*BOUNDARY, AMPLITUDE=TURN\n900, 6, 6, {omega!r}\n*CLOAD\n901, 2, {-load!r}\n"
    history = run(tmp_path, *cards, dt=1 / n, end=1.0, scheme="ENERGY-MOMENTUM", loads=turn)
    theta = omega * history["time"][:]
    lift = offset * (1 - np.cos(theta))
    assert np.abs(history["rigid/FACE/U"][:, 1] - lift).max() < 1e-12
    middle = theta[1:] - omega / n / 2
    force = load + 2.0 * offset * omega**2 * np.cos(middle)
    (contact,) = history["contact"].values()
    assert np.abs(contact["normal"][1:] - force)[2:].max() < 1e-3 * force.max()
    assert balance(history) < 1e-11


def test_what_is_no_circle_is_no_slave(tmp_path: Path) -> None:
    """An open arc as slave is refused, with what to do."""
    half = "*SURFACE, NAME=DISC, TYPE=SEGMENTS\nSTART, 1., 0.\nCIRCL, 0., -1., 0., 0.\nCIRCL, -1., 0., 0., 0."
    node = "*NODE\n1, 0., 0.\n*ELEMENT, TYPE=MASS, ELSET=M\n1, 1\n*MASS, ELSET=M\n1."
    body = "*RIGID BODY, ANALYTICAL SURFACE=DISC, REF NODE=1\n*BOUNDARY\n1, 6"
    deck = tmp_path / "deck.inp"
    step = "*STEP\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP\n"
    deck.write_text("\n".join([node, half, body, FLOOR, FIXED, pair("DISC", "FLOOR", 0.1), step]))
    done = subprocess.run([binary(), "check", deck], capture_output=True, text=True)
    assert done.returncode == 2
    assert "error[D407]: the rigid surface DISC cannot be slave" in done.stderr + done.stdout


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_disc_rolls_on_an_elastic_block(tmp_path: Path, scheme: str) -> None:
    """Energy never rises, the ledger closes, and the certificate finds gaps, forces and momenta right."""
    nodes = [f"{1 + i + 13 * j}, {-3 + 0.5 * i}, {-2 + 0.5 * j}" for j in range(3) for i in range(13)]
    corners = [(1 + i + 13 * j) for j in range(2) for i in range(12)]
    elements = [f"{e}, {a}, {a + 1}, {a + 14}, {a + 13}" for e, a in enumerate(corners, 1)]
    cards = [
        "*NODE",
        *nodes,
        "*NSET, NSET=BOTTOM, GENERATE\n1, 13\n*ELEMENT, TYPE=CPE4, ELSET=BLOCK",
        *elements,
        "*SOLID SECTION, ELSET=BLOCK, MATERIAL=SOFT\n1.",
        "*MATERIAL, NAME=SOFT\n*HYPERELASTIC, NEO HOOKE\n200., 2.E-3\n*DENSITY\n1.",
        "*SURFACE, NAME=SKIN\nBLOCK",
        disc(1000, "DISC", -1.0, 0.0),
        pair("DISC", "SKIN", 0.4),
        "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 2.\nNDISC, 6, -2.\n*BOUNDARY\nBOTTOM, 1, 2",
    ]
    weight = f"*CLOAD\nNDISC, 2, {-GRAVITY!r}\n"
    history = run(tmp_path, *cards, dt=0.005, end=1.0, scheme=scheme, loads=weight)
    energy = history["energy"]
    total = energy["kinetic"][:] + energy["strain"][:] - energy["external_work"][:]
    if scheme == "ENERGY-MOMENTUM":
        assert np.diff(total).max() < 1e-12
    assert balance(history) < 1e-11
    history.file.close()
    assert_holds(tmp_path / "deck.vtkhdf")


@pytest.mark.parametrize("scheme", SCHEMES)
def test_discs_land_alike_where_impacts_are_events(tmp_path: Path, scheme: str) -> None:
    """Discs have their contacts with IMPACT TIME=EVENT too: with each other and in a hole."""
    two = [
        disc(1, "DISC", 0.0, 0.0),
        disc(2, "OTHER", 2.515, 0.3, mass=2.0),
        pair("DISC", "OTHER", 0.3),
        "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 1.",
    ]
    hole = [
        disc(1, "DISC", 0.0, -0.5),
        HOLE,
        FIXED,
        pair("DISC", "FLOOR", 0.2),
        "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 3.",
    ]
    weight = f"*DLOAD\nMDISC, GRAV, {GRAVITY!r}, 0., -1.\n"
    for cards, loads in ((two, ""), (hole, weight)):
        motions = []
        for event in ("", ", IMPACT TIME=EVENT"):
            history = run(tmp_path, *cards, dt=0.01, end=1.5, scheme=scheme + event, loads=loads)
            motions.append(history["rigid/DISC/V"][:])
            history.file.close()
        assert np.abs(motions[0] - motions[0][0]).max() > 0.3
        assert np.abs(motions[1] - motions[0]).max() < 1e-9


def test_models_without_elements_are_certified(tmp_path: Path) -> None:
    """The certificate of two discs that collide holds, and not that of another kinetic energy."""
    start = "*INITIAL CONDITIONS, TYPE=VELOCITY\nNDISC, 1, 1."
    cards = [disc(1, "DISC", 0.0, 0.0), disc(2, "OTHER", 2.515, 0.3), pair("DISC", "OTHER", 0.3), start]
    history = run(tmp_path, *cards, dt=0.01, end=1.0, scheme="ENERGY-MOMENTUM")
    history.file.close()
    checks = {check.name: check for check in certify(tmp_path / "deck.vtkhdf").checks}
    assert all(check.holds for check in checks.values())
    assert all(checks[name].is_told for name in ("balance", "cone", "accounts", "penetration"))
    with h5py.File(tmp_path / "deck.vtkhdf", "r+") as file:
        file["history/rigid/OTHER/kinetic"][-1] *= 1.01
    broken = [check.name for check in certify(tmp_path / "deck.vtkhdf").checks if not check.holds]
    assert broken == ["accounts"]
