"""Decks built by the typed methods of `Deck`: the program takes them, and they do what their names say."""

from pathlib import Path

import pytest
from bodies import FAMILIES, grid
from stickslip import Deck, Fault, run
from stickslip.building import FORMULATIONS, ROUGH, element_types

LAWS = ("elastic", "plastic", "kinematic", "neo_hooke", "mooney_rivlin", "yeoh", "ogden")


def with_material(deck: Deck, law: str) -> Deck:
    """The deck with a material M of a law."""
    if law == "elastic":
        return deck.elastic("M", 1000.0, 0.3, 1.0, alpha=0.1, beta=1e-4)
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


def test_faults_of_materials_are_exceptions() -> None:
    deck = Deck.titled("faults")
    for build, message in (
        (lambda: deck.plastic("M", 1.0, 0.3, [(1.0, 0.1)], 1.0), "plastic strain 0"),
        (lambda: deck.yeoh("M", (1.0,), (1.0,), 1.0), "three C"),
        (lambda: deck.ogden("M", [], (), 1.0), "one to three terms"),
        (lambda: deck.rigid_line("R", [(0.0, 0.0)], "REF"), "two points or more"),
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


def test_springs_dashpots_masses_and_rigid_bodies(tmp_path: Path) -> None:
    """A rigid block with a mass of its own hangs on a spring beside a dashpot: its weight stretches the spring."""
    deck = Deck.titled("a block on a spring")
    deck.add_mesh(grid("CPE4", 1, 1, lambda x, y: (x - 0.5, y - 0.5)))
    deck.elastic("M", 1000.0, 0.3, 2.0).section("BODY", "M")
    reference, above = deck.node("REF", 0.0, 0.0), deck.node("ABOVE", 0.0, 3.0)
    deck.rigid_body("BODY", "REF").point_mass(reference, 1.5)
    deck.spring(above, reference, 100.0).dashpot(above, reference, 20.0)
    deck.support("ABOVE").support("REF", 1, 6)
    with deck.step(0.02, 4.0, automatic=True):
        deck.gravity("BODY", 10.0).history("REF")
    result = run(deck, tmp_path, threads=1)
    assert result.quantity("nodes/REF/U2")[-1] == pytest.approx(-0.2, rel=0.01)


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
