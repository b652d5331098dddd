"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, mapped, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

INNER, SEAT, OUTER, OVERLAP = 0.5, 1.0, 2.0, 1e-3
YOUNG, POISSON = 1e5, 0.3


def write(folder: Path, ring: int, shaft: int, kind: str = "CPS4", means: int = 0, curved: int = 1, swap: int = 0) -> None:
    """A quarter of a ring shrunk on a hollow shaft, `ring` and `shaft` elements around it.

    `means`: from surface to surface; `curved`: faces that bend between their nodes; `swap`: the shaft is slave.
    """

    def quarter(name: str, inner: float, outer: float, around: int, after: Block | None = None) -> Block:
        """Its `bottom` is the inner side, `left` lies on y, `right` on x."""
        through = max(round(around * (outer - inner) / 2), 2)
        angles = [pi / 2 * (1 - k / around) for k in range(around + 1)]
        radii = [inner + (outer - inner) * k / through for k in range(through + 1)]
        return mapped(name, kind, angles, radii, lambda a, r: (r * cos(a), r * sin(a)), after)

    around = quarter("RING", SEAT, OUTER, ring)
    within = quarter("SHAFT", INNER, SEAT + OVERLAP, shaft, around)
    slave = within if swap else around
    formulation = ", TYPE=SURFACE TO SURFACE" if means else ""
    if not curved:
        formulation += ", GEOMETRIC CORRECTION=NONE"
    pair = ("SEAT", "BORE") if swap else ("BORE", "SEAT")
    cards = [
        card("HEADING", ("a ring shrunk on a hollow shaft, unlike meshes",)),
        around.cards(),
        within.cards(),
        around.surface("BORE", "bottom"),
        within.surface("SEAT", "top"),
        slave.nset("FACE", "top" if swap else "bottom"),
        around.nset("OUTSIDE", "top"),
        *(body.nset("ON_X", "right") + body.nset("ON_Y", "left") for body in (around, within)),
        elastic(YOUNG, POISSON, 1.0, "RING", "SHAFT"),
        dry(0.0),
        card(f"CONTACT PAIR, INTERACTION=DRY{formulation}", pair),
        card("BOUNDARY", ("ON_X", 2, 2), ("ON_Y", 1, 1)),
        static(card("CONTACT INTERFERENCE, SHRINK", pair), dt=0.5, direct=True),
    ]
    write_deck(folder, "fit.inp", cards)
