"""Result depend neither on the units, nor on the linear solver, nor on the threads."""

import pytest
from compare import differences, largest_deviations, scaled_differences
from conftest import Job
from decks import BAR, BLOCK, CANTILEVERS, SCHEMES, shortened
from rescale import Units, rescale
from stickslip.deck import Deck
from stickslip.result import Result

CENTIMETRES_TO_METRES = Units(length=0.01)
POWERS_OF_TWO = [
    Units(length=2.0**7),
    Units(mass=2.0**-11),
    Units(time=2.0**5),
    Units(2.0**-6, 2.0**9, 2.0**-13),
]
SPANS = {
    "bar_ss22": lambda: Deck.read(BAR / "ss22_impulse.inp"),
    "bar_default": lambda: Deck.read(BAR / "em_impulse.inp"),
    "cantilevers_ss22": lambda: shortened(CANTILEVERS / "A_mu04.inp", 300, "ss22"),
    "cantilevers_default": lambda: shortened(CANTILEVERS / "A_mu04.inp", 300, "default"),
}
TOLERANCE = 1e-7


@pytest.fixture(params=SPANS)
def deck(request: pytest.FixtureRequest) -> Deck:
    """The whole impact of the bar; the first 300 increments of the cantilevers."""
    return SPANS[request.param]()


def has_contact(deck: Deck, job: Job) -> bool:
    """Whether the span compared holds contact at all."""
    with Result(job(deck)) as results:
        return any(contact.closed.any() for contact in results.contact.values())


@pytest.mark.parametrize("units", POWERS_OF_TWO, ids=["length", "mass", "time", "all"])
def test_units_scaled_by_powers_of_two_change_nothing(deck: Deck, units: Units, job: Job) -> None:
    assert scaled_differences(job(deck), job(rescale(deck, units)), units) == []


@pytest.mark.parametrize("scheme", SCHEMES)
def test_units_scaled_by_powers_of_two_change_nothing_for_the_block(scheme: str, job: Job) -> None:
    units = POWERS_OF_TWO[-1]
    deck = shortened(BLOCK / "block_slope_mu05.inp", 200, scheme)
    assert scaled_differences(job(deck), job(rescale(deck, units)), units) == []


def test_kg_cm_s_and_si_agree(deck: Deck, job: Job) -> None:
    assert has_contact(deck, job)
    metres = job(rescale(deck, CENTIMETRES_TO_METRES))
    worst = largest_deviations(job(deck), metres, CENTIMETRES_TO_METRES)
    assert {name: error for name, error in worst.items() if error > TOLERANCE} == {}


def test_the_two_linear_solvers_agree(deck: Deck, job: Job) -> None:
    worst = largest_deviations(job(deck, "--solver", "faer"), job(deck, "--solver", "sprs"))
    assert {name: error for name, error in worst.items() if error > TOLERANCE} == {}


def test_runs_repeat_bit_for_bit_with_any_number_of_threads(deck: Deck, job: Job) -> None:
    first = job(deck, "--threads", "1")
    assert differences(first, job(deck, "--threads", "1", again=1)) == []
    assert differences(first, job(deck, "--threads", "2")) == []
