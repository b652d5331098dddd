"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi, sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import graded, mapped, prints, ride, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

YOUNG, POISSON, FRICTION = 1000.0, 0.3, 0.3
PRESS = pi / 4 * YOUNG / (1 - POISSON**2)
"""Force of like cylinders of radius 1, over a^2."""


def write(folder: Path, share: float, n: int = 16, a: float = 0.0125, increments: int = 1, kind: str = "") -> None:
    """Like cylinders, pressed to the half width `a` of `n` elements, then sheared by `share` of mu P."""
    right = graded(a / n, 1.5 * a, 0.8)
    xs = [-x for x in reversed(right[1:])] + right
    up = graded(a / n, a, 1.0)

    def above(x: float, t: float) -> tuple[float, float]:
        foot = 1.0 - sqrt(1.0 - x**2)
        return x, foot + (1.0 - foot) * t

    def below(x: float, t: float) -> tuple[float, float]:
        x, y = above(x, -t)
        return x, -y

    upper = mapped("UPPER", "CPE4", xs, up, above)
    lower = mapped("LOWER", "CPE4", xs, [-t for t in reversed(up)], below, upper)
    press = PRESS * a**2
    cards = [
        card("HEADING", ("like cylinders, pressed and sheared",)),
        upper.cards(),
        lower.cards(),
        upper.surface("FOOT", "bottom"),
        upper.nset("FOOT", "bottom"),
        lower.surface("GROUND", "top"),
        lower.nset("BASE", "bottom"),
        ride(upper, "top", "HEAD", 1, 2),
        elastic(YOUNG, POISSON, 1.0, "UPPER", "LOWER"),
        dry(FRICTION),
        card(f"CONTACT PAIR, INTERACTION=DRY{kind}", ("FOOT", "GROUND")),
        card("BOUNDARY", ("BASE", 1, 2)),
        static(card("CLOAD", ("HEAD", 2, -press)), prints("HEAD"), dt=0.25, direct=True),
        static(card("CLOAD", ("HEAD", 1, share * FRICTION * press)), dt=1.0 / increments, direct=True),
    ]
    write_deck(folder, "mindlin.inp", cards)
