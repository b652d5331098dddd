"""Decks as lists of cards, which can be read with the files that they name, made from meshes, changed, and written as
one file.

Cards without a method of their own are added by text: `deck.add("KEYWORD, PARAMETER=VALUE", row, row)`.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from stickslip.building import Building
from stickslip.cards import Card, fields, fold
from stickslip.decks import card
from stickslip.errors import Fault
from stickslip.notebook import Shown
from stickslip.whole import write_text

Value = float | int | str
"""Value of a parameter of a deck."""

FREE_TEXT = ("HEADING", "STEP")
"""Keywords whose data lines are text."""


PROCEDURES = ("DYNAMIC", "STATIC")
"""Keywords whose data line has the increment and the duration of a step."""

PARAMETER = re.compile(r"<\s*([A-Za-z]\w*)\s*>")
"""A parameter where its value stands."""

PLAIN_TEXT = re.compile(r"\s*(?P<name>[A-Za-z]\w*)\s*=\s*(?P<quote>['\"])(?P<text>[^'\"]*)(?P=quote)\s*(?:#.*)?")
"""A row of *PARAMETER with a text."""


class Deck(Building, Shown):
    """The cards of a deck in order; the cards of an included file stand in its place."""

    def __init__(self, cards: Iterable[Card] = (), folder: Path | str = ".") -> None:
        self.cards = list(cards)
        self.folder = Path(folder).absolute()
        """Where files are looked for whose names are parameters, `INPUT=<name>` (`filled`)."""

    @classmethod
    def titled(cls, title: str) -> "Deck":
        """A deck with a heading and nothing else."""
        return cls([Card("HEADING", "*HEADING", [[title]])])

    @classmethod
    def read(cls, path: Path | str) -> "Deck":
        """Reads a deck; data lines from files named with INPUT= are inserted."""
        path = Path(path)
        return cls._of(_lines(_text(path), path.parent, path.parent), str(path), path.parent)

    @classmethod
    def parse(cls, text: str, folder: Path | str = ".") -> "Deck":
        """A deck made from text; files that the text names are searched in `folder`."""
        return cls._of(_lines(text, Path(folder), Path(folder)), "the deck", folder)

    @classmethod
    def _of(cls, lines: Iterable[str], name: str, folder: Path | str) -> "Deck":
        """A deck from its logical lines."""
        cards: list[Card] = []
        for line in lines:
            if line.startswith("*"):
                cards.append(Card(fold(fields(line)[0][1:]), line))
            elif not cards:
                raise Fault(f"{name}: data before the first keyword: {line}")
            elif cards[-1].keyword in FREE_TEXT:
                cards[-1].rows.append([line])
            else:
                cards[-1].rows.append(fields(line))
        return cls(cards, folder)

    def text(self) -> str:
        """The whole deck as text."""
        return "".join(card.text() for card in self.cards)

    def write(self, path: Path | str) -> Path:
        """Writes the deck and returns its path."""
        write_text(path, self.text())
        return Path(path)

    def filled(self, values: Mapping[str, Value]) -> "tuple[Deck, dict[str, Value]]":
        """The deck with the contents of files whose names are parameters, and the values of parameters that these names
        still need.

        A parameter that is not given has the value of `*PARAMETER`, if this value is a plain text.
        """
        named = {name for head in map(_input_of, self.cards) for name in PARAMETER.findall(head)}
        if not named:
            return self, dict(values)
        texts = {name: str(value) for name, value in self._plain_texts().items() | values.items()}
        lines = _lines(self.text(), self.folder, self.folder, texts)
        whole = Deck._of(lines, "the deck", self.folder)
        used = {name for card in whole.cards for name in PARAMETER.findall(card.text())}
        defined = {row[0].partition("=")[0].strip() for card in whole.find("PARAMETER") for row in card.rows}
        known = used | defined
        return whole, {name: v for name, v in values.items() if name in known or name not in named}

    def _plain_texts(self) -> dict[str, str]:
        """Parameters of the deck whose values are plain texts."""
        rows = (", ".join(row) for card in self.find("PARAMETER") for row in card.rows)
        found = (PLAIN_TEXT.fullmatch(row) for row in rows)
        return {each["name"]: each["text"] for each in found if each}

    def find(self, keyword: str) -> list[Card]:
        """All cards with a given keyword."""
        return [card for card in self.cards if card.keyword == fold(keyword)]

    def one(self, keyword: str) -> Card:
        """The card with a given keyword; the deck must have exactly one."""
        found = self.find(keyword)
        if len(found) != 1:
            raise ValueError(f"the deck has {len(found)} cards *{keyword}, not one")
        return found[0]

    @property
    def dt(self) -> float:
        """Increment of the step; the deck must have exactly one step."""
        return float(self.one("DYNAMIC").rows[0][0])

    @property
    def period(self) -> float:
        """Duration of the step; the deck must have exactly one step."""
        return float(self.one("DYNAMIC").rows[0][1])

    @property
    def duration(self) -> float | None:
        """Sum of the durations of all steps; None if a duration is not a plain number."""
        try:
            return sum(float(card.rows[0][1]) for card in self.cards if card.keyword in PROCEDURES)
        except (IndexError, ValueError):
            return None

    # Building.

    def add(self, head: str, *rows: Sequence[object]) -> "Deck":
        """Appends a card, given by its keyword line without the star and its data lines."""
        return self.extend(card(head, *rows))

    def extend(self, text: str) -> "Deck":
        """Appends the cards of a text."""
        self.cards += Deck.parse(text).cards
        return self

    # Changing.

    def set_increments(self, dt: float, count: int) -> None:
        """Gives the only step of the deck `count` increments of `dt`."""
        self.one("DYNAMIC").rows = [[repr(dt), repr(count * dt)]]
        step = self.one("STEP")
        parts = [part for part in step.head.split(",") if not fold(part).startswith("INC=")]
        step.head = ",".join(parts) + f", INC={count}"

    def set_settings(self, **settings: object) -> None:
        """Replaces the STICKSLIP cards of all steps; without settings the cards are removed."""
        self.cards = [card for card in self.cards if card.keyword != "STICKSLIP"]
        if settings:
            text = "".join(f", {key.replace('_', ' ')}={value}" for key, value in settings.items())
            for step in self.find("STEP"):
                place = next(i for i, card in enumerate(self.cards) if card is step) + 1
                self.cards.insert(place, Card("STICKSLIP", "*STICKSLIP" + text))

    def set_formulation(self, kind: str) -> None:
        """Gives all contacts one discretisation: NODE TO SURFACE or SURFACE TO SURFACE."""
        self.cards = [card for card in self.cards if card.keyword != "CONTACTFORMULATION"]
        for card in self.find("CONTACT PAIR"):
            parts = [part for part in card.head.split(",") if not fold(part).startswith("TYPE=")]
            card.head = ",".join(parts) + f", TYPE={kind}"
        for card in self.find("CONTACT INCLUSIONS"):
            place = next(i for i, other in enumerate(self.cards) if other is card) + 1
            self.cards.insert(place, Card("CONTACTFORMULATION", f"*CONTACT FORMULATION, TYPE={kind}"))


def _text(path: Path) -> str:
    """The text of a file of a deck."""
    return path.read_text(encoding="utf-8-sig", errors="replace")


def _lines(
    text: str, folder: Path, main: Path, values: Mapping[str, str] = {}, depth: int = 0
) -> list[str]:
    """Logical lines of a file and of the files that it includes, without comments and empty lines.

    `values` holds the values of parameters in names of files.
    """
    if depth > 9:
        raise Fault(f"{folder}: includes are nested too deep")
    lines: list[str] = []
    is_open = False
    for physical in text.splitlines():
        line = physical.strip()
        if not line or line.startswith("**"):
            continue
        if is_open and not line.startswith("*"):
            lines[-1] = f"{lines[-1]} {line}"
        else:
            _read_input(lines, folder, main, values, depth)
            lines.append(line)
        starts = line.startswith("*") or is_open
        is_open = starts and line.endswith(",")
    _read_input(lines, folder, main, values, depth)
    return lines


def _input_of(card: Card) -> str:
    """The name of a file that a line still needs; empty if the line needs no file."""
    return "" if card.keyword in FREE_TEXT else card.parameters.get("INPUT", "")


def _read_input(
    lines: list[str], folder: Path, main: Path, values: Mapping[str, str], depth: int
) -> None:
    """Replaces INPUT= of the last line, a keyword line, by the lines of the file that it names.

    A file name that contains a parameter without value stays as it is.
    """
    if not lines or not lines[-1].startswith("*"):
        return
    head = fields(lines[-1])
    if fold(head[0]) in ("*HEADING", "*STEP"):
        return
    inputs = [part for part in head[1:] if fold(part.partition("=")[0]) == "INPUT"]
    if not inputs:
        return
    name = inputs[0].partition("=")[2].strip().strip('"')
    name = PARAMETER.sub(lambda found: values.get(found[1], found[0]), name)
    if PARAMETER.search(name):
        return
    near = folder / name
    path = near if near.exists() else main / name
    more = _lines(_text(path), path.parent, main, values, depth + 1)
    kept = [part for part in head if part not in inputs]
    lines[-1:] = more if fold(head[0]) == "*INCLUDE" else [", ".join(kept), *more]
