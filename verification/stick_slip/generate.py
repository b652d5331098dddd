"""Writes blocks on springs on a belt: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, elastic, step, write_to_folder  # noqa: E402

MASS, NORMAL, SPEED = 1.0, 10.0, 0.05
"""Mass and normal force of each block, speed of the belt."""
GROUND, COUPLING = 100.0, 60.0
"""Springs from the first block to the ground and between the blocks."""
AT_REST, SLIDING = 0.4, 0.2
TIME = 4.0
SIDES = 1.0, 0.5
APART = 1.5


def blocks(number: int, decay: float, increments: int) -> str:
    """Rigid blocks that the belt carries along until their springs hold them back."""
    width, height = SIDES
    cards = [card("HEADING"), f"{number} on springs on a belt, decay {decay}\n"]
    names = [f"B{k}" for k in range(number)]
    for k, name in enumerate(names):
        x, first = k * APART, 10 * k + 1
        corners = [(x, 0.0), (x + width, 0.0), (x + width, height), (x, height)]
        cards += [
            card(f"NODE, NSET=N{name}", *((first + i, *p) for i, p in enumerate(corners))),
            card(f"NODE, NSET=R{name}", (first + 5, x + width / 2, height / 2)),
            card(f"ELEMENT, TYPE=CPE4, ELSET=E{name}", (first, *(first + i for i in range(4)))),
            card(f"RIGID BODY, ELSET=E{name}, REF NODE={first + 5}"),
            card(f"SURFACE, NAME={name}", (f"E{name}", "S1")),
        ]
    cards += [
        elastic(1e5, 0.3, MASS / (width * height), *(f"E{name}" for name in names)),
        card("ELEMENT, TYPE=SPRING1, ELSET=EGROUND", (101, 6)),
        card("SPRING, ELSET=EGROUND", (1,), (GROUND,)),
    ]
    if number > 1:
        cards += [
            card("ELEMENT, TYPE=SPRING2, ELSET=ECOUPLING", (102, 6, 16)),
            card("SPRING, ELSET=ECOUPLING", (1, 1), (COUPLING,)),
        ]
    cards += [
        card("NODE, NSET=NBELT", (200, 0.0, -1.0)),
        card("SURFACE, NAME=BELT, TYPE=SEGMENTS", ("START", -20.0, 0.0), ("LINE", 20.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=BELT, REF NODE=200"),
        card("SURFACE INTERACTION, NAME=DRY"),
        card("FRICTION, EXPONENTIAL DECAY", (AT_REST, SLIDING, decay)),
        card("CONTACT PAIR, INTERACTION=DRY", *((name, "BELT") for name in names)),
        card("AMPLITUDE, NAME=MOVE", (0.0, 0.0, TIME, TIME)),
        card("BOUNDARY", ("NBELT", 2, 2), *((f"R{name}", 6, 6) for name in names)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *((f"R{name}", 1, SPEED) for name in names)),
        step(
            TIME / increments,
            increments,
            card("BOUNDARY, AMPLITUDE=MOVE", ("NBELT", 1, 1, SPEED)),
            card("CLOAD", *((f"R{name}", 2, -NORMAL) for name in names)),
            card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
        ),
    ]
    return "".join(cards)


def write(folder: Path, decay: float = 200.0, increments: int = 4000) -> None:
    """Writes the decks into `folder`: `decay` of the friction, and how many increments there are."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "one.inp").write_text(blocks(1, decay, int(increments)))
    (folder / "two.inp").write_text(blocks(2, decay, int(increments)))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
