"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, radians, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


def write(
    folder: Path, angle: float, friction: float, duration: float, speed: float = 0.0, count: int = 400,
    scheme: str = "ENERGY-MOMENTUM",
) -> None:
    """A rigid block of mass 1/2 on a rigid slope of an angle in degrees, x along it, with an initial speed."""
    slope = radians(angle)
    cards = [
        card("HEADING", ("sliding block",)),
        card("NODE, NSET=CORNERS", (1, 0.0, 0.0), (2, 1.0, 0.0), (3, 1.0, 0.5), (4, 0.0, 0.5)),
        card("NODE, NSET=MIDDLE", (5, 0.5, 0.25)),
        card("NODE, NSET=FIXED", (6, 0.0, -1.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4)),
        elastic(1e6, 0.3, 1.0, "BLOCK"),
        card("RIGID BODY, ELSET=BLOCK, REF NODE=MIDDLE"),
        card("SURFACE, NAME=SOLE", ("BLOCK", "S1")),
        card("SURFACE, NAME=SLOPE, TYPE=SEGMENTS", ("START", -10.0, 0.0), ("LINE", 20.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=SLOPE, REF NODE=FIXED"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "SLOPE")),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("MIDDLE", 1, speed)),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(
            duration / count,
            count,
            card(f"STICKSLIP, SCHEME={scheme}"),
            card("DLOAD", ("BLOCK", "GRAV", 9.81, sin(slope), -cos(slope))),
            prints("MIDDLE"),
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sliding.inp").write_text("".join(cards))
