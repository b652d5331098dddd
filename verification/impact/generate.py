"""Writes the decks of bodies that bounce without friction: `generate.py [-o FOLDER]`."""

import sys
from math import ceil, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, GridMesh, card, disc, dry, elastic, outline, ring, step, write_to_folder  # noqa: E402

DECKS = ("box", "bar", "rings")

# Two discs in a box with rigid walls.
BOX_YOUNG, BOX_DT, BOX_TIME = 1e4, 0.002, 8.0
HALF = 1.3
RADIUS = 0.5
SIDE, RINGS = 8, 2
DISCS = (((-0.7, 0.1), (2.0, 1.3)), ((0.6, -0.2), (-1.1, 0.7)))
"""Centres and velocities."""

# A bar on a fixed wall.
YOUNG, LENGTH, DEPTH = 1000.0, 10.0, 1.0
ELEMENTS = 50
SPEED, GAP = 0.03, 0.001555
WAVE_SPEED = sqrt(YOUNG)
BAR_TIME = GAP / SPEED + 1.5 * 2 * LENGTH / WAVE_SPEED
"""One and a half contact times after the landing."""

# Two rings that fly past each other.
RING_YOUNG, RING_DT, RING_TIME = 1000.0, 0.005, 4.0
RADII = 0.8, 1.0
OFFSET, RING_SPEED, SPIN = 0.7, 0.8, 0.5


def edge(deck: str) -> float:
    """About the length of the shortest edge of a deck's mesh."""
    return {"box": 0.07, "bar": LENGTH / ELEMENTS, "rings": 0.08}[deck]


def box(settings: str, around: int) -> str:
    """Two frictionless discs in a box; `around` times as fine."""
    bodies: list[GridMesh] = []
    for name, (centre, _) in zip("AB", DISCS):
        first = (bodies[0].next_node, bodies[0].next_element) if bodies else (1, 1)
        bodies.append(disc(name, centre, RADIUS, 0.0, SIDE * around, RINGS * around, *first))
    corner = bodies[1].next_node
    walls = [("START", HALF, -HALF)]
    walls += [("LINE", x, y) for x, y in ((HALF, HALF), (-HALF, HALF), (-HALF, -HALF))]
    pairs = (("A", "BOX"), ("B", "BOX"), ("A", "B"), ("B", "A"))
    speeds = [("AB"[k], i + 1, v[i]) for k, (_, v) in enumerate(DISCS) for i in range(2)]
    return "".join(
        [
            card("HEADING", ("two frictionless discs in a box",)),
            *(body.mesh("CPE4") for body in bodies),
            card("NODE", (corner, HALF, -HALF)),
            outline("A", "B"),
            card("SURFACE, TYPE=SEGMENTS, NAME=BOX", *walls, ("LINE", HALF, -HALF)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=BOX, REF NODE={corner}"),
            elastic(BOX_YOUNG, 0.3, 1.0, "A", "B"),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", *pairs),
            card("BOUNDARY", (corner, 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
            one_step(BOX_DT / around, BOX_TIME, settings),
        ]
    )


def bar(settings: str, courant: float, beta: float) -> str:
    """A bar on a wall; increment and viscosity `beta` in transit times h/c of an element."""
    bar = Grid("BAR", ELEMENTS, 1, lambda i, j: (LENGTH * i / ELEMENTS, DEPTH * j))
    labels = bar.next_node, bar.next_element
    wall = Grid("WALL", 1, 1, lambda i, j: (i - 1.0 - GAP, (2 * j - 0.5) * DEPTH), *labels)
    transit = LENGTH / ELEMENTS / WAVE_SPEED
    return "".join(
        [
            card("HEADING", (f"elastic bar on a wall, Courant number {courant}",)),
            bar.mesh("CPS4"),
            wall.mesh("CPS4"),
            bar.side_nodes("FACE", "left"),
            bar.side_surface("FACE", "left"),
            wall.side_surface("WALL_FACE", "right"),
            elastic(YOUNG, 0.0, 1.0, "BAR", "WALL", beta=beta * transit),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "WALL_FACE")),
            card("BOUNDARY", ("WALL", 1, 2), ("BAR", 2, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BAR", 1, -SPEED)),
            one_step(courant * transit, BAR_TIME, settings),
        ]
    )


def rings(settings: str, around: int, across: int) -> str:
    """Two frictionless rings, one of them spinning, without supports."""
    apart = (4 * RADII[1] ** 2 - OFFSET**2) ** 0.5 + 0.1
    centre = -0.5 * apart, -0.5 * OFFSET
    left = ring("LEFT", centre, RADII, around, across)
    labels = left.next_node, left.next_element
    right = ring("RIGHT", (-centre[0], -centre[1]), RADII, around, across, *labels)
    spinning = []
    for k, (x, y) in enumerate(left.nodes):
        spinning.append((left.first_node + k, 1, RING_SPEED - SPIN * (y - centre[1])))
        spinning.append((left.first_node + k, 2, SPIN * (x - centre[0])))
    return "".join(
        [
            card("HEADING", ("two frictionless rings thrown at each other",)),
            left.mesh("CPE4"),
            right.mesh("CPE4"),
            outline("LEFT", "RIGHT"),
            elastic(RING_YOUNG, 0.3, 1.0, "LEFT", "RIGHT"),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", ("LEFT", "RIGHT"), ("RIGHT", "LEFT")),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *spinning, ("RIGHT", 1, -RING_SPEED)),
            one_step(RING_DT, RING_TIME, settings),
        ]
    )


def one_step(dt: float, time: float, settings: str) -> str:
    """The step of a deck with the parameters of its *STICKSLIP."""
    cards = [card(f"STICKSLIP, {settings}")] if settings else []
    return step(dt, ceil(time / dt - 1e-9), *cards, card("OUTPUT, FIELD, NUMBER INTERVAL=20"))


def write(
    folder: Path,
    settings: str = "",
    refine: int = 1,
    courant: float = 1.0,
    beta: float = 0.0,
    around: int = 60,
    across: int = 2,
) -> None:
    """Writes all decks into `folder`: `refine` that of the box, `courant` and `beta` that of the bar,
    `around` and `across` the elements of the rings."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "box.inp").write_text(box(settings, refine))
    (folder / "bar.inp").write_text(bar(settings, courant, beta))
    (folder / "rings.inp").write_text(rings(settings, around, across))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
