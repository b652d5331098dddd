"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import dead, prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402


def write(folder: Path, nx: int, ny: int, dt: float = 0.0) -> None:
    """Half of a clamped beam with a load in its middle: at once with increments `dt`, or static."""
    height = 0.125
    beam = rectangle("BEAM", "CPS8", (nx, ny), (10.0, height))
    loads = dead("SECTION", 320.0 / height, 0.0, -1.0) + prints("MIDDLE")
    cards = [
        card("HEADING", ("clamped beam under 640 lb",)),
        beam.cards(),
        beam.nset("HELD", "left"),
        beam.nset("SYMMETRY", "right"),
        card("NSET, NSET=MIDDLE", (beam.node(2 * nx, ny),)),
        beam.surface("SECTION", "right"),
        elastic(30e6, 0.0, 2.54e-4, "BEAM"),
        card("BOUNDARY", ("HELD", 1, 2), ("SYMMETRY", 1, 1)),
        step(dt, round(1.5e-3 / dt), loads) if dt else static(loads, dt=0.1),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "clamped.inp").write_text("".join(cards))
