"""Decks as cards: read with their includes, change, write as one file."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Card:
    """One keyword line with its data lines."""

    keyword: str
    """In capitals, without blanks: `CONTACTPAIR`."""
    head: str
    """Text of the keyword line."""
    rows: list[list[str]] = field(default_factory=list)
    """Fields of the data lines; the lines of HEADING are one field each."""

    @property
    def parameters(self) -> dict[str, str]:
        """Parameters of the keyword line, names in capitals without blanks."""
        pairs = (part.partition("=") for part in self.head.split(",")[1:])
        return {_fold(name): value.strip() for name, _, value in pairs if name.strip()}

    def text(self) -> str:
        """The card as deck lines."""
        return "\n".join([self.head, *(", ".join(row) for row in self.rows)]) + "\n"


class Deck:
    """A deck's cards in order, includes in place."""

    def __init__(self, cards: list[Card]) -> None:
        self.cards = cards

    @classmethod
    def read(cls, path: Path | str) -> "Deck":
        """Reads a deck; INCLUDE cards are replaced by what they include."""
        cards: list[Card] = []
        for line in _lines(Path(path)):
            if line.startswith("*"):
                cards.append(Card(_fold(line[1:].split(",")[0]), line))
            elif not cards:
                raise ValueError(f"{path}: data before the first keyword: {line}")
            elif cards[-1].keyword == "HEADING":
                cards[-1].rows.append([line])
            else:
                cards[-1].rows.append([part.strip() for part in line.split(",")])
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
        return [card for card in self.cards if card.keyword == _fold(keyword)]

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

    def set_increments(self, dt: float, count: int) -> None:
        """Gives the only step `count` increments of `dt`."""
        self.one("DYNAMIC").rows = [[repr(dt), repr(count * dt)]]
        step = self.one("STEP")
        parts = [part for part in step.head.split(",") if not _fold(part).startswith("INC=")]
        step.head = ",".join(parts) + f", INC={count}"

    def set_settings(self, **settings: object) -> None:
        """Replaces the STICKSLIP cards of all steps; without settings they are removed."""
        self.cards = [card for card in self.cards if card.keyword != "STICKSLIP"]
        if settings:
            text = "".join(f", {key.replace('_', ' ')}={value}" for key, value in settings.items())
            for step in self.find("STEP"):
                place = next(i for i, card in enumerate(self.cards) if card is step) + 1
                self.cards.insert(place, Card("STICKSLIP", "*STICKSLIP" + text))


def _lines(path: Path, depth: int = 0) -> list[str]:
    """Lines of a deck without comments and empty lines, includes in place."""
    if depth > 9:
        raise ValueError(f"{path}: includes are nested too deep")
    lines: list[str] = []
    for line in (text.strip() for text in path.read_text().splitlines()):
        if not line or line.startswith("**"):
            continue
        if _fold(line.split(",")[0]) == "*INCLUDE":
            name = line.partition("=")[2].strip().strip('"')
            lines += _lines(path.parent / name, depth + 1)
        else:
            lines.append(line)
    return lines


def _fold(text: str) -> str:
    return "".join(text.split()).upper()


def write_to_folder(about: str | None, folder: Path, write: Callable[[Path], None]) -> None:
    """Command line of a script that writes decks: into `folder`, or that of the option `-o`."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("-o", "--output", type=Path, default=folder, help="folder of the decks")
    write(parser.parse_args().output)
