"""Writes the decks of the fast bullet that hits a thin plate: `generate.py [-o FOLDER]`."""

import sys
from math import cos, radians, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, outline, write_to_folder  # noqa: E402

YOUNG, POISSON, THICKNESS = 1e4, 0.3, 1.0
DENSITY = {"PLATE": 1.0, "BULLET": 0.2}
LENGTH, EDGE = 4.0, 0.1
LAYERS = {"one": 1, "two": 2}
"""Elements through the plate."""
SIDE = 3
"""Elements along a side of the bullet."""
TURN = radians(10.0)
START = -0.23, 2.87
"""Centre of the bullet above the plate's middle."""
SPEED = 30.0
FLIGHT = 3, 10 * EDGE / SPEED
"""Increments of the first step: the bullet flies ten element edges in each and hits in the last."""
REBOUND = 300, 0.2 * EDGE / SPEED
"""Increments of the second step, short enough for the waves in the plate."""


def material(name: str) -> str:
    """Cards of a body's material."""
    return "".join(
        [
            card(f"MATERIAL, NAME={name}"),
            card("ELASTIC", (YOUNG, POISSON)),
            card("DENSITY", (DENSITY[name],)),
            card(f"SOLID SECTION, ELSET={name}, MATERIAL={name}", (THICKNESS,)),
        ]
    )


def model(layers: int) -> str:
    """Everything but the friction and the step."""
    along = round(LENGTH / EDGE)
    plate = Grid("PLATE", along, layers, lambda i, j: ((i - along / 2) * EDGE, (j - layers) * EDGE))

    def place(i: int, j: int) -> tuple[float, float]:
        x, y = (i - SIDE / 2) * EDGE, (j - SIDE / 2) * EDGE
        turned = x * cos(TURN) - y * sin(TURN), x * sin(TURN) + y * cos(TURN)
        return START[0] + turned[0], START[1] + turned[1]

    bullet = Grid("BULLET", SIDE, SIDE, place, plate.next_node, plate.next_element)
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            plate.mesh("CPE4"),
            bullet.mesh("CPE4"),
            plate.side_nodes("LEFT_END", "left"),
            plate.side_nodes("RIGHT_END", "right"),
            outline("PLATE", "BULLET"),
            *(material(name) for name in DENSITY),
            card("CONTACT PAIR, INTERACTION=DRY", ("BULLET", "PLATE"), ("PLATE", "BULLET")),
            card("BOUNDARY", ("LEFT_END", 1, 2), ("RIGHT_END", 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BULLET", 2, -SPEED)),
        ]
    )


def problem(layers: str) -> str:
    """A deck: heading, include, friction, step."""
    return "".join(
        [
            card("HEADING", (f"fast bullet on a plate, elements through it: {layers}",)),
            card(f"INCLUDE, INPUT={layers}.inc"),
            card("SURFACE INTERACTION, NAME=DRY"),
            card("FRICTION", (0.2,)),
            *(
                card(f"STEP, NLGEOM, INC={count}")
                + card("DYNAMIC, DIRECT", (dt, count * dt))
                + card(f"OUTPUT, FIELD, FREQUENCY={every}")
                + card("END STEP")
                for (count, dt), every in ((FLIGHT, 1), (REBOUND, 2))
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include files and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, layers in LAYERS.items():
        (folder / f"{name}.inc").write_text(model(layers))
        (folder / f"bullet_{name}.inp").write_text(problem(name))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
