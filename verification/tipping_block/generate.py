"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, plane, prints, rectangle, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402

BASE, HEIGHT = 1.0, 2.0
"""Of the block."""

YOUNG, GRAVITY = 1e11, 10.0
"""A block that is all but rigid: the force of gravity per area is 1e-10 of the modulus."""

STROKE, INCREMENTS = 5e-4, 20
"""Way of the node that is pushed, in so many increments."""

PITCH = 1.5
"""Distance of several blocks."""


def write(
    folder: Path,
    elements: int = 1,
    kind: str = "CPE4",
    floor: str = "rigid",
    friction: float = 1.0,
    contact: str = "SURFACE TO SURFACE",
    blocks: int = 1,
) -> None:
    """Blocks on a rigid floor or an elastic one, pushed at one corner of their tops.

    `elements` in the base of each. `contact` is the discretisation of pairs, or GENERAL.
    """
    height = max(1, round(elements * HEIGHT / BASE))
    bodies: list[Block] = []
    for k in range(blocks):
        corner = (k * PITCH, 0.0)
        before = bodies[-1] if bodies else None
        bodies.append(rectangle(f"B{k}", kind, (elements, height), (BASE, HEIGHT), corner, before))
    ends = -1.0, (blocks - 1) * PITCH + BASE + 1.0
    if floor == "rigid":
        ground, held, grounds = plane("GROUND", (ends[0], 0.0), (ends[1], 0.0)), "REFERENCE", []
    else:
        # longer elements than those of the blocks, whose corners lie between the nodes
        cells = round((ends[1] - ends[0]) * elements / (0.6 * BASE))
        body = rectangle("FLOOR", kind, (cells, 1), (ends[1] - ends[0], 0.5), (ends[0], -0.5), bodies[-1])
        ground = body.cards() + body.surface("GROUND", "top") + body.nset("BED", "bottom")
        held, grounds = "BED", ["FLOOR"]
    names = [body.name for body in bodies]
    tops = [body.on("top")[0] for body in bodies]
    pushed = [f"P{k}" for k in range(blocks)]
    pairs = [(f"{name}_FOOT", "GROUND") for name in names]
    if contact == "GENERAL":
        touch = (
            card("CONTACT")
            + card("CONTACT INCLUSIONS, ALL EXTERIOR")
            + card("CONTACT FORMULATION, TYPE=SURFACE TO SURFACE")
            + card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY"))
        )
    else:
        touch = card(f"CONTACT PAIR, INTERACTION=DRY, TYPE={contact}", *pairs)
    push = card("BOUNDARY", *((name, 1, 1, STROKE) for name in pushed))
    cards = [
        card("HEADING", ("a block that is tipped over",)),
        *(body.cards() for body in bodies),
        *(body.surface(f"{body.name}_FOOT", "bottom") for body in bodies),
        *(card(f"NSET, NSET={name}", (node,)) for name, node in zip(pushed, tops, strict=True)),
        ground,
        elastic(YOUNG, 0.3, 1.0, *names, *grounds),
        dry(friction),
        touch,
        card("BOUNDARY", (held, 1, 2), *((name, 1, 1) for name in pushed)),
        static(card("DLOAD", *((name, "GRAV", GRAVITY, 0.0, -1.0) for name in names)), prints(*pushed)),
        static(push, prints(*pushed), dt=1.0 / INCREMENTS, direct=True),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tipping.inp").write_text("".join(cards))
