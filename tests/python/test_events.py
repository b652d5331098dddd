"""Decks that stopped with a node gone through a segment when impacts were events run to their ends."""

import pytest
from conftest import ROOT, Job
from stickslip.deck import Deck
from stickslip.result import Result

BEAM = ROOT / "tests/decks/beam_lands_with_events.inp"
"""A beam without mass at its surface lands on a rigid floor with a hollow vertex."""

STACK = ROOT / "tests/decks/stack_with_events.inp"
"""Twenty blocks on each other, whose corners meet corners."""

EVENTS = {"IMPACT_TIME": "EVENT", "CONTACT_MASS": "REDISTRIBUTED"}
ALL = EVENTS | {"LANDING": "RETURN", "LCP": "LEMKE", "FACTORIZATION": "EVERY PASS"}


@pytest.mark.parametrize("settings", [EVENTS, ALL])
def test_a_beam_lands_round_a_hollow_vertex(job: Job, settings: dict[str, str]) -> None:
    deck = Deck.read(BEAM)
    deck.set_settings(**settings)
    with Result(job(deck)) as results:
        ended(results, 1)


@pytest.mark.parametrize(("kind", "cutbacks"), [("NODE TO SURFACE", 0), ("SURFACE TO SURFACE", 1)])
def test_corners_of_a_stack_hold_each_other(job: Job, kind: str, cutbacks: int) -> None:
    # a short part of an increment between two impacts ends above the tolerance by round-off, from surface to surface
    deck = Deck.read(STACK)
    deck.set_formulation(kind)
    deck.set_increments(deck.dt, 49)
    with Result(job(deck)) as results:
        ended(results, cutbacks)


def ended(results: Result, cutbacks: int) -> None:
    """The run went to its end, with so many cutbacks at most, and kept its balance."""
    record = results.file["run"].attrs
    assert record["exit_status"] == 0 and record["cutbacks"] <= cutbacks
    assert abs(results.history.energy["balance"]).max() < 1e-10 * results.history.energy.largest
