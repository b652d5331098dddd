"""Contact from surface to surface: patch tests of unlike meshes, momenta and energy, and what it is refused for."""

import shutil
import subprocess
from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path

import h5py
import numpy as np
import pytest
from bodies import ELASTIC, grid, with_section
from lab.bench_decks import elastic_blocks
from oracle.checks import assert_holds
from stickslip import Deck, program
from stickslip.certificate.certify import certify
from stickslip.mesh import Mesh
from stickslip.penetration import intrusion
from stickslip.result import Result

SURFACES = "TYPE=SURFACE TO SURFACE"
Place = Callable[[float, float], tuple[float, float]]


def add_body(deck: Deck, name: str, kind: str, mesh: Mesh, **sides: str) -> None:
    """Adds a body with its elements, nodes and surfaces named after it."""
    mesh.element_sets = {name: mesh.element_sets["BODY"]}
    mesh.node_sets = {key + name: value for key, value in mesh.node_sets.items()}
    mesh.node_sets["N" + name] = np.arange(len(mesh.points))
    mesh.sides = {surface: mesh.sides[side] for side, surface in sides.items()}
    before = len(deck.find("ELEMENT"))
    deck.add_mesh(mesh, plane="stress" if kind[2] == "S" else "strain")
    for card in deck.find("ELEMENT")[before:]:
        card.head = card.head.replace(("CPE" if kind[2] == "X" else kind[:3]) + kind[3], kind)
    with_section(deck, kind, name, "M")


def contact(deck: Deck, slave: str, master: str, friction: float, kind: str = SURFACES) -> None:
    deck.extend(f"*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{friction}\n")
    deck.extend(f"*CONTACT PAIR, INTERACTION=DRY, {kind}\n{slave}, {master}\n")


def uneven(x: float) -> float:
    """A map of [0, 1] onto itself with unequal spacing."""
    return x + 0.15 * sin(2.0 * pi * x) / pi


def patch(
    tmp_path: Path,
    kinds: tuple[str, str],
    counts: tuple[int, int],
    gradient: np.ndarray,
    degrees: float,
    friction: float,
    contact_kind: str = SURFACES,
    slope: float = 0.0,
    tie: str = "",
) -> float:
    """Largest deviation of the stresses of two blocks from those of a homogeneous displacement gradient in a frame turned by
    some degrees, beside the largest stress; the surface between them has a slope. All nodes but those between the blocks are moved as the gradient says.
    With `tie`, parameters of *TIE, the blocks are tied in place of being in contact."""
    c, s = cos(degrees * pi / 180.0), sin(degrees * pi / 180.0)
    turn = np.array([[c, -s], [s, c]])
    deck = Deck.titled("patch")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    numbers = {}
    spaced = uneven if degrees else lambda x: x
    for name, side, kind, count, low in zip(
        ("A", "B"), ("TOP", "BOTTOM"), kinds, counts, (-1.0, 0.0)
    ):

        def place(x: float, y: float) -> tuple[float, float]:
            return tuple(turn @ np.array([spaced(x) if name == "A" else x, low + y + slope * x]))

        mesh = grid(kind, count, 3, place)
        between = {"A": "NTOP", "B": "NBOTTOM"}[name]
        ends = {"NLEFT", "NRIGHT", "NTOP", "NBOTTOM"} - {between}
        held = {int(n) for key in ends for n in mesh.node_sets[key]}
        first = len(deck.find("NODE")) and sum(len(card.rows) for card in deck.find("NODE"))
        numbers[name] = [(first + n + 1, turn @ gradient @ turn.T @ mesh.points[n]) for n in sorted(held)]
        add_body(deck, name, kind, mesh, **{side: "S" + name})
    if tie:
        deck.extend(f"*TIE, NAME=BOND, {tie}\nSB, SA\n")
    else:
        contact(deck, "SB", "SA", friction, contact_kind)
    rows = [(n, i + 1, i + 1, float(u[i])) for both in numbers.values() for n, u in both for i in (0, 1)]
    deck.extend("*STEP, NLGEOM\n*STATIC, DIRECT\n0.5, 1.\n*STICKSLIP, TOLERANCE=1.E-13\n")
    deck.add("BOUNDARY", *rows)
    deck.extend("*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    stress = np.column_stack([result.frames[-1]["S"], result.frames[-1]["S33"]])
    return float(np.abs(stress - stress.mean(axis=0)).max() / np.abs(stress).max())


PRESSED = np.array([[0.0, 0.0], [0.0, -0.01]])
SHEARED = np.array([[0.0, 0.002], [0.0, -0.01]])


UNLIKE = [("CPE4", "CPE4"), ("CPS4", "CPS4"), ("CPE3", "CPE4"), ("CPS4", "CPS3")]
QUADRATIC = [("CPE8", "CPE4"), ("CPE4", "CPE8"), ("CPS6", "CPS8")]


@pytest.mark.parametrize("kinds", UNLIKE + QUADRATIC)
@pytest.mark.parametrize(("counts", "degrees"), [((16, 7), 0.0), ((7, 16), 0.0), ((13, 8), 30.0)])
def test_unlike_meshes_pass_the_patch_test(
    tmp_path: Path, kinds: tuple[str, str], counts: tuple[int, int], degrees: float
) -> None:
    assert patch(tmp_path, kinds, counts, PRESSED, degrees, 0.0) < 1e-11
    assert patch(tmp_path, kinds, counts, SHEARED, degrees, 0.9) < 1e-11


@pytest.mark.parametrize("counts", [(16, 7), (7, 16)])
@pytest.mark.parametrize("kinds", [("CAX4", "CAX4"), ("CAX3", "CAX4"), ("CAX8", "CAX4"), ("CAX4", "CAX8")])
def test_discs_of_unlike_mesh_pass_the_patch_test(
    tmp_path: Path, kinds: tuple[str, str], counts: tuple[int, int]
) -> None:
    assert patch(tmp_path, kinds, counts, PRESSED, 0.0, 0.0) < 1e-11
    # On a cone the same stress has a part along the surface, and friction holds it. 32 faces on 7 segments between nodes that
    # are held let the round-off of gaps grow 1e5 times; a CAX8 has two faces.
    counts = tuple(count // 2 if kind == "CAX8" else count for kind, count in zip(kinds, counts))
    assert patch(tmp_path, kinds, counts, PRESSED, 0.0, 0.9, slope=0.3) < 1e-11
    assert patch(tmp_path, kinds, counts, PRESSED, 0.0, 0.01, slope=0.3) > 1e-3


def test_nodes_on_segments_do_not(tmp_path: Path) -> None:
    """The patch test sees the difference."""
    error = patch(tmp_path, ("CPE4", "CPE4"), (16, 7), PRESSED, 0.0, 0.0, "TYPE=NODE TO SURFACE")
    assert error > 1e-3


def test_colliding_bars_of_unlike_mesh_stay_straight(tmp_path: Path) -> None:
    deck = Deck.titled("bars")
    deck.extend("*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n")
    for name, side, count, low in (("A", "TOP", 4, 0.0), ("B", "BOTTOM", 3, 1.05)):
        mesh = grid("CPS4", count, 6, lambda x, y: (x, low + y))
        add_body(deck, name, "CPS4", mesh, **{side: "S" + name})
    contact(deck, "SB", "SA", 0.3)
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.4\n*NODE FILE, FREQUENCY=1\nU, V\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    assert result.history.contact.SB_SA.normal.max() > 0.0
    assert max(np.abs(frame["V"][:, 0]).max() for frame in result.frames) < 1e-12


def ring(count: int, x: float, y: float, radius: float) -> Mesh:
    """A ring of two layers of elements."""
    points = [
        (x + r * radius * cos(2.0 * pi * k / count), y + r * radius * sin(2.0 * pi * k / count))
        for r in (0.8, 0.9, 1.0)
        for k in range(count)
    ]
    elements = [
        [j * count + k, (j + 1) * count + k, (j + 1) * count + (k + 1) % count, j * count + (k + 1) % count]
        for j in (0, 1)
        for k in range(count)
    ]
    outside = [[2 * count + k, 2 * count + (k + 1) % count] for k in range(count)]
    return Mesh(np.array(points), elements, {"BODY": range(2 * count)}, {}, {"OUT": outside})


def rings() -> Deck:
    deck = Deck.titled("rings")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    for name, mesh in (("A", ring(24, 0.0, 0.0, 1.0)), ("B", ring(34, 0.35, 2.03, 1.0))):
        add_body(deck, name, "CPS4", mesh, OUT="S" + name)
    return deck


def beams() -> Deck:
    """A soft beam falls with its face on the face of another, tilted, past its end."""
    deck = Deck.titled("beams")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    c, s = cos(0.08), sin(0.08)
    places: dict[str, Place] = {
        "A": lambda x, y: (4.0 * x - 2.0, 0.4 * y - 0.4),
        "B": lambda x, y: (0.4 + c * 3.0 * x - s * 0.3 * y, 0.03 + s * 3.0 * x + c * 0.3 * y),
    }
    for name, side, count in (("A", "TOP", 18), ("B", "BOTTOM", 11)):
        mesh = grid("CPS4", count, 2, places[name])
        add_body(deck, name, "CPS4", mesh, **{side: "S" + name})
    return deck


INCREMENTS = (0.01, 0.02, 0.04, 0.08)
OTHER_RULES = ("LANDING=RETURN", "CONTACT MASS=REDISTRIBUTED", "CONTACT MASS=REDISTRIBUTED, LANDING=RETURN")


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize(
    ("dt", "setting"),
    [(dt, rule) for dt in INCREMENTS for rule in ("", "IMPACT TIME=EVENT")]
    + [(0.02, rule) for rule in OTHER_RULES],
)
@pytest.mark.parametrize("make", [rings, beams])
def test_collisions_keep_momenta_and_never_gain_energy(
    tmp_path: Path, make: Callable[[], Deck], dt: float, setting: str, friction: float
) -> None:
    deck = make()
    contact(deck, "SB", "SA", friction)
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\nNA, 2, 0.5\n")
    deck.extend(f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n{dt}, 1.6\n*STICKSLIP, {setting}\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    history = result.history
    assert history.contact.SB_SA.normal.max() > 0.0
    assert (result.run["events"] > 0) == (setting == "IMPACT TIME=EVENT")
    energy, momentum = history.energy, history.momentum
    total = energy.kinetic + energy.strain
    assert np.diff(total).max() < 1e-13 * energy.largest
    assert np.abs(energy.balance).max() < 1e-12 * energy.largest
    for values in (momentum.linear, momentum.angular):
        assert np.abs(values - values[0]).max() < 1e-12 * np.abs(values).max()


def with_skin(mesh: Mesh) -> Mesh:
    """A mesh of a block with a side SKIN all around."""
    around = ("BOTTOM", "RIGHT", "TOP", "LEFT")
    mesh.sides["SKIN"] = np.concatenate([mesh.sides[name] for name in around])
    return mesh


def tilted(angle: float, corner: tuple[float, float], width: float, height: float) -> Place:
    """Places of a rectangle that is turned about its lower left corner."""
    c, s = cos(angle), sin(angle)
    return lambda x, y: (
        corner[0] + c * width * x - s * height * y,
        corner[1] + s * width * x + c * height * y,
    )


SCENES: dict[str, tuple[dict[str, Place], dict[str, tuple[int, int]]]] = {
    "a corner on a face": (
        {"A": lambda x, y: (4.0 * x - 2.0, y - 1.0), "B": tilted(0.25 * pi, (0.0, 0.02), 1.0, 1.0)},
        {"A": (13, 5), "B": (5, 5)},
    ),
    "a corner below a face": (
        {"A": lambda x, y: (2.0 * x - 1.0, y - 1.0), "B": tilted(-0.3, (-0.7, 0.6), 2.0, 1.0)},
        {"A": (7, 5), "B": (9, 5)},
    ),
    "beams": (
        {"A": lambda x, y: (4.0 * x - 2.0, 0.4 * y - 0.4), "B": tilted(0.08, (0.4, 0.03), 3.0, 0.3)},
        {"A": (18, 2), "B": (11, 2)},
    ),
    "plates thinner than the reach": (
        {"A": lambda x, y: (4.0 * x - 2.0, 0.05 * y - 0.05), "B": tilted(0.05, (-0.9, 0.03), 2.0, 0.04)},
        {"A": (18, 1), "B": (11, 1)},
    ),
}


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("is_general", [False, True])
@pytest.mark.parametrize("scene", SCENES)
def test_whole_skins_keep_corners_out(
    tmp_path: Path, scene: str, is_general: bool, friction: float
) -> None:
    """Whole skins collide: energy, momenta, and no node deeper than 0.02 of a segment."""
    places, counts = SCENES[scene]
    deck = Deck.titled("skins")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    for name, place in places.items():
        mesh = with_skin(grid("CPS4", *counts[name], place))
        add_body(deck, name, "CPS4", mesh, SKIN="S" + name)
    if is_general:
        deck.extend(f"*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{friction}\n*CONTACT\n")
        deck.extend("*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , DRY\n")
        deck.extend(f"*CONTACT FORMULATION, {SURFACES}\n")
    else:
        contact(deck, "SB", "SA", friction)
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\nNA, 2, 0.5\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 1.6\n")
    deck.extend("*NODE FILE, FREQUENCY=1\nU\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    assert result.run["cutbacks"] == 0
    gains_nothing(result, "ALL_EXTERIOR" if is_general else "SB_SA")
    momentum = result.history.momentum
    for values in (momentum.linear, momentum.angular):
        assert np.abs(values - values[0]).max() < 1e-12 * np.abs(values).max()
    overlaps = intrusion.follow(result)
    assert max(overlap.depth for overlap in overlaps) < 0.02


@pytest.mark.parametrize("setting", ["", "IMPACT TIME=EVENT"])
def test_bent_plates_do_not_touch_their_own_far_side(tmp_path: Path, setting: str) -> None:
    """A face on one side is in front of the lines of bent faces on the other side, beyond their ends."""
    places, counts = SCENES["plates thinner than the reach"]
    deck = Deck.titled("plates")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    for name, place in places.items():
        add_body(deck, name, "CPS4I", with_skin(grid("CPS4I", *counts[name], place)), SKIN="S" + name)
    deck.extend(f"*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT FORMULATION, {SURFACES}\n")
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\nNA, 2, 0.5\n")
    deck.extend(f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 1.6\n*STICKSLIP, {setting}\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    assert result.run["cutbacks"] == 0
    gains_nothing(result, "ALL_EXTERIOR")


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_the_legs_of_a_bent_strip_are_pressed_on_each_other(tmp_path: Path, friction: float) -> None:
    length, radius = 2.0, 0.3
    whole = 2.0 * length + pi * radius

    def place(x: float, y: float) -> tuple[float, float]:
        way, off = x * whole, radius + 0.06 * (0.5 - y)
        if way < length:
            return length - way, off
        if way < length + pi * radius:
            angle = (way - length) / radius
            return -off * sin(angle), off * cos(angle)
        return way - length - pi * radius, -off

    deck = Deck.titled("strip")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    add_body(deck, "A", "CPS4", with_skin(grid("CPS4", 60, 2, place)), SKIN="SA")
    deck.extend(f"*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{friction}\n")
    deck.extend(f"*CONTACT PAIR, INTERACTION=DRY, {SURFACES}\nSA\n")
    deck.extend("*AMPLITUDE, NAME=RAMP\n0., 0., 1., 1.\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 1.\n")
    supports = "NLEFTA, 2, 2, -0.32\nNRIGHTA, 2, 2, 0.32\nNRIGHTA, 1, 1, -0.3\n"
    deck.extend(f"*BOUNDARY, AMPLITUDE=RAMP\n{supports}")
    deck.extend("*NODE FILE, FREQUENCY=1\nU\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    gains_nothing(result, next(iter(result.contact)))
    assert result.run["cutbacks"] == 0
    assert max(overlap.depth for overlap in intrusion.follow(result)) < 0.02


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_pairs_in_both_orders_slide_a_segment_in_an_increment(tmp_path: Path, friction: float) -> None:
    """The corner of the lower block ends each increment outside the upper one, whose face turns: its straight path, of the
    length of a segment, cuts that. Means leave single nodes deeper in than where they slide less (0.01)."""
    path = tmp_path / "deck.inp"
    path.write_text(elastic_blocks.two_blocks(32, friction, segments=1.0, kind=""))
    result = program.run(path, tmp_path)
    assert list(result.contact) == ["UPPER_LOWER"]
    assert result.run["cutbacks"] == 0
    assert max(overlap.depth for overlap in intrusion.follow(result)) < 0.04


def test_the_stored_formulation_is_told(tmp_path: Path) -> None:
    deck = rings()
    contact(deck, "SB", "SA", 0.0)
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.04\n*END STEP\n")
    path = deck.write(tmp_path / "deck.inp")
    program.run(path, tmp_path)
    assert "surface to surface" in (tmp_path / "deck.log").read_text()
    words = [program.binary(), "info", tmp_path / "deck.vtkhdf"]
    told = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    assert "SB_SA, surface to surface, largest normal force" in told
    with h5py.File(tmp_path / "deck.vtkhdf") as file:
        assert file["history/contact/SB_SA"].attrs["formulation"] == "SURFACE TO SURFACE"


def test_nodes_as_slaves_have_segments_all_the_same(tmp_path: Path) -> None:
    deck = rings()
    deck.extend("*SURFACE, NAME=SN, TYPE=NODE\nNB\n")
    contact(deck, "SN", "SA", 0.0)
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.04\n*END STEP\n")
    path = deck.write(tmp_path / "deck.inp")
    done = subprocess.run([program.binary(), "check", path], capture_output=True, text=True)
    told = done.stdout + done.stderr
    assert done.returncode == 0, told
    assert "is taken as NODE TO SURFACE" in told
    assert "the slave surface must be made of element faces" in told


@pytest.mark.parametrize("setting", ["", "CONTACT MASS=REDISTRIBUTED", "LANDING=RETURN"])
def test_a_ring_falls_on_a_rigid_arc(tmp_path: Path, setting: str) -> None:
    deck = Deck.titled("ring")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    add_body(deck, "B", "CPS4", ring(34, 0.3, 1.02, 1.0), OUT="SB")
    corners = [(3.0 * cos(a), 3.0 * sin(a) - 3.0) for a in np.linspace(0.75 * pi, 0.25 * pi, 16)]
    deck.add("NODE", (9000, 0.0, -3.0))
    deck.add("SURFACE, NAME=R, TYPE=SEGMENTS", ("START", *corners[0]), *(("LINE", *p) for p in corners[1:]))
    deck.add("RIGID BODY, REF NODE=9000, ANALYTICAL SURFACE=R")
    contact(deck, "SB", "R", 0.3)
    deck.extend("*BOUNDARY\n9000, 1, 2\n*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\n")
    deck.extend(f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 1.6\n*STICKSLIP, {setting}\n*END STEP\n")
    gains_nothing(program.run(deck.write(tmp_path / "deck.inp"), tmp_path), "SB_R")


def test_a_rigid_disc_rolls_over_a_soft_block(tmp_path: Path) -> None:
    deck = Deck.titled("disc")
    deck.extend(f"*MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.\n")
    mesh = grid("CPE4", 20, 5, lambda x, y: (4.0 * x - 2.0, 0.8 * y - 0.8))
    add_body(deck, "B", "CPE4", mesh, TOP="SB")
    turns = np.linspace(0.5 * pi, -1.5 * pi, 49)[:-1]
    corners = [(0.5 * cos(a) - 1.0, 0.5 * sin(a) + 0.5) for a in turns]
    deck.add("NODE", (9000, -1.0, 0.5))
    lines = (("LINE", *p) for p in [*corners[1:], corners[0]])
    deck.add("SURFACE, NAME=R, TYPE=SEGMENTS", ("START", *corners[0]), *lines)
    deck.add("RIGID BODY, REF NODE=9000, ANALYTICAL SURFACE=R")
    deck.extend("*ELEMENT, TYPE=MASS, ELSET=EM\n9100, 9000\n*MASS, ELSET=EM\n1.\n")
    deck.extend("*ELEMENT, TYPE=ROTARYI, ELSET=ER\n9101, 9000\n")
    deck.extend("*ROTARY INERTIA, ELSET=ER\n0., 0., 0.125\n")
    contact(deck, "SB", "R", 0.3)
    deck.extend("*BOUNDARY\nNBOTTOMB, 1, 2\n*INITIAL CONDITIONS, TYPE=VELOCITY\n9000, 1, 1.\n9000, 2, -0.5\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 1.\n*CLOAD\n9000, 2, -9.81\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    gains_nothing(result, "SB_R")
    assert result.history.rigid.R.angular_velocity[-1] < -1.0


def gains_nothing(result: Result, name: str) -> None:
    """The bodies touch, energy never rises, and the ledger is closed."""
    energy = result.history.energy
    assert getattr(result.history.contact, name).normal.max() > 0.0
    total = energy.kinetic + energy.strain - energy.external_work
    assert np.diff(total).max() < 1e-12 * energy.largest
    assert np.abs(energy.balance).max() < 1e-12 * energy.largest


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("scheme", ["ENERGY-MOMENTUM", "SS22"])
def test_sheared_blocks_with_an_overhang_need_no_cutback(
    tmp_path: Path, friction: float, scheme: str
) -> None:
    """The end of the master lies inside a slave face, whose node sticks as the bodies are strained."""
    deck = Deck.titled("blocks")
    deck.extend("*MATERIAL, NAME=M\n*ELASTIC\n1.E4, 0.3\n*DENSITY\n1.\n")
    places: dict[str, Place] = {
        "A": lambda x, y: (x, 0.5 * y - 0.5),
        "B": lambda x, y: (0.1 + x, 0.5 * y),
    }
    for name, side, count in (("A", "TOP", 45), ("B", "BOTTOM", 32)):
        mesh = grid("CPE4", count, count // 2, places[name])
        add_body(deck, name, "CPE4", mesh, **{side: "S" + name})
    contact(deck, "SB", "SA", friction)
    deck.extend("*BOUNDARY\nNBOTTOMA, 1, 2\n")
    deck.extend("*AMPLITUDE, NAME=PRESS\n0., 0., 0.1, 1., 1., 1.\n")
    deck.extend("*AMPLITUDE, NAME=SHEAR\n0., 0., 0.1, 0., 0.2, 1.\n")
    deck.extend(f"*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.2\n*STICKSLIP, SCHEME={scheme}\n")
    deck.extend("*BOUNDARY, AMPLITUDE=PRESS\nNTOPB, 2, 2, -0.01\n")
    deck.extend("*BOUNDARY, AMPLITUDE=SHEAR\nNTOPB, 1, 1, 0.02\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    assert len(result.history.time) == 21
    energy = result.history.energy
    if scheme == "ENERGY-MOMENTUM":
        total = energy.kinetic + energy.strain - energy.external_work
        assert np.diff(total).max() < 1e-13 * energy.largest


def wall(courses: int) -> Deck:
    """A wall of bricks in bond on a floor, with joints, under its weight."""
    deck = Deck.titled("wall")
    deck.extend("*MATERIAL, NAME=M\n*ELASTIC\n1.E6, 0.2\n*DENSITY\n1.\n")
    floor = grid("CPS4", courses * 2 + 2, 1, lambda x, y: (0.225 * (courses + 1) * x - 0.1, 0.1 * y - 0.1))
    add_body(deck, "FLOOR", "CPS4", floor)
    for course in range(courses):
        for k in range(courses):
            left, low = 0.202 * k + 0.101 * (course % 2), 1e-5 * (course + 1) + 0.1 * course

            def place(x: float, y: float) -> tuple[float, float]:
                return left + 0.2 * x, low + 0.1 * y

            add_body(deck, f"B{course}{k}", "CPS4", grid("CPS4", 4, 2, place))
    deck.extend("*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.6\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n")
    deck.extend(f"*CONTACT FORMULATION, {SURFACES}\n*CONTACT PROPERTY ASSIGNMENT\n, , DRY\n")
    deck.extend("*BOUNDARY\nNFLOOR, 1, 2\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.001, 0.02\n")
    deck.extend("*DLOAD\n, GRAV, 10., 0., -1.\n*END STEP\n")
    return deck


def test_a_wall_of_bricks_needs_no_cutback(tmp_path: Path) -> None:
    """Tips of bricks lie on the brick above, whose far end is not what they are behind."""
    result = program.run(wall(3).write(tmp_path / "deck.inp"), tmp_path)
    assert result.run["cutbacks"] == 0
    assert result.history.solver.passes.mean() < 6
    gains_nothing(result, "ALL_EXTERIOR")


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("make", [rings, beams])
def test_both_sides_show_pressure_slip_and_state(
    tmp_path: Path, make: Callable[[], Deck], friction: float
) -> None:
    deck = make()
    contact(deck, "SB", "SA", friction)
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\nNA, 2, 0.5\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.4\n*NODE FILE, FREQUENCY=1\nU\n*END STEP\n")
    result = program.run(deck.write(tmp_path / "deck.inp"), tmp_path)
    assert_holds(result)
    certificate = certify(result)
    told = {check.name: check.count for check in certificate.checks}
    assert told["gap"] > 0 and told["cone"] > len(result.frames)
    assert (told["slip"] > 0) == (friction > 0.0)
    seen = 0
    for before, frame in zip(result.frames, list(result.frames)[1:]):
        status, slip = frame["CONTACT_STATUS"], frame["SLIP"]
        pressed = np.linalg.norm(frame["CONTACT_FORCE"], axis=1) > 0.0
        for side in ("A", "B"):
            nodes = result.node_set("N" + side)
            own = nodes[pressed[nodes]]
            # a slave node beside a closed mean may carry a part of its force
            assert (status[own] >= (2 if side == "A" else 1)).all()
            assert (frame["CONTACT_PRESSURE"][own] > 0.0).all()
            step = (slip - before["SLIP"])[own]
            assert (step >= 0.0).all()
            if friction == 0.0 and (status[own] >= 2).any():
                assert step.max() > 0.0
            seen += len(own)
    assert seen > 40


def test_forces_out_of_the_cone_and_means_off_their_masters_are_found(tmp_path: Path) -> None:
    deck = rings()
    contact(deck, "SB", "SA", 0.3)
    deck.extend("*INITIAL CONDITIONS, TYPE=VELOCITY\nNB, 2, -1.\nNB, 1, 0.3\nNA, 2, 0.5\n")
    deck.extend("*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 0.2\n*NODE FILE, FREQUENCY=1\nU\n*END STEP\n")
    program.run(deck.write(tmp_path / "deck.inp"), tmp_path)

    def failing(field: str, amount: float) -> list[str]:
        path = shutil.copy(tmp_path / "deck.vtkhdf", tmp_path / "spoiled.vtkhdf")
        with h5py.File(path, "r+") as file:
            values = file[f"VTKHDF/PointData/{field}"]
            closed = np.flatnonzero(file["VTKHDF/PointData/CONTACT_STATUS"][:] >= 2)
            slaves = file["model/contacts/SB_SA/slaves"][:]
            nodes = len(file["model/coordinates"])
            row = int(closed[np.isin(closed % nodes, slaves)][-1])
            size = 1.0 if field == "GAP" else np.abs(values[:][closed]).max()
            values[row] += amount * size
        return [check.name for check in certify(path).checks if not check.holds]

    assert "gap" in failing("GAP", 1e-4)
    assert "cone" in failing("CONTACT_FORCE", 0.1)
