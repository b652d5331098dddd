"""Writes the deck of the discs that fall into a box: `generate.py [-o FOLDER]`."""

import sys
from math import pi
from pathlib import Path
from random import Random

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, GridMesh, card, disc, dry, elastic, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 4000.0, 0.3, 1.0, 1.0
GRAVITY, FRICTION = 10.0, 0.3
RADIUS, SPREAD = 0.5, 0.08
"""Mean radius of the discs and the largest deviation, as a part of it."""
COLUMNS, ROWS = 4, 8
SIDE, RINGS = 5, 1
"""Elements along the square in a disc (4 SIDE nodes on the rim) and rings around it."""
WIDTH, HEIGHT, WALL = 4.7, 7.2, 0.4
"""The box inside, and the thickness of its walls."""
PITCH, SHIFT = 1.145, 0.03
"""Distance of the discs at the start, and how far each may be displaced along and up."""
EDGE = 0.4
"""About the length of the walls' elements."""
DT, INCREMENTS = 0.002, 2000
SEED = 1


def box() -> list[Grid]:
    """Floor and two walls, apart from each other by a small gap."""
    gap = 0.01
    across = round((WIDTH + 2 * (gap + WALL)) / EDGE)
    up = round(HEIGHT / EDGE)
    half = 0.5 * WIDTH
    outer = half + gap + WALL
    floor = Grid("FLOOR", across, 1, lambda i, j: (outer * (2 * i / across - 1), (j - 1) * WALL))
    left = Grid(
        "LEFT",
        1,
        up,
        lambda i, j: (-half + (i - 1) * WALL, gap + HEIGHT * j / up),
        floor.next_node,
        floor.next_element,
    )
    right = Grid(
        "RIGHT",
        1,
        up,
        lambda i, j: (half + i * WALL, gap + HEIGHT * j / up),
        left.next_node,
        left.next_element,
    )
    return [floor, left, right]


def discs(after: Grid) -> list[GridMesh]:
    """Discs of slightly different sizes on a grid, each displaced and turned by chance."""
    chance = Random(SEED)
    bodies: list[GridMesh] = []
    first = after.next_node, after.next_element
    for row in range(ROWS):
        for column in range(COLUMNS):
            radius = RADIUS * (1 + SPREAD * chance.uniform(-1, 1))
            shift = [SHIFT * chance.uniform(-1, 1) for _ in range(2)]
            x = PITCH * (column - 0.5 * (COLUMNS - 1)) + shift[0]
            y = PITCH * (row + 0.5) + shift[1]
            turn = chance.uniform(0, 0.5 * pi)
            name = f"DISC{len(bodies) + 1:02}"
            bodies.append(disc(name, (x, y), radius, turn, SIDE, RINGS, *first))
            first = bodies[-1].next_node, bodies[-1].next_element
    return bodies


def deck() -> str:
    """The whole deck."""
    walls = box()
    bodies = discs(walls[-1])
    first, last = walls[-1].next_element, bodies[-1].next_element - 1
    return "".join(
        [
            card("HEADING", (f"{len(bodies)} discs fall into a box; friction {FRICTION}",)),
            "** Written by generate.py; any consistent units.\n",
            *(wall.mesh("CPE4") for wall in walls),
            *(body.mesh("CPE4") for body in bodies),
            card("NSET, NSET=BOX", [wall.name for wall in walls]),
            card("ELSET, ELSET=BOX", [wall.name for wall in walls]),
            card("ELSET, ELSET=DISCS, GENERATE", (first, last, 1)),
            elastic(YOUNG, POISSON, DENSITY, "BOX", "DISCS", thickness=THICKNESS),
            dry(FRICTION),
            "** Every body against every other, and against itself.\n",
            card("CONTACT"),
            card("CONTACT INCLUSIONS, ALL EXTERIOR"),
            card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
            card("BOUNDARY", ("BOX", 1, 2)),
            step(
                DT,
                INCREMENTS,
                card("DLOAD", ("DISCS", "GRAV", GRAVITY, 0.0, -1.0)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=200"),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the deck into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "disc_pile.inp").write_text(deck())


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
