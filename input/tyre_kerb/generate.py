"""Writes the deck of a tyre-like ring that rolls over a kerb: `generate.py [-o FOLDER]`."""

import sys
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, step, write_to_folder  # noqa: E402

RADII = 0.26, 0.3
AROUND = 48
"""Elements around; one layer."""
C10, D1, DENSITY = 5e5, 1e-7, 1100.0
"""Shear modulus 1 MPa, bulk modulus 20 MPa."""
PRESSURE, FILL = 3e4, 0.02
"""Inner pressure, which rises in this time."""
SPEED, GRAVITY = 4.0, 9.81
GAP, STEP = 0.005, 0.05
"""Between the ring and the road; height of the kerb."""
START, KERB, END = -0.6, 0.0, 1.6
FRICTION = 0.8
INCREMENT, INCREMENTS = 5e-4, 700
DAMPING = 2e-4


def model() -> str:
    """Everything but the step."""
    centre = START, RADII[1] + GAP
    nodes, index = [], {}
    for k in range(2 * AROUND):
        for j in range(3):
            if k % 2 and j == 1:
                continue
            radius, angle = RADII[0] + (RADII[1] - RADII[0]) * j / 2, pi * k / AROUND
            index[k, j] = len(nodes) + 1
            nodes.append((len(nodes) + 1, centre[0] + radius * cos(angle), centre[1] + radius * sin(angle)))
    elements = []
    for e in range(AROUND):
        a, b, c = 2 * e, 2 * e + 1, (2 * e + 2) % (2 * AROUND)
        own = (a, 0), (a, 2), (c, 2), (c, 0), (a, 1), (b, 2), (c, 1), (b, 0)
        elements.append((e + 1, *(index[at] for at in own)))
    turn = SPEED / RADII[1]
    velocity = [(n, 1, SPEED + turn * (y - centre[1])) for n, _, y in nodes]
    velocity += [(n, 2, -turn * (x - centre[0])) for n, x, _ in nodes]
    reference = len(nodes) + 1
    road = ("START", START - 1.0, 0.0), ("LINE", KERB, 0.0), ("LINE", KERB, STEP), ("LINE", END, STEP)
    return "".join(
        [
            card("HEADING", ("a tyre-like ring rolls over a kerb",)),
            "** Written by generate.py; kg, m, s.\n",
            card("NODE, NSET=TYRE", *nodes),
            card("ELEMENT, TYPE=CPE8R, ELSET=TYRE", *elements),
            card("NODE, NSET=REF", (reference, KERB, 0.0)),
            card("SURFACE, NAME=TREAD", ("TYRE", "S2")),
            card("SURFACE, NAME=BORE", ("TYRE", "S4")),
            card("SURFACE, NAME=ROAD, TYPE=SEGMENTS", *road),
            card(f"RIGID BODY, ANALYTICAL SURFACE=ROAD, REF NODE={reference}"),
            card("MATERIAL, NAME=RUBBER"),
            card("HYPERELASTIC, NEO HOOKE", (C10, D1)),
            card("DENSITY", (DENSITY,)),
            card(f"DAMPING, BETA={DAMPING!r}"),
            card("SOLID SECTION, ELSET=TYRE, MATERIAL=RUBBER", (1.0,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE", ("TREAD", "ROAD")),
            card("AMPLITUDE, NAME=FILL", (0.0, 0.0, FILL, 1.0)),
            card("BOUNDARY", (reference, 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *velocity),
        ]
    )


def problem() -> str:
    """The deck."""
    loads = [
        card("DLOAD", ("TYRE", "GRAV", GRAVITY, 0.0, -1.0)),
        card("DSLOAD, AMPLITUDE=FILL", ("BORE", "P", PRESSURE)),
        card("OUTPUT, FIELD, NUMBER INTERVAL=70"),
        card("NODE PRINT, NSET=TYRE, TOTALS=ONLY", ("U", "V")),
    ]
    return model() + step(INCREMENT, INCREMENTS, *loads)


def write(folder: Path) -> None:
    """Writes the deck into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tyre_kerb.inp").write_text(problem())


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
