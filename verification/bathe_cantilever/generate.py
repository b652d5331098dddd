"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import dead, prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402


PERIOD = 5.651e-3
"""T1 of small vibrations."""


def write(folder: Path, load: float, nx: int, ny: int, steps: int = 0) -> None:
    """A cantilever under a dead load p along its length; `steps` in T1, or 0 for a static step."""
    beam = rectangle("BEAM", "CPS8", (nx, ny), (10.0, 1.0))
    loads = dead("TOP", load / 2, 0.0, -1.0) + dead("BOTTOM", load / 2, 0.0, -1.0) + prints("END")
    cards = [
        card("HEADING", ("cantilever under a uniform load",)),
        beam.cards(),
        beam.nset("HELD", "left"),
        card("NSET, NSET=END", (beam.node(2 * nx, ny),)),
        beam.surface("TOP", "top"),
        beam.surface("BOTTOM", "bottom"),
        elastic(1.2e4, 0.2, 1e-6, "BEAM"),
        card("BOUNDARY", ("HELD", 1, 2)),
        step(PERIOD / steps, steps, loads) if steps else static(loads, dt=0.1),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cantilever.inp").write_text("".join(cards))
