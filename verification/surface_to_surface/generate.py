"""Writes the decks of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import rectangle  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, material  # noqa: E402

from form import load

flat = load(Path(__file__).resolve().parents[1] / "static_contact" / "generate.py")

HARD, SOFT = 10_000.0, 1000.0
"""Young's moduli of the slider and the foundation."""
LENGTH, DEPTH, WIDTH, RADIUS = 6.0, 1.5, 2.0, 2.0
"""Of the foundation, and width of the slider and radius at the vertex of its parabola."""
PRESS, WAY = 0.12, 2.0


def write(folder: Path, what: str, **parameters: object) -> None:
    """Cylinders that touch, a slider on a foundation, or two blocks."""
    text = {"hertz": hertz, "ironing": ironing, "blocks": blocks}[what](**parameters)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{what}.inp").write_text(text)


def pair(kind: str, slave: str, master: str) -> str:
    """A contact pair of a discretisation."""
    return card(f"CONTACT PAIR, INTERACTION=DRY, TYPE={kind}", (slave, master))


def hertz(upper: float, lower: float, kind: str) -> str:
    """Two like cylinders, so many elements in the half width of Hertz' contact on each."""
    above = flat.cylinder("UPPER", flat.HALF_WIDTH / upper, half=False)
    below = flat.cylinder("LOWER", flat.HALF_WIDTH / lower, half=False, below=True, **flat.after(above))
    middle = above.node(above.nx // 2, 0)
    return "".join(
        [
            card("HEADING", ("two like cylinders of unlike mesh",)),
            above.mesh("CPE4"),
            below.mesh("CPE4"),
            above.side_surface("FOOT", "bottom"),
            below.side_surface("GROUND", "top"),
            below.side_nodes("BASE", "bottom"),
            above.side_nodes("NFOOT", "bottom"),
            below.side_nodes("NGROUND", "top"),
            card("NSET, NSET=MIDDLE", (middle,)),
            flat.guided(above, 1, 2),
            flat.elastic(flat.YOUNG, flat.POISSON, 1.0, "UPPER", "LOWER"),
            dry(0.0),
            pair(kind, "FOOT", "GROUND"),
            card("BOUNDARY", ("BASE", 1, 2), ("HEAD", 1, 1)),
            flat.static(card("CLOAD", ("HEAD", 2, -flat.PRESS)), dt=0.25, direct=True),
        ]
    )


def ironing(slider: int, foundation: int, slave: str, friction: float, kind: str) -> str:
    """A parabolic slider, so many elements wide, is pressed into a foundation of so many elements and drawn along."""
    ground = rectangle("GROUND", "CPE4", (foundation, foundation // 4), (LENGTH, DEPTH))
    tool = rectangle("TOOL", "CPE4", (slider, max(slider // 2, 2)), (WIDTH, 1.0), (1.0, DEPTH), ground)
    flat_place = tool.place

    def place(i: int, j: int) -> tuple[float, float]:
        x, y = flat_place(i, j)
        sag = (x - 1.0 - WIDTH / 2.0) ** 2 / (2.0 * RADIUS)
        return x, y + sag * (1.0 - (y - DEPTH))

    tool.place = place
    both = {"slider": ("SOLE", "TOP"), "foundation": ("TOP", "SOLE")}
    sections = "".join(
        material(name, young, 0.3, 1.0) + card(f"SOLID SECTION, ELSET={body}, MATERIAL={name}", (1.0,))
        for name, young, body in (("HARD", HARD, "TOOL"), ("SOFT", SOFT, "GROUND"))
    )
    return "".join(
        [
            card("HEADING", ("a parabolic slider on a foundation",)),
            ground.cards(),
            tool.cards(),
            ground.nset("BASE", "bottom"),
            tool.nset("HEAD", "top"),
            ground.surface("TOP", "top"),
            tool.surface("SOLE", "bottom"),
            sections,
            dry(friction),
            pair(kind, *both[slave]),
            card("BOUNDARY", ("BASE", 1, 2)),
            flat.static(card("BOUNDARY", ("HEAD", 1, 1, 0.0), ("HEAD", 2, 2, -PRESS)), dt=0.125, direct=True),
            flat.static(card("BOUNDARY", ("HEAD", 1, 1, WAY), ("HEAD", 2, 2, -PRESS)), dt=1 / 160, direct=True),
        ]
    )


def blocks(count: int, friction: float, scheme: str, kind: str) -> str:
    """Two blocks, the upper one with so many elements along the interface and the lower one with 1.4 times as many,
    pressed and sheared in dynamic increments."""
    lower = round(1.4 * count)
    below = rectangle("BELOW", "CPE4", (lower, lower // 2), (1.0, 0.5))
    above = rectangle("ABOVE", "CPE4", (count, count // 2), (1.0, 0.5), (0.1, 0.5), below)
    return "".join(
        [
            card("HEADING", ("two blocks of unlike mesh",)),
            below.cards(),
            above.cards(),
            below.nset("BASE", "bottom"),
            above.nset("HEAD", "top"),
            above.surface("SOLE", "bottom"),
            below.surface("GROUND", "top"),
            flat.elastic(HARD, 0.3, 1.0, "BELOW", "ABOVE"),
            dry(friction),
            pair(kind, "SOLE", "GROUND"),
            card("BOUNDARY", ("BASE", 1, 2)),
            card("AMPLITUDE, NAME=PRESS", (0.0, 0.0, 0.1, 1.0, 1.0, 1.0)),
            card("AMPLITUDE, NAME=SHEAR", (0.0, 0.0, 0.1, 0.0, 0.2, 1.0)),
            card("STEP, NLGEOM"),
            card("DYNAMIC, DIRECT", (0.01, 0.2)),
            card(f"STICKSLIP, SCHEME={scheme}"),
            card("BOUNDARY, AMPLITUDE=PRESS", ("HEAD", 2, 2, -0.01)),
            card("BOUNDARY, AMPLITUDE=SHEAR", ("HEAD", 1, 1, 0.02)),
            card("END STEP"),
        ]
    )
