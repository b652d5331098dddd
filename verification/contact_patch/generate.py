"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402


def write(folder: Path, kind: str, upper: int, lower: int, friction: float) -> None:
    """Two square blocks, so many cells along each, the upper one pressed down by 0.1."""
    below = rectangle("BELOW", kind, (lower, lower), (1.0, 1.0))
    above = rectangle("ABOVE", kind, (upper, upper), (1.0, 1.0), (0.0, 1.0), below)
    cards = [
        card("HEADING", ("two blocks, one pressed on the other",)),
        below.cards(),
        above.cards(),
        below.nset("BASE", "bottom"),
        below.nset("LEFT", "left"),
        above.nset("LEFT", "left"),
        above.nset("TOP", "top"),
        above.nset("SOLE", "bottom"),
        above.surface("SOLE", "bottom"),
        below.surface("GROUND", "top"),
        elastic(1000.0, 0.0, 1.0, "BELOW", "ABOVE"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "GROUND")),
        card("BOUNDARY", ("BASE", 2, 2), ("LEFT", 1, 1)),
        static(card("BOUNDARY", ("TOP", 2, 2, -0.1)), prints("TOP"), dt=0.25),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "stacked.inp").write_text("".join(cards))
