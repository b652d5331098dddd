"""Writes the deck of a copper rod that hits a wall: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, write_to_folder  # noqa: E402

LENGTH, RADIUS, SPEED = 32.4, 3.2, 227000.0
"""Rod, and its speed: N, mm, s."""
YOUNG, POISSON, DENSITY = 117000.0, 0.35, 8.93e-9
YIELD, HARDENING, LAST = 400.0, 100.0, 5.0
"""Yield stress, its slope over the plastic strain, and the plastic strain up to which the table goes."""
ACROSS, ALONG = 4, 40
INCREMENT, DURATION = 5e-7, 8e-5


def rod() -> str:
    """Nodes, elements and sets of the rod, its face on the wall y = 0."""
    index: dict[tuple[int, int], int] = {}
    for j in range(2 * ALONG + 1):
        for i in range(2 * ACROSS + 1):
            if i % 2 == 0 or j % 2 == 0:
                index[i, j] = len(index) + 1
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    corners = [(2 * i, 2 * j) for j in range(ALONG) for i in range(ACROSS)]
    places = [
        (number, RADIUS * i / (2 * ACROSS), LENGTH * j / (2 * ALONG))
        for (i, j), number in index.items()
    ]
    elements = [
        (number, *(index[i + p, j + q] for p, q in around))
        for number, (i, j) in enumerate(corners, 1)
    ]
    sets = {
        "AXIS": [n for (i, _), n in index.items() if i == 0],
        "FACE": [n for (_, j), n in index.items() if j == 0],
        "BACK": [n for (_, j), n in index.items() if j == 2 * ALONG],
        "EDGE": [index[2 * ACROSS, 0]],
    }
    return "".join(
        [
            card("NODE, NSET=ALL", *places),
            card("ELEMENT, TYPE=CAX8R, ELSET=ROD", *elements),
            *(card(f"NSET, NSET={name}", *([n] for n in nodes)) for name, nodes in sets.items()),
        ]
    )


def problem() -> str:
    """The deck."""
    return "".join(
        [
            card("HEADING", ("a copper rod hits a wall without friction (Taylor test)",)),
            "** Written by generate.py; N, mm, s.\n",
            rod(),
            card("MATERIAL, NAME=COPPER"),
            card("ELASTIC", (YOUNG, POISSON)),
            card("PLASTIC", (YIELD, 0.0), (YIELD + HARDENING * LAST, LAST)),
            card("DENSITY", (DENSITY,)),
            card("SOLID SECTION, ELSET=ROD, MATERIAL=COPPER"),
            card("BOUNDARY", ("AXIS", 1), ("FACE", 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("ALL", 2, -SPEED), ("FACE", 2, 0.0)),
            card("STEP, NLGEOM, INC=100000"),
            card("DYNAMIC, DIRECT", (INCREMENT, DURATION)),
            card("NODE PRINT, NSET=BACK", ("U",)),
            card("NODE PRINT, NSET=EDGE", ("U",)),
            card("END STEP"),
        ]
    )


def write(folder: Path) -> None:
    """Writes the deck into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "taylor_bar.inp").write_text(problem())


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
