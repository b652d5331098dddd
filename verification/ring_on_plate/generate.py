"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, plane, prints, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

INNER, OUTER, WAY = 4.15, 6.35, 2.225


def write(folder: Path, n: int, kind: str = "CPS8", law: str = "ELASTIC") -> None:
    """A quarter of a ring, pressed by a rigid plate from below; `n` elements around."""
    angles = [-pi / 2 * (1 - k / n) for k in range(n + 1)]
    through = max(n // 8, 2)
    radii = [OUTER - (OUTER - INNER) * k / through for k in range(through + 1)]
    ring = mapped("RING", kind, angles, radii, lambda a, r: (r * cos(a), r * sin(a)))
    solid = elastic(407.0, 0.48, 1.0, "RING")
    if law != "ELASTIC":
        shear = 407.0 / 2 / 1.48
        solid = card("MATERIAL, NAME=RUBBER") + card("HYPERELASTIC, NEO HOOKE", (shear / 2, 2 / (407.0 / 3 / 0.04)))
        solid += card("DENSITY", (1.0,)) + card("SOLID SECTION, ELSET=RING, MATERIAL=RUBBER", (1.0,))
    cards = [
        card("HEADING", ("an elastic ring pressed on a plate",)),
        ring.cards(),
        ring.surface("SKIN", "bottom"),
        ring.nset("FOOT_LINE", "left"),
        ring.nset("CUT", "right"),
        plane("PLATE", (-1.0, -OUTER), (12.0, -OUTER)),
        solid,
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "PLATE")),
        card("BOUNDARY", ("FOOT_LINE", 1, 1), ("CUT", 2, 2), ("REFERENCE", 1, 1)),
        static(card("BOUNDARY", ("REFERENCE", 2, 2, WAY)), prints("REFERENCE"), dt=0.0625, direct=True),
    ]
    write_deck(folder, "ring.inp", cards)
