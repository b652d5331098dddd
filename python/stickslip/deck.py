"""Decks as cards: read with the files they name, change, write as one file."""

import argparse
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from stickslip.errors import Fault

FREE_TEXT = ("HEADING", "STEP")
"""Keywords whose data lines are text."""


PROCEDURES = ("DYNAMIC", "STATIC")
"""Keywords whose data line has the increment and the duration of a step."""


@dataclass
class Card:
    """One keyword line with its data lines."""

    keyword: str
    """In capitals, without blanks: `CONTACTPAIR`."""
    head: str
    """Text of the keyword line."""
    rows: list[list[str]] = field(default_factory=list)
    """Fields of the data lines; free text, under HEADING and STEP, is one field a line."""

    @property
    def parameters(self) -> dict[str, str]:
        """Parameters of the keyword line, names in capitals without blanks."""
        pairs = (part.partition("=") for part in fields(self.head)[1:])
        return {fold(name): value.strip() for name, _, value in pairs if name.strip()}

    def text(self) -> str:
        """The card as deck lines."""
        return "\n".join([self.head, *(", ".join(row) for row in self.rows)]) + "\n"


class Deck:
    """A deck's cards in order, includes in place."""

    def __init__(self, cards: list[Card]) -> None:
        self.cards = cards

    @classmethod
    def read(cls, path: Path | str) -> "Deck":
        """Reads a deck; data lines from files named with INPUT= are inserted."""
        path = Path(path)
        return cls._of(_lines(_text(path), path.parent, path.parent), str(path))

    @classmethod
    def parse(cls, text: str, folder: Path | str = ".") -> "Deck":
        """A deck from its text; files that it names are looked for in a folder."""
        return cls._of(_lines(text, Path(folder), Path(folder)), "the deck")

    @classmethod
    def _of(cls, lines: Iterable[str], name: str) -> "Deck":
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
        return cls(cards)

    def text(self) -> str:
        """The whole deck."""
        return "".join(card.text() for card in self.cards)

    def write(self, path: Path | str) -> Path:
        """Writes the deck and returns its path."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(self.text())
        return path

    def find(self, keyword: str) -> list[Card]:
        """All cards with this keyword."""
        return [card for card in self.cards if card.keyword == fold(keyword)]

    def one(self, keyword: str) -> Card:
        """The only card with this keyword."""
        found = self.find(keyword)
        if len(found) != 1:
            raise ValueError(f"the deck has {len(found)} cards *{keyword}, not one")
        return found[0]

    @property
    def dt(self) -> float:
        """Increment of the only step."""
        return float(self.one("DYNAMIC").rows[0][0])

    @property
    def period(self) -> float:
        """Duration of the only step."""
        return float(self.one("DYNAMIC").rows[0][1])

    @property
    def duration(self) -> float | None:
        """Time of all steps; None where it is no plain number."""
        try:
            return sum(float(card.rows[0][1]) for card in self.cards if card.keyword in PROCEDURES)
        except (IndexError, ValueError):
            return None

    def set_increments(self, dt: float, count: int) -> None:
        """Gives the only step `count` increments of `dt`."""
        self.one("DYNAMIC").rows = [[repr(dt), repr(count * dt)]]
        step = self.one("STEP")
        parts = [part for part in step.head.split(",") if not fold(part).startswith("INC=")]
        step.head = ",".join(parts) + f", INC={count}"

    def set_settings(self, **settings: object) -> None:
        """Replaces the STICKSLIP cards of all steps; without settings they are removed."""
        self.cards = [card for card in self.cards if card.keyword != "STICKSLIP"]
        if settings:
            text = "".join(f", {key.replace('_', ' ')}={value}" for key, value in settings.items())
            for step in self.find("STEP"):
                place = next(i for i, card in enumerate(self.cards) if card is step) + 1
                self.cards.insert(place, Card("STICKSLIP", "*STICKSLIP" + text))


def _text(path: Path) -> str:
    """The text of a file of a deck."""
    return path.read_text(encoding="utf-8-sig", errors="replace")


def _lines(text: str, folder: Path, main: Path, depth: int = 0) -> list[str]:
    """Logical lines of a file without comments and empty lines, with those of included files."""
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
            _read_input(lines, folder, main, depth)
            lines.append(line)
        starts = line.startswith("*") or is_open
        is_open = starts and line.endswith(",")
    _read_input(lines, folder, main, depth)
    return lines


def _read_input(lines: list[str], folder: Path, main: Path, depth: int) -> None:
    """Puts the lines of a file in the place of the INPUT= of the last line, a keyword line."""
    if not lines or not lines[-1].startswith("*"):
        return
    head = fields(lines[-1])
    if fold(head[0]) in ("*HEADING", "*STEP"):
        return
    inputs = [part for part in head[1:] if fold(part.partition("=")[0]) == "INPUT"]
    if not inputs:
        return
    name = inputs[0].partition("=")[2].strip().strip('"')
    near = folder / name
    path = near if near.exists() else main / name
    more = _lines(_text(path), path.parent, main, depth + 1)
    kept = [part for part in head if part not in inputs]
    lines[-1:] = more if fold(head[0]) == "*INCLUDE" else [", ".join(kept), *more]


def fields(line: str) -> list[str]:
    """Fields of a line between its commas; commas between quotation marks do not count."""
    if '"' not in line:
        return [part.strip() for part in line.split(",")]
    parts = [""]
    quoted = False
    for character in line:
        quoted ^= character == '"'
        if character == "," and not quoted:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def fold(text: str) -> str:
    """A word as it is compared: in capitals, without blanks."""
    return "".join(text.split()).upper()


def write_to_folder(about: str | None, folder: Path, write: Callable[[Path], None]) -> None:
    """Command line of a script that writes decks: into `folder`, or that of the option `-o`."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("-o", "--output", type=Path, default=folder, help="folder of the decks")
    write(parser.parse_args().output)
