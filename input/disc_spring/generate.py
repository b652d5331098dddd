"""Writes the decks of a disc spring pressed flat and let go: `generate.py [-o FOLDER]`."""

import sys
from math import log, pi
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, write_to_folder  # noqa: E402

OUTSIDE, INSIDE, THICKNESS, HEIGHT = 100.0, 51.0, 5.0, 2.8
"""Diameters, thickness and height of the cone of the unloaded spring."""
YOUNG, POISSON, DENSITY = 206000.0, 0.3, 7.85e-9
"""Steel in N, mm, s."""
LONG, ACROSS, INCREMENTS = 16, 3, 15
"""Elements along and across the section, and increments of each step."""
PRESSED = 0.75 * HEIGHT
"""How far the plate goes down."""
FRICTION = {"disc_spring_mu00": 0.0, "disc_spring_mu014": 0.14}

INCLUDE = "disc_spring.inc"


def formula(s: float) -> float:
    """Force at the compression s after Almen and Laszlo (1936), as in DIN EN 16984, without friction."""
    ratio = OUTSIDE / INSIDE
    k = ((ratio - 1.0) / ratio) ** 2 / ((ratio + 1.0) / (ratio - 1.0) - 2.0 / log(ratio)) / pi
    factor = 4.0 * YOUNG / (1.0 - POISSON**2) * THICKNESS**3 * s / (k * OUTSIDE**2)
    cone, way = HEIGHT / THICKNESS, s / THICKNESS
    return factor * ((cone - way) * (cone - 0.5 * way) + 1.0)


def section() -> str:
    """Nodes and elements of the section, its upper edge inside, its lower one outside."""
    index: dict[tuple[int, int], int] = {}
    for j in range(2 * ACROSS + 1):
        for i in range(2 * LONG + 1):
            if i % 2 == 0 or j % 2 == 0:
                index[i, j] = len(index) + 1

    def place(i: int, j: int) -> tuple[float, float]:
        part = i / (2 * LONG)
        return (INSIDE + (OUTSIDE - INSIDE) * part) / 2.0, HEIGHT * (1.0 - part) + THICKNESS * j / (2 * ACROSS)

    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    corners = [(2 * i, 2 * j) for j in range(ACROSS) for i in range(LONG)]
    elements = [
        (number, *(index[i + p, j + q] for p, q in around))
        for number, (i, j) in enumerate(corners, 1)
    ]
    nodes = [(number, *place(i, j)) for (i, j), number in index.items()]
    return card("NODE", *nodes) + card("ELEMENT, TYPE=CAX8R, ELSET=DISC", *elements)


def model() -> str:
    """The spring and its plates."""
    return "".join(
        [
            "** Written by generate.py; N, mm, s.\n",
            section(),
            card("NODE, NSET=FLOOR", (9001, 0.0, 0.0)),
            card("NODE, NSET=PLATE", (9002, 0.0, HEIGHT + THICKNESS)),
            card("SURFACE, NAME=SKIN", ("DISC",)),
            card(
                "SURFACE, NAME=BELOW, TYPE=SEGMENTS",
                ("START", 0.0, 0.0),
                ("LINE", OUTSIDE, 0.0),
            ),
            card(
                "SURFACE, NAME=ABOVE, TYPE=SEGMENTS",
                ("START", OUTSIDE, HEIGHT + THICKNESS),
                ("LINE", 0.0, HEIGHT + THICKNESS),
            ),
            card("RIGID BODY, ANALYTICAL SURFACE=BELOW, REF NODE=9001"),
            card("RIGID BODY, ANALYTICAL SURFACE=ABOVE, REF NODE=9002"),
            card("MATERIAL, NAME=STEEL"),
            card("ELASTIC", (YOUNG, POISSON)),
            card("DENSITY", (DENSITY,)),
            card("SOLID SECTION, ELSET=DISC, MATERIAL=STEEL"),
        ]
    )


def problem(friction: float) -> str:
    """A deck: heading, include, friction, the way down and the way up."""
    steps = [
        card("STEP, NLGEOM, INC=1000")
        + card("STATIC, DIRECT", (1.0 / INCREMENTS, 1.0))
        + card("BOUNDARY", ("PLATE", 2, 2, motion))
        + card("NODE PRINT, NSET=PLATE", ("U, RF",))
        + card("END STEP")
        for motion in (-PRESSED, -0.05 * PRESSED)
    ]
    return "".join(
        [
            card("HEADING", (f"a disc spring pressed and let go, friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "BELOW"), ("SKIN", "ABOVE")),
            card("BOUNDARY", ("FLOOR", 1, 6), ("PLATE", 1, 1), ("PLATE", 6, 6)),
            *steps,
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, friction in FRICTION.items():
        (folder / f"{name}.inp").write_text(problem(friction))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
