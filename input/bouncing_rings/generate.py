"""Writes the decks of the two rings thrown at each other: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, elastic, outline, ring, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 1000.0, 0.3, 1.0, 1.0
RADII = 0.8, 1.0
AROUND, ACROSS = 60, 2
GAP, OFFSET = 0.1, 0.7
SPEED, SPIN = 0.8, 0.5
FRICTION = {"rings_mu00": 0.0, "rings_mu02": 0.2}
DT = 0.005
INCREMENTS = 800

INCLUDE = "bouncing_rings.inc"


def model() -> str:
    """Everything but the friction and the step."""
    apart = (4 * RADII[1] ** 2 - OFFSET**2) ** 0.5 + GAP
    centre = -0.5 * apart, -0.5 * OFFSET
    left = ring("LEFT", centre, RADII, AROUND, ACROSS)
    right = ring(
        "RIGHT",
        (-centre[0], -centre[1]),
        RADII,
        AROUND,
        ACROSS,
        left.next_node,
        left.next_element,
    )
    spinning = []
    for k, (x, y) in enumerate(left.nodes):
        spinning.append((left.first_node + k, 1, SPEED - SPIN * (y - centre[1])))
        spinning.append((left.first_node + k, 2, SPIN * (x - centre[0])))
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            left.mesh("CPE4"),
            right.mesh("CPE4"),
            outline("LEFT", "RIGHT"),
            elastic(YOUNG, POISSON, DENSITY, "LEFT", "RIGHT", thickness=THICKNESS),
            card("CONTACT PAIR, INTERACTION=DRY", ("LEFT", "RIGHT"), ("RIGHT", "LEFT")),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *spinning, ("RIGHT", 1, -SPEED)),
        ]
    )


def problem(friction: float) -> str:
    """A deck: heading, include, friction, step."""
    return "".join(
        [
            card("HEADING", (f"two rings thrown at each other; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            dry(friction),
            step(DT, INCREMENTS, card("OUTPUT, FIELD, NUMBER INTERVAL=160")),
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
