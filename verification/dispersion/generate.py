"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402

WAVES = 4
"""Quarter waves in the length of the bar, times two less one: the mode sin((2 WAVES - 1) pi x/2)."""


def write(folder: Path, per: float, courant: float, periods: float = 2.0, scheme: str = "ENERGY-MOMENTUM") -> None:
    """A standing wave of `per` elements per wave length in a bar of length 1, c = 1, with c dt = `courant` h."""
    wave = 4.0 / (2 * WAVES - 1)
    n = round(per / wave)
    dt = courant / n
    bar = rectangle("BAR", "CPE4", (n, 1), (1.0, 1.0 / n))
    number = 2 * pi / wave
    speeds = [
        (bar.node(2 * i, 2 * j), 1, 1e-8 * sin(number * i / n)) for i in range(1, n + 1) for j in (0, 1)
    ]
    cards = [
        card("HEADING", ("a standing wave",)),
        bar.cards(),
        bar.nset("HELD", "left"),
        bar.nset("END", "right"),
        elastic(1.0, 0.0, 1.0, "BAR"),
        card("BOUNDARY", ("HELD", 1, 1), ("BAR", 2, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
        step(dt, round(periods * wave / dt), card(f"STICKSLIP, SCHEME={scheme}, TOLERANCE=1.E-12"), prints("END")),
    ]
    write_deck(folder, "bar.inp", cards)
