"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import atan2, cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, prints, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, material  # noqa: E402

HOLE, END, LENGTH = 50.0, 100.0, 200.0
CORE = 5.0
"""Radius of the middle of the pin, where the force acts: a rigid core."""


def outline(angle: float) -> tuple[float, float]:
    """Point of the sheet's outline at the end of a ray: half a circle, then straight to the left, then the left edge."""
    c, s = cos(angle), sin(angle)
    if angle <= pi / 2:
        return END * c, END * s
    corner = atan2(END, -LENGTH)
    return (END * c / s, END) if angle <= corner else (-LENGTH, -LENGTH * s / c)


def write(folder: Path, n: int, friction: float = 0.1, kind: str = "CPE4", force: float = 10e3, steps: int = 10) -> None:
    """Half of a sheet with a pin in its hole, which is pulled to the right; `n` elements on each quarter of the hole."""
    corner = atan2(END, -LENGTH)
    left = max(n // 3, 2)
    angles = [pi / 2 * k / n for k in range(n)]
    angles += [pi / 2 + (corner - pi / 2) * k / (n - left) for k in range(n - left)]
    angles += [corner + (pi - corner) * k / left for k in range(left + 1)]
    out = [(k / n) ** 1.3 for k in range(n + 1)]

    def sheet(t: float, minus: float) -> tuple[float, float]:
        angle = -minus
        x, y = outline(angle)
        return HOLE * cos(angle) * (1 - t) + x * t, HOLE * sin(angle) * (1 - t) + y * t

    def pin(r: float, angle: float) -> tuple[float, float]:
        return r * cos(angle), r * sin(angle)

    plate = mapped("SHEET", kind, out, angles, lambda t, a: sheet(t, -a))
    radii = [CORE + (HOLE - CORE) * k / (n // 2) for k in range(n // 2 + 1)]
    bolt = mapped("PIN", kind, radii, angles, pin, plate)
    fixed = [plate.node(2 * plate.nx, j) for j in range(2 * (2 * n - left), 2 * plate.ny + 1) if plate.quadratic or j % 2 == 0]
    cards = [
        card("HEADING", ("NAFEMS R0094, benchmark 4: a loaded pin",)),
        plate.cards(),
        bolt.cards(),
        plate.surface("BORE", "left"),
        plate.nset("BORE", "left"),
        bolt.surface("SKIN", "right"),
        bolt.nset("CORE", "left"),
        *(plate.nset("AXIS", side) for side in ("bottom", "top")),
        card("NSET, NSET=AXIS", *((node,) for side in ("bottom", "top") for node in bolt.on(side)[1:])),
        card("NSET, NSET=EDGE", *((node,) for node in fixed)),
        card("NSET, NSET=A", (plate.node(0, 0),)),
        card("NSET, NSET=FRONT", (plate.node(2 * plate.nx, 0),)),
        card("NSET, NSET=PIN_FRONT", (bolt.node(2 * bolt.nx, 0),)),
        card("NODE, NSET=CENTRE", (100_000, 0.0, 0.0)),
        card("KINEMATIC COUPLING, REF NODE=CENTRE", ("CORE", 1, 2)),
        elastic(70e3, 0.3, 1.0, "SHEET"),
        material("STEEL", 210e3, 0.3, 1.0),
        card("SOLID SECTION, ELSET=PIN, MATERIAL=STEEL", (1.0,)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "BORE")),
        card("BOUNDARY", ("AXIS", 2, 2), ("EDGE", 1, 2), ("CENTRE", 2, 2), ("CENTRE", 6, 6)),
        static(card("CLOAD", ("CENTRE", 1, force)), prints("A", "FRONT", "PIN_FRONT", "CENTRE"), dt=1.0 / steps),
    ]
    write_deck(folder, "pin.inp", cards)
