"""Writes the decks of an O-ring squeezed in its groove and let go: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, disc, dry, write_to_folder  # noqa: E402

RADIUS, DEPTH = 2.65, 4.0
"""Radius of the cord and depth of the groove."""
WIDTHS = {"o_ring_groove": 5.8, "o_ring_plates": 9.0}
"""Widths of the groove; the walls of the wide one are never touched."""
C10, C01, D1 = 0.8, 0.2, 0.02
"""Mooney-Rivlin material: mu = 2, K = 100 in N, mm: a rubber of some 60 Shore A."""
DENSITY = 1.2e-9
FRICTION = 0.3
SIDE, RINGS, INCREMENTS = 12, 6, 20
"""Elements along the square in the middle of the cord and around it, and increments in which it is squeezed."""

INCLUDE = "o_ring.inc"


def model() -> str:
    """The cord and its cover."""
    ring = disc("RING", (0.0, RADIUS), RADIUS, 0.0, SIDE, RINGS)
    reference = ring.next_node
    half, top = RADIUS, 2.0 * RADIUS
    return "".join(
        [
            "** Written by generate.py; N, mm, s.\n",
            ring.mesh("CPE4"),
            card("NODE, NSET=GROOVE", (reference, 0.0, 0.0)),
            card("NODE, NSET=COVER", (reference + 1, 0.0, top)),
            card("SURFACE, NAME=SKIN", ("RING",)),
            card("SURFACE, NAME=PLATE, TYPE=SEGMENTS", ("START", 2.0 * half, top), ("LINE", -2.0 * half, top)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=PLATE, REF NODE={reference + 1}"),
            card("MATERIAL, NAME=RUBBER"),
            card("HYPERELASTIC, MOONEY-RIVLIN", (C10, C01, D1)),
            card("DENSITY", (DENSITY,)),
            card("SOLID SECTION, ELSET=RING, MATERIAL=RUBBER, FORMULATION=MEAN DILATATION", (1.0,)),
        ]
    )


def problem(width: float) -> str:
    """A deck: heading, include, groove, friction, squeeze and release."""
    half, top, squeeze = width / 2.0, 2.0 * RADIUS, 2.0 * RADIUS - DEPTH
    steps = [
        card("STEP, NLGEOM, INC=1000")
        + card("STATIC, DIRECT", (1.0 / INCREMENTS, 1.0))
        + card("BOUNDARY", ("COVER", 2, 2, motion))
        + card("END STEP")
        for motion in (-squeeze, 0.0)
    ]
    return "".join(
        [
            card("HEADING", (f"an O-ring squeezed in a groove of width {width} and let go",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card(
                "SURFACE, NAME=WALLS, TYPE=SEGMENTS",
                ("START", -half, top),
                ("LINE", -half, 0.0),
                ("LINE", half, 0.0),
                ("LINE", half, top),
            ),
            card("RIGID BODY, ANALYTICAL SURFACE=WALLS, REF NODE=GROOVE"),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "WALLS"), ("SKIN", "PLATE")),
            card("BOUNDARY", ("GROOVE", 1, 2), ("COVER", 1, 1)),
            *steps,
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, width in WIDTHS.items():
        (folder / f"{name}.inp").write_text(problem(width))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
