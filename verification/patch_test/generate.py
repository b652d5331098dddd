"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic  # noqa: E402


CORNERS = [(0.0, 0.0), (0.24, 0.0), (0.24, 0.12), (0.0, 0.12), (0.04, 0.02), (0.18, 0.03), (0.16, 0.08), (0.08, 0.08)]
QUADS = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
GRADIENT = ((0.2, 0.3), (0.1, -0.1))
"""Of the displacement."""


def write(folder: Path, kind: str) -> None:
    """Five quadrilaterals, or ten triangles, whose outer nodes follow an affine motion."""
    nodes = int(kind.rstrip("RIH")[-1])
    cells = QUADS if nodes in (4, 8) else [cut for a, b, c, d in QUADS for cut in ((a, b, c), (a, c, d))]
    places, middles, elements = list(CORNERS), {}, []
    for cell in cells:
        row = list(cell)
        for a, b in zip(cell, cell[1:] + cell[:1]) if nodes in (6, 8) else ():
            key = frozenset((a, b))
            if key not in middles:
                middles[key] = len(places)
                places.append(tuple((p + q) / 2 for p, q in zip(CORNERS[a], CORNERS[b])))
            row.append(middles[key])
        elements.append(row)
    outer = [k for k, (x, y) in enumerate(places) if x in (0.0, 0.24) or y in (0.0, 0.12)]
    moved = [
        (k + 1, d + 1, d + 1, GRADIENT[d][0] * places[k][0] + GRADIENT[d][1] * places[k][1]) for k in outer for d in (0, 1)
    ]
    cards = [
        card("HEADING", ("patch test",)),
        card("NODE", *((k + 1, *place) for k, place in enumerate(places))),
        card(f"ELEMENT, TYPE={kind}, ELSET=PATCH", *((k + 1, *(n + 1 for n in row)) for k, row in enumerate(elements))),
        card("NSET, NSET=INNER", *((k + 1,) for k in range(len(places)) if k not in outer)),
        elastic(1000.0, 0.3, 1.0, "PATCH"),
        static(card("BOUNDARY", *moved), dt=0.25),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "patch.inp").write_text("".join(cards))
