"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from form import load
from meshes import graded, mapped, ride, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

sneddon = load(Path(__file__).resolve().parent / "sneddon.py")
YOUNG, LOAD = 100e3, 1e-3
"""LOAD: the curvature of the edge and the force are so many times the S4F ones; the contact remains the same, the strains become small."""


def write(folder: Path, n: int, kind: str = "CAX4", size: float = 1.0) -> None:
    """A punch with a rounded edge on a foundation, `n` elements in the radius of the contact; `size` of the bodies."""
    flat, contact = sneddon.FLAT, sneddon.CONTACT
    radius = sneddon.ROUND / LOAD
    xs = graded(contact / n, 1.2 * contact, 50.0 * size)
    ys = graded(contact / n, 0.5 * contact, 100.0 * size)

    def punch(x: float, t: float) -> tuple[float, float]:
        foot = max(x - flat, 0.0) ** 2 / (2 * radius)
        return x, foot + (100.0 * size - foot) * t / (100.0 * size)

    upper = mapped("PUNCH", kind, xs, ys, punch)
    below = [-y for y in reversed(graded(contact / n, 0.5 * contact, 200.0 * size))]
    lower = mapped("FOUNDATION", kind, graded(contact / n, 1.2 * contact, 100.0 * size), below, after=upper)
    cards = [
        card("HEADING", ("a punch with a rounded edge",)),
        upper.cards(),
        lower.cards(),
        upper.surface("FOOT", "bottom"),
        upper.nset("FOOT", "bottom"),
        upper.nset("AXIS", "left"),
        lower.nset("AXIS", "left"),
        lower.surface("GROUND", "top"),
        lower.nset("BASE", "bottom"),
        ride(upper, "top", "HEAD", 2),
        elastic(YOUNG, 0.3, 1.0, "PUNCH", "FOUNDATION"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
        card("BOUNDARY", ("AXIS", 1, 1), ("BASE", 1, 2)),
        static(card("CLOAD", ("HEAD", 2, -sneddon.force() * LOAD)), dt=0.25, direct=True),
    ]
    write_deck(folder, "punch.inp", cards)
