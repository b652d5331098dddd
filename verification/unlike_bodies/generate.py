"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import cos, radians, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import Block, rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, step  # noqa: E402

LAWS = {
    "kirchhoff": card("ELASTIC", (1000.0, 0.3)),
    "neo-hooke": card("HYPERELASTIC, NEO HOOKE", (192.0, 2.4e-3)),
    "mooney": card("HYPERELASTIC, MOONEY-RIVLIN", (150.0, 42.0, 2.4e-3)),
    "yeoh": card("HYPERELASTIC, YEOH", (192.0, -10.0, 5.0, 2.4e-3, 2.4e-3, 2.4e-3)),
    "plastic": card("ELASTIC", (1000.0, 0.3)) + card("PLASTIC", (10.0, 0.0), (20.0, 0.1)),
    "kinematic": card("ELASTIC", (1000.0, 0.3)) + card("PLASTIC, HARDENING=KINEMATIC", (10.0, 0.0), (20.0, 0.1)),
}
OTHERS = dict(zip(LAWS, (*list(LAWS)[4:], *list(LAWS)[:4])))
"""The law of the lower body for that of the upper one."""
SLOPE = 8.0
"""Angle of the lower side of the upper body, in degrees."""
DT, INCREMENTS = 0.01, 60


def write(folder: Path, kinds: str, law: str, scheme: str) -> None:
    """A body falls on another at rest: `kinds` are the types of the elements of both, upper-lower."""
    upper_kind, lower_kind = kinds.split("-")
    is_round = upper_kind.startswith("CAX")
    lower = rectangle("LOWER", lower_kind, (4, 2), (2.0, 1.0))
    left, width, height = (0.0 if is_round else 0.3), 1.3, 1.2
    s, c = sin(radians(SLOPE)), cos(radians(SLOPE))

    def place(i: int, j: int) -> tuple[float, float]:
        x, y = width * i / 6, height * j / 6
        if is_round:
            return left + x, 1.02 + y + s * x
        return left + c * x - s * y, 1.02 + s * x + c * y

    upper = Block("UPPER", upper_kind, 3, 3, place, lower)
    axis = [node for body in (lower, upper) for node in body.on("left")]
    cards = [
        card("HEADING", ("two unlike bodies",)),
        lower.cards(),
        upper.cards(),
        card("MATERIAL, NAME=A") + LAWS[law] + card("DENSITY", (1.0,)),
        card("MATERIAL, NAME=B") + LAWS[OTHERS[law]] + card("DENSITY", (1.0,)),
        *(
            card(f"SOLID SECTION, ELSET={body}, MATERIAL={material}", *(() if is_round else ((1.0,),)))
            for body, material in (("UPPER", "A"), ("LOWER", "B"))
        ),
        dry(0.3),
        card("CONTACT"),
        card("CONTACT INCLUSIONS, ALL EXTERIOR"),
        card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
        card("BOUNDARY", *((node, 1, 1) for node in axis)) if is_round else "",
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *(() if is_round else (("UPPER", 1, 1.0),)), ("UPPER", 2, -1.0)),
        step(DT, INCREMENTS, card(f"STICKSLIP, SCHEME={scheme}")),
    ]
    write_deck(folder, "bodies.inp", cards)
