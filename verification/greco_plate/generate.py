"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402


def write(folder: Path, nx: int, ny: int) -> None:
    """Half of a plate on a rigid base, pressed from above and from its free side; in mm and MPa."""
    plate = rectangle("PLATE", "CPE4", (nx, ny), (40.0, 40.0))
    cards = [
        card("HEADING", ("plate on a rigid base, SSNV128",)),
        plate.cards(),
        plate.nset("SYMMETRY", "right"),
        plate.nset("FOOT", "bottom"),
        plate.surface("SOLE", "bottom"),
        plate.surface("TOP", "top"),
        plate.surface("SIDE", "left"),
        card("NODE, NSET=FIXED", (100_000, 0.0, -10.0)),
        card("SURFACE, NAME=BASE, TYPE=SEGMENTS", ("START", -20.0, 0.0), ("LINE", 60.0, 0.0)),
        card("RIGID BODY, ANALYTICAL SURFACE=BASE, REF NODE=FIXED"),
        elastic(130000.0, 0.2, 1.0, "PLATE"),
        dry(1.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "BASE")),
        card("BOUNDARY", ("FIXED", 1, 2), ("SYMMETRY", 1, 1)),
        static(
            card("DSLOAD", ("SIDE", "P", 150.0), ("TOP", "P", 50.0)),
            prints("SYMMETRY"),
            dt=0.05,
            direct=True,
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "greco.inp").write_text("".join(cards))
