"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import GridMesh, card, disc, dry, elastic, outline, step  # noqa: E402

RADIUS, SPEED, GAP = 0.5, 0.1, 0.02


def write(folder: Path, count: int, side: int = 8, dt: float = 0.002, settings: str = "") -> None:
    """`count` discs in a row, the first of which moves; 4 `side` elements around each."""
    discs: list[GridMesh] = []
    for k in range(count):
        first = (discs[-1].next_node, discs[-1].next_element) if discs else (1, 1)
        discs.append(disc(f"DISC{k + 1}", (k * (2 * RADIUS + GAP), 0.0), RADIUS, 0.0, side, side // 4, *first))
    names = [body.name for body in discs]
    pairs = [pair for one, two in zip(names, names[1:]) for pair in ((one, two), (two, one))]
    cards = [
        card("HEADING", ("discs in a row",)),
        *(body.mesh("CPE4") for body in discs),
        outline(*names),
        elastic(1e4, 0.3, 1.0, *names),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", *pairs),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("DISC1", 1, SPEED)),
        step(dt, round(0.55 * (count - 1) / dt), card(f"STICKSLIP, {settings}") if settings else ""),
    ]
    write_deck(folder, "discs.inp", cards)
