"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, dead, prints, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


FORCE = 1e-4


def write(folder: Path, kind: str, shape: str, n: int) -> None:
    """A clamped beam of `n` cells: rectangles, or with sides of 45 degrees."""
    length, height = 6.0, 0.2
    lean = {"rectangles": (0, 0), "parallelograms": (1, 1), "trapezoids": (1, -1)}[shape]

    def line(k: int) -> float:
        return 0.0 if k in (0, n) else lean[k % 2] * min(1.0, 6 / n)

    def place(i: int, j: int) -> tuple[float, float]:
        up = height * (j / 2 - 0.5)
        leaning = line(i // 2) if i % 2 == 0 else (line(i // 2) + line(i // 2 + 1)) / 2
        return length * i / (2 * n) + leaning * up, up

    beam = Block("BEAM", kind, n, 1, place)
    cards = [
        card("HEADING", ("slender beam of MacNeal and Harder",)),
        beam.cards(),
        beam.nset("HELD", "left"),
        beam.nset("END", "right"),
        beam.surface("TIP", "right"),
        elastic(1e7, 0.3, 1.0, "BEAM", thickness=0.1),
        card("BOUNDARY", ("HELD", 1, 2)),
        static(dead("TIP", FORCE / (0.1 * height), 0.0, -1.0), prints("END")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "slender.inp").write_text("".join(cards))
