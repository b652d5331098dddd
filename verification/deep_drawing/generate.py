"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, radians, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry  # noqa: E402

BLANK, PUNCH, FILLET, YOUNG = 59.18, 50.8, 6.35, 69004.0
CURVE = (
    (0.0011675, 80.5592278), (0.0036675, 162.8356672), (0.0061675, 188.3434203), (0.0086675, 205.2915297),
    (0.0136675, 228.9788303), (0.0211675, 253.2827677), (0.0311675, 276.3666650), (0.0461675, 301.5903407),
    (0.0661675, 326.4741413), (0.0961675, 354.3254003), (0.1311675, 379.1396378), (0.1761675, 404.2640312),
    (0.2411675, 432.7927743), (0.3211675, 460.5290181), (0.4261675, 489.6315265), (0.5511675, 517.6672496),
    (0.7011675, 545.3431615), (0.9011675, 575.7608082), (1.2011675, 612.6695002), (1.6011675, 651.9451725),
)
"""Strains and stresses."""


def write(folder: Path, n: int, layers: int = 2, kind: str = "CAX8R", way: float = 44.0, steps: int = 200) -> None:
    """A sheet held at its rim is drawn by a sphere over the edge of a die; `n` elements along the radius."""
    blank = rectangle("BLANK", kind, (n, layers), (BLANK, 1.0))
    end = radians(80)
    cards = [
        card("HEADING", ("deep drawing by a sphere",)),
        blank.cards(),
        blank.surface("LOWER", "bottom"),
        blank.surface("UPPER", "top"),
        blank.nset("AXIS", "left"),
        blank.nset("RIM", "right"),
        card("NODE, NSET=PUSH", (100_001, 0.0, -PUNCH)),
        card("NODE, NSET=HELD", (100_002, 80.0, 1.0)),
        card(
            "SURFACE, NAME=PUNCH, TYPE=SEGMENTS",
            ("START", -PUNCH * sin(0.1), PUNCH * (cos(0.1) - 1)),
            ("CIRCL", PUNCH * sin(end), PUNCH * (cos(end) - 1), 0.0, -PUNCH),
        ),
        card(
            "SURFACE, NAME=DIE, TYPE=SEGMENTS",
            ("START", BLANK + 5.0, 1.0),
            ("LINE", BLANK, 1.0),
            ("CIRCL", BLANK - FILLET, 1.0 + FILLET, BLANK, 1.0 + FILLET),
            ("LINE", BLANK - FILLET, 60.0),
        ),
        card("RIGID BODY, ANALYTICAL SURFACE=PUNCH, REF NODE=PUSH"),
        card("RIGID BODY, ANALYTICAL SURFACE=DIE, REF NODE=HELD"),
        card("MATERIAL, NAME=STEEL") + card("ELASTIC", (YOUNG, 0.3)) + card("DENSITY", (1.0,)),
        card("PLASTIC", *((stress, strain - stress / YOUNG if k else 0.0) for k, (strain, stress) in enumerate(CURVE))),
        card("SOLID SECTION, ELSET=BLANK, MATERIAL=STEEL", (1.0,)),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("LOWER", "PUNCH"), ("UPPER", "DIE")),
        card("BOUNDARY", ("AXIS", 1, 1), ("RIM", 1, 2), ("HELD", 1, 2), ("PUSH", 1, 1)),
        static(card("BOUNDARY", ("PUSH", 2, 2, way)), prints("PUSH"), dt=1.0 / steps),
    ]
    write_deck(folder, "drawing.inp", cards)
