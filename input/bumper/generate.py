"""Writes the deck of a metal bumper that a post dents: `generate.py [-o FOLDER]`."""

import sys
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, write_to_folder  # noqa: E402

SPAN, RISE, SHEET = 600.0, 80.0, 3.0
"""Of the arch between its feet; thickness of the sheet."""
YOUNG, POISSON, DENSITY = 70000.0, 0.33, 2.7e-9
HARDENING = ((200.0, 0.0), (260.0, 0.05), (300.0, 0.2))
"""Aluminium: yield stress and accumulated plastic strain; N, mm, s."""
ALONG = 60
"""Elements along the arch; one layer."""
POST, SIDES = 60.0, 24
"""Radius of the post, and segments of the half of it that looks at the bumper."""
GAP, PUSH = 1.0, 40.0
FRICTION = 0.2
INCREMENTS = 40


def model() -> str:
    """Everything but the steps."""
    nodes, index = [], {}
    for k in range(2 * ALONG + 1):
        x = SPAN * (k / (2 * ALONG) - 0.5)
        angle = pi * x / SPAN
        height, slope = RISE * cos(angle), -RISE * pi / SPAN * sin(angle)
        size = (1.0 + slope * slope) ** 0.5
        for j in range(3):
            if k % 2 and j == 1:
                continue
            off = SHEET * (j / 2 - 0.5)
            index[k, j] = len(nodes) + 1
            nodes.append((len(nodes) + 1, x - off * slope / size, height + off / size))
    around = (0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)
    elements = [(e + 1, *(index[2 * e + p, q] for p, q in around)) for e in range(ALONG)]
    feet = [index[k, j] for k in (0, 2 * ALONG) for j in range(3)]
    reference = len(nodes) + 1
    centre = RISE + SHEET / 2 + GAP + POST
    angles = [2.0 * pi - pi * k / SIDES for k in range(SIDES + 1)]
    post = [(POST * cos(a), centre + POST * sin(a)) for a in angles]
    return "".join(
        [
            card("HEADING", ("a metal bumper yields under a post and springs back",)),
            "** Written by generate.py; N, mm, s.\n",
            card("NODE, NSET=BUMPER", *nodes),
            card("ELEMENT, TYPE=CPE8R, ELSET=BUMPER", *elements),
            card("NODE, NSET=POST", (reference, 0.0, centre)),
            card("NSET, NSET=FEET", *([n] for n in feet)),
            card("NSET, NSET=TOP", (index[ALONG, 0],)),
            card("SURFACE, NAME=FACE", ("BUMPER", "S3")),
            card(
                "SURFACE, NAME=ROUND, TYPE=SEGMENTS",
                *((("START", "LINE")[k > 0], *x) for k, x in enumerate(post)),
            ),
            card(f"RIGID BODY, ANALYTICAL SURFACE=ROUND, REF NODE={reference}"),
            card("MATERIAL, NAME=ALUMINIUM"),
            card("ELASTIC", (YOUNG, POISSON)),
            card("PLASTIC", *HARDENING),
            card("DENSITY", (DENSITY,)),
            card("SOLID SECTION, ELSET=BUMPER, MATERIAL=ALUMINIUM", (1.0,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE", ("FACE", "ROUND")),
            card("BOUNDARY", ("FEET", 1, 2), ("POST", 1, 1), ("POST", 6, 6)),
        ]
    )


def move(way: float) -> str:
    """A static step to a place of the post."""
    return "".join(
        [
            card("STEP, NLGEOM, INC=10000"),
            card("STATIC, DIRECT", (1.0 / INCREMENTS, 1.0)),
            card("BOUNDARY", ("POST", 2, 2, way)),
            card("OUTPUT, FIELD, NUMBER INTERVAL=10"),
            card("NODE PRINT, NSET=POST", ("U", "RF")),
            card("NODE PRINT, NSET=TOP", ("U",)),
            card("END STEP"),
        ]
    )


def write(folder: Path) -> None:
    """Writes the deck into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bumper.inp").write_text(model() + move(-GAP - PUSH) + move(GAP))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
