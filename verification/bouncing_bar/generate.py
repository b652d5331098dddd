"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


SMALL = 1e-3
"""Gravity and height are those of the paper times this: the strains stay small."""


def write(folder: Path, n: int) -> None:
    """A bar of `n` elements that falls on a rigid floor and bounces, for a period of 16/3."""
    bar = rectangle("BAR", "CPE4", (1, n), (1.0, 10.0), (0.0, 5.0 * SMALL))
    dt = 10.0 / n / 30.0
    cards = [
        card("HEADING", ("bouncing bar with gravity",)),
        bar.cards(),
        bar.surface("NOSE", "bottom"),
        card("NODE, NSET=FIXED", (100_000, 0.0, -1.0)),
        card("SURFACE, NAME=FLOOR, TYPE=SEGMENTS", ("START", -3.0, 0.0), ("LINE", 4.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=FIXED"),
        elastic(900.0, 0.0, 1.0, "BAR"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("NOSE", "FLOOR")),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(
            dt,
            round(16 / 3 / dt),
            card("STICKSLIP, CONTACT MASS=REDISTRIBUTED, LANDING=RETURN"),
            card("DLOAD", ("BAR", "GRAV", 10.0 * SMALL, 0.0, -1.0)),
            prints("FIXED"),
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bouncing_bar.inp").write_text("".join(cards))
