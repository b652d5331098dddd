"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402


def write(folder: Path, kind: str, n: int) -> None:
    """A bar of `n` cells in its first mode, for half of its period; the increment falls with h, or h^2 if quadratic."""
    bar = rectangle("BAR", kind, (n, 1), (1.0, 0.1))
    count = 2 * n * (n if bar.quadratic else 4)
    line = range(0, 2 * n + 1, 1 if bar.quadratic else 2)
    rows = []
    for i in line:
        for j in (0, 1, 2) if bar.quadratic and i % 2 == 0 else (0, 2):
            rows.append((bar.node(i, j), 1, 1e-7 * sin(pi / 2 * i / (2 * n))))
    cards = [
        card("HEADING", ("first mode of a bar",)),
        bar.cards(),
        bar.nset("HELD", "left"),
        bar.nset("END", "right"),
        elastic(1.0, 0.0, 1.0, "BAR"),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *rows),
        card("BOUNDARY", ("HELD", 1, 2)),
        step(2.0 / count, count, prints("END")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bar_mode.inp").write_text("".join(cards))
