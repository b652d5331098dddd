"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


def write(folder: Path, ratio: float = 0.0, first: float = 0.01, direct: int = 0, factor: float = 0.0) -> None:
    """A mass of 1 on a spring of 1 (omega = 1) with a dashpot of the damping `ratio`, for 50; automatic increments or fixed ones."""
    keyword = "DYNAMIC, DIRECT" if direct else "DYNAMIC"
    if factor:
        keyword += f", HALFINC SCALE FACTOR={factor}"
    cards = [
        card("HEADING", ("automatic increments",)),
        card("NODE, NSET=ALL", (1, 0.0, 0.0), (2, 1.0, 0.0), (3, 1.0, 1.0), (4, 0.0, 1.0), (5, -1.0, 0.0)),
        card("NSET, NSET=BODY", (1,), (2,), (3,), (4,)),
        card("NSET, NSET=MASS", (1,)),
        card("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4)),
        card("EQUATION", *(row for node in (2, 3, 4) for row in ((2,), (node, 1, 1.0, 1, 1, -1.0)))),
        card("ELEMENT, TYPE=SPRING1, ELSET=SPRING", (2, 1)),
        card("SPRING, ELSET=SPRING", (1,), (1.0,)),
        card("ELEMENT, TYPE=DASHPOT1, ELSET=DASHPOT", (3, 1)) + card("DASHPOT, ELSET=DASHPOT", (1,), (2 * ratio,)) if ratio else "",
        elastic(1e3, 0.0, 1.0, "BLOCK"),
        card("BOUNDARY", ("BODY", 2, 2), (5, 1, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BODY", 1, 1.0)),
        card("STEP, NLGEOM, INC=100000"),
        card(keyword, (first, 50.0, 1e-6, 5.0)),
        prints("MASS"),
        card("END STEP"),
    ]
    write_deck(folder, "mass.inp", cards)
