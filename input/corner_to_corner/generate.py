"""Writes the decks of the two squares that meet with their corners: `generate.py [-o FOLDER]`."""

import sys
from math import sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, elastic, outline, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 1000.0, 0.3, 1.0, 1.0
SIDE, ELEMENTS = 1.0, 6
GAP, SPEED = 0.05, 0.5
OFFSETS = {"left": -1e-6, "right": 1e-6}
FRICTION = {"mu00": 0.0, "mu02": 0.2}
DT = 0.005
INCREMENTS = 300


def square(name: str, tip: tuple[float, float], above: bool, after: Grid | None = None) -> Grid:
    """A square on its corner; `tip` is its lowest corner if it is above, else its highest."""
    step = SIDE / ELEMENTS / sqrt(2)
    lowest = tip[1] if above else tip[1] - sqrt(2) * SIDE
    first = (after.next_node, after.next_element) if after else (1, 1)
    return Grid(
        name,
        ELEMENTS,
        ELEMENTS,
        lambda i, j: (tip[0] + (i - j) * step, lowest + (i + j) * step),
        *first,
    )


def model(offset: float) -> str:
    """Everything but the friction and the step."""
    lower = square("LOWER", (0.0, -0.5 * GAP), above=False)
    upper = square("UPPER", (offset, 0.5 * GAP), above=True, after=lower)
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            lower.mesh("CPE4"),
            upper.mesh("CPE4"),
            outline("LOWER", "UPPER"),
            elastic(YOUNG, POISSON, DENSITY, "LOWER", "UPPER", thickness=THICKNESS),
            card("CONTACT PAIR, INTERACTION=DRY", ("LOWER", "UPPER"), ("UPPER", "LOWER")),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("LOWER", 2, SPEED), ("UPPER", 2, -SPEED)),
        ]
    )


def problem(side: str, friction: float) -> str:
    """A deck: heading, include, friction, step."""
    return "".join(
        [
            card("HEADING", (f"two corners that meet, upper {side} by 1e-6; friction {friction}",)),
            card(f"INCLUDE, INPUT={side}.inc"),
            dry(friction),
            step(DT, INCREMENTS, card("OUTPUT, FIELD, NUMBER INTERVAL=150")),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include files and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for side, offset in OFFSETS.items():
        (folder / f"{side}.inc").write_text(model(offset))
        for name, friction in FRICTION.items():
            (folder / f"corners_{side}_{name}.inp").write_text(problem(side, friction))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
