"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


OFFSET = 0.85e-3
"""First displacement: the spring begins with it."""


def write(folder: Path, dt: float, scheme: str) -> None:
    """A rigid block of mass 1 on a level plane, on a spring of stiffness 1e4."""
    cards = [
        card("HEADING", ("mass on a spring with friction",)),
        card("NODE, NSET=CORNERS", (1, 0.0, 0.0), (2, 1.0, 0.0), (3, 1.0, 1.0), (4, 0.0, 1.0)),
        card("NODE, NSET=MIDDLE", (5, 0.5, 0.5)),
        card("NODE, NSET=FIXED", (6, 0.0, -1.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4)),
        elastic(1e9, 0.3, 1.0, "BLOCK"),
        card("RIGID BODY, ELSET=BLOCK, REF NODE=MIDDLE"),
        card("ELEMENT, TYPE=SPRING1, ELSET=ESPRING", (2, 5)),
        card("SPRING, ELSET=ESPRING, NONLINEAR", (1,), (1e4 * (OFFSET - 0.01), -0.01), (1e4 * (OFFSET + 0.01), 0.01)),
        card("SURFACE, NAME=SOLE", ("BLOCK", "S1")),
        card("SURFACE, NAME=PLANE, TYPE=SEGMENTS", ("START", -10.0, 0.0), ("LINE", 20.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=PLANE, REF NODE=FIXED"),
        dry(0.1),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "PLANE")),
        card("BOUNDARY", ("FIXED", 1, 2), ("MIDDLE", 6, 6)),
        step(
            dt,
            round(0.2 / dt),
            card(f"STICKSLIP, SCHEME={scheme}"),
            card("DLOAD", ("BLOCK", "GRAV", 10.0, 0.0, -1.0)),
            prints("MIDDLE"),
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "oscillator_with_friction.inp").write_text("".join(cards))
