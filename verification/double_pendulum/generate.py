"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402

LENGTH, DEPTH, GRAVITY, ANGLES = 1.0, 0.1, 9.81, (1.2, 0.6)
"""Angles of the rods from the vertical at the start."""


def write(folder: Path, count: int, duration: float = 2.0) -> None:
    """Two rigid rods that hang on each other, released at rest."""
    start, blocks = (0.0, 0.0), []
    for k, angle in enumerate(ANGLES):
        along, across, (x0, y0) = (sin(angle), -cos(angle)), (cos(angle), sin(angle)), start

        def place(s: float, t: float, u=along, w=across, x=x0, y=y0) -> tuple[float, float]:
            return x + s * u[0] + t * w[0], y + s * u[1] + t * w[1]

        xs, ys = [0.0, LENGTH / 2, LENGTH], [-DEPTH / 2, 0.0, DEPTH / 2]
        blocks.append(mapped(f"ROD{k + 1}", "CPE4", xs, ys, place, blocks[-1] if blocks else None))
        start = (x0 + LENGTH * along[0], y0 + LENGTH * along[1])
    one, two = blocks
    cards = [
        card("HEADING", ("a double pendulum",)),
        one.cards(),
        two.cards(),
        card("NSET, NSET=PIVOT", (one.node(0, 2),)),
        card("NSET, NSET=ELBOW", (two.node(0, 2),)),
        card("NSET, NSET=JOINT", (one.node(4, 2),)),
        card("NSET, NSET=END", (two.node(4, 2),)),
        elastic(1e6, 0.3, 1.0 / (LENGTH * DEPTH), "ROD1", "ROD2"),
        card("RIGID BODY, ELSET=ROD1, REF NODE=PIVOT"),
        card("RIGID BODY, ELSET=ROD2, REF NODE=ELBOW"),
        card("MPC", ("PIN", "JOINT", "ELBOW")),
        card("BOUNDARY", ("PIVOT", 1, 2)),
        step(duration / count, count, card("DLOAD", ("", "GRAV", GRAVITY, 0.0, -1.0)), prints("JOINT", "END")),
    ]
    write_deck(folder, "pendulum.inp", cards)
