"""Writes blocks on springs on a belt: `generate.py [-o FOLDER]`."""

import sys
from math import atan, pi, sqrt
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
FACE_SPEED, FACE_SPRING, FACE_SLIDING = 0.1, 50.0, 0.25
"""Speed of the belt, spring and friction of slip of the block with a face of many nodes."""
PERIODS = 7
FORMULATIONS = {"nodes": "NODE TO SURFACE", "surface": "SURFACE TO SURFACE"}


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


def face_period() -> float:
    """Period of a block whose friction falls at once from mu_s to mu_k.

    It sticks over the way 2 a, a = (mu_s - mu_k) N/k, and slips for (pi + 2 atan(V/(w a)))/w with
    w = sqrt(k/m).
    """
    w = sqrt(FACE_SPRING / MASS)
    a = (AT_REST - FACE_SLIDING) * NORMAL / FACE_SPRING
    return 2.0 * a / FACE_SPEED + (pi + 2.0 * atan(FACE_SPEED / (w * a))) / w


def face(nodes: int, formulation: str, increments: int) -> str:
    """One rigid block with a face of many nodes, and so many increments in a period."""
    width, height = SIDES
    places = [(i * width / (nodes - 1), j * height) for i in range(nodes) for j in range(2)]
    elements = [(i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2) for i in range(nodes - 1)]
    belt = [("LINE", 2.0 * k - 18.0, 0.0) for k in range(20)]
    contact = f"CONTACT PAIR, INTERACTION=DRY, TYPE={FORMULATIONS[formulation]}"
    dt = face_period() / increments
    return "".join(
        (
            card("HEADING"),
            f"A rigid block with {nodes} nodes on its face, {formulation}\n",
            card("NODE", *((k + 1, *place) for k, place in enumerate(places))),
            card("ELEMENT, TYPE=CPE4, ELSET=EB0", *elements),
            card("NODE, NSET=RB0", (101, width / 2, height / 2)),
            card("NODE, NSET=NBELT", (102, 0.0, -1.0)),
            card("RIGID BODY, ELSET=EB0, REF NODE=101"),
            card("SURFACE, NAME=B0", ("EB0", "S1")),
            elastic(1e5, 0.3, MASS / (width * height), "EB0"),
            card("ELEMENT, TYPE=SPRING1, ELSET=EGROUND", (101, 101)),
            card("SPRING, ELSET=EGROUND", (1,), (FACE_SPRING,)),
            card("SURFACE, NAME=BELT, TYPE=SEGMENTS", ("START", -20.0, 0.0), *belt),
            card("RIGID BODY, ANALYTICAL SURFACE=BELT, REF NODE=102"),
            card("SURFACE INTERACTION, NAME=DRY"),
            card("FRICTION", (AT_REST, 0.0), (FACE_SLIDING, 1e-5)),
            card(contact, ("B0", "BELT")),
            card("BOUNDARY", ("NBELT", 2, 2), ("RB0", 6, 6)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("RB0", 1, FACE_SPEED)),
            step(
                dt,
                PERIODS * increments,
                card("BOUNDARY, TYPE=VELOCITY", ("NBELT", 1, 1, FACE_SPEED)),
                card("CLOAD", ("RB0", 2, -NORMAL)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
            ),
        )
    )


def write(
    folder: Path,
    decay: float = 200.0,
    increments: int = 4000,
    nodes: int = 6,
    formulation: str = "nodes",
    per_period: int = 400,
) -> None:
    """Writes the decks into `folder`: `decay` of the friction, and how many increments there are.

    Of the block with a face of many nodes: their number, formulation of contact, increments in a
    period.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "face.inp").write_text(face(int(nodes), formulation, int(per_period)))
    (folder / "one.inp").write_text(blocks(1, decay, int(increments)))
    (folder / "two.inp").write_text(blocks(2, decay, int(increments)))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
