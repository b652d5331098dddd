"""Tied surfaces: energy and momenta of a pair that turns, uniform stress through a tie, messages; coupled nodes."""

import re
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from stickslip.program import binary

MATERIAL = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1."
GENERAL = (
    "*SURFACE INTERACTION, NAME=F\n*FRICTION\n0.2\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n"
    "*CONTACT PROPERTY ASSIGNMENT\n,,F"
)


def block(name: str, first: int, corner: tuple[float, float], size: tuple[float, float], cells: tuple[int, int]) -> str:
    """Nodes and elements of a rectangle, with its surfaces NAME_BOT and NAME_TOP."""
    (x, y), (w, h), (nx, ny) = corner, size, cells
    lines = [f"*NODE, NSET=N{name}"]
    for j in range(ny + 1):
        for i in range(nx + 1):
            lines.append(f"{first + j * (nx + 1) + i}, {x + w * i / nx!r}, {y + h * j / ny!r}")
    lines.append(f"*ELEMENT, TYPE=CPE4, ELSET=E{name}")
    for j in range(ny):
        for i in range(nx):
            a = first + j * (nx + 1) + i
            lines.append(f"{first + j * nx + i}, {a}, {a + 1}, {a + nx + 2}, {a + nx + 1}")
    for side, row, kind in (("BOT", 0, "S1"), ("TOP", ny - 1, "S3")):
        labels = ", ".join(str(first + row * nx + i) for i in range(nx))
        lines += [f"*ELSET, ELSET={name}{side}", labels, f"*SURFACE, NAME={name}_{side}", f"{name}{side}, {kind}"]
    return "\n".join([*lines, f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M", "1."])


def run(tmp_path: Path, *cards: str) -> tuple[h5py.Group, str]:
    """The history of a deck of these cards, and the log."""
    deck = tmp_path / "deck.inp"
    deck.write_text("\n".join([*cards, ""]))
    done = subprocess.run(
        [binary(), "run", deck, "-o", tmp_path, "--overwrite", "-q"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return h5py.File(tmp_path / "deck.vtkhdf")["history"], (tmp_path / "deck.log").read_text()


@pytest.mark.parametrize("contact", ["", GENERAL], ids=["tie", "general contact"])
@pytest.mark.parametrize("gap", [0.0, 0.1])
@pytest.mark.parametrize("kind", ["SURFACE TO SURFACE", "NODE TO SURFACE"])
def test_a_turning_pair_keeps_energy_and_momenta(
    tmp_path: Path, kind: str, gap: float, contact: str
) -> None:
    """Two blocks of other meshes turn once; general contact does not act between them as well."""
    history, _ = run(
        tmp_path,
        block("A", 1, (0.0, 0.0), (2.0, 1.0), (4, 2)),
        block("B", 101, (0.2, 1.0 + gap), (1.5, 1.0), (5, 3)),
        MATERIAL,
        f"*TIE, NAME=BOND, TYPE={kind}, ADJUST=NO, POSITION TOLERANCE=0.2\nB_BOT, A_TOP",
        contact,
        "*NSET, NSET=ALL\nNA, NB\n*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\nALL, 3., 0.2, -0.1, 0.",
        "1., 1., 0., 1., 1., 1.\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 2.\n*END STEP",
    )
    energy = history["energy"]
    total = energy["kinetic"][:] + energy["strain"][:]
    assert np.abs(total - total[0]).max() < 1e-13 * total[0]
    momentum = history["momentum"]
    scale = np.abs(momentum["linear"][:]).max()
    assert np.abs(momentum["linear"][:] - momentum["linear"][0]).max() < 1e-13 * scale
    angular = momentum["angular"][:]
    assert np.abs(angular - angular[0]).max() < 1e-13 * np.abs(angular).max()
    assert history["ties/BOND/labels"].shape == (6,)
    # the tie alone drives the upper block
    force, mass = history["ties/BOND/force"][:], 1.5
    velocity = history["bodies/velocity"][:, 1]
    change = mass * np.diff(velocity, axis=0) / 0.02
    assert np.abs(force[1:] - change).max() < 1e-9 * np.abs(force).max()


@pytest.mark.parametrize("kind", ["adjusted", "plain", "dynamic"])
def test_pressure_goes_through_a_tie_unchanged(tmp_path: Path, kind: str) -> None:
    """Static, symmetric about a line where slave and master are held alike; at rest in a dynamic step.

    The nodes of the master are places of slave nodes too: weights at other nodes are no exact rule.
    """
    height = 1.02 if kind == "adjusted" else 1.0
    procedure = "*DYNAMIC, DIRECT\n0.01, 0.1" if kind == "dynamic" else "*STATIC\n0.25, 1."
    load = "" if kind == "dynamic" else "*DLOAD\nBTOP, P3, 50."
    left = ", ".join(str(1 + 5 * j) for j in range(3)) + ", " + ", ".join(str(101 + 9 * j) for j in range(4))
    history, said = run(
        tmp_path,
        block("A", 1, (0.0, 0.0), (2.0, 1.0), (4, 2)),
        block("B", 101, (0.0, height), (2.0, 1.0), (8, 3)),
        MATERIAL,
        "*TIE, NAME=BOND\nB_BOT, A_TOP",
        f"*NSET, NSET=LEFT\n{left}\n*NSET, NSET=BASE, GENERATE\n1, 5\n*ELSET, ELSET=ALL\nEA, EB",
        f"*STEP, NLGEOM\n{procedure}\n*BOUNDARY\nLEFT, 1, 1\nBASE, 2, 2\n{load}",
        "*EL PRINT, ELSET=ALL\nS, E\n*END STEP",
    )
    assert ("moved onto the master" in said) == (kind == "adjusted")
    stress = history["elements/ALL/S"][-1]
    if kind == "dynamic":
        assert np.abs(stress).max() == 0.0
        return
    most = np.abs(stress[:, 1]).max()
    assert most > 49.0
    assert np.abs(stress - stress[0]).max() < 1e-9 * most
    assert np.abs(history["energy/balance"][:]).max() < 1e-12 * history["energy/external_work"][-1]


def test_nodes_that_are_not_tied_are_told(tmp_path: Path) -> None:
    """The slave reaches over the end of the master."""
    _, said = run(
        tmp_path,
        block("A", 1, (0.0, 0.0), (2.0, 1.0), (4, 2)),
        block("B", 101, (1.0, 1.0), (2.0, 1.0), (4, 2)),
        MATERIAL,
        "*TIE, NAME=BOND\nB_BOT, A_TOP",
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.1\n*BOUNDARY\nNA, 1, 2\n*END STEP",
    )
    assert re.search(r"the tie BOND leaves out 2 slave nodes farther .*: 104, 105", said)


TOP_NODES = (13, 14, 15, 16)
BASE = "*NSET, NSET=BASE, GENERATE\n1, 4"
RIDE = {
    "coupling": "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=900, SURFACE=A_TOP\n*KINEMATIC\n1, 2",
    "set": "*KINEMATIC COUPLING, REF NODE=900\nTOPS, 1, 2",
    "beam": "*MPC\nBEAM, TOPS, 900",
}


def coupled(tmp_path: Path, ride: str, *cards: str) -> h5py.Group:
    """The history of a square with nodes of its top that ride on node 900, or are coupled to it otherwise."""
    tops = ", ".join(str(node) for node in TOP_NODES)
    square = block("A", 1, (0.0, 0.0), (1.0, 1.0), (3, 3))
    reference = f"*NODE, NSET=NREF\n900, 0.4, 1.7\n*NSET, NSET=TOPS\n{tops}"
    output = "*NODE PRINT, NSET=NREF\nU\n*NODE PRINT, NSET=BASE\nRF\n*NODE PRINT, NSET=TOPS\nU\n*END STEP"
    return run(tmp_path, square, MATERIAL, reference, BASE, RIDE.get(ride, ride), *cards, output)[0]


@pytest.mark.parametrize("ride", list(RIDE))
def test_coupled_nodes_that_turn_keep_energy_and_momenta(tmp_path: Path, ride: str) -> None:
    """The top of a free square rides on a node beside it that has no mass."""
    history = coupled(
        tmp_path,
        ride,
        "*NSET, NSET=ALL\nNA, NREF\n*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\nALL, 4., 0.2, -0.1, 0.",
        "0.5, 0.5, 0., 0.5, 0.5, 1.\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 2.",
    )
    energy, momentum = history["energy"], history["momentum"]
    total = energy["kinetic"][:] + energy["strain"][:]
    assert np.abs(total - total[0]).max() < 1e-12 * total[0]
    linear, angular = momentum["linear"][:], momentum["angular"][:]
    assert np.abs(linear - linear[0]).max() < 1e-12 * np.abs(linear).max()
    assert np.abs(angular - angular[0]).max() < 1e-12 * np.abs(angular).max()
    top = history["nodes/TOPS/U"][:] + np.array([[k / 3, 1.0] for k in range(4)])
    length = np.linalg.norm(top[:, 3] - top[:, 0], axis=1)
    assert np.abs(length - 1.0).max() < 1e-13


def test_static_equilibrium_of_coupled_nodes(tmp_path: Path) -> None:
    """It does not depend on the increments; an angle asks for the moment that brings it about."""
    ends = []
    for dt in (1.0, 0.1):
        load = f"*STEP, NLGEOM\n*STATIC, DIRECT\n{dt!r}, 1.\n*BOUNDARY\nBASE, 1, 2\n*CLOAD\nNREF, 1, 20.\nNREF, 6, 8."
        history = coupled(tmp_path, "coupling", load)
        ends.append(history["nodes/NREF/U"][-1, 0])
        most = history["energy/external_work"][-1]
        assert np.abs(history["energy/balance"][:]).max() < 1e-12 * most
        reaction = history["nodes/BASE/sum/RF"][-1]
        assert np.abs(reaction - [-20.0, 0.0]).max() < 1e-9
        angle = float(history["rigid/GRIP/angle"][-1])
    assert np.abs(ends[0] - ends[1]).max() < 1e-10
    driven = (
        f"*STEP, NLGEOM\n*STATIC, DIRECT\n0.1, 1.\n*BOUNDARY\nBASE, 1, 2\nNREF, 6, 6, {angle!r}\n*CLOAD\nNREF, 1, 20."
    )
    history = coupled(tmp_path, "coupling", driven)
    assert abs(history["rigid/GRIP/moment"][-1] - 8.0) < 1e-9
    assert np.abs(history["energy/balance"][:]).max() < 1e-12 * most


def test_a_distributed_load_is_that_of_its_parts(tmp_path: Path) -> None:
    """The reference node moves by the mean; prescribed, it asks for the force that brings this about."""
    step = "*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\nBASE, 1, 2\n"
    distribute = "*COUPLING, CONSTRAINT NAME=PULL, REF NODE=900, SURFACE=A_TOP\n*DISTRIBUTING"
    history = coupled(tmp_path, distribute, step + "*CLOAD\nNREF, 1, 20.")
    tops = history["nodes/TOPS/U"][-1]
    mean = history["nodes/NREF/U"][-1, 0]
    assert np.abs(mean - tops.mean(axis=0)).max() < 1e-14
    plain = coupled(tmp_path, "*MPC\nPIN, 900, 13", step + "*CLOAD\nTOPS, 1, 5.")
    assert np.abs(plain["nodes/TOPS/U"][-1] - tops).max() < 1e-11
    held = coupled(tmp_path, distribute, step[:-1] + f"\nNREF, 1, 1, {float(mean[0])!r}")
    assert np.abs(held["nodes/TOPS/U"][-1] - tops).max() < 1e-10
