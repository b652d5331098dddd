"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import asin, cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402

CRANK, ROD, DEPTH, SPEED = 0.153, 0.306, 0.02, 150.0
START = pi / 4


def write(folder: Path, count: int) -> None:
    """A crank turns once at constant speed; rod and slider follow; bodies of mass 1 per area."""
    tilt = -asin(CRANK / ROD * sin(START))
    elbow = (CRANK * cos(START), CRANK * sin(START))
    head = elbow[0] + ROD * cos(tilt)

    def bar(name, length, angle, x0, y0, after=None):
        def place(s: float, t: float) -> tuple[float, float]:
            return x0 + s * cos(angle) - t * sin(angle), y0 + s * sin(angle) + t * cos(angle)

        return mapped(name, "CPE4", [0.0, length / 2, length], [-DEPTH / 2, 0.0, DEPTH / 2], place, after)

    crank = bar("CRANK", CRANK, START, 0.0, 0.0)
    rod = bar("ROD", ROD, tilt, *elbow, crank)
    slider = bar("SLIDER", 0.05, 0.0, head, 0.0, rod)
    swing = -SPEED * CRANK * cos(START) / (ROD * cos(tilt))
    vx = -SPEED * CRANK * sin(START) - swing * ROD * sin(tilt)
    first = [("BIG_END", 1, -SPEED * elbow[1]), ("BIG_END", 2, SPEED * elbow[0]), ("BIG_END", 6, swing), ("PISTON", 1, vx)]
    period = 2 * pi / SPEED
    cards = [
        card("HEADING", ("a crank, a rod and a slider",)),
        crank.cards(),
        rod.cards(),
        slider.cards(),
        card("NSET, NSET=SHAFT", (crank.node(0, 2),)),
        card("NSET, NSET=CRANK_END", (crank.node(4, 2),)),
        card("NSET, NSET=BIG_END", (rod.node(0, 2),)),
        card("NSET, NSET=SMALL_END", (rod.node(4, 2),)),
        card("NSET, NSET=PISTON", (slider.node(0, 2),)),
        elastic(1e9, 0.3, 1.0 / DEPTH, "CRANK", "ROD", "SLIDER"),
        card("RIGID BODY, ELSET=CRANK, REF NODE=SHAFT"),
        card("RIGID BODY, ELSET=ROD, REF NODE=BIG_END"),
        card("RIGID BODY, ELSET=SLIDER, REF NODE=PISTON"),
        card("MPC", ("PIN", "CRANK_END", "BIG_END"), ("PIN", "SMALL_END", "PISTON")),
        card("BOUNDARY", ("SHAFT", 1, 2), ("PISTON", 2, 2), ("PISTON", 6, 6)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *first),
        step(period / count, count, card("BOUNDARY, TYPE=VELOCITY", ("SHAFT", 6, 6, SPEED)), prints("PISTON", "SHAFT")),
    ]
    write_deck(folder, "crank.inp", cards)
