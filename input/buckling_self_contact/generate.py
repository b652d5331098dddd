"""Writes the decks of the column that folds onto itself: `generate.py [-o FOLDER]`."""

import sys
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, elastic, outline, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 1e4, 0.3, 1.0, 1.0
LENGTH, DEPTH = 12.0, 0.16
ALONG, ACROSS = 100, 2
IMPERFECTION = 0.05
"""Amplitude of the first shape: one wave along the column."""
PUSH = 11.0
"""How far the upper end is pushed down."""
RISE, HOLD = 10.0, 2.0
"""Duration of the push, and of the time after it."""
DT = 0.01
FRICTION = {"column_mu00": 0.0, "column_mu02": 0.2}

INCLUDE = "column.inc"


def model() -> str:
    """Everything but the friction and the step."""

    def place(i: int, j: int) -> tuple[float, float]:
        up = LENGTH * j / ALONG
        turn = 2 * pi * j / ALONG
        return DEPTH * (i / ACROSS - 0.5) + IMPERFECTION * (sin(turn) - 0.5 * sin(2 * turn)), up

    column = Grid("COLUMN", ACROSS, ALONG, place)
    times = [RISE * k / 40 for k in range(41)]
    push = [(t, 0.5 * (1 - cos(pi * t / RISE))) for t in times]
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            column.mesh("CPE4"),
            column.side_nodes("FOOT", "bottom"),
            column.side_nodes("HEAD", "top"),
            outline("COLUMN"),
            elastic(YOUNG, POISSON, DENSITY, "COLUMN", thickness=THICKNESS),
            "** One surface on the row: contact of the surface with itself.\n",
            card("CONTACT PAIR, INTERACTION=DRY", ("COLUMN",)),
            card("AMPLITUDE, NAME=PUSH", *push),
            card("BOUNDARY", ("FOOT", 1, 2), ("HEAD", 1, 1)),
        ]
    )


def problem(friction: float) -> str:
    """A deck: heading, include, friction, step."""
    return "".join(
        [
            card("HEADING", (f"column that folds onto itself; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            dry(friction),
            step(
                DT,
                round((RISE + HOLD) / DT),
                card("BOUNDARY, AMPLITUDE=PUSH", ("HEAD", 2, 2, -PUSH)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=200"),
                card("NODE PRINT, NSET=HEAD", ("U", "RF")),
            ),
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
