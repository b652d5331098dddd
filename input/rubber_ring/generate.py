"""Writes the decks of the rubber ring thrown on the floor: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, outline, ring, step, write_to_folder  # noqa: E402

C10, D1, DENSITY, THICKNESS = 100.0, 2.0e-3, 1.0, 1.0
"""Shear modulus 2 C10 = 200, bulk modulus 2/D1 = 1000."""
RADII = 0.6, 1.0
AROUND, ACROSS = 48, 4
GAP = 0.1
VELOCITY = 2.0, -5.0
FRICTION = {"rubber_ring_mu00": 0.0, "rubber_ring_mu05": 0.5}
FLOOR = -4.0, 8.0
DT, INCREMENTS = 0.002, 400

INCLUDE = "rubber_ring.inc"


def model() -> str:
    """Everything but the friction and the step."""
    body = ring("RING", (0.0, RADII[1] + GAP), RADII, AROUND, ACROSS)
    reference = body.next_node
    velocity = [("RING", k + 1, component) for k, component in enumerate(VELOCITY)]
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            body.mesh("CPE4"),
            outline("RING"),
            card("NODE, NSET=REF", (reference, 0.0, 0.0)),
            card(
                "SURFACE, NAME=FLOOR, TYPE=SEGMENTS",
                ("START", FLOOR[0], 0.0),
                ("LINE", FLOOR[1], 0.0),
            ),
            card(f"RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE={reference}"),
            card("MATERIAL, NAME=RUBBER"),
            card("HYPERELASTIC, NEO HOOKE", (C10, D1)),
            card("DENSITY", (DENSITY,)),
            card(
                "SOLID SECTION, ELSET=RING, MATERIAL=RUBBER, FORMULATION=MEAN DILATATION",
                (THICKNESS,),
            ),
            card("CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE", ("RING", "FLOOR")),
            card("BOUNDARY", (reference, 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *velocity),
        ]
    )


def problem(friction: float) -> str:
    """A deck: heading, include, friction, step."""
    return "".join(
        [
            card("HEADING", (f"a rubber ring thrown on the floor; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            dry(friction),
            step(DT, INCREMENTS, card("OUTPUT, FIELD, NUMBER INTERVAL=100")),
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
