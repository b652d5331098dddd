"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


def polygon(sides: int) -> list[str]:
    """A rigid polygon of so many sides with one on the floor."""
    half = pi / sides
    # the area is that of the disc of radius 1
    angles = [-pi / 2 - half + 2 * half * k for k in range(sides)]
    rim = [(cos(a) / cos(half), sin(a) / cos(half)) for a in angles]
    return [
        card("NODE, NSET=MIDDLE", (1, 0.0, 0.0)),
        card("NODE, NSET=RIM", *((k + 2, *place) for k, place in enumerate(rim))),
        card("ELEMENT, TYPE=CPE3, ELSET=DISC", *((k + 1, 1, k + 2, (k + 1) % sides + 2) for k in range(sides))),
        elastic(1e6, 0.3, 1 / pi, "DISC"),
        card("RIGID BODY, ELSET=DISC, REF NODE=MIDDLE"),
        card("SURFACE, NAME=DISC", ("DISC", "S2")),
    ]


def circle() -> list[str]:
    """A rigid disc, whose profile is a full circle."""
    ends = [(0.0, -1.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)]
    return [
        card("NODE, NSET=MIDDLE", (1, 0.0, 0.0)),
        card("ELEMENT, TYPE=MASS, ELSET=MASS", (1, 1)),
        card("MASS, ELSET=MASS", (1.0,)),
        card("ELEMENT, TYPE=ROTARYI, ELSET=INERTIA", (2, 1)),
        card("ROTARY INERTIA, ELSET=INERTIA", (0.0, 0.0, 0.5)),
        card("SURFACE, NAME=DISC, TYPE=SEGMENTS", ("START", 1.0, 0.0), *(("CIRCL", *end, 0.0, 0.0) for end in ends)),
        card("RIGID BODY, ANALYTICAL SURFACE=DISC, REF NODE=MIDDLE"),
    ]


def write(folder: Path, sides: int) -> None:
    """A rigid disc that slides at first: a polygon, or a circle if it has no sides."""
    fixed = sides + 10
    weight = card("DLOAD", ("DISC", "GRAV", 9.81, 0.0, -1.0)) if sides else card("CLOAD", ("MIDDLE", 2, -9.81))
    cards = [
        card("HEADING", ("a disc slides, then rolls",)),
        *(polygon(sides) if sides else circle()),
        card("NODE, NSET=FIXED", (fixed, 0.0, -3.0)),
        card("SURFACE, NAME=FLOOR, TYPE=SEGMENTS", ("START", -10.0, -1.0), ("LINE", 10.0, -1.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=FIXED"),
        dry(0.2),
        card("CONTACT PAIR, INTERACTION=DRY", ("DISC", "FLOOR")),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("MIDDLE", 1, 1.0)),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(5e-4, 640, weight, prints("MIDDLE")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rolling.inp").write_text("".join(cards))
