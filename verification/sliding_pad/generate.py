"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

RAMP, END = 0.07, 3.5


def write(folder: Path, dt: float, n: int = 4, scheme: str = "ENERGY-MOMENTUM") -> None:
    """A pad of 1 m x 1 m on two springs is pushed sideways; `n` elements along its sides."""
    pad = rectangle("PAD", "CPE4", (n, n), (1.0, 1.0))
    corners = (pad.node(0, 0), pad.node(0, 2 * n))
    cards = [
        card("HEADING", ("a pad on springs, pushed over a base",)),
        pad.cards(),
        pad.surface("SOLE", "bottom"),
        pad.surface("TOP", "top"),
        pad.surface("SIDE", "left"),
        pad.nset("LEFT", "left"),
        card("NODE, NSET=REFERENCE", (100_000, -5.0, 0.0)),
        card("SURFACE, NAME=BASE, TYPE=SEGMENTS", ("START", -5.0, 0.0), *(("LINE", float(x), 0.0) for x in range(-4, 26))),
        card("RIGID BODY, ANALYTICAL SURFACE=BASE, REF NODE=REFERENCE"),
        card("ELEMENT, TYPE=SPRING1, ELSET=SPRINGS", *((9000 + k, node) for k, node in enumerate(corners))),
        card("SPRING, ELSET=SPRINGS", (1,), (12e3,)),
        card("AMPLITUDE, NAME=RAMP", (0.0, 0.0, RAMP, 1.0, 2 * END, 1.0)),
        elastic(2.1e11, 0.0, 7000.0, "PAD"),
        dry(0.3),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "BASE")),
        card("BOUNDARY", ("REFERENCE", 1, 2)),
        step(
            dt,
            round(END / dt),
            card(f"STICKSLIP, SCHEME={scheme}"),
            card("DSLOAD, AMPLITUDE=RAMP", ("TOP", "P", 70e3), ("SIDE", "P", 200e3)),
            prints("LEFT"),
        ),
    ]
    write_deck(folder, "pad.inp", cards)
