"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import acosh, atan, cos, hypot, sin, sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import Grid, card, dry, elastic, step  # noqa: E402


HALF = 0.25, 1.0
"""Half of width and height."""


def write(
    folder: Path,
    tilt: float,
    dt: float = 2e-4,
    base: int = 1,
    kind: str = "NODE TO SURFACE",
    impact: str = "INCREMENT",
) -> None:
    """A rigid block on its right corner, tilted by a part of the angle at which it falls over, with so many elements in its
    base."""
    b, h = HALF
    angle = -tilt * atan(b / h)

    def turned(x: float, y: float) -> tuple[float, float]:
        return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)

    block = Grid("BLOCK", base, 1, lambda i, j: turned(2 * b * (i / base - 1), 2 * h * j))
    middle, fixed = block.next_node, block.next_node + 1
    quarter = acosh(1 / (1 - tilt)) / sqrt(3 * 9.81 / (4 * hypot(b, h)))
    loads = card("DLOAD", ("BLOCK", "GRAV", 9.81, 0.0, -1.0))
    cards = [
        card("HEADING", ("rocking block",)),
        block.mesh("CPE4"),
        card("NODE, NSET=MIDDLE", (middle, *turned(-b, h))),
        card("NODE, NSET=FIXED", (fixed, 0.0, -1.0)),
        elastic(1e6, 0.3, 1.0, "BLOCK"),
        card("RIGID BODY, ELSET=BLOCK, REF NODE=MIDDLE"),
        card("SURFACE, NAME=BLOCK", ("BLOCK",)),
        card("SURFACE, NAME=FLOOR, TYPE=SEGMENTS", ("START", -10.0, 0.0), ("LINE", 10.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=FIXED"),
        dry(2.0),
        card(f"CONTACT PAIR, INTERACTION=DRY, TYPE={kind}", ("BLOCK", "FLOOR")),
        card("BOUNDARY", ("FIXED", 1, 2)),
        step(dt, round(1.3 * quarter / dt), loads, card(f"STICKSLIP, IMPACT TIME={impact}"), prints("MIDDLE")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "housner.inp").write_text("".join(cards))
