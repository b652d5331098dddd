"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

RADIUS, OFFSET, SPEED, MASS, STIFFNESS, PRELOAD = 1.0, 0.3, 1.0, 1.0, 10.0, 5.0


def write(folder: Path, n: int, count: int, friction: float = 0.0) -> None:
    """A round cam, whose middle is OFFSET from its shaft, lifts a flat follower on a spring; `n` elements along the foot."""
    foot = rectangle("FOLLOWER", "CPE4", (n, 1), (1.0, 0.2), (-0.5, RADIUS))
    x = OFFSET
    quarters = [(x, RADIUS), (x + RADIUS, 0.0), (x, -RADIUS), (x - RADIUS, 0.0), (x, RADIUS)]
    period = 2 * pi / SPEED
    cards = [
        card("HEADING", ("a cam and its follower",)),
        foot.cards(),
        foot.surface("FOOT", "bottom"),
        card("NODE, NSET=SHAFT", (100_000, 0.0, 0.0)),
        card("NODE, NSET=STEM", (100_001, 0.0, RADIUS + 0.1)),
        card("SURFACE, NAME=CAM, TYPE=SEGMENTS", ("START", *quarters[0]), *(("CIRCL", *q, x, 0.0) for q in quarters[1:])),
        card("RIGID BODY, ANALYTICAL SURFACE=CAM, REF NODE=SHAFT"),
        elastic(1e6, 0.3, MASS / 0.2, "FOLLOWER"),
        card("RIGID BODY, ELSET=FOLLOWER, REF NODE=STEM"),
        card("ELEMENT, TYPE=SPRING1, ELSET=SPRING", (90_000, 100_001)),
        card("SPRING, ELSET=SPRING", (2,), (STIFFNESS,)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "CAM")),
        card("BOUNDARY", ("SHAFT", 1, 2), ("STEM", 1, 1), ("STEM", 6, 6)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("STEM", 2, OFFSET * SPEED)),
        step(
            period / count,
            count,
            card("BOUNDARY, TYPE=VELOCITY", ("SHAFT", 6, 6, SPEED)),
            card("CLOAD", ("STEM", 2, -PRELOAD)),
            prints("STEM", "SHAFT"),
        ),
    ]
    write_deck(folder, "cam.inp", cards)
