"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


def write(folder: Path, n: int, settings: str = "") -> None:
    """A bar of `n` elements that flies against a rigid wall."""
    bar = rectangle("BAR", "CPE4", (n, 1), (10.0, 1.0), (-10.01, 0.0))
    dt = 10.0 / n / sqrt(3e7 / 7.3e-4)
    cards = [
        card("HEADING", ("bar on a wall, VM265",)),
        bar.cards(),
        bar.surface("NOSE", "right"),
        card("NODE, NSET=FIXED", (100_000, 1.0, 0.0)),
        card("SURFACE, NAME=WALL, TYPE=SEGMENTS", ("START", 0.0, -2.0), ("LINE", 0.0, 3.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=WALL, REF NODE=FIXED"),
        elastic(3e7, 0.0, 7.3e-4, "BAR"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("NOSE", "WALL")),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BAR", 1, 202.2)),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(dt, round(2.2e-4 / dt), card(f"STICKSLIP, {settings}") if settings else "", prints("FIXED")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bar_on_wall.inp").write_text("".join(cards))
