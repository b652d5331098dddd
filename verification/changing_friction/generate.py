"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import follower, plane, prints, rectangle, ride, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402

YOUNG, PRESSURE, WEAR = 1e3, 1.0, 1e-4
LAWS = {
    "constant": card("FRICTION", (0.3,)),
    "rates": card("FRICTION", (0.3, 0.0), (0.25, 1.0), (0.2, 10.0)),
    "decay": card("FRICTION, EXPONENTIAL DECAY", (0.3, 0.1, 0.5)),
    "limited": card("FRICTION, TAUMAX=0.1", (0.3,)),
}


def write(folder: Path, law: str = "constant", kind: str = "static", speed: float = 2.0, wear: str = "") -> None:
    """A block under pressure is drawn over a plane; its friction changes to 0.1 in the second step of `kind`."""
    block = rectangle("BLOCK", "CPE4", (8, 2), (1.0, 0.25))
    dynamic = kind == "dynamic"
    pull = card("BOUNDARY, TYPE=VELOCITY", ("HEAD", 1, 1, speed))
    changed = card("CHANGE FRICTION, INTERACTION=DRY") + card("FRICTION", (0.1,)) if law == "constant" else ""
    procedure = card("DYNAMIC, DIRECT", (0.01, 1.0)) if dynamic else card("STATIC, DIRECT", (0.05, 1.0))
    drag = card("STEP, NLGEOM, INC=100") + procedure
    cards = [
        card("HEADING", ("a block drawn over a plane",)),
        block.cards(),
        block.surface("SOLE", "bottom"),
        block.nset("SOLE", "bottom"),
        block.surface("ROOF", "top"),
        ride(block, "top", "HEAD", 1, 2),
        *(card("EQUATION", (2,), (b, 1, 1.0, a, 1, -1.0)) for a, b in zip(block.on("left")[:-1], block.on("right")[:-1])),
        plane("GROUND", (-5.0, 0.0), (15.0, 0.0)),
        elastic(YOUNG, 0.0, 1e-3, "BLOCK"),
        card("SURFACE INTERACTION, NAME=DRY") + LAWS[law],
        card(f"WEAR SURFACE PROPERTIES{wear}", (WEAR * (50 if "UNITLESS" in wear else 1),)),
        card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "GROUND")),
        card("BOUNDARY", ("REFERENCE", 1, 2)),
        static(follower("ROOF", PRESSURE), card("BOUNDARY", ("HEAD", 1, 1)), prints("HEAD"), dt=1.0),
        drag,
        pull,
        card("END STEP"),
        drag if changed else "",
        changed,
        card("END STEP") if changed else "",
    ]
    write_deck(folder, "block.inp", cards)
