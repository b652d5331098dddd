"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


def write(folder: Path, ratio: float, friction: float, periods: int = 40, count: int = 1600) -> None:
    """A mass 1 on a spring 1 under cos(ratio t); the largest friction is a part `friction` of the load."""
    cards = [
        card("HEADING", ("mass on a spring with friction under a harmonic load",)),
        card("NODE, NSET=CORNERS", (1, 0.0, 0.0), (2, 1.0, 0.0), (3, 1.0, 1.0), (4, 0.0, 1.0)),
        card("NODE, NSET=MIDDLE", (5, 0.5, 0.5)),
        card("NODE, NSET=FIXED", (6, 0.0, -1.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4)),
        elastic(1e9, 0.3, 1.0, "BLOCK"),
        card("RIGID BODY, ELSET=BLOCK, REF NODE=MIDDLE"),
        card("ELEMENT, TYPE=SPRING1, ELSET=ESPRING", (2, 5)),
        card("SPRING, ELSET=ESPRING", (1,), (1.0,)),
        card("SURFACE, NAME=SOLE", ("BLOCK", "S1")),
        card("SURFACE, NAME=PLANE, TYPE=SEGMENTS", ("START", -50.0, 0.0), ("LINE", 50.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=PLANE, REF NODE=FIXED"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "PLANE")),
        card("AMPLITUDE, NAME=WAVE, DEFINITION=PERIODIC", (1, ratio, 0.0, 0.0), (1.0, 0.0)),
        card("BOUNDARY", ("FIXED", 1, 2), ("MIDDLE", 6, 6)),
        step(
            2 * pi / ratio / count,
            periods * count,
            card("CLOAD", (5, 2, -1.0)),
            card("CLOAD, AMPLITUDE=WAVE", (5, 1, 1.0)),
            prints("MIDDLE"),
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "den_hartog.inp").write_text("".join(cards))
