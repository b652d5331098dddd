"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

RADIUS, LENGTH, WAY = 50.0, 65.0, 155.0
DIE = ((50.0, -5.0), (50.0, 70.0), (45.0, 85.0), (45.0, 115.0), (48.0, 135.0), (48.0, 205.0), (48.0, 240.0))


def write(folder: Path, n: int, kind: str = "CAX4", law: str = "ELASTIC", steps: int = 155, reach: float = 240.0) -> None:
    """A billet is pushed through a narrow and a wider die up to the height `reach`; `n` elements along the radius."""
    billet = rectangle("BILLET", kind, (n, round(n * LENGTH / RADIUS)), (RADIUS, LENGTH))
    solid = elastic(5000.0, 0.45, 1.0, "BILLET")
    if law != "ELASTIC":
        shear, bulk = 5000.0 / 2 / 1.45, 5000.0 / 3 / 0.1
        solid = card("MATERIAL, NAME=RUBBER") + card("HYPERELASTIC, NEO HOOKE", (shear / 2, 2 / bulk))
        solid += card("DENSITY", (1.0,)) + card("SOLID SECTION, ELSET=BILLET, MATERIAL=RUBBER", (1.0,))
    points = [*(point for point in DIE if point[1] < reach), (48.0, reach)]
    cards = [
        card("HEADING", ("a billet pushed through a die",)),
        billet.cards(),
        billet.surface("SKIN", "right"),
        billet.nset("AXIS", "left"),
        billet.nset("PUSHED", "bottom"),
        card("NSET, NSET=K", (billet.on("top")[0],)),
        card("NODE, NSET=HELD", (100_000, 80.0, 0.0)),
        card("SURFACE, NAME=DIE, TYPE=SEGMENTS", ("START", *points[0]), *(("LINE", *point) for point in points[1:])),
        card("RIGID BODY, ANALYTICAL SURFACE=DIE, REF NODE=HELD"),
        solid,
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "DIE")),
        card("BOUNDARY", ("AXIS", 1, 1), ("HELD", 1, 2)),
        static(card("BOUNDARY", ("PUSHED", 2, 2, WAY)), prints("K", "PUSHED"), dt=1.0 / steps),
    ]
    write_deck(folder, "billet.inp", cards)
