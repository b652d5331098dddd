"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, radians, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import plane, prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

LENGTH, GRAVITY = 1.0, 9.81


def write(folder: Path, angle: float, friction: float, speed: float, dt: float = 1e-5, count: int = 10) -> None:
    """A slender uniform rod of mass 1 at an angle in degrees, its lower end on a rough plane, moves sideways."""
    half = LENGTH / 2
    x, y = half * cos(radians(angle)), half * sin(radians(angle))
    cards = [
        card("HEADING", ("a rod slides on its end",)),
        card("NODE, NSET=MIDDLE", (1, x, y)),
        card("NODE, NSET=FAR", (11, 5.0, 5.0), (12, 6.0, 5.0), (13, 6.0, 6.0), (14, 5.0, 6.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=ELSEWHERE", (11, 11, 12, 13, 14)),
        elastic(1.0, 0.3, 1.0, "ELSEWHERE"),
        card("NODE, NSET=TIP", (2, 0.0, 0.0)),
        card("ELEMENT, TYPE=MASS, ELSET=MASS", (1, 1)),
        card("MASS, ELSET=MASS", (1.0,)),
        card("ELEMENT, TYPE=ROTARYI, ELSET=INERTIA", (2, 1)),
        card("ROTARY INERTIA, ELSET=INERTIA", (1.0, 1.0, LENGTH**2 / 12)),
        card("RIGID BODY, NSET=TIP, REF NODE=MIDDLE"),
        card("SURFACE, NAME=END, TYPE=NODE", ("TIP", 1.0)),
        plane("GROUND", (-10.0, 0.0), (10.0, 0.0)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("END", "GROUND")),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("MIDDLE", 1, speed)),
        card("BOUNDARY", ("REFERENCE", 1, 2), ("FAR", 1, 2)),
        step(dt, count, card("CLOAD", ("MIDDLE", 2, -GRAVITY)), prints("MIDDLE", "TIP")),
    ]
    write_deck(folder, "rod.inp", cards)
