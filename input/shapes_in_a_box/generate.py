"""Writes the decks of the shapes that are thrown about in a box: `generate.py [-o FOLDER]`."""

import sys
from math import cos, hypot, pi, sin
from pathlib import Path
from random import Random

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, GridMesh, card, elastic, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 6000.0, 0.3, 1.0, 1.0
GRAVITY, SPEED = 9.81, 3.0
"""Largest velocity of a shape at the start, along and up."""
SHAPES = {
    "bar": ["######"],
    "L": ["#..", "#..", "###"],
    "T": ["#####", ".#..."],
    "U": ["#..#", "#..#", "####"],
    "plus": [".#.", "###", ".#."],
    "block": ["##", "##"],
    "square": ["#"],
}
"""Cells of the shapes, from above."""
CELLS = (0.25, 0.3, 0.4)
"""Sides of the cells."""
SIZE = 1.8
"""No shape has a longer diagonal."""
COLUMNS, ROWS, PITCH = 4, 3, 2.6
MARGIN, WALL, EDGE = 0.1, 0.3, 0.9
"""Gap between the outermost shapes and the walls; thickness of the walls; their elements."""
FRICTION = {"one": 0.2, "two": 0.6, "three": 0.0, "four": 0.2, "five": 0.0, "six": 0.6}
"""Friction of every deck; the index of a deck in this list is the seed of its random numbers."""
DT, INCREMENTS = 0.004, 400


def box() -> list[Grid]:
    """Four walls, apart from each other by a small gap."""
    half, height, gap = 0.5 * COLUMNS * PITCH + MARGIN, ROWS * PITCH + MARGIN, 0.001
    outer = half + WALL
    across, up = round(2 * outer / EDGE), round(height / EDGE)
    along = [outer * (2 * i / across - 1) for i in range(across + 1)]
    upright = [gap + (height - 2 * gap) * j / up for j in range(up + 1)]
    places = {
        "FLOOR": (across, 1, lambda i, j: (along[i], (j - 1) * WALL)),
        "LID": (across, 1, lambda i, j: (along[i], height + j * WALL)),
        "LEFT": (1, up, lambda i, j: (-half + (i - 1) * WALL, upright[j])),
        "RIGHT": (1, up, lambda i, j: (half + i * WALL, upright[j])),
    }
    walls: list[Grid] = []
    for name, place in places.items():
        first = (walls[-1].next_node, walls[-1].next_element) if walls else (1, 1)
        walls.append(Grid(name, *place, *first))
    return walls


def shape(chance: Random, name: str, centre: tuple[float, float], after: Grid | GridMesh) -> GridMesh:
    """A shape of some size, turned; its cells are one element or four."""
    rows = chance.choice(list(SHAPES.values()))[::-1]
    parts = chance.choice((1, 2))
    wide, tall = max(map(len, rows)), len(rows)
    edge = min(chance.choice(CELLS), SIZE / hypot(wide, tall)) / parts
    turn = chance.uniform(0, 2 * pi)
    index: dict[tuple[int, int], int] = {}

    def node(i: int, j: int) -> int:
        return index.setdefault((i, j), len(index))

    elements = [
        (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
        for row, cells in enumerate(rows)
        for column, cell in enumerate(cells)
        if cell == "#"
        for j in range(row * parts, (row + 1) * parts)
        for i in range(column * parts, (column + 1) * parts)
    ]
    flat = [(edge * (i - 0.5 * wide * parts), edge * (j - 0.5 * tall * parts)) for i, j in index]
    nodes = [
        (centre[0] + x * cos(turn) - y * sin(turn), centre[1] + x * sin(turn) + y * cos(turn))
        for x, y in flat
    ]
    return GridMesh(name, nodes, elements, after.next_node, after.next_element)


def deck(name: str) -> str:
    """A whole deck."""
    chance = Random(list(FRICTION).index(name) + 1)
    walls = box()
    bodies: list[GridMesh] = []
    for column in range(COLUMNS):
        for row in range(ROWS):
            centre = PITCH * (column - 0.5 * (COLUMNS - 1)), PITCH * (row + 0.5)
            after = bodies[-1] if bodies else walls[-1]
            bodies.append(shape(chance, f"SHAPE{len(bodies) + 1:02}", centre, after))
    thrown = [
        (body.name, direction, chance.uniform(-SPEED, SPEED))
        for body in bodies
        for direction in (1, 2)
    ]
    first, last = walls[-1].next_element, bodies[-1].next_element - 1
    return "".join(
        [
            card("HEADING", (f"{len(bodies)} shapes in a box; friction {FRICTION[name]}",)),
            "** Written by generate.py; any consistent units.\n",
            *(body.mesh("CPE4") for body in [*walls, *bodies]),
            card("NSET, NSET=BOX", [wall.name for wall in walls]),
            card("ELSET, ELSET=BOX", [wall.name for wall in walls]),
            card("ELSET, ELSET=SHAPES, GENERATE", (first, last, 1)),
            elastic(YOUNG, POISSON, DENSITY, "BOX", "SHAPES", thickness=THICKNESS),
            card("SURFACE INTERACTION, NAME=DRY"),
            card("FRICTION", (FRICTION[name],)),
            card("CONTACT"),
            card("CONTACT INCLUSIONS, ALL EXTERIOR"),
            card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
            card("BOUNDARY", ("BOX", 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *thrown),
            step(
                DT,
                INCREMENTS,
                card("DLOAD", ("SHAPES", "GRAV", GRAVITY, 0.0, -1.0)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=200"),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in FRICTION:
        (folder / f"shapes_{name}.inp").write_text(deck(name))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
