"""Writes the decks of the case: `write(folder, ...)`."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "convergence")]

import runner  # noqa: E402  (first: it finds the modules of python/)
from stickslip.deck import Deck  # noqa: E402

GRAVITY = 1e-3
"""Of bodies that nothing holds before they touch."""


FILL = "*AMPLITUDE, NAME=FILL"
"""Of the pressure in the tyre, which grows over all of a static step, as its weight does."""


def write(folder: Path, of: str, increments: int, holds: str = "", **parameters: float) -> None:
    """A deck of input/, or a generated one, with static steps of so many increments at most, or with its own step for none.

    `holds`: the set of elements that a small weight holds until they touch. All heat of friction goes into the slave surfaces.
    """
    deck = source(of, **parameters)
    place = next(i for i, card in enumerate(deck.cards) if card.keyword == "FRICTION") + 1
    deck.cards[place:place] = Deck().add("GAP HEAT GENERATION", (1.0, 1.0)).cards
    if increments:
        deck.set_settings()
        (step,) = deck.find("DYNAMIC")
        duration = float(step.rows[0][1])
        step.keyword, step.head = "STATIC", "*STATIC"
        for ramp in deck.find("AMPLITUDE"):
            if ramp.head == FILL:
                ramp.rows[0][2] = repr(duration)
        step.rows = [[repr(duration / increments), repr(duration), "", repr(duration / increments)]]
        if holds:
            place = next(i for i, card in enumerate(deck.cards) if card is step) + 1
            weight = Deck().add("DLOAD", (holds, "BY", -GRAVITY))
            deck.cards[place:place] = weight.cards
    deck.write(folder / "twin.inp")


def source(of: str, **parameters: float) -> Deck:
    """The dynamic deck."""
    if of == "two_blocks":
        import elastic_blocks

        return Deck.parse(elastic_blocks.two_blocks(**parameters))
    if of == "sliding_pad":
        with TemporaryDirectory() as folder:
            runner.load(runner.HERE / of / "generate.py").write(Path(folder), 0.005)
            deck = Deck.read(Path(folder) / "pad.inp")
        # the load grows over the whole step
        deck.one("AMPLITUDE").rows = [["0.", "0.", deck.one("DYNAMIC").rows[0][1], "1."]]
        return deck
    deck = Deck.read(runner.ROOT / "input" / of)
    if of == "tyre_kerb/tyre_kerb.inp":
        # it stays where it is put down, and comes to rest
        deck.cards.remove(deck.one("INITIAL CONDITIONS"))
        deck.one("DAMPING").head = "*DAMPING, ALPHA=40., BETA=0.0002"
        deck.one("DYNAMIC").rows = [["0.0005", "1.5"]]
        deck.one("STEP").head = "*STEP, NLGEOM, INC=4000"
        deck.one("AMPLITUDE").rows = [["0.", "0.", "0.5", "1."]]
    return deck
