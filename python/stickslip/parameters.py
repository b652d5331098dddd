"""Values for the parameters of a deck: `<name>` in its text.

The one place that knows how parameters get their values. It reads `*PARAMETER` cards with plain numbers;
`stickslip run --set name=value` shall take its place when the program reads `*PARAMETER` itself.
"""

import re
from collections.abc import Mapping

from stickslip.deck import Deck
from stickslip.errors import Fault

NAME = re.compile(r"<\s*([A-Za-z]\w*)\s*>")

Value = float | int | str


def with_parameters(deck: Deck, values: Mapping[str, Value]) -> Deck:
    """The deck with every `<name>` replaced by its value, and without `*PARAMETER` cards.

    Values of `*PARAMETER` cards hold where `values` has none. A name without a value and a value
    whose name the deck does not use are Faults. Names do not depend on capitals, as in the rest of
    a deck. Numbers are written so that they are read back as the same number.
    """
    own = _own_values(deck)
    given = {name.upper(): value for name, value in values.items()}
    text = Deck([card for card in deck.cards if card.keyword != "PARAMETER"]).text()
    used = {name.upper() for name in NAME.findall(text)}
    known = {**own, **given}
    if unknown := sorted(name for name in values if name.upper() not in used | own.keys()):
        there = f"it uses {', '.join(sorted(used))}" if used else "it uses none"
        raise Fault(f"the deck uses no parameter <{'>, <'.join(unknown)}>: {there}")
    if missing := sorted(used - known.keys()):
        raise Fault(f"the deck's parameter <{'>, <'.join(missing)}> has no value")
    filled = NAME.sub(lambda found: _written(known[found[1].upper()]), text)
    return Deck.parse(filled)


def _own_values(deck: Deck) -> dict[str, Value]:
    """What the deck's `*PARAMETER` cards say."""
    values: dict[str, Value] = {}
    for card in deck.find("PARAMETER"):
        for row in card.rows:
            name, _, value = ", ".join(row).partition("=")
            try:
                values[name.strip().upper()] = float(value)
            except ValueError:
                raise Fault(f"*PARAMETER {name.strip()}: {value.strip()} is no number") from None
    return values


def _written(value: Value) -> str:
    """A value as it stands in the deck."""
    return value if isinstance(value, str) else repr(float(value))
