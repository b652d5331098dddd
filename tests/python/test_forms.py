"""The same deck moved, turned, mirrored, boosted, renumbered, in another order, in other units."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Job
from lab import changed_decks as changed
from lab.changed_decks import Unchangeable
from lab.expected_results import Change, Deviations, Seen, deviations
from lab.invariance import FORMS, TOLERANCE, Settings, flat, judge
from lab.sample_decks import Sample, all_samples
from stickslip.deck import Deck
from stickslip.program import binary

DECKS = (
    # a rigid surface that moves
    "tests/decks/rigid_floor",
    # three steps, equations, loads of all kinds, damping
    "tests/decks/every_card",
    # friction in two passes, two steps
    "input/fast_bullet/bullet_two",
    # the paper's scheme, loads, large rotations
    "input/two_cantilevers/A_mu04",
    # prescribed motion in both directions
    "verification/convergence/blocks_16_mu03_p2",
    # supports of one direction, damping
    "verification/damping/em_beta_long",
    # bodies of revolution
    "input/disc_spring/disc_spring_mu014",
)

ENOUGH = 0.5
"""Seconds of processor time of a run."""

EVERY_CARD = ROOT / "tests/decks/every_card.inp"
FLOOR = ROOT / "tests/decks/rigid_floor.inp"


def sample(name: str) -> Sample:
    """A deck by its name."""
    return next(sample for sample in all_samples() if sample.name == name)


@pytest.mark.parametrize("name", DECKS)
def test_what_has_one_answer_has_it_in_every_form(name: str) -> None:
    verdict = judge(sample(name), Settings(binary(), ENOUGH, tuple(FORMS)))
    assert verdict.fault == ""
    outcomes = verdict.outcomes.items()
    assert {form: outcome for form, outcome in outcomes if not outcome.is_good} == {}
    assert verdict.compared >= 10
    assert sum(not outcome.refused for _, outcome in outcomes) >= 5


def flat_floor(folder: Path) -> Deck:
    """A square that falls on a moving floor."""
    return flat(binary(), Deck.read(FLOOR).write(folder / "floor.inp"))


def compared(deck: Deck, other: Deck, change: Change, job: Job) -> Deviations:
    """Deviations of another deck from a deck."""
    first, second = Seen(job(deck), deck), Seen(job(other), other)
    return deviations(first, second, change, 0.5, set())


def test_it_sees_that_a_deck_is_elsewhere(tmp_path: Path, job: Job) -> None:
    deck = flat_floor(tmp_path)
    other = changed.moved(deck, np.array([1e-6, 0.0]))
    found = compared(deck, other, Change(), job).by_name
    assert found["history/bodies/center"].max() > 1e-8
    assert found["history/momentum/angular"].max() > 1e-8
    assert found["history/energy/kinetic"].max() < TOLERANCE


def test_it_sees_another_coefficient_of_friction(tmp_path: Path, job: Job) -> None:
    deck, other = flat_floor(tmp_path), flat_floor(tmp_path)
    other.one("FRICTION").rows = [["0.0"]]
    found = compared(deck, other, Change(), job).by_name
    assert np.isinf(found["history/contact/BOT_FLOOR/sticking"]).any()
    assert found["history/bodies/velocity"].max() > 1e-3


def test_two_corners_that_meet_do_not_depend_on_the_way_of_the_passes(
    tmp_path: Path, job: Job
) -> None:
    path = ROOT / "input/corner_to_corner/corners_left_mu00.inp"
    deck = flat(binary(), Deck.read(path).write(tmp_path / "corners.inp"))
    first = Seen(job(deck), deck)
    form = FORMS["solved otherwise"](deck, first)
    found = compared(deck, form.deck, form.change, job).by_name
    assert found["VTKHDF/PointData/V"].max() < TOLERANCE


def test_a_load_that_is_taken_back_stays_so(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    path.write_text("*NODE\n1, 0., 0.\n*STEP\n*STATIC\n0.5, 1.\n*DLOAD\nALL, BY, 0.\n*END STEP\n")
    mirrored = changed.turned(Deck.read(path), np.diag([1.0, -1.0]))
    (load,) = mirrored.find("DLOAD")
    assert load.rows == [["ALL", "BY", "0.0"]]


def test_it_says_what_cannot_be_written_otherwise(tmp_path: Path) -> None:
    deck = flat(binary(), Deck.read(EVERY_CARD).write(tmp_path / "every_card.inp"))
    with pytest.raises(Unchangeable, match="ALPHA damps the velocity itself"):
        changed.boosted(deck, np.array([1.0, 0.0]))
    with pytest.raises(Unchangeable, match="has equations"):
        changed.turned(deck, np.array([[0.8, -0.6], [0.6, 0.8]]))
    with pytest.raises(Unchangeable, match="no contact of two passes"):
        changed.exchanged(deck)
