"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import plane, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

LENGTH, RADIUS, SPEED, GAP, DENSITY = 32.4, 3.2, 227e3, 1.0, 8.9225e-9
YOUNG = 117e3
"""N, mm, s, t."""


def write(folder: Path, settings: str, n: int = 40, stiff: float = 1e4, kind: str = "CAX4", courant: float = 1.0) -> None:
    """A bar hits a wall; `stiff` times as stiff as copper, so that it stays as good as rigid."""
    bar = rectangle("BAR", kind, (1, n), (RADIUS, LENGTH), (0.0, GAP))
    speed = (YOUNG * stiff / DENSITY) ** 0.5
    flight, contact = GAP / SPEED, 2 * LENGTH / speed
    dt = courant * LENGTH / n / speed
    cards = [
        card("HEADING", ("a bar hits a wall",)),
        bar.cards(),
        bar.surface("FOOT", "bottom"),
        bar.nset("AXIS", "left"),
        plane("WALL", (-1.0, 0.0), (20.0, 0.0)),
        elastic(YOUNG * stiff, 0.0, DENSITY, "BAR"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "WALL")),
        card("BOUNDARY", ("AXIS", 1, 1), ("REFERENCE", 1, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BAR", 2, -SPEED)),
        step(0.9 * flight / 10, 10),
        step(dt, round((0.1 * flight + 3 * contact) / dt)),
    ]
    if settings:
        cards[-2] = step(0.9 * flight / 10, 10, card(f"STICKSLIP, {settings}"))
    write_deck(folder, "bar.inp", cards)
