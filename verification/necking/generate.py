"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import exp
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, prints, ride, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card  # noqa: E402

RADIUS, HALF, WAY = 6.413, 26.667, 7.0
BULK, SHEAR, YIELD, LAST, RISE, SLOPE = 164.206, 80.1938, 0.45, 0.715, 16.93, 0.12924
"""GPa; mm."""


def flow(strain: float) -> float:
    """Yield stress over the plastic strain."""
    return YIELD + SLOPE * strain + (LAST - YIELD) * (1 - exp(-RISE * strain))


def write(folder: Path, n: int, kind: str = "CAX8R", steps: int = 100) -> None:
    """A quarter of a round bar that is stretched and necks; 2 `n` x 5 `n` elements... the middle thinner by 0.1 %."""
    young = 9 * BULK * SHEAR / (3 * BULK + SHEAR)
    poisson = (3 * BULK - 2 * SHEAR) / (6 * BULK + 2 * SHEAR)
    ys = [HALF * (k / (5 * n)) ** 1.5 for k in range(5 * n + 1)]
    xs = [RADIUS * k / (2 * n) for k in range(2 * n + 1)]
    bar = mapped("BAR", kind, xs, ys, lambda x, y: (x * (1 - 0.001 * (1 - y / HALF)), y))
    strains = [0.0, *(0.002 * 1.35**k for k in range(24))]
    cards = [
        card("HEADING", ("necking of a round bar",)),
        bar.cards(),
        bar.nset("AXIS", "left"),
        bar.nset("MIDDLE", "bottom"),
        card("NSET, NSET=NECK", (bar.on("bottom")[-1],)),
        ride(bar, "top", "HEAD", 2),
        card("MATERIAL, NAME=STEEL") + card("ELASTIC", (young, poisson)) + card("DENSITY", (1.0,)),
        card("PLASTIC", *((flow(e), e) for e in strains)),
        card("SOLID SECTION, ELSET=BAR, MATERIAL=STEEL"),
        card("BOUNDARY", ("AXIS", 1, 1), ("MIDDLE", 2, 2)),
        static(card("BOUNDARY", ("HEAD", 2, 2, WAY)), prints("HEAD", "NECK"), dt=1.0 / steps, direct=True),
    ]
    write_deck(folder, "necking.inp", cards)
