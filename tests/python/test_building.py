"""Decks built by the typed methods of `Deck`: the program takes them, and they do what their names say."""

from pathlib import Path

import numpy as np
import pytest
from bodies import FAMILIES, grid
from stickslip import Deck, Fault, run
from stickslip.building import FORMULATIONS, ROUGH, element_types

LAWS = ("elastic", "hencky", "plastic", "kinematic", "neo_hooke", "mooney_rivlin", "yeoh", "ogden")


def with_material(deck: Deck, law: str) -> Deck:
    """The deck with a material M of a law."""
    if law == "elastic":
        return deck.elastic("M", 1000.0, 0.3, 1.0, alpha=0.1, beta=1e-4)
    if law == "hencky":
        return deck.hencky("M", 1000.0, 0.3, 1.0, beta=1e-4)
    if law in ("plastic", "kinematic"):
        table = [(7.0, 0.0), (30.0, 0.1)]
        return deck.plastic("M", 1000.0, 0.3, table, 1.0, kinematic=law == "kinematic")
    if law == "neo_hooke":
        return deck.neo_hooke("M", 200.0, 2e-3, 1.0)
    if law == "mooney_rivlin":
        return deck.mooney_rivlin("M", 150.0, 50.0, 2e-3, 1.0)
    if law == "yeoh":
        return deck.yeoh("M", (200.0, -2.0, 1.0), (2e-3, 0.0, 0.0), 1.0)
    return deck.ogden("M", [(300.0, 2.0), (100.0, -2.0), (20.0, 4.0)], (2e-3, 0.0, 0.0), 1.0)


def block(plane: str, formulation: str, count: int, law: str = "elastic", left: float = 1.0) -> Deck:
    """A block of two by two elements, held below."""
    mesh = grid(f"CPE{count}", 2, 2, lambda x, y: (left + x, y))
    deck = Deck.titled(f"{plane} {formulation} {count} {law}")
    deck.add_mesh(mesh, plane, formulation)
    with_material(deck, law)
    deck.section("BODY", "M", None if plane == "axisymmetric" else 1.0)
    return deck.support("NBOTTOM")


def test_every_type_of_elements_is_built(tmp_path: Path) -> None:
    """All types that the program has, and no other; triangles are the plain ones of their planes."""
    built = set()
    for plane in ("strain", "stress", "axisymmetric"):
        for formulation in FORMULATIONS:
            if plane == "stress" and "hybrid" in formulation:
                with pytest.raises(Fault, match="no element is hybrid"):
                    element_types(plane, formulation)
                continue
            for count, kind in element_types(plane, formulation).items():
                if kind in built:
                    continue
                built.add(kind)
                deck = block(plane, formulation, count)
                assert deck.one("ELEMENT").parameters["TYPE"] == kind
                with deck.static_step():
                    deck.pressure("TOP", 10.0)
                result = run(deck, tmp_path, frames=1, threads=1)
                assert result.frames[-1]["U2"].min() < -0.005
                assert result.is_axisymmetric == (plane == "axisymmetric")
    assert built == {kind for family in FAMILIES.values() for kind in family}
    for wrong, message in ((("solid", ""), "no plane"), (("strain", "enhanced"), "no formulation")):
        with pytest.raises(Fault, match=message):
            element_types(*wrong)


@pytest.mark.parametrize("law", LAWS)
def test_materials(law: str, tmp_path: Path) -> None:
    deck = block("strain", "hybrid", 4, law)
    deck.amplitude("RISE", [(0.0, 0.0), (1.0, 1.0)])
    with deck.static_step(0.25, 1.0, automatic=False):
        deck.pressure("TOP", 10.0, amplitude="RISE")
    result = run(deck, tmp_path, frames=4, threads=1)
    assert result.rows == 5 and len(result.frames) == 5
    # the four shear moduli agree but for their constants; a plastic one yields
    shortening = -result.frames[-1]["U2"].min()
    assert 0.004 < shortening < 0.05
    assert ("PEEQ" in result.frames.fields) == (law in ("plastic", "kinematic"))
    if "PEEQ" in result.frames.fields:
        assert result.frames[-1]["PEEQ"].max() > 1e-3


def test_faults_are_exceptions() -> None:
    deck = Deck.titled("faults")
    for build, message in (
        (lambda: deck.plastic("M", 1.0, 0.3, [(1.0, 0.1)], 1.0), "plastic strain 0"),
        (lambda: deck.yeoh("M", (1.0,), (1.0,), 1.0), "three C"),
        (lambda: deck.ogden("M", [], (), 1.0), "one to three terms"),
        (lambda: deck.rigid_line("R", [(0.0, 0.0)], "REF"), "two points or more"),
        (lambda: deck.hinge(3, 3), "node 3 twice"),
        (lambda: deck.pre_tension("CUT", "BOLT", (0.0, 0.0)), "no length"),
        (lambda: deck.equation((1, 2, 1.0)), "two terms or more"),
        (lambda: deck.equation((1, 2, 1.0), (2, 6, 1.0)), "direction 6 is not 1 or 2"),
        (lambda: deck.equation((1, 2, 1.0), (2, 1, 0.0)), "is not 0"),
        (lambda: deck.spring(1, 2, [(0.0, 0.0)]), "two rows or more"),
        (lambda: deck.dashpot(1, 2, [(0.0, 0.0), (1.0, 0.0)]), "second column increases"),
    ):
        with pytest.raises(Fault, match=message):
            build()
    assert [card.keyword for card in deck.cards] == ["HEADING"]


@pytest.mark.parametrize("discretisation", ["", "node to surface", "surface to surface"])
@pytest.mark.parametrize("friction", [0.3, ROUGH])
def test_a_rigid_line_presses_through_contact(discretisation: str, friction: float | str, tmp_path: Path) -> None:
    deck = block("strain", "", 4)
    deck.node("REF", 1.5, 2.0)
    deck.rigid_line("PLATE", [(3.0, 1.0), (0.0, 1.0)], "REF")
    deck.contact("TOP", "PLATE", friction, discretisation)
    with deck.static_step(0.25, automatic=True):
        deck.support("REF", 1).support("REF", 2, value=-0.05)
    result = run(deck, tmp_path, threads=1)
    force = result.quantity("rigid/PLATE/force")[-1]
    assert force[1] < -30.0 and result.frames[-1]["U2"].min() == pytest.approx(-0.05, rel=1e-9)


SPRINGS = {
    "linear": (100.0, 20.0),
    "tables": ([(0.0, 0.0), (10.0, 0.05), (30.0, 0.35)], [(-20.0, -1.0), (20.0, 1.0)]),
}
"""Laws of a spring that 20 stretch by 0.2, and of a dashpot."""


@pytest.mark.parametrize("kind", SPRINGS)
def test_springs_dashpots_masses_and_rigid_bodies(kind: str, tmp_path: Path) -> None:
    """A rigid block with a mass of its own hangs on a spring beside a dashpot: its weight stretches the spring."""
    spring, dashpot = SPRINGS[kind]
    deck = Deck.titled("a block on a spring")
    deck.add_mesh(grid("CPE4", 1, 1, lambda x, y: (x - 0.5, y - 0.5)))
    deck.elastic("M", 1000.0, 0.3, 2.0).section("BODY", "M")
    reference, above = deck.node("REF", 0.0, 0.0), deck.node("ABOVE", 0.0, 3.0)
    deck.rigid_body("BODY", "REF").point_mass(reference, 1.5)
    deck.spring(above, reference, spring).dashpot(above, reference, dashpot)
    deck.support("ABOVE").support("REF", 1, 6)
    with deck.step(0.02, 4.0, automatic=True):
        deck.gravity("BODY", 10.0).history("REF")
    result = run(deck, tmp_path, threads=1)
    assert result.quantity("nodes/REF/U2")[-1] == pytest.approx(-0.2, rel=0.01)


def test_a_hinge_between_rigid_bodies(tmp_path: Path) -> None:
    """A square swings about a corner: at first its centre falls with g/8 * 3, m g/2 over 2/3 m being the angular acceleration."""
    deck = Deck.titled("a square on a hinge")
    square = grid("CPE4", 8, 8, lambda x, y: (x, y))
    left = deck.add_mesh(square)
    right = grid("CPE4", 8, 8, lambda x, y: (1.0 + x, y))
    right.element_sets = {"SWING": right.element_sets["BODY"]}
    right.sides, right.node_sets = {}, {}
    second = deck.add_mesh(right)
    deck.elastic("M", 1000.0, 0.3, 1.0).section("BODY", "M").section("SWING", "M")
    for elements, reference, x in (("BODY", "FIRST", 0.5), ("SWING", "SECOND", 1.5)):
        deck.node(reference, x, 0.5)
        deck.rigid_body(elements, reference)
    corner, other = (int(np.argmin(np.hypot(*(one.points - (1.0, 1.0)).T))) for one in (square, right))
    deck.hinge(left + corner, second + other).support("FIRST", 1, 2, 6)
    with deck.step(0.001, 0.04):
        deck.gravity("SWING", 10.0).history("SECOND")
    result = run(deck, tmp_path, threads=1)
    assert result.quantity("nodes/SECOND/U2")[-1] == pytest.approx(-0.5 * 3.75 * 0.04**2, rel=0.03)
    places = result.frames[-1].positions
    assert np.allclose(places[corner], places[len(square.points) + other], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("distributing", [False, True])
def test_couplings(distributing: bool, tmp_path: Path) -> None:
    """The top rides on a node; or a force on a node goes to the top, whose mean the node is."""
    deck = block("strain", "", 4)
    deck.node("REF", 1.5, 2.0)
    deck.coupling("GRIP", "TOP", "REF", distributing)
    with deck.static_step(0.5, automatic=True):
        if distributing:
            deck.load("REF", x=3.0, y=-30.0)
        else:
            deck.support("REF", 1, 6).support("REF", 2, value=-0.05)
    result = run(deck, tmp_path, threads=1)
    frame = result.frames[-1]
    top = frame["U"][result.node_set("NTOP")]
    (reference,) = result.node_set("REF")
    assert np.allclose(top.mean(axis=0), frame["U"][reference], rtol=1e-9)
    if distributing:
        assert frame["RF"][result.node_set("NBOTTOM")].sum(axis=0) == pytest.approx([-3.0, 30.0], rel=1e-9)
        assert np.ptp(top[:, 1]) > 1e-4
    else:
        assert np.allclose(top, [0.0, -0.05], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("normal", [None, (0.0, 1.0)])
def test_a_bolt_is_tightened_and_locked(normal: tuple[float, float] | None, tmp_path: Path) -> None:
    """The force of a bolt that is held at both ends is that of its cut."""
    deck = block("strain", "", 4).support("NTOP")
    deck.add("SURFACE, NAME=CUT", (1, "S3"), (2, "S3"))
    deck.node("BOLT", 0.0, 0.0)
    deck.pre_tension("CUT", "BOLT", normal)
    with deck.static_step():
        deck.load("BOLT", x=5.0)
    result = run(deck, tmp_path, threads=1)
    frame = result.frames[-1]
    assert frame["RF"][result.node_set("NBOTTOM"), 1].sum() == pytest.approx(-5.0, rel=1e-9)
    (bolt,) = result.node_set("BOLT")
    assert frame["U"][bolt, 0] > 1e-3


def test_equations_join_nodes(tmp_path: Path) -> None:
    """A node of its own moves the top; its reaction is that of the top."""
    deck = block("strain", "", 4)
    deck.node("HAND", 0.0, 3.0)
    deck.equation(("NTOP", 2, 1.0), ("HAND", 2, -2.0))
    with deck.static_step():
        deck.support("HAND", 2, value=-0.02).support("HAND", 1)
    result = run(deck, tmp_path, threads=1)
    frame = result.frames[-1]
    assert np.allclose(frame["U"][result.node_set("NTOP"), 1], -0.04, rtol=1e-12)
    (hand,) = result.node_set("HAND")
    bottom = frame["RF"][result.node_set("NBOTTOM"), 1].sum()
    assert bottom > 10.0 and frame["RF"][hand, 1] == pytest.approx(-2.0 * bottom, rel=1e-9)


def test_ties_and_general_contact(tmp_path: Path) -> None:
    deck = block("strain", "", 4)
    lid = grid("CPE4", 3, 1, lambda x, y: (1.0 + x, 1.0 + 0.5 * y))
    lid.element_sets = {"LID": lid.element_sets["BODY"]}
    lid.sides = {name + "LID": one for name, one in lid.sides.items()}
    lid.node_sets = {name + "LID": one for name, one in lid.node_sets.items()}
    deck.add_mesh(lid, "strain", "incompatible")
    deck.section("LID", "M").tie("BOTTOMLID", "TOP")
    deck.general_contact(0.2, "node to surface")
    with deck.step(0.01, 0.05, impact="NONE"):
        deck.pressure("TOPLID", 5.0)
    result = run(deck, tmp_path, threads=1)
    assert result.frames[-1]["U2"].min() < -0.001 and list(result.contact) == ["ALL_EXTERIOR"]


def test_heat(tmp_path: Path) -> None:
    """A block between two walls that lets its top move: S11 = -E (1/theta^2 - 1)/2 over the stretch along y, nu = 0."""
    mesh = grid("CPE4", 2, 2, lambda x, y: (x, y))
    deck = Deck.titled("heat")
    deck.add_mesh(mesh, "stress")
    deck.elastic("M", 1000.0, 0.0, 1.0).expansion([(1e-4, 0.0), (2e-4, 100.0)], zero=10.0)
    deck.section("BODY", "M").initial_temperature("BODY", 10.0)
    deck.support("NBOTTOM", 2).support("NLEFT", 1).support("NRIGHT", 1)
    with deck.static_step():
        deck.temperature("BODY", 60.0)
    frame = run(deck, tmp_path, frames=1, threads=1).frames[-1]
    theta = 1.0 + 1.6e-4 * 50.0
    # sigma_11 = theta S_11 (E_m)_11/J, J = theta^2 with both free stretches
    stress = theta * 1000.0 * (theta**-2 - 1.0) / 2.0 / theta**2
    assert frame["S"][:, 0] == pytest.approx(stress, rel=1e-9)
    assert frame["NT"].max() == 60.0
    with pytest.raises(Fault, match="right behind the material"):
        Deck.titled("late").expansion(1e-5)
