"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from form import load
from meshes import plane, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry  # noqa: E402

held = load(Path(__file__).resolve().parents[2] / "input" / "taylor_bar" / "generate.py")


def write(folder: Path, across: int, increment: float = 5e-7, friction: float = -1.0, kind: str = "CAX8R") -> None:
    """The rod of input/taylor_bar with its face held along the axis, or in contact with a wall of a friction from 0 on."""
    if friction < 0:
        held.ACROSS, held.ALONG, held.INCREMENT = across, 10 * across, increment
        held.write(folder)
        return
    rod = rectangle("ROD", kind, (across, 10 * across), (held.RADIUS, held.LENGTH))
    cards = [
        card("HEADING", ("a copper rod hits a wall",)),
        rod.cards(),
        rod.surface("FACE", "bottom"),
        rod.nset("AXIS", "left"),
        rod.nset("BACK", "top"),
        card("NSET, NSET=EDGE", (rod.on("bottom")[-1],)),
        plane("WALL", (-1.0, 0.0), (20.0, 0.0)),
        card("MATERIAL, NAME=COPPER"),
        card("ELASTIC", (held.YOUNG, held.POISSON)),
        card("PLASTIC", (held.YIELD, 0.0), (held.YIELD + held.HARDENING * held.LAST, held.LAST)),
        card("DENSITY", (held.DENSITY,)),
        card("SOLID SECTION, ELSET=ROD, MATERIAL=COPPER"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "WALL")),
        card("BOUNDARY", ("AXIS", 1, 1), ("REFERENCE", 1, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("ROD", 2, -held.SPEED)),
        card("STEP, NLGEOM, INC=100000"),
        card("DYNAMIC, DIRECT", (increment, held.DURATION)),
        card("NODE PRINT, NSET=BACK", ("U",)),
        card("NODE PRINT, NSET=EDGE", ("U",)),
        card("END STEP"),
    ]
    write_deck(folder, "taylor_bar.inp", cards)
