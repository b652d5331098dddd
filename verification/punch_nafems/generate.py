"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import follower, graded, mapped, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, material  # noqa: E402

FLAT, FILLET, RADIUS, HEIGHT = 40.0, 10.0, 50.0, 100.0
ARC = FILLET * pi / 3
"""How much of the fillet is meshed."""


def write(folder: Path, size: float, friction: float = 0.0, order: int = 1, steps: int = 5) -> None:
    """A steel punch with a fillet on an aluminium cylinder; `size` of the elements at the contact."""
    kind = "CAX4" if order == 1 else "CAX8"
    inner = [FLAT - x for x in reversed(graded(size, 2.0, FLAT, 1.25))]
    along = inner + [FLAT + ARC * k / round(ARC / size) for k in range(1, round(ARC / size) + 1)]
    up = graded(size, 3.0, HEIGHT)

    def punch(s: float, t: float) -> tuple[float, float]:
        angle = max(s - FLAT, 0.0) / FILLET
        x, y = min(s, FLAT) + FILLET * sin(angle), FILLET * (1 - cos(angle))
        width = FLAT + FILLET * sin(ARC / FILLET)
        x += x * (RADIUS / width - 1) * min(t / 20.0, 1.0)
        return x, y + (HEIGHT - y) * t / HEIGHT

    upper = mapped("PUNCH", kind, along, up, punch)
    outward = graded(size, 8.0, 60.0)
    depths = [-y for y in reversed(graded(size, 4.0, 200.0))]
    lower = mapped("FOUNDATION", kind, inner + [FLAT + x for x in outward[1:]], depths, after=upper)
    cards = [
        card("HEADING", ("NAFEMS R0094, benchmark 2: a punch with a fillet",)),
        upper.cards(),
        lower.cards(),
        upper.surface("FOOT", "bottom"),
        upper.nset("FOOT", "bottom"),
        upper.surface("HEAD", "top"),
        upper.nset("AXIS", "left"),
        lower.nset("AXIS", "left"),
        lower.surface("GROUND", "top"),
        lower.nset("TOP", "top"),
        lower.nset("BASE", "bottom"),
        elastic(210e3, 0.3, 1.0, "PUNCH"),
        material("ALUMINIUM", 70e3, 0.3, 1.0),
        card("SOLID SECTION, ELSET=FOUNDATION, MATERIAL=ALUMINIUM", (1.0,)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
        card("BOUNDARY", ("AXIS", 1, 1), ("BASE", 1, 2)),
        static(follower("HEAD", 100.0), dt=1.0 / steps, direct=True),
    ]
    write_deck(folder, "punch.inp", cards)
