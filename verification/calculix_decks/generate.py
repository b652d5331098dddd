"""Writes the decks of the case: `write(folder, ...)`."""

import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, prints, rectangle, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


def sections(block: Block, thickness: Sequence[float]) -> str:
    """The material and a section for each element."""
    steel = card("MATERIAL, NAME=STEEL") + card("ELASTIC", (210000.0, 0.3)) + card("DENSITY", (1.0,))
    for k, value in enumerate(thickness):
        steel += card(f"ELSET, ELSET=E{k + 1}", (block.first_element + k,))
        steel += card(f"SOLID SECTION, ELSET=E{k + 1}, MATERIAL=STEEL", (value,))
    return steel


def plate(kind: str, thickness: Sequence[float], load: float) -> list[str]:
    """A square of 1 x 1, pulled at its right by `load` on each length."""
    cells = 1 if len(thickness) == 1 else 2
    block = rectangle("PLATE", kind, (cells, cells), (1.0, 1.0))
    return [
        block.cards(),
        sections(block, thickness),
        block.nset("LEFT", "left"),
        block.surface("RIGHT", "right"),
        card("NSET, NSET=CORNER", (block.on("right")[-1],)),
        card("BOUNDARY", ("LEFT", 1, 1), (block.node(0, cells if cells == 2 else 0), 2, 2)),
        static(card("DSLOAD", ("RIGHT", "P", -load)), prints("CORNER")),
    ]


def write(folder: Path, deck: str, scale: float = 1.0) -> None:
    """The model of a deck of CalculiX, its loads times `scale`."""
    if deck == "planestrain":
        cards = plate("CPE4", (0.01,), 100.0 * scale)
    elif deck == "planestrain2":
        cards = plate("CPE8", (0.01,), 100.0 * scale)
    elif deck == "planestress":
        cards = plate("CPS8R", (0.01,) * 4, 100.0 * scale)
    elif deck == "planestress2":
        cards = plate("CPS8R", (0.01, 0.03, 0.02, 0.04), 100.0 * scale)
    elif deck == "planestress3":
        block = rectangle("PLATE", "CPS4", (2, 2), (20.0, 10.0))
        middle = block.node(2, 2)
        around = {node for side in ("bottom", "right", "top", "left") for node in block.on(side)}
        cards = [
            block.cards(),
            elastic(9100.0, 0.3, 1.0, "PLATE", thickness=0.1),
            card("NSET, NSET=CORNER", (middle,)),
            card("BOUNDARY", *((node, 1, 2) for node in sorted(around))),
            static(card("CLOAD", (middle, 1, 86.60254038 * scale), (middle, 2, 50.0 * scale)), prints("CORNER")),
        ]
    else:
        block = rectangle("DISC", "CAX6", (8, 2), (8.0, 1.0))
        corner = block.node(0, 0)
        cards = [
            block.cards(),
            card("MATERIAL, NAME=STEEL") + card("ELASTIC", (210000.0, 0.3)) + card("DENSITY", (1.0,)),
            card("SOLID SECTION, ELSET=DISC, MATERIAL=STEEL"),
            card("NSET, NSET=CORNER", (block.node(0, 2 * block.ny),)),
            card("NSET, NSET=RIM", (block.node(2 * block.nx, 2 * block.ny),)),
            card("NSET, NSET=LOADED", (block.node(2 * block.nx, 0),)),
            card("BOUNDARY", (corner, 1, 2), (block.node(0, 2 * block.ny), 1, 1)),
            static(card("CLOAD", (block.node(2 * block.nx, 0), 2, scale)), prints("CORNER", "RIM", "LOADED")),
        ]
    write_deck(folder, "model.inp", [card("HEADING", (f"after CalculiX {deck}",)), *cards])
