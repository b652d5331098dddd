"""Writes the decks of the brake pad on a moving belt: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, material, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY = 1e4, 0.3, 1.0
LENGTH, HEIGHT = 1.0, 0.5
ALONG, UP = 16, 8
PRESSURE, RISE = 20.0, 0.1
"""Pressure on the back of the pad, and the time in which it grows."""
SPEED, FRICTION = 2.0, 0.5
BELT = -2.0, 2.0
"""Ends of the belt, which moves under the pad to the right."""
DT, INCREMENTS = 5e-4, 2000
BETA = {"brake_pad_undamped": 0.0, "brake_pad_damped": 1e-4}

INCLUDE = "brake_pad.inc"


def model() -> str:
    """Everything but the material and the step."""
    pad = Grid("PAD", ALONG, UP, lambda i, j: (LENGTH * i / ALONG, HEIGHT * j / UP))
    reference = pad.next_node
    time = DT * INCREMENTS
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            pad.mesh("CPE4"),
            pad.side_nodes("BACK_NODES", "top"),
            pad.side_surface("FACE", "bottom"),
            pad.side_surface("BACK", "top"),
            card("NODE, NSET=REF", (reference, 0.0, -1.0)),
            card(
                "SURFACE, NAME=BELT, TYPE=SEGMENTS",
                ("START", BELT[0] - SPEED * time, 0.0),
                ("LINE", BELT[1], 0.0),
            ),
            card(f"RIGID BODY, ANALYTICAL SURFACE=BELT, REF NODE={reference}"),
            card("SOLID SECTION, ELSET=PAD, MATERIAL=LINING", (1.0,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "BELT")),
            card("AMPLITUDE, NAME=MOVE", (0.0, 0.0), (time, time)),
            card("AMPLITUDE, NAME=PRESS", (0.0, 0.0), (RISE, 1.0)),
            card("BOUNDARY", ("REF", 2, 2), ("BACK_NODES", 1, 1)),
        ]
    )


def problem(beta: float) -> str:
    """A deck: heading, include, material, step."""
    damping = f"beta {beta!r}" if beta > 0.0 else "no damping"
    return "".join(
        [
            card("HEADING", (f"brake pad on a moving belt; {damping}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            material("LINING", YOUNG, POISSON, DENSITY, beta=beta),
            step(
                DT,
                INCREMENTS,
                card("BOUNDARY, AMPLITUDE=MOVE", ("REF", 1, 1, SPEED)),
                card("DSLOAD, AMPLITUDE=PRESS", ("BACK", "P", PRESSURE)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=200"),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, beta in BETA.items():
        (folder / f"{name}.inp").write_text(problem(beta))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
