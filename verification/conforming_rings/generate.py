"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, mapped, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

OUTER, MIDDLE, INNER = 1.0, 0.6, 0.2
YOUNG, POISSON, LOAD = 1e9, 0.2, 1e3


def ring(name: str, kind: str, radii: tuple[float, float], around: int, through: int, after: Block | None = None) -> Block:
    """A quarter of a ring: `bottom` is its inner side, `left` lies on y, `right` on x."""
    inner, outer = radii
    angles = [pi / 2 * (1 - k / around) for k in range(around + 1)]
    radial = [inner + (outer - inner) * k / through for k in range(through + 1)]
    return mapped(name, kind, angles, radial, lambda a, r: (r * cos(a), r * sin(a)), after)


def write(
    folder: Path,
    n: int,
    ratio: float = 1.0,
    waves: float = 0.0,
    kind: str = "CPS4",
    swap: int = 0,
    curved: int = 0,
    means: int = 0,
) -> None:
    """`n` elements around a quarter of the outer ring, `ratio` times as many around the inner one; p1 = `waves` p0.

    `curved`: faces that bend between their nodes, none of which has to be moved; `means`: from surface to surface.
    """
    inside = round(ratio * n)
    outer = ring("OUTER", kind, (MIDDLE, OUTER), n, max(n // 4, 1))
    inner = ring("INNER", kind, (INNER, MIDDLE), inside, max(inside // 4, 1), outer)
    loads = []
    for k in range(n):
        angle = pi / 2 * (1 - (k + 0.5) / n)
        half = pi / 4 / n
        mean = cos(2 * angle) * sin(2 * half) / (2 * half)
        element = outer.first_element + k + n * (outer.ny - 1)
        loads.append((element, "P3", LOAD * (1 + waves * mean)))
    pair = ("RIM", "BORE") if swap else ("BORE", "RIM")
    formulation = ", TYPE=SURFACE TO SURFACE" if means else ""
    formulation += "" if curved else ", GEOMETRIC CORRECTION=NONE, ADJUST=0.01"
    cards = [
        card("HEADING", ("two rings, one in the other",)),
        outer.cards(),
        inner.cards(),
        outer.surface("BORE", "bottom"),
        inner.surface("RIM", "top"),
        outer.nset("FACE", "bottom") if not swap else inner.nset("FACE", "top"),
        *(ring.nset("ON_X", "right") + ring.nset("ON_Y", "left") for ring in (outer, inner)),
        elastic(YOUNG, POISSON, 1.0, "OUTER", "INNER"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY" + formulation, pair),
        card("BOUNDARY", ("ON_X", 2, 2), ("ON_Y", 1, 1)),
        static(card("DLOAD", *loads), dt=0.5, direct=True),
    ]
    write_deck(folder, "rings.inp", cards)
