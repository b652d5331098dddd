"""Writes a deck in other units: every number with a dimension is multiplied by its factor.

The factors are given as new units per old unit: from cm to m it is `--length 0.01`. What the
numbers of each keyword measure stands in dimensions.json, which is written from the program's own
tables; a card, parameter or field that is not there is refused by its name.
"""

import argparse
import json
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, repeat
from pathlib import Path
from typing import Any

from stickslip import command
from stickslip.deck import Card, Deck, fields, fold
from stickslip.errors import Fault

BASE: dict[str, "Dimension"] = {
    "1": (0, 0, 0),
    "length": (1, 0, 0),
    "mass": (0, 1, 0),
    "time": (0, 0, 1),
    "force": (1, 1, -2),
    "energy": (2, 1, -2),
    "temperature": (0, 0, 0),
}
"""Exponents of the names that dimensions are made of."""

Dimension = tuple[int, int, int]
"""Exponents of length, mass and time."""

Measure = Any
"""What a field holds: None (nothing to scale), a dimension, "unknown", an object with a dimension
and a default or the leave to be a name, or the list of words it may be."""

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]([+-]?\d+)|([+-]\d+))?")
"""A number as the program reads it: `1.D3` and `1.5-5` too."""


class Unscalable(Fault):
    """Something in a deck whose dimension is not known."""


@dataclass(frozen=True)
class Units:
    """New units per old unit."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def factor(self, dimension: Dimension) -> float:
        """Factor of a quantity of this dimension."""
        return self.length ** dimension[0] * self.mass ** dimension[1] * self.time ** dimension[2]


def dimension(text: str) -> Dimension:
    """Exponents of length, mass and time of a dimension in words: 'mass*length^2/time'."""
    total = [0, 0, 0]
    for index, part in enumerate(text.split("/")):
        for name, _, power in (factor.strip().partition("^") for factor in part.split("*")):
            exponent = int(power or 1) * (1 if index == 0 else -1)
            total = [sum_ + exponent * one for sum_, one in zip(total, BASE[name], strict=True)]
    return total[0], total[1], total[2]


def table() -> dict[str, Any]:
    """What the numbers of each keyword measure; keywords and parameters are folded."""
    path = Path(__file__).with_name("dimensions.json")
    read = json.loads(path.read_text())
    entries: dict[str, Any] = {fold(name): entry for name, entry in read.items()}
    for entry in entries.values():
        parameters = entry.get("parameters", {})
        entry["parameters"] = {fold(name): measure for name, measure in parameters.items()}
    return entries


TABLE = table()


def rescale(deck: Deck, units: Units) -> Deck:
    """The deck in other units."""
    if deck.find("PARAMETER"):
        raise Unscalable(
            "the deck has parameters, whose dimensions are not known: "
            "`stickslip flatten` writes it with their values"
        )
    return Deck([_card(card, units) for card in deck.cards])


def _card(card: Card, units: Units) -> Card:
    entry = TABLE.get(card.keyword)
    if entry is None:
        raise Unscalable(f"this card cannot be rescaled: {card.head}")
    if card.keyword in ("SPRING", "DASHPOT") and card.rows and card.rows[0][0] == "6":
        raise Unscalable(f"moments of springs and dashpots cannot be rescaled: {card.head}")
    if "anything" in entry:
        return card
    head = [_parameter(card, part, entry["parameters"], units) for part in fields(card.head)[1:]]
    head = [fields(card.head)[0], *head]
    rows = card.rows if "text" in entry else _rows(card, entry["rows"], units)
    return Card(card.keyword, ", ".join(head), rows)


def _parameter(card: Card, part: str, known: dict[str, Measure], units: Units) -> str:
    name, equals, value = (piece.strip() for piece in part.partition("="))
    place = f"parameter {name} of {fields(card.head)[0]}"
    if not name:
        return part
    if fold(name) not in known:
        raise Unscalable(f"{place} cannot be rescaled: write its name in full, or leave it out")
    return f"{name}={_scaled(value, known[fold(name)], units, place)}" if equals else name


def _rows(card: Card, forms: list[dict[str, Any]], units: Units) -> list[list[str]]:
    rows = card.rows
    if not rows and any("default" in (field or ()) for form in forms for field in form["fields"]):
        rows = [[""]]
    return [_row(card, number, row, forms, units) for number, row in enumerate(rows)]


def _row(
    card: Card, number: int, row: list[str], forms: list[dict[str, Any]], units: Units
) -> list[str]:
    keyword, line = fields(card.head)[0], ", ".join(row)
    form = next((form for form in forms if is_meant(form, card, number)), None)
    if form is None:
        raise Unscalable(f"a data line of {card.head} cannot be rescaled: {line}")
    new = []
    for field, (text, measure) in enumerate(zip(row, _measures(form), strict=False), 1):
        new.append(_scaled(text, measure, units, f"field {field} of {keyword}: {line}"))
    if any(row[len(new) :]):
        raise Unscalable(f"field {len(new) + 1} of {keyword} is not known: {line}")
    return new


def _measures(form: dict[str, Any]) -> Iterator[Measure]:
    """What the fields of a data line hold; the last ones may repeat along the line."""
    measures = form["fields"]
    repeating = form.get("repeating", 0)
    if not repeating:
        return iter(measures)
    return chain(measures, chain.from_iterable(repeat(measures[-repeating:])))


def is_meant(form: dict[str, Any], card: Card, number: int) -> bool:
    """Whether the data line of a card with this number, from 0, has this form."""
    name, value = form.get("parameter", (None, None))
    if name and fold(name) not in card.parameters:
        return False
    if value and fold(card.parameters[fold(name)]) != fold(value):
        return False
    if form.get("first") and number > 0:
        return False
    row = card.rows[number] if number < len(card.rows) else []
    index, words = form.get("word", (None, None))
    return index is None or (index < len(row) and fold(row[index]) in words)


def _scaled(text: str, measure: Measure, units: Units, place: str) -> str:
    """A field, or a parameter's value, in other units."""
    about = measure if isinstance(measure, dict) else {"dimension": measure}
    text = text or about.get("default", "")
    what = about["dimension"]
    if isinstance(what, list) and text and fold(text) not in map(fold, what):
        raise Unscalable(f"{place} cannot be rescaled: it is none of {', '.join(what)}")
    if not text or what is None or isinstance(what, list):
        return text
    if what == "unknown":
        raise Unscalable(f"the dimension of {place} is not known: leave it out")
    number = NUMBER.fullmatch(text)
    if number:
        mantissa, *exponents = number.groups()
        old = float(f"{mantissa}e{exponents[0] or exponents[1] or 0}")
        new = old * units.factor(dimension(what))
        if old and not sys.float_info.min <= abs(new) < math.inf:
            raise Unscalable(f"{place} leaves the range of numbers: {text}")
        return repr(new)
    if about.get("or_name"):
        return text
    raise Unscalable(f"{place} is no number: {text}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("deck", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="the deck to write")
    for unit in ("length", "mass", "time"):
        help_ = "new units per old unit"
        parser.add_argument(f"--{unit}", type=command.positive, default=1.0, help=help_)
    arguments = parser.parse_args()
    units = Units(arguments.length, arguments.mass, arguments.time)
    rescale(Deck.read(arguments.deck), units).write(arguments.output)


if __name__ == "__main__":
    command.finish(main)
