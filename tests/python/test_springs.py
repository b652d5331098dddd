"""Springs and dashpots against closed forms of the scheme, in decks of stiff blocks."""

import math
import re
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from stickslip.program import binary

MASS = 1.0
"""Of a block."""


def block(first: int, x: float, y: float) -> str:
    """Nodes, element and section of a block with sides of 0.1, very stiff."""
    corners = [(x, y), (x + 0.1, y), (x + 0.1, y + 0.1), (x, y + 0.1)]
    rows = [f"{first + k}, {a!r}, {b!r}" for k, (a, b) in enumerate(corners)]
    labels = ", ".join(str(first + k) for k in range(4))
    return "\n".join(
        [f"*NODE, NSET=N{first}", *rows, f"*ELEMENT, TYPE=CPE4, ELSET=B{first}", f"{first}, {labels}"]
        + [f"*SOLID SECTION, ELSET=B{first}, MATERIAL=STIFF", "1."]
    )


STIFF = "*MATERIAL, NAME=STIFF\n*ELASTIC\n1.E8, 0.3\n*DENSITY\n100."


def run(tmp_path: Path, *cards: str, dt: float, end: float, scheme: str = "EM") -> h5py.Group:
    """The history of a deck of these cards."""
    setting = "*STICKSLIP, SCHEME=SS22\n" if scheme == "SS22" else ""
    step = f"*STEP, NLGEOM, INC=100000\n*DYNAMIC, DIRECT\n{dt!r}, {end!r}\n{setting}*END STEP"
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([STIFF, *cards, step, ""]))
    done = subprocess.run(
        [binary(), "run", deck, "-o", tmp_path, "--overwrite", "-q"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return h5py.File(tmp_path / "deck.vtkhdf")["history"]


def velocity(first: int, vx: float, vy: float) -> str:
    """Initial velocity of a block."""
    return f"*INITIAL CONDITIONS, TYPE=VELOCITY\nN{first}, 1, {vx!r}\nN{first}, 2, {vy!r}"


def balance(history: h5py.Group) -> float:
    """Largest value of the balance, relative to the largest energy."""
    energy = history["energy"]
    return float(np.abs(energy["balance"][:]).max() / energy["kinetic"][:].max())


@pytest.mark.parametrize("kind", ["SPRING1", "SPRING2"])
def test_a_block_on_springs_swings_as_the_mid_point_rule_does(tmp_path: Path, kind: str) -> None:
    """Four springs at the corners along x: tan(omega_h dt/2) = omega dt/2, and energy stays."""
    k, dt, steps = 25.0, 0.02, 500
    ground = "*NODE\n90, 1., 0.\n*BOUNDARY\n90, 1, 2" if kind == "SPRING2" else ""
    other = ", 90" if kind == "SPRING2" else ""
    springs = [f"*ELEMENT, TYPE={kind}, ELSET=SPRINGS", *(f"{50 + n}, {n}{other}" for n in range(1, 5))]
    directions = "1, 1" if kind == "SPRING2" else "1"
    springs += ["*SPRING, ELSET=SPRINGS", directions, f"{k / 4!r}"]
    cards = [block(1, 0.0, 0.0), velocity(1, 1.0, 0.0), "\n".join(springs), ground]
    history = run(tmp_path, *cards, dt=dt, end=steps * dt)
    omega = 2.0 / dt * math.atan(math.sqrt(k / MASS) * dt / 2.0)
    time = np.arange(steps + 1) * dt
    exact = np.cos(omega * time)
    assert np.abs(history["bodies/velocity"][:, 0, 0] - exact).max() < 1e-4
    energy = history["energy/kinetic"][:] + history["energy/strain"][:]
    assert np.abs(energy - energy[0]).max() < 1e-11 * energy[0]
    assert balance(history) < 1e-12
    elongation, force = (history["connectors"][name][:] for name in ("elongation", "force"))
    assert np.abs(force - k / 4 * elongation).max() < 1e-12
    assert elongation.max() > 0.19


@pytest.mark.parametrize("table", [False, True])
def test_two_blocks_on_a_spring_keep_energy_and_momenta(tmp_path: Path, table: bool) -> None:
    """They turn about each other by several turns; the spring is linear or stiffens."""
    rows = "-9., -1.\n0., 0.\n1., 0.1\n9., 0.3" if table else "30."
    option = ", NONLINEAR" if table else ""
    spring = f"*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n*SPRING, ELSET=S{option}\n\n{rows}"
    cards = [block(1, 0.0, 0.0), block(11, 0.9, 0.0), spring, velocity(1, 0.2, -1.5), velocity(11, -0.2, 1.5)]
    history = run(tmp_path, *cards, dt=0.02, end=10.0)
    energy = history["energy/kinetic"][:] + history["energy/strain"][:]
    assert np.abs(energy - energy[0]).max() < 1e-10 * energy[0]
    linear, angular = history["momentum/linear"][:], history["momentum/angular"][:]
    assert np.abs(linear - linear[0]).max() < 1e-11
    log = (tmp_path / "deck.log").read_text()
    drift = re.search(r"momentum (\S+)", log.partition("energy balance")[2])
    assert drift is not None and float(drift[1]) < 1e-11
    assert np.abs(angular - angular[0]).max() < 1e-11
    assert history["energy/strain"][:].max() > 0.05 * energy[0]
    assert np.abs(history["connectors/elongation"][:]).max() > 0.1


@pytest.mark.parametrize("scheme", ["EM", "SS22"])
def test_a_dashpot_brakes_as_the_scheme_does(tmp_path: Path, scheme: str) -> None:
    """Four dashpots against the ground: v falls by (1 - c dt/2m)/(1 + c dt/2m) in every increment."""
    c, dt, steps = 2.0, 0.05, 60
    dashpots = ["*ELEMENT, TYPE=DASHPOT1, ELSET=D", *(f"{50 + n}, {n}" for n in range(1, 5))]
    dashpots += ["*DASHPOT, ELSET=D", "1", f"{c / 4!r}"]
    cards = [block(1, 0.0, 0.0), velocity(1, 1.0, 0.0), "\n".join(dashpots)]
    history = run(tmp_path, *cards, dt=dt, end=steps * dt, scheme=scheme)
    half = c * dt / 2.0 / MASS
    exact = ((1.0 - half) / (1.0 + half)) ** np.arange(steps + 1)
    assert np.abs(history["bodies/velocity"][:, 0, 0] - exact).max() < 1e-9
    energy = history["energy"]
    lost = energy["kinetic"][0] - energy["kinetic"][:]
    assert np.abs(energy["damping"][:] - lost).max() < 1e-9
    assert balance(history) < 1e-10


def test_a_table_of_a_dashpot_limits_its_force(tmp_path: Path) -> None:
    """Beyond the table the force is constant: the block is braked evenly."""
    force, dt, steps = 0.1, 0.05, 60
    dashpots = ["*ELEMENT, TYPE=DASHPOT1, ELSET=D", *(f"{50 + n}, {n}" for n in range(1, 5))]
    dashpots += ["*DASHPOT, ELSET=D, NONLINEAR", "1", f"{-force / 4!r}, -1.E-3", f"{force / 4!r}, 1.E-3"]
    cards = [block(1, 0.0, 0.0), velocity(1, 1.0, 0.0), "\n".join(dashpots)]
    history = run(tmp_path, *cards, dt=dt, end=steps * dt)
    exact = 1.0 - force / MASS * dt * np.arange(steps + 1)
    assert np.abs(history["bodies/velocity"][:, 0, 0] - exact).max() < 1e-9


def test_springs_hold_a_block_in_a_static_step_and_it_stays_in_a_dynamic_one(tmp_path: Path) -> None:
    """Forces of the springs balance the weight; a dynamic step from there moves nothing."""
    springs = "*NODE\n90, 0.05, 1.\n*ELEMENT, TYPE=SPRINGA, ELSET=LINES\n50, 90, 3\n51, 90, 4\n*SPRING, ELSET=LINES\n\n100."
    sides = "*ELEMENT, TYPE=SPRING1, ELSET=SIDES\n52, 1\n53, 2\n*SPRING, ELSET=SIDES\n1\n50."
    steps = "*BOUNDARY\n90, 1, 2\n*STEP, NLGEOM\n*STATIC\n0.2, 1.\n*DLOAD\nB1, GRAV, 10., 0.6, -0.8\n*END STEP\n"
    steps += "*STEP, NLGEOM, INC=1000\n*DYNAMIC, DIRECT\n0.01, 2.\n*END STEP\n"
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([STIFF, block(1, 0.0, 0.0), springs, sides, steps]))
    done = subprocess.run(
        [binary(), "run", deck, "-o", tmp_path, "-q"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "deck.vtkhdf") as file:
        history = file["history"]
        static = history["step"][:] == 1
        force = history["connectors/force"][static][-1]
        kinetic = history["energy/kinetic"][~static]
        assert kinetic.max() < 1e-20 * history["energy/strain"][-1]
        held = history["connectors/force"][~static]
        assert np.abs(held - force).max() < 1e-9 * np.abs(force).max()
        elongation = history["connectors/elongation"][static][-1]
        assert np.allclose(force, [100.0, 100.0, 50.0, 50.0] * elongation, rtol=1e-12)
        work, strain = history["energy/external_work"][-1], history["energy/strain"][-1]
        assert abs(work - strain) < 2e-3 * strain  # the trapezoid of five increments


FAULTS = [
    ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11", "element 50 has no *SPRING"),
    ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n*SPRING, ELSET=B1\n\n3.", "B1 holds no SPRING elements"),
    ("*ELEMENT, TYPE=SPRING1, ELSET=S\n50, 3\n*SPRING, ELSET=S\n3\n30.", "only directions 1 and 2"),
    ("*ELEMENT, TYPE=SPRING1, ELSET=S\n50, 3\n*SPRING, ELSET=S\n1", "needs two rows"),
    ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n*SPRING, ELSET=S\n-3.", "must not be negative"),
    ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n*SPRING, ELSET=S, NONLINEAR\n1., 2.\n2., 1.", "must increase"),
    ("*NODE\n90, 2., 0.\n*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 90\n*SPRING, ELSET=S\n3.", "node 90 of element 50 has no mass"),
    ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n*DASHPOT, ELSET=S\n1.", "S holds no DASHPOT elements"),
]


@pytest.mark.parametrize(("cards", "message"), FAULTS)
def test_faults_of_springs_are_told(tmp_path: Path, cards: str, message: str) -> None:
    """Each with its place."""
    step = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP\n"
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([STIFF, block(1, 0.0, 0.0), block(11, 0.9, 0.0), cards, step]))
    done = subprocess.run([binary(), "check", deck], capture_output=True, text=True)
    assert done.returncode == 2
    assert message in done.stderr


def test_a_flat_deck_has_the_springs(tmp_path: Path) -> None:
    """`flatten` reads its own deck back and compares the models."""
    cards = "*ELEMENT, TYPE=SPRINGA, ELSET=S\n50, 3, 11\n51, 2, 14\n*SPRING, ELSET=S, NONLINEAR\n-1., -1.\n2., 1.\n"
    cards += "*ELEMENT, TYPE=DASHPOT2, ELSET=D\n60, 1, 11\n*DASHPOT, ELSET=D\n1, 2\n0.5"
    step = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP\n"
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([STIFF, block(1, 0.0, 0.0), block(11, 0.9, 0.0), cards, step]))
    done = subprocess.run([binary(), "flatten", deck], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "TYPE=SPRINGA" in done.stdout and "TYPE=DASHPOT2" in done.stdout


@pytest.mark.parametrize("rows", ["3.", "-2., -30.\n-0.5, -1.\n0.5, 1.\n2., 30."])
@pytest.mark.parametrize("kind", ["SPRING1", "SPRING2"])
def test_a_torsion_spring_swings_rigid_bodies_and_keeps_their_energy(
    tmp_path: Path, kind: str, rows: str
) -> None:
    """One body against the ground, or two against each other, of inertia 0.5; linear or a table."""
    nodes, directions = ("1, 3", "6, 6") if kind == "SPRING2" else ("1", "6")
    option = ", NONLINEAR" if "\n" in rows else ""
    cards = f"""*NODE\n1, 0., 0.\n2, 1., 0.\n3, 3., 0.\n4, 3., 2.\n*NSET, NSET=A\n2\n*NSET, NSET=B\n4
*ELEMENT, TYPE=ROTARYI, ELSET=ER\n20, 1\n21, 3\n*ROTARY INERTIA, ELSET=ER\n0., 0., 0.5
*ELEMENT, TYPE=MASS, ELSET=EM\n10, 1\n11, 3\n*MASS, ELSET=EM\n2.
*RIGID BODY, REF NODE=1, PIN NSET=A\n*RIGID BODY, REF NODE=3, PIN NSET=B
*ELEMENT, TYPE={kind}, ELSET=S\n50, {nodes}\n*SPRING, ELSET=S{option}\n{directions}\n{rows}
*BOUNDARY\n1, 1, 2\n3, 1, 2\n*INITIAL CONDITIONS, TYPE=VELOCITY\n1, 6, 1.5"""
    history = run(tmp_path, cards, dt=0.05, end=20.0)
    energy = history["energy/kinetic"][:] + history["energy/strain"][:]
    assert np.abs(energy - energy[0]).max() < 1e-11 * energy[0]
    assert balance(history) < 1e-11
    angle, moment = (history["rotary_connectors"][name][:, 0] for name in ("angle", "moment"))
    assert angle.max() > 0.4
    if not option:
        assert np.abs(moment - 3.0 * angle).max() < 1e-12
        # its largest angle is the first rate over the frequency
        omega = math.sqrt(3.0 / 0.5 * (2.0 if kind == "SPRING2" else 1.0))
        assert abs(angle.max() * omega / 1.5 - 1.0) < 2e-3


ROD = """*NODE\n1, 0., 0.\n2, 1., 0.\n*NSET, NSET=ARM\n2\n*RIGID BODY, REF NODE=1, PIN NSET=ARM
*ELEMENT, TYPE=MASS, ELSET=EM\n10, 1\n*MASS, ELSET=EM\n2.
*ELEMENT, TYPE=ROTARYI, ELSET=ER\n20, 1\n*ROTARY INERTIA, ELSET=ER\n0., 0., 0.5
*ELEMENT, TYPE=SPRING1, ELSET=S\n50, 1\n*SPRING, ELSET=S\n6\n8.\n*BOUNDARY\n1, 1, 2"""
"""A rod that a torsion spring of 8 holds, with the inertia 0.5: omega = 4."""


def test_the_period_on_a_torsion_spring_is_of_second_order(tmp_path: Path) -> None:
    """The angle follows sin(2 n atan(omega dt/2)) v/omega, whose period is longer by (omega dt)^2/12."""
    errors = []
    for parts in (20, 40, 80):
        dt = math.pi / 2 / parts
        start = "*INITIAL CONDITIONS, TYPE=VELOCITY\n1, 6, 0.004"
        history = run(tmp_path, ROD, start, dt=dt, end=3 * math.pi / 2)
        angle = history["rotary_connectors/angle"][:, 0]
        phase = 2 * np.arange(len(angle)) * math.atan(2 * dt)
        assert np.abs(angle - 1e-3 * np.sin(phase)).max() < 1e-8
        errors.append(np.abs(angle - 1e-3 * np.sin(4 * history["time"][:])).max())
        assert balance(history) < 1e-11
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.03)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.01)


def test_a_torsion_spring_holds_a_rod_in_a_static_step(tmp_path: Path) -> None:
    """A force P at the arm turns it by k a = P cos a; ramps do the work of the spring."""
    deck = tmp_path / "deck.inp"
    deck.write_text(f"{ROD}\n*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*CLOAD\n2, 2, 4.\n*END STEP\n")
    done = subprocess.run(
        [binary(), "run", deck, "-o", tmp_path, "--overwrite", "-q"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    history = h5py.File(tmp_path / "deck.vtkhdf")["history"]
    angle = history["rotary_connectors/angle"][-1, 0]
    assert 8.0 * angle == pytest.approx(4.0 * math.cos(angle), abs=1e-10)
    energy = history["energy"]
    assert energy["strain"][-1] == pytest.approx(4.0 * angle**2, rel=1e-10)
    assert np.abs(energy["balance"][:]).max() < 1e-11 * energy["strain"][-1]
