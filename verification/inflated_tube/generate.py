"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, prints, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card  # noqa: E402


def write(folder: Path, kind: str, n: int) -> None:
    """A quarter of a tube of radii 1 and 2, whose bore grows to twice its radius; `n` cells across the wall."""

    def place(i: int, j: int) -> tuple[float, float]:
        radius, angle = 1 + i / (2 * n), pi / 2 * j / (4 * n)
        # both ends lie on the axes
        return 0.0 if j == 4 * n else radius * cos(angle), radius * sin(angle)

    wall = Block("WALL", kind, n, 2 * n, place)
    step = 1 if wall.quadratic else 2
    bore = [(wall.node(0, j), *place(0, j)) for j in range(0, 4 * n + 1, step)]
    cards = [
        card("HEADING", ("inflated tube",)),
        wall.cards(),
        wall.nset("BELOW", "bottom"),
        wall.nset("ABOVE", "top"),
        wall.nset("BORE", "left"),
        wall.nset("RIM", "right"),
        card("MATERIAL, NAME=RUBBER"),
        card("HYPERELASTIC, NEO HOOKE", (0.5, 2e-6)),
        card("DENSITY", (1.0,)),
        card("SOLID SECTION, ELSET=WALL, MATERIAL=RUBBER", (1.0,)),
        card("BOUNDARY", ("BELOW", 2, 2), ("ABOVE", 1, 1)),
        static(
            card("BOUNDARY", *((node, d + 1, d + 1, (x, y)[d]) for node, x, y in bore for d in (0, 1))),
            prints("BORE"),
            dt=0.125,
            direct=True,
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tube.inp").write_text("".join(cards))
