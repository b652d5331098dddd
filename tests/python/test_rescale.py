"""Decks in other units: every card, every example, and what is refused."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from compare import scaled_differences
from conftest import ROOT, Job
from decks import parse
from rescale import TABLE, Units, Unscalable, is_meant, rescale
from stickslip.command import FAULT
from stickslip.deck import Card, Deck, fields, fold
from stickslip.result import Result

EVERY_CARD = ROOT / "tests/decks/every_card.inp"
HYPERELASTIC = ROOT / "tests/decks/hyperelastic.inp"
ASSEMBLY = ROOT / "tests/decks/assembly.inp"
CONNECTIONS = ROOT / "tests/decks/connections.inp"
STATIC_STEPS = ROOT / "tests/decks/static_steps.inp"
TIES = ROOT / "tests/decks/ties.inp"
FRICTION = ROOT / "tests/decks/friction.inp"
REVOLUTION = ROOT / "tests/decks/revolution.inp"
PLASTIC = ROOT / "tests/decks/plastic.inp"
HEATED = ROOT / "tests/decks/heated.inp"
OTHER_PROGRAMS = ROOT / "tests/decks/other_programs.inp"
FITS = [ROOT / f"tests/decks/{name}.inp" for name in ("fits", "general_fit", "bolt")]
CIRCLES = [ROOT / f"tests/decks/circles_{name}.inp" for name in ("of_a_pair", "in_general")]
ALL_CARDS = [
    EVERY_CARD, HYPERELASTIC, ASSEMBLY, CONNECTIONS, STATIC_STEPS, TIES, FRICTION, REVOLUTION, PLASTIC, HEATED, OTHER_PROGRAMS, *FITS,
    *CIRCLES,
]
"""Decks that use every keyword, and every number with a dimension."""
EXAMPLES = sorted((ROOT / "input").glob("*/*.inp"))
POWERS_OF_TWO = [Units(length=2.0**7), Units(mass=2.0**-11), Units(time=2.0**5)]
ALL_AT_ONCE = Units(2.0**-6, 2.0**9, 2.0**-13)
INCREMENTS = 25
"""Increments of each step of an example; the option --full runs them all."""


def read_keywords() -> set[str]:
    """Keywords that docs/keywords.md marks as read."""
    text = (ROOT / "docs/keywords.md").read_text()
    read = text.partition("## Each keyword")[2].partition("\n## ")[0]
    return {fold(name) for name in re.findall(r"^### `\*(.+)`$", read, re.MULTILINE)}


def measured(measure: Any) -> bool:
    """Whether a field or a parameter has a known dimension."""
    about = measure["dimension"] if isinstance(measure, dict) else measure
    return isinstance(about, str) and about != "unknown"


def is_used(form: dict[str, Any], field: int, card: Card) -> bool:
    """Whether a data line of a card has something in a field of this form."""
    rows = [row for number, row in enumerate(card.rows) if is_meant(form, card, number)]
    return any(field < len(row) and row[field] for row in rows)


def test_the_deck_uses_every_keyword_that_is_read() -> None:
    used = {card.keyword for path in ALL_CARDS for card in Deck.read(path).cards}
    assert "*INCLUDE" in EVERY_CARD.read_text()
    # with *NO ANALYSIS the deck would not run; decks with *PARAMETER are refused
    assert read_keywords() - used - {"INCLUDE", "NOANALYSIS", "PARAMETER"} == set()
    assert len(read_keywords()) > 40


def test_a_deck_with_parameters_is_refused() -> None:
    deck = Deck.parse("*PARAMETER\nmu = 0.3\n*FRICTION\n<mu>\n")
    with pytest.raises(Unscalable, match="stickslip flatten"):
        rescale(deck, Units(length=0.01))


def test_the_deck_uses_every_number_that_has_a_dimension() -> None:
    decks = [Deck.read(path) for path in ALL_CARDS]
    unused = []
    for keyword, entry in TABLE.items():
        cards = [card for deck in decks for card in deck.find(keyword)]
        for name, measure in entry["parameters"].items():
            if measured(measure) and not any(name in card.parameters for card in cards):
                unused.append(f"*{keyword}, {name}=")
        for form in entry.get("rows", []):
            for number, measure in enumerate(form["fields"]):
                if measured(measure) and not any(is_used(form, number, card) for card in cards):
                    unused.append(f"*{keyword} {form} field {number + 1}")
    assert unused == []


def test_words_of_loads_and_profiles_are_all_used() -> None:
    decks = [Deck.read(path) for path in ALL_CARDS]
    for keyword, entry in TABLE.items():
        for form in entry.get("rows", []):
            index, words = form.get("word", (0, []))
            rows = [row for deck in decks for card in deck.find(keyword) for row in card.rows]
            said = {fold(row[index]) for row in rows if index < len(row)}
            assert set(words) <= said, keyword


@pytest.mark.parametrize(
    "units", [*POWERS_OF_TWO, ALL_AT_ONCE], ids=["length", "mass", "time", "all"]
)
def test_every_card_in_other_units_gives_the_same_bits(units: Units, job: Job) -> None:
    deck = Deck.read(EVERY_CARD)
    with Result(job(deck)) as results:
        closed = [name for name, contact in results.contact.items() if contact.closed.any()]
    assert len(closed) >= 2, "the pair and general contact"
    assert scaled_differences(job(deck), job(rescale(deck, units)), units) == []


@pytest.mark.parametrize("path", ALL_CARDS[1:], ids=lambda path: path.stem)
def test_other_decks_of_cards_in_other_units_give_the_same_bits(path: Path, job: Job) -> None:
    deck = Deck.read(path)
    assert scaled_differences(job(deck), job(rescale(deck, ALL_AT_ONCE)), ALL_AT_ONCE) == []


def cut(deck: Deck) -> Deck:
    """The deck with a few increments in each step, at the pace of the whole."""
    for card in [*deck.find("DYNAMIC"), *deck.find("STATIC")]:
        dt, period = map(float, card.rows[0][:2])
        card.rows = [[repr(dt), repr(min(period, INCREMENTS * dt))]]
    return deck


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_examples_in_other_units_give_the_same_bits(
    path: Path, job: Job, request: pytest.FixtureRequest
) -> None:
    deck = Deck.read(path)
    if not request.config.getoption("--full"):
        deck = cut(deck)
    assert scaled_differences(job(deck), job(rescale(deck, ALL_AT_ONCE)), ALL_AT_ONCE) == []


def small(text: str, folder: Path, units: Units) -> list[str]:
    """Lines of a deck in other units."""
    return rescale(parse(text, folder), units).text().splitlines()


def test_numbers_names_and_defaults(tmp_path: Path) -> None:
    text = """*SURFACE, NAME=R0.5, TYPE=SEGMENTS
START, 0.5, 1.D1
LINE, 2., 1.5-1
*CONTACT PAIR, INTERACTION=D0.5, ADJUST=0.5
A, B
*CONTACT PAIR, INTERACTION=D, ADJUST=NODES
A, B
*SOLID SECTION, ELSET=E, MATERIAL="Soft, 0.5"
*STEP,
 NLGEOM
*DYNAMIC
0.1, 1., , 0.5
*OUTPUT, FIELD, TIME INTERVAL=.25
"""
    assert small(text, tmp_path, Units(length=2.0, time=4.0)) == [
        "*SURFACE, NAME=R0.5, TYPE=SEGMENTS",
        "START, 1.0, 20.0",
        "LINE, 4.0, 0.3",
        "*CONTACT PAIR, INTERACTION=D0.5, ADJUST=1.0",
        "A, B",
        "*CONTACT PAIR, INTERACTION=D, ADJUST=NODES",
        "A, B",
        '*SOLID SECTION, ELSET=E, MATERIAL="Soft, 0.5"',
        "2.0",
        "*STEP, NLGEOM",
        "*DYNAMIC",
        "0.4, 4.0, , 2.0",
        "*OUTPUT, FIELD, TIME INTERVAL=1.0",
    ]


def test_the_first_line_of_a_periodic_amplitude_is_another_one(tmp_path: Path) -> None:
    text = """*AMPLITUDE, NAME=A, DEFINITION=PERIODIC
1, 2., 3., 0.5
1., 0.25, 2., 4.
"""
    assert small(text, tmp_path, Units(time=4.0))[1:] == ["1, 0.5, 12.0, 0.5", "1., 0.25, 2., 4."]


def test_ranges_of_times_and_of_numbers(tmp_path: Path) -> None:
    text = """*TIME POINTS, NAME=A, GENERATE
0., 1., 0.5
*TIME POINTS, NAME=B
0., 1., 2., 3.
*NSET, NSET=N, GENERATE
1, 7, 2
"""
    new = small(text, tmp_path, Units(time=4.0))
    assert new[1::2] == ["0.0, 4.0, 2.0", "0.0, 4.0, 8.0, 12.0", "1, 7, 2"]


def test_files_of_data_lines_are_read_in_their_place(tmp_path: Path) -> None:
    (tmp_path / "nodes.txt").write_text("1, 0.5, 1.\n** x\n2, 3., 4.\n")
    text = "*NODE, NSET=ALL, INPUT=nodes.txt\n3, 5., 6.\n"
    assert small(text, tmp_path, Units(length=2.0)) == [
        "*NODE, NSET=ALL",
        "1, 1.0, 2.0",
        "2, 6.0, 8.0",
        "3, 10.0, 12.0",
    ]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("*JOINT\n1.\n", "JOINT"),
        ("*PHYSICAL CONSTANTS, ABSOLUTE ZERO=-273.\n", "PHYSICAL CONSTANTS"),
        ("*NODE, COLOUR=3\n1, 0., 0.\n", "COLOUR of \\*NODE"),
        ("*CONTACT PAIR, INTER=D\nA, B\n", "INTER of \\*CONTACT PAIR"),
        ("*NODE\n1, 0., 0., 0., 5.\n", "field 5 of \\*NODE"),
        ("*NODE\n1, abc, 0.\n", "field 2 of \\*NODE.* is no number"),
        ("*AMPLITUDE, NAME=A, DEFINITION=DECAY\n1., 2., 3., 4., 5.\n", "field 5 of \\*AMPLITUDE"),
        ("*FRICTION\n0.3, 0., 0., 20.\n", "field 4 of \\*FRICTION"),
        ("*SURFACE BEHAVIOR\n0.1\n", "field 1 of \\*SURFACE BEHAVIOR"),
        ("*SURFACE, NAME=S, TYPE=CYLINDER\nA\n", "TYPE of \\*SURFACE"),
        ("*SURFACE, NAME=S, TYPE=SEGMENTS\nPARAB, 1., 2., 3., 4.\n", "PARAB|field 3"),
        ("*DLOAD\nA, CORIO, 3.\n", "CORIO"),
        ("*INITIAL CONDITIONS, TYPE=STRESS\nA, 1.\n", "TYPE of \\*INITIAL CONDITIONS"),
        ("*DENSITY\n1.E-308\n", "field 1 of \\*DENSITY.* range of numbers"),
        ("*MATERIAL, NAME=M, STRAIN RATE REGULARIZATION=1.\n", "STRAIN RATE"),
    ],
)
def test_what_has_no_known_dimension_is_refused(text: str, named: str, tmp_path: Path) -> None:
    with pytest.raises(Unscalable, match=named):
        small(text, tmp_path, Units(length=2.0**10))


def test_the_script_says_in_one_line_what_it_refuses(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text("*FRICTION\n0.3, 0., 0., 20.\n")
    script = [sys.executable, str(ROOT / "scripts/rescale.py")]
    stray = tmp_path / "stray.inp"
    stray.write_text("1, 2.\n")
    missing = tmp_path / "missing.inp"
    faults = {deck: "field 4 of *FRICTION", stray: str(stray), missing: str(missing)}
    for path, named in faults.items():
        command = [*script, str(path), "-o", str(tmp_path / "new.inp"), "--length", "2"]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        assert done.returncode == FAULT and len(done.stderr.splitlines()) == 1, done.stderr
        assert named in done.stderr
    assert not (tmp_path / "new.inp").exists()


def test_keyword_lines_are_cut_at_commas_outside_quotation_marks() -> None:
    assert fields('*MATERIAL, NAME="a, b", RTOL=1') == ["*MATERIAL", 'NAME="a, b"', "RTOL=1"]
