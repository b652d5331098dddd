"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import graded, mapped, ride, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, material  # noqa: E402

RADIUS, SIDE = 50.0, 200.0


MODULUS = 1 / ((1 - 0.3**2) / 210e3 + (1 - 0.3**2) / 70e3)


def write(folder: Path, n: int, a: float, friction: float = 0.0, order: int = 1, steps: int = 4) -> None:
    """Half of a steel cylinder on half of an aluminium block; `n` elements in the half width `a` of the load by Hertz."""
    kind = "CPE4" if order == 1 else "CPE8"
    size, force = a / n, pi * MODULUS * a**2 / (4 * RADIUS) / 2

    def cylinder(x: float, t: float) -> tuple[float, float]:
        foot = RADIUS - (RADIUS**2 - x**2) ** 0.5
        return x, foot + (RADIUS - foot) * t / RADIUS

    upper = mapped("CYLINDER", kind, graded(size, 1.5 * a, 45.0), graded(size, a, RADIUS), cylinder)
    depths = [-y for y in reversed(graded(size, a, SIDE))]
    lower = mapped("BLOCK", kind, graded(size, 1.5 * a, SIDE / 2), depths, after=upper)
    cards = [
        card("HEADING", ("NAFEMS R0094, benchmark 1: a cylinder on a block",)),
        upper.cards(),
        lower.cards(),
        upper.surface("FOOT", "bottom"),
        upper.nset("FOOT", "bottom"),
        upper.nset("MIDDLE", "left"),
        lower.surface("GROUND", "top"),
        lower.nset("MIDDLE_BELOW", "left"),
        lower.nset("BASE", "bottom"),
        card("NSET, NSET=B", (lower.node(0, 2 * lower.ny),)),
        ride(upper, "top", "HEAD", 2),
        elastic(210e3, 0.3, 1.0, "CYLINDER"),
        material("ALUMINIUM", 70e3, 0.3, 1.0),
        card("SOLID SECTION, ELSET=BLOCK, MATERIAL=ALUMINIUM", (1.0,)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
        card("BOUNDARY", ("MIDDLE", 1, 1), ("MIDDLE_BELOW", 1, 1), ("BASE", 1, 2)),
        static(card("CLOAD", ("HEAD", 2, -force)), card("NODE PRINT, NSET=B", ("U",)), dt=1.0 / steps, direct=True),
    ]
    write_deck(folder, "hertz.inp", cards)
