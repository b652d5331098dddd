"""Writes the decks of the block that falls on a slope: `generate.py [-o FOLDER]`."""

import argparse
import sys
from math import sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card  # noqa: E402

# kg, cm, s; the unit of force is kg cm/s^2 = 0.01 N.
YOUNG = 1e9  # the block's; the slope's is twice that: 1e7 N/cm^2 = 1e9 kg/(cm s^2)
POISSON = 0.2
DENSITY = 1.0
THICKNESS = 1.0
FORCE = 400 * 100.0  # 400 N
DT = 1.5e-5
INCREMENTS = 13333
FRICTION = {"block_slope_mu00": 0.0, "block_slope_mu02": 0.2, "block_slope_mu05": 0.5}

# Our choice of geometry.
SINE, COSINE = 0.5, sqrt(3) / 2  # 30 degrees
LENGTH, DEPTH = 40.0, 2.0
SIDE, START, GAP = 4.0, 2.0, 2.0
MASS = DENSITY * SIDE**2 * THICKNESS

INCLUDE = "block_slope.inc"


def place(along: float, above: float) -> tuple[float, float]:
    """Position of a point by its distances down the slope and out of it.

    The origin is the slope's upper end; down the slope is (cos, -sin), out of it (sin, cos).
    """
    return along * COSINE + above * SINE, above * COSINE - along * SINE


def model(refine: int = 1, flight: float = 0.0) -> str:
    """Everything but the friction and the step.

    `refine` divides the edges of all elements. After `flight`, a time before the landing, the
    block's fall continues: it starts from where it is then, with the velocity that it has then.
    """
    along, normal = (flight * FORCE / MASS * direction for direction in (SINE, -COSINE))
    start, gap = START + 0.5 * flight * along, GAP + 0.5 * flight * normal
    nx, ny = 40 * refine, 2 * refine
    slope = Grid("SLOPE", nx, ny, lambda i, j: place(LENGTH * i / nx, DEPTH * j / ny - DEPTH))
    n = 8 * refine
    block = Grid(
        "BLOCK",
        n,
        n,
        lambda i, j: place(start + SIDE * i / n, gap + SIDE * j / n),
        slope.next_node,
        slope.next_element,
    )
    cards = "".join(
        [
            "** Written by generate.py; kg, cm, s (force: kg cm/s^2 = 0.01 N).\n",
            slope.mesh("CPS4"),
            block.mesh("CPS4"),
            slope.side_nodes("SLOPE_BASE", "bottom"),
            block.side_nodes("BLOCK_FACE", "bottom"),
            card("NSET, NSET=BLOCK_CENTRE", (block.node(n // 2, n // 2),)),
            slope.side_surface("SLOPE_FACE", "top"),
            block.side_surface("BLOCK_FACE", "bottom"),
            card("MATERIAL, NAME=BLOCK"),
            card("ELASTIC", (YOUNG, POISSON)),
            card("DENSITY", (DENSITY,)),
            card("MATERIAL, NAME=SLOPE"),
            card("ELASTIC", (2 * YOUNG, POISSON)),
            card("DENSITY", (DENSITY,)),
            card("SOLID SECTION, ELSET=BLOCK, MATERIAL=BLOCK", (THICKNESS,)),
            card("SOLID SECTION, ELSET=SLOPE, MATERIAL=SLOPE", (THICKNESS,)),
            card("CONTACT PAIR, INTERACTION=INTERFACE", ("BLOCK_FACE", "SLOPE_FACE")),
            card("BOUNDARY", ("SLOPE_BASE", 1, 2)),
        ]
    )
    if flight > 0.0:
        velocity = place(along, normal)
        rows = [("BLOCK", i + 1, velocity[i]) for i in range(2)]
        cards += card("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)
    return cards


def problem(friction: float) -> str:
    """A deck: heading, include, friction, step."""
    body_force = FORCE / (SIDE**2 * THICKNESS)
    return "".join(
        [
            card("HEADING", (f"block falling on a slope of 30 degrees; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card("SURFACE INTERACTION, NAME=INTERFACE"),
            card("SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"),
            card("FRICTION", (friction,)),
            card(f"STEP, NLGEOM, INC={INCREMENTS}"),
            "** The paper's scheme; without this card the default, energy-momentum, is used.\n",
            card("STICKSLIP, SCHEME=SS22, THETA1=1., THETA2=1."),
            card("DYNAMIC, DIRECT", (DT, INCREMENTS * DT)),
            card("DLOAD", ("BLOCK", "BY", -body_force)),
            card("NODE PRINT, NSET=BLOCK", ("U", "V")),
            card("NODE PRINT, NSET=BLOCK_CENTRE", ("U", "V")),
            card("END STEP"),
        ]
    )


def write(folder: Path, refine: int = 1, flight: float = 0.0) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model(refine, flight))
    for name, friction in FRICTION.items():
        (folder / f"{name}.inp").write_text(problem(friction))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--refine", type=int, default=1, help="divide the edges of all elements")
    parser.add_argument("--flight", type=float, default=0.0, help="time of fall left out")
    parser.add_argument("-o", "--output", type=Path, default=HERE, help="folder of the decks")
    arguments = parser.parse_args()
    write(arguments.output, arguments.refine, arguments.flight)


if __name__ == "__main__":
    main()
