"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


def write(folder: Path, kind: str, n: int, poisson: float = 0.3, pressure: float = 1e-4) -> None:
    """A quarter of a cylinder in plane strain, or a slice of a body of revolution; `n` cells across the wall."""

    def place(i: int, j: int) -> tuple[float, float]:
        radius, angle = 3 + 6 * i / (2 * n), pi / 2 * j / (4 * n)
        # both ends lie on the axes
        return 0.0 if j == 4 * n else radius * cos(angle), radius * sin(angle)

    if kind.startswith("CAX"):
        wall = rectangle("WALL", kind, (n, 1), (6.0, 1.0), (3.0, 0.0))
        sides = card("BOUNDARY", ("BELOW", 2, 2), ("ABOVE", 2, 2))
    else:
        wall = Block("WALL", kind, n, 2 * n, place)
        sides = card("BOUNDARY", ("BELOW", 2, 2), ("ABOVE", 1, 1))
    cards = [
        card("HEADING", ("thick cylinder under internal pressure",)),
        wall.cards(),
        wall.nset("BELOW", "bottom"),
        wall.nset("ABOVE", "top"),
        wall.nset("BORE", "left"),
        wall.surface("INSIDE", "left"),
        elastic(1000.0, poisson, 1.0, "WALL"),
        sides,
        static(card("DSLOAD", ("INSIDE", "P", pressure)), prints("BORE")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cylinder.inp").write_text("".join(cards))
