"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, graded, mapped, prints, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

PLATES = ((10.0, 2.0), (20.0, 4.0))
"""Radius and height of the upper and the lower plate."""
BALLS = (5.0, 10.0)
"""Radii of the upper and the lower ball."""


def ball(name: str, kind: str, n: int, radius: float, middle: float, after: Block | None) -> Block:
    """A ball on the axis as a square that is drawn to a half circle: `bottom`, `right` and `top` are its outside."""

    def place(x: float, y: float) -> tuple[float, float]:
        reach, share = max(x, abs(y)), 0.0
        if reach > 0.0:
            angle = pi / 4 * (y / x if x >= abs(y) else (2 - x / abs(y)) * (1 if y > 0 else -1))
            flat, around = (x, y), (reach * cos(angle), reach * sin(angle))
            share = reach**2
            x, y = (a * (1 - share) * 0.8 + b * share for a, b in zip(flat, around))
        return radius * x, middle + radius * y

    fine = [1 - x for x in reversed(graded(1.0 / n, 0.2, 1.0, 1.1))]
    return mapped(name, kind, [k / n for k in range(n + 1)], [-y for y in reversed(fine[1:])] + fine, place, after)


def write(folder: Path, n: int, kind: str = "CAX4", steps: int = 20, way: float = 2.0) -> None:
    """Two balls between two plates, the lower one held at its rim, the upper one pushed by `way`; `n` elements in the radius of a ball."""
    (wide, high), (base, depth) = PLATES
    small, large = BALLS
    size = 5.0 / n * 0.6
    top = 2 * (small + large)
    upper = mapped("PLATE1", kind, graded(size, 4.0, wide), [top + y for y in graded(size, 0.5, high)])
    one = ball("BALL2", kind, n, small, 2 * large + small, upper)
    two = ball("BALL3", kind, n, large, large, one)
    lower = mapped("PLATE4", kind, graded(size, 6.0, base), [-y for y in reversed(graded(size, 1.0, depth))], after=two)
    blocks = (upper, one, two, lower)
    cards = [
        card("HEADING", ("a plate, two balls and a plate",)),
        *(block.cards() for block in blocks),
        upper.surface("LAB1", "bottom"),
        one.surface("CEP2", "top"),
        one.surface("CME2", "bottom"),
        two.surface("CEP3", "top"),
        two.surface("CME3", "bottom"),
        lower.surface("LCD4", "top"),
        *(block.nset("AXIS", "left") for block in blocks),
        upper.nset("PUSHED", "top"),
        lower.nset("BASE", "right"),
        card("NSET, NSET=PA4", (lower.on("bottom")[0],)),
        elastic(2e5, 0.3, 1.0, *(block.name for block in blocks)),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("CEP2", "LAB1"), ("CEP3", "CME2"), ("CME3", "LCD4")),
        card("BOUNDARY", ("AXIS", 1, 1), ("BASE", 1, 2)),
        static(card("BOUNDARY", ("PUSHED", 2, 2, -way)), prints("PA4", "BASE"), dt=1.0 / steps),
    ]
    write_deck(folder, "balls.inp", cards)
