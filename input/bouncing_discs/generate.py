"""Writes the decks of the two discs in a box: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import GridMesh, card, disc, dry, elastic, outline, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY = 1e4, 0.3, 1.0
HALF = 1.3
"""Half the side of the box."""
RADIUS = 0.5
SIDE, RINGS = 8, 2
DISCS = {"A": ((-0.7, 0.1), (2.0, 1.3)), "B": ((0.6, -0.2), (-1.1, 0.7))}
"""Centres and velocities."""
DT = 0.002
INCREMENTS = 20000
SETTINGS = {
    "discs_plastic": "LANDING=PLASTIC",
    "discs_return": "LANDING=RETURN",
    "discs_redistributed": "CONTACT MASS=REDISTRIBUTED, LANDING=RETURN",
}

INCLUDE = "bouncing_discs.inc"


def model(fine: int = 1) -> str:
    """Everything but the step, `fine` times as fine."""
    bodies: list[GridMesh] = []
    for name, (centre, _) in DISCS.items():
        first = (bodies[-1].next_node, bodies[-1].next_element) if bodies else (1, 1)
        bodies.append(disc(name, centre, RADIUS, 0.0, SIDE * fine, RINGS * fine, *first))
    corner = bodies[-1].next_node
    walls = [("START", HALF, -HALF)]
    walls += [("LINE", x, y) for x, y in ((HALF, HALF), (-HALF, HALF), (-HALF, -HALF))]
    pairs = (("A", "BOX"), ("B", "BOX"), ("A", "B"), ("B", "A"))
    speeds = [(name, i + 1, v[i]) for name, (_, v) in DISCS.items() for i in range(2)]
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            *(body.mesh("CPE4") for body in bodies),
            card("NODE", (corner, HALF, -HALF)),
            outline(*DISCS),
            card("SURFACE, TYPE=SEGMENTS, NAME=BOX", *walls, ("LINE", HALF, -HALF)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=BOX, REF NODE={corner}"),
            elastic(YOUNG, POISSON, DENSITY, *DISCS),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", *pairs),
            card("BOUNDARY", (corner, 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
        ]
    )


def problem(settings: str) -> str:
    """A deck: heading, include, step."""
    return "".join(
        [
            card("HEADING", (f"two discs in a box; {settings}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            step(
                DT,
                INCREMENTS,
                card(f"STICKSLIP, {settings}"),
                card("OUTPUT, FIELD, NUMBER INTERVAL=400"),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, settings in SETTINGS.items():
        (folder / f"{name}.inp").write_text(problem(settings))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
