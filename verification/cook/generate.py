"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, dead, prints, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


def write(folder: Path, kind: str, n: int, force: float = 1e-4, poisson: float = 1 / 3) -> None:
    """The membrane of n x n cells; a small force gives the linear answer."""

    def place(i: int, j: int) -> tuple[float, float]:
        u, v = i / (2 * n), j / (2 * n)
        return 48 * u, 44 * u + v * (44 - 28 * u)

    membrane = Block("MEMBRANE", kind, n, n, place)
    cards = [
        card("HEADING", ("Cook's membrane",)),
        membrane.cards(),
        membrane.nset("HELD", "left"),
        card("NSET, NSET=MIDDLE", (membrane.node(2 * n, n),)),
        membrane.surface("END", "right"),
        elastic(1.0, poisson, 1.0, "MEMBRANE"),
        card("BOUNDARY", ("HELD", 1, 2)),
        static(dead("END", force / 16, 0.0, 1.0), prints("MIDDLE"), dt=0.25 if force > 0.1 else 1.0),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cook.inp").write_text("".join(cards))
