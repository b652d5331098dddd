"""Writes the decks of the two cantilevers: `generate.py [-o FOLDER]`."""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, elastic  # noqa: E402

YOUNG = 4000.0
POISSON = 0.3
DENSITY = 4.0
THICKNESS = 0.01
FORCE = 0.15
DT = 0.015
INCREMENTS = 1000
FRICTION = {"mu00": 0.0, "mu02": 0.2, "mu04": 0.4}

# Our choice of geometry.
LENGTH, DEPTH = 10.0, 1.0
OVERLAP, GAP = 5.0, 0.5

INCLUDE = "two_cantilevers.inc"


def model(refine: int = 1) -> str:
    """Everything but the friction and the step; `refine` divides the edges of all elements."""
    nx, ny = 20 * refine, 2 * refine
    bottom = DEPTH + GAP
    upper = Grid("UPPER", nx, ny, lambda i, j: (LENGTH * i / nx, bottom + DEPTH * j / ny))
    lower = Grid(
        "LOWER",
        nx,
        ny,
        lambda i, j: (LENGTH - OVERLAP + LENGTH * i / nx, DEPTH * j / ny),
        upper.next_node,
        upper.next_element,
    )
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            upper.mesh("CPS4"),
            lower.mesh("CPS4"),
            upper.side_nodes("UPPER_CLAMP", "left"),
            upper.side_nodes("UPPER_TIP", "right"),
            lower.side_nodes("LOWER_TIP", "left"),
            lower.side_nodes("LOWER_CLAMP", "right"),
            upper.side_surface("UPPER_FACE", "bottom"),
            lower.side_surface("LOWER_FACE", "top"),
            elastic(YOUNG, POISSON, DENSITY, "UPPER", "LOWER", thickness=THICKNESS),
            card("CONTACT PAIR, INTERACTION=INTERFACE", ("UPPER_FACE", "LOWER_FACE")),
            card("BOUNDARY", ("UPPER_CLAMP", 1, 2), ("LOWER_CLAMP", 1, 2)),
        ]
    )


def problem(case: str, friction: float, refine: int = 1) -> str:
    """A deck: heading, include, friction, step; load case A or B."""
    share = round(FORCE / (2 * refine + 1), 15)
    loads: list[tuple[str, int, float]] = [("UPPER_TIP", 2, -share)]
    if case == "B":
        loads.append(("LOWER_TIP", 2, share))
    return "".join(
        [
            card("HEADING", (f"two cantilevers; load case {case}; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card("SURFACE INTERACTION, NAME=INTERFACE"),
            card("SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"),
            card("FRICTION", (friction,)),
            card(f"STEP, NLGEOM, INC={INCREMENTS}"),
            "** The paper's scheme; without this card the default, energy-momentum, is used.\n",
            card("STICKSLIP, SCHEME=SS22, THETA1=1., THETA2=1."),
            card("DYNAMIC, DIRECT", (DT, INCREMENTS * DT)),
            "** The tip force, shared equally by the nodes of the end face.\n",
            card("CLOAD", *loads),
            card("NODE PRINT, NSET=UPPER_TIP", ("U", "V")),
            card("NODE PRINT, NSET=LOWER_TIP", ("U", "V")),
            card("END STEP"),
        ]
    )


def write(folder: Path, refine: int = 1) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model(refine))
    for case in "AB":
        for name, friction in FRICTION.items():
            (folder / f"{case}_{name}.inp").write_text(problem(case, friction, refine))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--refine", type=int, default=1, help="divide the edges of all elements")
    parser.add_argument("-o", "--output", type=Path, default=HERE, help="folder of the decks")
    arguments = parser.parse_args()
    write(arguments.output, arguments.refine)


if __name__ == "__main__":
    main()
