"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.cards import card, dry, elastic, step  # noqa: E402


def write(folder: Path, sides: int) -> None:
    """A rigid disc, a polygon of so many sides with one on the floor, that slides at first."""
    half = pi / sides
    # the area is that of the disc of radius 1
    angles = [-pi / 2 - half + 2 * half * k for k in range(sides)]
    rim = [(cos(a) / cos(half), sin(a) / cos(half)) for a in angles]
    cards = [
        card("HEADING", ("a disc slides, then rolls",)),
        card("NODE, NSET=MIDDLE", (1, 0.0, 0.0)),
        card("NODE, NSET=RIM", *((k + 2, *place) for k, place in enumerate(rim))),
        card("NODE, NSET=FIXED", (sides + 10, 0.0, -3.0)),
        card("ELEMENT, TYPE=CPE3, ELSET=DISC", *((k + 1, 1, k + 2, (k + 1) % sides + 2) for k in range(sides))),
        elastic(1e6, 0.3, 1 / pi, "DISC"),
        card("RIGID BODY, ELSET=DISC, REF NODE=MIDDLE"),
        card("SURFACE, NAME=DISC", ("DISC", "S2")),
        card("SURFACE, NAME=FLOOR, TYPE=SEGMENTS", ("START", -10.0, -1.0), ("LINE", 10.0, -1.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=FIXED"),
        dry(0.2),
        card("CONTACT PAIR, INTERACTION=DRY", ("DISC", "FLOOR")),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("MIDDLE", 1, 1.0)),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(5e-4, 640, card("DLOAD", ("DISC", "GRAV", 9.81, 0.0, -1.0)), prints("MIDDLE")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rolling.inp").write_text("".join(cards))
