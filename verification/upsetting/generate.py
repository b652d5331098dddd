"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import plane, prints, rectangle, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry  # noqa: E402

RADIUS, HALF, YOUNG, YIELD, HARDENING = 10.0, 15.0, 200e3, 700.0, 300.0


def write(folder: Path, n: int, friction: float = 0.0, kind: str = "CAX4", share: float = 0.5, steps: int = 50) -> None:
    """The upper half of a cylinder is upset by a plate to (1 - `share`) of its height."""
    billet = rectangle("BILLET", kind, (n, round(1.5 * n)), (RADIUS, HALF))
    cards = [
        card("HEADING", ("a cylinder is upset",)),
        billet.cards(),
        billet.surface("HEAD", "top"),
        billet.surface("SIDE", "right"),
        billet.nset("AXIS", "left"),
        billet.nset("MIDDLE", "bottom"),
        card("NSET, NSET=EQUATOR", (billet.on("bottom")[-1],)),
        plane("PLATE", (40.0, HALF), (-5.0, HALF)),
        card("MATERIAL, NAME=STEEL") + card("ELASTIC", (YOUNG, 0.3)) + card("DENSITY", (1.0,)),
        card("PLASTIC", (YIELD, 0.0), (YIELD + 2 * HARDENING, 2.0)),
        card("SOLID SECTION, ELSET=BILLET, MATERIAL=STEEL"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("HEAD", "PLATE"), ("SIDE", "PLATE")),
        card("BOUNDARY", ("AXIS", 1, 1), ("MIDDLE", 2, 2), ("REFERENCE", 1, 1)),
        static(card("BOUNDARY", ("REFERENCE", 2, 2, -share * HALF)), prints("REFERENCE", "EQUATOR"), dt=1.0 / steps, direct=True),
    ]
    write_deck(folder, "upsetting.inp", cards)
