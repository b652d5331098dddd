"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import Grid, card, dry, elastic  # noqa: E402

STONES, RADIUS, THICKNESS = 10, 10.0, 1.6
"""Of the arch: half a ring of so many stones, its mean radius and its thickness."""

CELLS = 4, 4
"""Elements along and through a stone."""

YOUNG, GRAVITY, FRICTION = 1e9, 10.0, 0.8
"""Stones that are all but rigid and do not slide."""

SPREAD, INCREMENTS = 0.02, 20
"""Way of one abutment, in so many increments."""


def stone(number: int, first_node: int, first_element: int) -> Grid:
    """A stone; the first one stands on the right abutment."""
    along, through = CELLS
    start, end = (pi * k / STONES for k in (number, number + 1))

    def place(i: int, j: int) -> tuple[float, float]:
        radius = RADIUS + THICKNESS * (j / through - 0.5)
        angle = end - (end - start) * i / along
        return radius * cos(angle), radius * sin(angle)

    return Grid(f"STONE{number}", along, through, place, first_node, first_element)


def write(folder: Path, contact: str = "") -> None:
    """An arch under its weight, whose right abutment goes outward; `contact` is the discretisation that general contact is asked for."""
    parts: list[Grid] = []
    labels = 1, 1
    for number in range(STONES):
        parts.append(stone(number, *labels))
        labels = parts[-1].next_node, parts[-1].next_element
    abutments = []
    for name, middle in (("RIGHT", RADIUS), ("LEFT", -RADIUS)):
        left = middle - 0.8 * THICKNESS
        base = Grid(name, 4, 1, lambda i, j, left=left: (left + 0.4 * THICKNESS * i, 0.5 * (j - 1)), *labels)
        abutments.append(base)
        labels = base.next_node, base.next_element
    nodes = {name: labels[0] + k for k, name in enumerate(("RIGHT", "LEFT"))}
    gravity = card("DLOAD", ("STONES", "GRAV", GRAVITY, 0.0, -1.0))
    spread = card("BOUNDARY", ("NRIGHT", 1, 1, SPREAD))
    cards = [
        card("HEADING", ("a masonry arch whose abutments spread",)),
        *(part.mesh("CPE4") for part in (*parts, *abutments)),
        card("ELSET, ELSET=STONES, GENERATE", (1, parts[-1].next_element - 1, 1)),
        elastic(YOUNG, 0.2, 1.0, "STONES", "RIGHT", "LEFT"),
        *(card(f"NODE, NSET=N{name}", (node, 0.0, -1.0)) for name, node in nodes.items()),
        *(card(f"RIGID BODY, ELSET={name}, REF NODE={node}") for name, node in nodes.items()),
        dry(FRICTION),
        card("CONTACT"),
        card("CONTACT INCLUSIONS, ALL EXTERIOR"),
        card(f"CONTACT FORMULATION, TYPE={contact}") if contact else "",
        card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
        card("BOUNDARY", *((f"N{name}", dof, dof) for name in nodes for dof in (1, 2, 6))),
        static(gravity, prints("NRIGHT"), dt=0.1),
        static(spread, prints("NRIGHT"), dt=1.0 / INCREMENTS),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "arch.inp").write_text("".join(cards))
