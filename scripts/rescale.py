"""Writes a deck in other units: every number with a dimension is multiplied by its factor.

The factors are given as new units per old unit: from cm to m it is `--length 0.01`.
"""

import argparse
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from deck import Card, Deck

STRESS = (-1, 1, -2)
FORCE = (1, 1, -2)
BODY_FORCE = (-2, 1, -2)
ACCELERATION = (1, 0, -2)
VELOCITY = (1, 0, -1)
DENSITY = (-3, 1, 0)
LENGTH = (1, 0, 0)
TIME = (0, 0, 1)
NUMBER = (0, 0, 0)

Dimension = tuple[int, int, int]
"""Exponents of length, mass and time."""

PLAIN = set(
    "HEADING ELEMENT NSET ELSET SURFACE MATERIAL SURFACEINTERACTION FRICTION CONTACTPAIR "
    "CONTACT CONTACTINCLUSIONS CONTACTPROPERTYASSIGNMENT STEP STICKSLIP ENDSTEP NODEPRINT "
    "NODEFILE ELFILE CONTACTFILE OUTPUT NODEOUTPUT ELEMENTOUTPUT CONTACTOUTPUT".split()
)
"""Cards without a number that has a dimension, their parameters apart."""

COLUMNS: dict[str, dict[int, Dimension]] = {
    "NODE": {1: LENGTH, 2: LENGTH, 3: LENGTH},
    "ELASTIC": {0: STRESS, 1: NUMBER},
    "DENSITY": {0: DENSITY},
    "SOLIDSECTION": {0: LENGTH},
    "BOUNDARY": {3: LENGTH},
    "CLOAD": {2: FORCE},
    "DYNAMIC": {0: TIME, 1: TIME, 2: TIME, 3: TIME},
    "TIMEPOINTS": {column: TIME for column in range(8)},
}
"""Dimensions of the columns of a card's data lines."""

DISTRIBUTED: dict[str, Dimension] = {
    "GRAV": ACCELERATION,
    "BX": BODY_FORCE,
    "BY": BODY_FORCE,
    "TRVEC": STRESS,
    **{f"P{side}": STRESS for side in ("", 1, 2, 3, 4)},
}
"""Dimension of the magnitude (third column) of DLOAD and DSLOAD by load type."""


@dataclass(frozen=True)
class Units:
    """New units per old unit."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def factor(self, dimension: Dimension) -> float:
        """Factor of a quantity of this dimension."""
        return self.length ** dimension[0] * self.mass ** dimension[1] * self.time ** dimension[2]


def rescale(deck: Deck, units: Units) -> Deck:
    """The deck in other units."""
    return Deck([_rescale_card(card, units) for card in deck.cards])


def _rescale_card(card: Card, units: Units) -> Card:
    head = card.head
    if "TIMEINTERVAL" in card.parameters:
        old = card.parameters["TIMEINTERVAL"]
        head = head.replace(old, _scaled(old, units.factor(TIME)))
    if card.keyword == "SOLIDSECTION" and not any(row[0] for row in card.rows):
        raise ValueError("*SOLID SECTION without a thickness cannot be rescaled: write the 1")
    return Card(card.keyword, head, [_rescale_row(card, row, units) for row in card.rows])


def _rescale_row(card: Card, row: list[str], units: Units) -> list[str]:
    factors = {column: units.factor(dimension) for column, dimension in _columns(card, row)}
    return [
        _scaled(text, factors[column]) if column in factors and text else text
        for column, text in enumerate(row)
    ]


def _columns(card: Card, row: list[str]) -> Iterable[tuple[int, Dimension]]:
    """Columns of a data line that bear a dimension."""
    keyword = card.keyword
    if keyword in PLAIN:
        return ()
    if keyword in COLUMNS:
        return COLUMNS[keyword].items()
    if keyword in ("DLOAD", "DSLOAD") and row[1].upper() in DISTRIBUTED:
        return [(2, DISTRIBUTED[row[1].upper()])]
    if keyword == "INITIALCONDITIONS" and card.parameters.get("TYPE", "").upper() == "VELOCITY":
        return [(2, VELOCITY)]
    if keyword == "SURFACEBEHAVIOR":
        if card.parameters.get("PRESSURE-OVERCLOSURE", "HARD").upper() == "HARD":
            return ()
    if keyword == "AMPLITUDE":
        return [(column, TIME) for column in range(0, len(row), 2)]
    raise ValueError(f"this card cannot be rescaled: {card.head}: {', '.join(row)}")


def _scaled(text: str, factor: float) -> str:
    return repr(float(text) * factor)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="the deck to write")
    for unit in ("length", "mass", "time"):
        parser.add_argument(f"--{unit}", type=float, default=1.0, help="new units per old unit")
    arguments = parser.parse_args()
    units = Units(arguments.length, arguments.mass, arguments.time)
    rescale(Deck.read(arguments.deck), units).write(arguments.output)


if __name__ == "__main__":
    main()
