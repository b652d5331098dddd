"""Writes the decks of heated bodies: `write(folder, problem, ...)`."""

import sys
from collections.abc import Callable
from math import cos, log, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from meshes import Block, mapped, prints, rectangle, static, write_deck  # noqa: E402  (finds python/)
from stickslip.decks import card, step  # noqa: E402

YOUNG, POISSON, DENSITY, EXPANSION = 1000.0, 0.3, 1e-3, 1e-4
YIELD = 0.5
"""Of the metal."""

LAWS = {
    "kirchhoff": card("ELASTIC", (YOUNG, POISSON)),
    "hencky": card("ELASTIC, TYPE=HENCKY", (YOUNG, POISSON)),
    "neo-hooke": card("HYPERELASTIC, NEO HOOKE", (192.3, 2.4e-3)),
    "mooney": card("HYPERELASTIC, MOONEY-RIVLIN", (150.0, 42.3, 2.4e-3)),
    "ogden": card("HYPERELASTIC, OGDEN", (350.0, 1.3, 2.4e-3)),
    "plastic": card("ELASTIC", (YOUNG, POISSON)) + card("PLASTIC", (YIELD, 0.0), (2 * YIELD, 0.01)),
}

COLD, HOT = 20.0, 120.0
"""Initial temperature, and the highest."""

STRIP = {"length": 20.0, "lower": 0.6, "upper": 0.4, "stiffer": 2.0, "expansion": 3e-5}
"""Length and thicknesses of the layers of the bimetal; what the upper one has of E of the lower one, its expansion."""

RINGS = {"radius": 1.0, "rim": 2.0}
"""Radius of the shaft, outer radius of the hub."""

PIPE = (1.0, 2.0)
"""Inner and outer radius of the pipe."""

BLOCK = {"friction": 0.4, "load": 6.0, "spring": 50.0, "cold": 70.0}
"""Friction at the walls, load along them, spring of the block, temperature of the cold half of each cycle."""

BAR = {"length": 10.0, "thickness": 0.05, "pressure": 0.01, "friction": 0.3}
"""Half of a bar on a rough plane, on which a pressure lies."""


def material(law: str = "kirchhoff", expansion: float = EXPANSION, name: str = "ONE") -> str:
    """A material that expands."""
    return "".join(
        [card(f"MATERIAL, NAME={name}"), LAWS[law], card("DENSITY", (DENSITY,)), card("EXPANSION", (expansion,))]
    )


def section(block: Block, name: str = "ONE", thickness: float = 1.0) -> str:
    """The section of a block; rings have no thickness."""
    rows = () if block.kind.startswith("CAX") else ((thickness,),)
    return card(f"SOLID SECTION, ELSET={block.name}, MATERIAL={name}", *rows)


def at_start(*names: str) -> str:
    """All nodes of blocks at the initial temperature."""
    return card("INITIAL CONDITIONS, TYPE=TEMPERATURE", *((name, COLD) for name in names))


def free(kind: str, law: str = "kirchhoff") -> list[str]:
    """A distorted block that may expand: its lower left corner stays, and the lower side on its line."""
    left = 1.0 if kind.startswith("CAX") else 0.0

    def shape(x: float, y: float) -> tuple[float, float]:
        return left + x + 0.05 * sin(pi * x) * sin(2 * pi * y), y + 0.06 * sin(2 * pi * x) * sin(pi * y)

    block = mapped("BODY", kind, (0.0, 0.3, 0.7, 1.0), (0.0, 0.4, 0.6, 1.0), shape)
    corner = () if kind.startswith("CAX") else ((block.node(0, 0), 1, 1),)
    return [
        block.cards(), material(law), section(block), at_start("BODY"),
        card("BOUNDARY", *corner, *((node, 2, 2) for node in block.on("bottom"))),
        static(card("TEMPERATURE", ("BODY", HOT)), dt=0.25, direct=True),
    ]


def clamped(kind: str = "CPS4", law: str = "kirchhoff") -> list[str]:
    """A bar between two walls that lets its sides move."""
    bar = rectangle("BODY", kind, (4, 1), (4.0, 1.0))
    ends = [(node, 1, 1) for side in ("left", "right") for node in bar.on(side)]
    return [
        bar.cards(), bar.nset("END", "right"), material(law), section(bar), at_start("BODY"),
        card("BOUNDARY", *ends, *((node, 2, 2) for node in bar.on("bottom"))),
        static(card("TEMPERATURE", ("BODY", HOT)), prints("END"), dt=0.25, direct=True),
    ]


def bimetal(cells: int = 40, kind: str = "CPS8") -> list[str]:
    """A strip of two layers, held in the middle of its left end."""
    lower, upper = STRIP["lower"], STRIP["upper"]
    below = rectangle("BELOW", kind, (cells, 3), (STRIP["length"], lower))
    above = rectangle("ABOVE", kind, (cells, 2), (STRIP["length"], upper), (0.0, lower), after=below)
    pairs = zip(above.on("bottom"), below.on("top"), strict=True)
    glued = "".join(
        card("EQUATION", (2,), (slave, i, 1.0, master, i, -1.0)) for slave, master in pairs for i in (1, 2)
    )
    left = [(node, 1, 1) for node in below.on("left")] + [(node, 1, 1) for node in above.on("left")[1:]]
    stiff = card("MATERIAL, NAME=TWO") + card("ELASTIC", (STRIP["stiffer"] * YOUNG, POISSON))
    stiff += card("DENSITY", (DENSITY,)) + card("EXPANSION", (STRIP["expansion"],))
    return [
        below.cards(), above.cards(),
        material(expansion=1e-5), stiff, section(below), section(above, "TWO"), glued, at_start("BELOW", "ABOVE"),
        card("BOUNDARY", *left, (below.node(0, 0), 2, 2)),
        static(card("TEMPERATURE", ("BELOW", HOT), ("ABOVE", HOT)), dt=1.0, direct=True),
    ]


def shrink(cells: int = 16, kind: str = "CPS8", formulation: str = "SURFACE TO SURFACE", friction: float = 0.0) -> list[str]:
    """A hub that is as wide as the shaft when both are hot; it cools down and the shaft with it, which expands less."""
    radius, rim = RINGS["radius"], RINGS["rim"]

    def quarter(name: str, inner: float, outer: float, layers: int, around: int, after: Block | None = None) -> Block:
        radii = [inner + (outer - inner) * k / layers for k in range(layers + 1)]
        angles = [pi / 2 * k / around for k in range(around + 1)]
        return mapped(name, kind, radii, angles, lambda r, t: (r * cos(t), r * sin(t)), after)

    shaft = quarter("SHAFT", 0.5 * radius, radius, cells // 4, cells)
    hub = quarter("HUB", radius, rim, cells // 2, cells, shaft)
    sides = [(node, direction, direction) for body in (shaft, hub)
             for side, direction in (("bottom", 2), ("top", 1)) for node in body.on(side)]
    return [
        shaft.cards(), hub.cards(), shaft.surface("OUTSIDE", "right"), hub.surface("INSIDE", "left"),
        shaft.nset("FACE", "right"),
        material(expansion=0.0), material(name="TWO"), section(shaft), section(hub, "TWO"),
        card("INITIAL CONDITIONS, TYPE=TEMPERATURE", ("SHAFT", HOT), ("HUB", HOT)),
        card("SURFACE SMOOTHING, NAME=CIRCLES", ("OUTSIDE", "INSIDE", "CIRCUMFERENTIAL", 0.0, 0.0)),
        card("SURFACE INTERACTION, NAME=FIT"), card("FRICTION", (friction,)) if friction else "",
        card(f"CONTACT PAIR, INTERACTION=FIT, TYPE={formulation}, GEOMETRIC CORRECTION=CIRCLES", ("OUTSIDE", "INSIDE")),
        card("BOUNDARY", *sides),
        static(card("TEMPERATURE", ("SHAFT", COLD), ("HUB", COLD)), dt=0.5, direct=True),
    ]


def pipe(cells: int = 16, kind: str = "CAX8") -> list[str]:
    """A pipe that is hot inside: the temperature of steady heat flow, T = HOT log(b/r)/log(b/a) above that of the outside."""
    inner, outer = PIPE
    radii = [inner + (outer - inner) * k / cells for k in range(cells + 1)]
    body = mapped("BODY", kind, radii, (0.0, 0.1))
    places = {body.node(i, j): body.place(i, j)[0] for i in range(2 * cells + 1) for j in range(3)}
    used = {node for side in ("bottom", "top") for node in body.on(side)}
    if body.quadratic:
        used |= {body.node(i, 1) for i in range(0, 2 * cells + 1, 2)}
    heat = [(node, COLD + (HOT - COLD) * log(outer / places[node]) / log(outer / inner)) for node in sorted(used)]
    ends = [(node, 2, 2) for side in ("bottom", "top") for node in body.on(side)]
    return [
        body.cards(), material(expansion=1e-6), section(body), at_start("BODY"), card("BOUNDARY", *ends),
        static(card("TEMPERATURE", *heat), dt=1.0, direct=True),
    ]


def walls(cycles: int = 3) -> list[str]:
    """A block of one element that heat presses between two rough walls; its four nodes move along them together, each with a
    load and a spring."""
    block = rectangle("BODY", "CPS4", (1, 1), (1.0, 1.0))
    nodes = (*block.on("left"), *block.on("right"))
    springs = "".join(card(f"ELEMENT, TYPE=SPRING1, ELSET=S{k}", (100 + k, node)) for k, node in enumerate(nodes))
    springs += "".join(card(f"SPRING, ELSET=S{k}", (2,), (BLOCK["spring"],)) for k in range(4))
    law = card("MATERIAL, NAME=ONE") + card("ELASTIC", (YOUNG, 0.0)) + card("DENSITY", (DENSITY,))
    wall = "".join(
        card(f"NODE, NSET={name}", (label, x, 0.0)) + card(f"SURFACE, NAME=W{name}, TYPE=SEGMENTS", ("START", x, a), ("LINE", x, b))
        + card(f"RIGID BODY, ANALYTICAL SURFACE=W{name}, REF NODE={name}")
        for name, label, x, a, b in (("LEFT", 1001, 0.0, 5.0, -5.0), ("RIGHT", 1002, 1.0, -5.0, 5.0))
    )
    return [
        block.cards(), card("NSET, NSET=ALL", *((node,) for node in nodes)), springs, law, card("EXPANSION", (EXPANSION,)),
        section(block), wall, block.surface("L", "left"), block.surface("R", "right"), at_start("BODY"),
        card("SURFACE INTERACTION, NAME=ROUGH"), card("FRICTION", (BLOCK["friction"],)),
        card("CONTACT PAIR, INTERACTION=ROUGH, TYPE=NODE TO SURFACE", ("L", "WLEFT"), ("R", "WRIGHT")),
        card("BOUNDARY", ("LEFT", 1, 6), ("RIGHT", 1, 6)),
        *(card("EQUATION", (2,), (node, 2, 1.0, nodes[0], 2, -1.0)) for node in nodes[1:]),
        card("STEP, NLGEOM"), card("STATIC, DIRECT", (0.25, 1.0)), card("TEMPERATURE", ("BODY", HOT)), card("END STEP"),
        card("STEP, NLGEOM"), card("STATIC, DIRECT", (0.25, 1.0)), card("CLOAD", ("ALL", 2, -BLOCK["load"] / 4)),
        card("END STEP"),
        *(
            "".join([card("STEP, NLGEOM"), card("STATIC, DIRECT", (0.25, 1.0)), card("TEMPERATURE", ("BODY", t)),
                     prints("ALL"), card("END STEP")])
            for _ in range(cycles) for t in (BLOCK["cold"], HOT)
        ),
    ]


def flight(kind: str, law: str = "kirchhoff") -> list[str]:
    """A block that flies and turns while one of its ends is heated and cooled; bodies of revolution fly along the axis."""
    ring = kind.startswith("CAX")
    body = rectangle("BODY", kind, (3, 2), (3.0, 1.0), (1.0 if ring else 0.0, 0.0))
    used = sorted({int(line.split(",")[0]) for line in body.cards().partition("*ELEMENT")[0].splitlines()[1:]})
    places = {body.node(i, j): body.place(i, j) for j in range(5) for i in range(7)}
    speeds = [(node, 2, 2.0 + (0.0 if ring else places[node][0] - 1.5)) for node in used]
    if not ring:
        speeds += [(node, 1, 1.0 - (places[node][1] - 0.5)) for node in used]
    return [
        body.cards(), body.nset("END", "right"), material(law, 1e-3), section(body), at_start("BODY"),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
        card("AMPLITUDE, NAME=PULSE", (0.0, COLD, 0.02, HOT, 0.05, -HOT, 0.08, COLD)),
        step(2e-3, 50, card("TEMPERATURE, AMPLITUDE=PULSE", ("BODY", 1.0), ("END", 1.4))),
    ]


PROBLEMS: dict[str, Callable[..., list[str]]] = {
    "free": free, "clamped": clamped, "bimetal": bimetal, "shrink": shrink, "pipe": pipe, "walls": walls,
    "flight": flight,
}


def write(folder: Path, problem: str, **parameters: float | str) -> None:
    """The deck of a problem."""
    write_deck(folder, f"{problem}.inp", [card("HEADING", (problem,)), *PROBLEMS[problem](**parameters)])
