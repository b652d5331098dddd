"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import dead, prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


def write(folder: Path, load: float, nx: int, ny: int, slender: float = 20.0, kind: str = "CPS8") -> None:
    """A cantilever of the length 10 under the dead load P L^2/(E I) across its end; `slender` is L/h."""
    height, young = 10.0 / slender, 1000.0
    force = load * young * height**3 / 12 / 10.0**2
    beam = rectangle("BEAM", kind, (nx, ny), (10.0, height))
    cards = [
        card("HEADING", (f"cantilever with the dead load P L^2/(E I) = {load}",)),
        beam.cards(),
        beam.nset("HELD", "left"),
        card("NSET, NSET=END", (beam.node(2 * nx, ny),)),
        beam.surface("TIP", "right"),
        elastic(young, 0.0, 1.0, "BEAM"),
        card("BOUNDARY", ("HELD", 1, 2)),
        static(dead("TIP", force / height, 0.0, -1.0), prints("END"), dt=0.1),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "elastica.inp").write_text("".join(cards))
