"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from form import load
from meshes import plane, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, disc, dry, elastic, outline, step  # noqa: E402

case = load(Path(__file__).resolve().parent / "explicit.py")


def write(folder: Path, share: float, side: int, settings: str = "", dt: float = 0.0) -> None:
    """An elastic disc meets a rigid plane with v_t = `share` mu v_n; 4 `side` elements around."""
    dt = dt or 0.004 / side
    body = disc("DISC", (0.0, case.RADIUS + 0.001), case.RADIUS, 0.0, side, side // 4)
    cards = [
        card("HEADING", ("oblique impact of a disc",)),
        body.mesh("CPE4"),
        outline("DISC"),
        plane("GROUND", (-2.0, 0.0), (2.0, 0.0)),
        elastic(case.YOUNG, case.POISSON, case.DENSITY, "DISC"),
        dry(case.FRICTION),
        card("CONTACT PAIR, INTERACTION=DRY", ("DISC", "GROUND")),
        card("BOUNDARY", ("REFERENCE", 1, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("DISC", 1, share * case.FRICTION * case.FALL), ("DISC", 2, -case.FALL)),
        step(dt, round(0.06 / dt), card(f"STICKSLIP, {settings}") if settings else ""),
    ]
    write_deck(folder, "disc.inp", cards)
