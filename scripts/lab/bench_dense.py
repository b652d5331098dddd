"""Decks of dense contact: walls, lattices of discs, arches, many pairs between two bodies."""

from collections.abc import Callable, Sequence
from math import cos, pi, sin

from stickslip.decks import Grid, GridMesh, card, disc, dry, elastic, outline, step

Place = Callable[[int, int], tuple[float, float]]

GENERAL = (
    card("CONTACT")
    + card("CONTACT INCLUSIONS, ALL EXTERIOR")
    + card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY"))
)
"""All outer faces are slaves and masters."""

BRICK, GAP = (0.2, 0.1), 1e-5
"""Size of a brick, and what it begins above that below."""

PERIOD = 0.1
"""Period of the shaking."""

PITCH = 0.202
"""Distance of bricks of a course: they do not touch at their sides."""


def at(left: float, bottom: float, width: float, height: float) -> Place:
    """Places of nodes of a grid with elements of the given size."""
    return lambda i, j: (left + i * width, bottom + j * height)


def cards(
    title: str,
    held: Sequence[Grid],
    moving: Sequence[Grid | GridMesh],
    contact: str,
    run: tuple[float, int],
    friction: float = 0.6,
    shaking: float = 0.0,
    speeds: Sequence[float] = (),
) -> str:
    """A deck of elastic bodies that gravity presses on held ones. `shaking`: the largest acceleration of the ground
    to and fro, which is a load in its frame. `speeds`: with which the bodies fall at the start."""
    last = moving[-1].next_element - 1
    names = [part.name for part in held]
    loads = card("DLOAD", ("MOVING", "GRAV", 10.0, 0.0, -1.0))
    sine = ""
    if shaking:
        omega = 2.0 * pi / PERIOD
        sine = card("AMPLITUDE, NAME=SHAKING, DEFINITION=PERIODIC", (1, omega, 0.0, 0.0), (0.0, 1.0))
        loads += card("DLOAD, AMPLITUDE=SHAKING", ("MOVING", "GRAV", shaking, 1.0, 0.0))
    falling = [(part.name, 2, -speed) for part, speed in zip(moving, speeds)]
    thrown = card("INITIAL CONDITIONS, TYPE=VELOCITY", *falling) if falling else ""
    dt, increments = run
    return "".join(
        [
            card("HEADING", (title,)),
            *(part.mesh("CPE4") for part in (*held, *moving)),
            card("ELSET, ELSET=MOVING, GENERATE", (moving[0].first_element, last, 1)),
            elastic(1e6, 0.2, 1.0, *names, "MOVING"),
            dry(friction),
            contact,
            card("BOUNDARY", *((name, 1, 2) for name in names)),
            sine,
            thrown,
            step(dt, increments, loads),
        ]
    )


def wall(
    courses: int, bricks: int, sides: int, increments: int = 10, shaking: float = 0.0
) -> str:
    """Bricks in running bond on a held floor: slaves are all faces, or the upper ones."""
    width = bricks * PITCH + BRICK[0]
    segments = max(8, int(width / 0.1125))
    floor = Grid("FLOOR", segments, 1, at(-0.1, -0.1, width / segments, 0.1))
    parts: list[Grid] = []
    labels = floor.next_node, floor.next_element
    for course in range(courses):
        for column in range(bricks):
            left = PITCH * column + (0.1 if course % 2 else 0.0)
            bottom = course * (BRICK[1] + GAP) + GAP
            name = f"B{course}_{column}"
            parts.append(Grid(name, 4, 2, at(left, bottom, 0.05, 0.05), *labels))
            labels = parts[-1].next_node, parts[-1].next_element
    contact = GENERAL if sides == 2 else one_sided(courses, bricks, parts)
    return cards("wall of bricks", [floor], parts, contact, (1e-3, increments), shaking=shaking)


def one_sided(courses: int, bricks: int, parts: Sequence[Grid]) -> str:
    """Contact pairs: of every brick with those below it, and with that on its left."""
    pairs = [(f"B0_{column}", "FLOOR") for column in range(bricks)]
    for course in range(1, courses):
        for column in range(bricks):
            below = (column, column + 1) if course % 2 else (column - 1, column)
            pairs += [
                (f"B{course}_{column}", f"B{course - 1}_{other}")
                for other in below
                if 0 <= other < bricks
            ]
    pairs += [(f"B{i}_{j}", f"B{i}_{j - 1}") for i in range(courses) for j in range(1, bricks)]
    names = ["FLOOR", *(part.name for part in parts)]
    return outline(*names) + card("CONTACT PAIR, INTERACTION=DRY", *pairs)


def lattice(columns: int, rows: int, increments: int) -> str:
    """Discs of 16 sides in a square lattice between held walls, flat side to flat side."""
    radius, side = 0.1, 4
    apothem = radius * cos(pi / (4 * side))
    pitch, height = 2 * apothem, 2 * apothem * rows
    width, left = pitch * columns, -apothem
    floor = Grid("FLOOR", 2 * columns, 1, at(left, -0.1, width / (2 * columns), 0.1))
    labels = floor.next_node, floor.next_element
    element = height / (2 * rows)
    near = Grid("NEAR", 1, 2 * rows, at(left - GAP - 0.1, 0.0, 0.1, element), *labels)
    labels = near.next_node, near.next_element
    far = Grid("FAR", 1, 2 * rows, at(left + width + GAP, 0.0, 0.1, element), *labels)
    labels = far.next_node, far.next_element
    discs: list[GridMesh] = []
    for row in range(rows):
        for column in range(columns):
            centre = pitch * column, apothem + row * pitch + (row + 1) * GAP
            turn = pi / (4 * side)
            discs.append(disc(f"D{row}_{column}", centre, radius, turn, side, 2, *labels))
            labels = discs[-1].next_node, discs[-1].next_element
    run = 1e-3, increments
    return cards("lattice of discs", [floor, near, far], discs, GENERAL, run, friction=0.3)


def thrown(columns: int, rows: int, increments: int = 10) -> str:
    """Octagons side by side that fall on a floor, the upper rows faster, by ten times the gaps between them in an increment: flat
    sides all over the lattice close at once."""
    radius, gap, speed = 0.1, 4e-5, 10.0
    apothem = radius * cos(pi / 8)
    pitch = 2 * apothem + gap
    floor = Grid("FLOOR", columns + 1, 1, at(-pitch, -0.1, pitch, 0.1))
    labels = floor.next_node, floor.next_element
    discs: list[GridMesh] = []
    speeds = []
    for row in range(rows):
        for column in range(columns):
            centre = pitch * column, gap + apothem + row * pitch
            discs.append(disc(f"D{row}_{column}", centre, radius, pi / 8, 2, 1, *labels))
            labels = discs[-1].next_node, discs[-1].next_element
            speeds.append(speed * (row + 1) / rows)
    run = 10 * gap / speed, increments
    return cards("lattice of octagons", [floor], discs, GENERAL, run, friction=0.25, speeds=speeds)


def arch(stones: int) -> str:
    """A half ring of stones on two held abutments, flush with each other."""
    inner, outer = 1.0, 1.2

    def stone(first: float, last: float) -> Place:
        def place(i: int, j: int) -> tuple[float, float]:
            angle = first + (last - first) * i / 4
            radius = outer + (inner - outer) * j / 4
            return radius * cos(angle), radius * sin(angle)

        return place

    parts: list[Grid] = []
    joint = 1e-5
    left = Grid("LEFT", 4, 2, at(-1.25, -0.2, 0.075, 0.1))
    right = Grid("RIGHT", 4, 2, at(0.95, -0.2, 0.075, 0.1), left.next_node, left.next_element)
    labels = right.next_node, right.next_element
    for k in range(stones):
        first, last = (pi * end / stones for end in (k, k + 1))
        parts.append(Grid(f"S{k}", 4, 4, stone(first + joint, last - joint), *labels))
        labels = parts[-1].next_node, parts[-1].next_element
    return cards(f"arch of {stones} stones", [left, right], parts, GENERAL, (1e-3, 10))


def long_block(pairs: int) -> str:
    """A block that lies on a held strip with so many pairs, its nodes amid the segments."""
    size = 0.01
    strip = Grid("STRIP", pairs + 20, 4, at(0.0, -4 * size, size, size))
    labels = strip.next_node, strip.next_element
    block = Grid("BLOCK", pairs - 1, 4, at(10.5 * size, 1e-5 * size, size, size), *labels)
    return "".join(
        [
            card("HEADING", (f"a block on a strip; {pairs} pairs",)),
            strip.mesh("CPE4"),
            block.mesh("CPE4"),
            strip.side_nodes("STRIP_BASE", "bottom"),
            strip.side_surface("ROAD", "top"),
            block.side_surface("SOLE", "bottom"),
            elastic(1e4, 0.3, 1.0, "STRIP", "BLOCK"),
            dry(0.3),
            card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "ROAD")),
            card("BOUNDARY", ("STRIP_BASE", 1, 2)),
            step(0.001, 20, card("DLOAD", ("BLOCK", "GRAV", 10.0, 0.0, -1.0))),
        ]
    )
