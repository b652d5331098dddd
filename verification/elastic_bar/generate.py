"""Writes the decks of the elastic bar that hits a fixed wall: `generate.py [-o FOLDER]`."""

import sys
from math import sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, elastic, write_to_folder  # noqa: E402

YOUNG = 1000.0
DENSITY = 1.0
LENGTH, DEPTH, THICKNESS = 10.0, 1.0, 1.0
ELEMENTS = 50
SPEED, GAP = 0.03, 0.0015

WAVE_SPEED = sqrt(YOUNG / DENSITY)
DT = LENGTH / ELEMENTS / WAVE_SPEED  # Courant number 1
INCREMENTS = 150  # contact from 8 to 108 at Courant number 1

INCLUDE = "elastic_bar.inc"
SCHEMES = {"ss22": "SCHEME=SS22, THETA1=1., THETA2=1.", "em": "SCHEME=ENERGY-MOMENTUM"}
IMPACTS = {"impulse": "IMPULSE", "none": "NONE"}


def model(beta: float) -> str:
    """Everything but the step, with a viscosity in transit times of an element."""
    bar = Grid("BAR", ELEMENTS, 1, lambda i, j: (LENGTH * i / ELEMENTS, DEPTH * j))
    wall = Grid(
        "WALL",
        1,
        1,
        lambda i, j: (i - 1.0 - GAP, (2 * j - 0.5) * DEPTH),
        bar.next_node,
        bar.next_element,
    )
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            bar.mesh("CPS4"),
            wall.mesh("CPS4"),
            bar.side_nodes("BAR_FACE", "left"),
            bar.side_surface("BAR_FACE", "left"),
            wall.side_surface("WALL_FACE", "right"),
            elastic(YOUNG, 0.0, DENSITY, "BAR", "WALL", thickness=THICKNESS, beta=beta * DT),
            card("SURFACE INTERACTION, NAME=SMOOTH"),
            card("CONTACT PAIR, INTERACTION=SMOOTH", ("BAR_FACE", "WALL_FACE")),
            card("BOUNDARY", ("WALL", 1, 2), ("BAR", 2, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BAR", 1, -SPEED)),
        ]
    )


def problem(scheme: str, impact: str) -> str:
    """A deck: heading, include, step."""
    return "".join(
        [
            card("HEADING", (f"elastic bar on a fixed wall; {scheme}, impact {impact}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card(f"STEP, NLGEOM, INC={INCREMENTS}"),
            card(f"STICKSLIP, {SCHEMES[scheme]}, IMPACT={IMPACTS[impact]}"),
            card("DYNAMIC, DIRECT", (DT, INCREMENTS * DT)),
            card("NODE PRINT, NSET=BAR", ("U", "V")),
            card("END STEP"),
        ]
    )


def write(folder: Path, beta: float = 0.0) -> None:
    """Writes the include file and all decks into `folder`; `beta` is in transit times h/c."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model(beta))
    for scheme in SCHEMES:
        for impact in IMPACTS:
            (folder / f"{scheme}_{impact}.inp").write_text(problem(scheme, impact))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
