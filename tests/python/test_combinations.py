"""The short part of the laboratory of combinations: no deck fails but for what is known."""

from itertools import combinations
from pathlib import Path

import pytest
from lab.combinations import SEED, SHORT, decks_of, judge, judge_all
from lab.covering import Covering, pairs_of
from lab.levels import FACTORS, SIMPLEST, allows
from lab.mutations import MUTATIONS, Mutation
from lab.scene import Scene
from lab.single import SINGLE
from repository import ROOT
from stickslip import program


def test_short_part() -> None:
    _, decks = decks_of(SEED, SHORT)
    wrong = [
        f"{verdict.name}: {', '.join(verdict.choice.values())}: {oracle}: {said}"
        for verdict in judge_all(decks, program.binary(), 2)
        for oracle, said in verdict.failures.items()
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("name", SINGLE)
def test_single_models(name: str, tmp_path: Path) -> None:
    assert SINGLE[name](program.binary(), tmp_path) == []


def test_an_array_covers_all_pairs_that_may_stand_together() -> None:
    factors = {"a": ["1", "2", "3"], "b": ["1", "2"], "c": ["1", "2", "3", "4"], "d": ["1", "2"]}

    def may(choice: dict[str, str]) -> bool:
        return not (choice.get("a") == "1" and choice.get("c") == "4")

    covering = Covering(factors, may, 3)
    choices = list(covering.choices())
    covered = {pair for choice in choices for pair in pairs_of(choice)}
    every = {
        frozenset(((a, one), (b, other)))
        for a, b in combinations(factors, 2)
        for one in factors[a]
        for other in factors[b]
    }
    assert covered == covering.pairs == every - {frozenset((("a", "1"), ("c", "4")))}
    assert len(choices) < 2 * 12
    assert choices == list(Covering(factors, may, 3).choices())


def test_decks_are_small_and_the_same_each_time() -> None:
    _, decks = decks_of(SEED, 12)
    for _, choice in decks:
        assert set(choice) == set(FACTORS) and allows(choice)
        scene = Scene(choice)
        assert scene.deck() == Scene(choice).deck()
        assert sum(len(body.mesh.elements) for body in scene.bodies) <= 150


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_mutations_have_their_places(mutation: Mutation) -> None:
    text = (ROOT / mutation.file).read_text()
    assert mutation.put_into(text) != text


@pytest.mark.parametrize("family", ["CPE4I", "CPE8RH"])
def test_certificate_of_a_body_at_rest_divides_no_round_off(family: str) -> None:
    choice = {**SIMPLEST, "family": family, "procedure": "dynamic", "sequence": "rest"}
    assert judge("rest", choice, program.binary(), "certificate").failures == {}


@pytest.mark.parametrize("family", ["CPE4I", "CPS4I", "CAX4I"])
@pytest.mark.parametrize("procedure", ["static direct", "dynamic"])
def test_certificate_adds_enhanced_strains_of_rubber_as_logarithms(family: str, procedure: str) -> None:
    choice = {**SIMPLEST, "family": family, "material": "mooney", "procedure": procedure}
    assert judge("rubber", choice, program.binary(), "certificate").failures == {}


@pytest.mark.parametrize("procedure", ["static direct", "quasi-static"])
def test_certificate_of_a_support_that_fades(procedure: str) -> None:
    choice = {**SIMPLEST, "family": "CAX4", "procedure": procedure, "sequence": "released"}
    assert judge("released", choice, program.binary(), "certificate").failures == {}


@pytest.mark.parametrize("family", ["CPE4R", "CPE8"])
@pytest.mark.parametrize("procedure", ["static direct", "dynamic"])
def test_certificate_of_two_contacts_from_surface_to_surface_in_both_orders(family: str, procedure: str) -> None:
    choice = {**SIMPLEST, "family": family, "procedure": procedure, "contact": "both orders s2s", "interaction": "wear"}
    assert judge("both orders", choice, program.binary(), "certificate").failures == {}


FOUND = [
    ("rests", {"family": "CPE3", "procedure": "dynamic", "sequence": "rest", "contact": "surface to surface", "interaction": "rough"}),
    ("certificate", {"connection": "disc"}),
    ("own checks", {"procedure": "static direct", "sequence": "removed", "contact": "general floor", "interaction": "friction", "connection": "disc", "load": "rotation", "amplitude": "tabular"}),
    ("balance", {"procedure": "redistributed", "contact": "node to surface", "connection": "rigid elements", "load": "moment"}),
    ("balance", {"procedure": "quasi-static", "sequence": "contact removed", "contact": "node to surface", "connection": "rigid tie nodes", "load": "gravity"}),
    ("certificate", {"procedure": "quasi-static", "sequence": "contact removed", "contact": "both orders", "connection": "pin", "load": "face pressure", "amplitude": "smooth"}),
    ("certificate", {"family": "CPE8RH", "material": "rubber", "procedure": "events", "sequence": "released", "contact": "node surface", "interaction": "taumax", "connection": "kinematic coupling", "load": "rotation", "amplitude": "smooth"}),
    ("certificate", {"family": "CAX8RH", "material": "metal", "procedure": "lemke", "sequence": "two loads", "contact": "general", "interaction": "wear and heat", "connection": "disc", "load": "gravity", "amplitude": "modulated"}),
    ("certificate", {"family": "CPS6", "material": "rubber", "procedure": "no impulses", "sequence": "rest", "contact": "general surfaces", "interaction": "rough", "connection": "disc", "load": "centrifugal", "amplitude": "smooth", "output": "points"}),
    ("certificate", {"family": "CPE6", "material": "kinematic metal", "procedure": "automatic", "sequence": "removed", "contact": "general nodes", "connection": "disc", "load": "centrifugal"}),
    *((oracle, {"family": "CPE8RH", "material": "mooney", "procedure": "ss22", "sequence": "rest", "contact": "general", "interaction": "rough", "connection": "pre-tension", "amplitude": "total time", "output": "fields"}) for oracle in ("runs", "certificate")),
    ("restarted", {"family": "CAX8", "material": "mooney", "procedure": "dynamic", "sequence": "removed", "contact": "general", "interaction": "taumax", "connection": "kinematic coupling", "load": "rotation", "amplitude": "periodic", "form": "restarted"}),
]
"""What decks of the arrays have failed, with the levels that are left of them."""


@pytest.mark.parametrize(("oracle", "levels"), FOUND)
def test_what_arrays_have_found(oracle: str, levels: dict[str, str]) -> None:
    choice = {**SIMPLEST, **levels}
    assert allows(choice)
    assert judge("found", choice, program.binary(), oracle).failures == {}


def test_an_amplitude_has_the_times_of_the_step_that_it_acts_in() -> None:
    for sequence, end in (("rest", "1.0"), ("hold", "0.1")):
        choice = {**SIMPLEST, "procedure": "dynamic", "sequence": sequence, "amplitude": "total time"}
        assert f"TIME=TOTAL TIME\n0., 0., {end}, 1.\n" in Scene(choice).deck()
