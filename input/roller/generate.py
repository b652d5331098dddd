"""Writes the decks of the roller that is pressed and rolled over a soft block: `generate.py [-o FOLDER]`."""

import sys
from math import pi
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, material, ring, write_to_folder  # noqa: E402

RUBBER, STEEL = (100.0, 0.49), (1e6, 0.3)
"""Young's modulus and Poisson's ratio of the block and of the roller."""
MODULUS = 1 / sum((1 - nu**2) / young for young, nu in (RUBBER, STEEL))
"""Of both in contact, in plane strain."""
DENSITY = 1.0
RADIUS, BORE = 1.0, 0.75
AROUND, ACROSS = 360, 2
"""Of the roller, a ring whose bore turns with its axis; elements around and across."""
HALF_WIDTH = 0.1
"""Of Hertz' contact."""
PRESS = pi / 4 * MODULUS * HALF_WIDTH**2 / RADIUS
"""Load of Hertz' contact."""
FRICTION = 0.4
PULL = {"roller_free": 0.0, "roller_braked": 0.75}
"""Force against the motion, as a part of the largest that friction holds."""
TURN, RISE = 1.0, 0.2
"""Angle in radians; part of the turn in which the pull grows."""
PRESSING, ROLLING = 10, 100
"""Increments."""

LENGTH, DEPTH = 3.0, 1.5
START = 1.0
"""Of the block, and where on it the roller is pressed."""
EVEN = START - 2 * HALF_WIDTH, START + TURN * RADIUS + 2 * HALF_WIDTH
"""Where the elements along the surface are equally long."""
SIZE, GROWTH = HALF_WIDTH / 6, 1.3
"""Their length; beside and below them the elements grow."""

INCLUDE = "roller.inc"


def graded(start: float, end: float) -> list[float]:
    """Places after `start` up to `end`, farther and farther apart."""
    steps = [SIZE]
    while sum(steps) < abs(end - start):
        steps.append(GROWTH * steps[-1])
    part = (end - start) / sum(steps)
    return [start + part * sum(steps[: k + 1]) for k in range(len(steps))]


def block() -> Grid:
    """The soft block, its upper side at y = 0."""
    even = round((EVEN[1] - EVEN[0]) / SIZE)
    middle = [EVEN[0] + (EVEN[1] - EVEN[0]) * k / even for k in range(even + 1)]
    along = [*graded(EVEN[0], 0.0)[::-1], *middle, *graded(EVEN[1], LENGTH)]
    down = [*graded(0.0, -DEPTH)[::-1], 0.0]
    return Grid("BLOCK", len(along) - 1, len(down) - 1, lambda i, j: (along[i], down[j]))


def model() -> str:
    """Everything but the steps."""
    soft = block()
    centre = START, RADIUS
    labels = soft.next_node, soft.next_element
    roller = ring("ROLLER", centre, (BORE, RADIUS), AROUND, ACROSS, *labels)
    axis = roller.next_node
    inner, outer = roller.first_element, roller.next_element - AROUND
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            soft.mesh("CPE4"),
            soft.side_nodes("BASE", "bottom"),
            soft.side_surface("ROAD", "top"),
            roller.mesh("CPE4"),
            card("ELSET, ELSET=INNER, GENERATE", (inner, inner + AROUND - 1, 1)),
            card("ELSET, ELSET=OUTER, GENERATE", (outer, outer + AROUND - 1, 1)),
            card("SURFACE, NAME=BORE", ("INNER", "S4")),
            card("SURFACE, NAME=TREAD", ("OUTER", "S2")),
            card("NODE, NSET=AXIS", (axis, *centre)),
            card(f"COUPLING, CONSTRAINT NAME=HUB, REF NODE={axis}, SURFACE=BORE"),
            card("KINEMATIC"),
            material("RUBBER", *RUBBER, DENSITY),
            card("SOLID SECTION, ELSET=BLOCK, MATERIAL=RUBBER, FORMULATION=MEAN DILATATION", (1.0,)),
            material("STEEL", *STEEL, DENSITY),
            card("SOLID SECTION, ELSET=ROLLER, MATERIAL=STEEL", (1.0,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("ROAD", "TREAD")),
            card("AMPLITUDE, NAME=BRAKE", (0.0, 0.0, RISE, 1.0)),
            card("BOUNDARY", ("BASE", 1, 2)),
        ]
    )


def static(increments: int, *cards: str) -> str:
    """A static step of the duration 1 with equal increments."""
    head = card("STEP, NLGEOM") + card("STATIC, DIRECT", (1.0 / increments, 1.0))
    return "".join([head, *cards, card("END STEP")])


def problem(pull: float) -> str:
    """A deck: heading, include, steps."""
    brake = card("CLOAD, AMPLITUDE=BRAKE", ("AXIS", 1, -pull * FRICTION * PRESS))
    return "".join(
        [
            card("HEADING", (f"roller pressed and rolled over a soft block; pulled back by {pull!r} mu P",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            static(
                PRESSING,
                card("BOUNDARY", ("AXIS", 6)),
                card("CLOAD", ("AXIS", 2, -PRESS)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=1"),
            ),
            static(
                ROLLING,
                card("BOUNDARY", ("AXIS", 6, 6, -TURN)),
                brake if pull > 0.0 else "",
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
                card("NODE PRINT, NSET=AXIS", ("U", "RF")),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, pull in PULL.items():
        (folder / f"{name}.inp").write_text(problem(pull))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
