"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import rectangle, static, prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

INNER, OUTER, OVERLAP = 0.5, 1.0, 0.6667e-3


def write(folder: Path, n: int, kind: str = "CAX4", friction: float = 0.0) -> None:
    """A ring shrunk on a solid shaft, one layer of `n` elements along each radius."""
    size = INNER / n
    ring = rectangle("RING", kind, (n, 1), (OUTER - INNER, size), (INNER, 0.0))
    shaft = rectangle("SHAFT", kind, (n, 1), (INNER + OVERLAP, size), after=ring)
    cards = [
        card("HEADING", ("a ring shrunk on a shaft",)),
        ring.cards(),
        shaft.cards(),
        ring.surface("BORE", "left"),
        ring.nset("BORE", "left"),
        ring.nset("OUTSIDE", "right"),
        shaft.nset("AXIS", "left"),
        shaft.surface("RIM", "right"),
        ring.nset("FLOOR", "bottom"),
        shaft.nset("FLOOR", "bottom"),
        elastic(2e5, 0.3, 1.0, "RING", "SHAFT"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("BORE", "RIM")),
        card("BOUNDARY", ("AXIS", 1, 1), ("FLOOR", 2, 2)),
        static(card("CONTACT INTERFERENCE, SHRINK", ("BORE", "RIM")), prints("OUTSIDE"), dt=0.5, direct=True),
    ]
    write_deck(folder, "fit.inp", cards)
