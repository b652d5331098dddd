"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import plane, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, disc, dry, elastic, outline, step  # noqa: E402

RADIUS, HEIGHT, GRAVITY = 0.5, 0.05, 1.0


def write(folder: Path, settings: str, side: int = 8, dt: float = 0.002, duration: float = 6.4) -> None:
    """An elastic disc falls from the height 0.05 again and again, ten times in 6.4."""
    body = disc("DISC", (0.0, RADIUS + HEIGHT), RADIUS, 0.0, side, side // 4)
    cards = [
        card("HEADING", ("a disc that bounces",)),
        body.mesh("CPE4"),
        outline("DISC"),
        plane("GROUND", (-2.0, 0.0), (2.0, 0.0)),
        elastic(1e4, 0.3, 1.0, "DISC"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("DISC", "GROUND")),
        card("BOUNDARY", ("REFERENCE", 1, 2)),
        step(dt, round(duration / dt), card(f"STICKSLIP, {settings}"), card("DLOAD", ("DISC", "GRAV", GRAVITY, 0.0, -1.0))),
    ]
    write_deck(folder, "disc.inp", cards)
