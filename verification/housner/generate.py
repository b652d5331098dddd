"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import acosh, atan, cos, hypot, sin, sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


HALF = 0.25, 1.0
"""Half of width and height."""


def write(folder: Path, tilt: float, dt: float = 2e-4) -> None:
    """A rigid block on its right corner, tilted by a part of the angle at which it falls over."""
    b, h = HALF
    angle = -tilt * atan(b / h)
    places = [(0.0, 0.0), (0.0, 2 * h), (-2 * b, 2 * h), (-2 * b, 0.0), (-b, h)]
    turned = [(x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)) for x, y in places]
    quarter = acosh(1 / (1 - tilt)) / sqrt(3 * 9.81 / (4 * hypot(b, h)))
    cards = [
        card("HEADING", ("rocking block",)),
        card("NODE, NSET=CORNERS", *((k + 1, *place) for k, place in enumerate(turned[:4]))),
        card("NODE, NSET=MIDDLE", (5, *turned[4])),
        card("NODE, NSET=FIXED", (6, 0.0, -1.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4)),
        elastic(1e6, 0.3, 1.0, "BLOCK"),
        card("RIGID BODY, ELSET=BLOCK, REF NODE=MIDDLE"),
        card("SURFACE, NAME=BLOCK", ("BLOCK",)),
        card("SURFACE, NAME=FLOOR, TYPE=SEGMENTS", ("START", -10.0, 0.0), ("LINE", 10.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=FIXED"),
        dry(2.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("BLOCK", "FLOOR")),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(dt, round(1.3 * quarter / dt), card("DLOAD", ("BLOCK", "GRAV", 9.81, 0.0, -1.0)), prints("MIDDLE")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "housner.inp").write_text("".join(cards))
