"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import rectangle, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, step  # noqa: E402

LAWS = {
    "kirchhoff": card("ELASTIC", (1e4, 0.3)),
    "neo-hooke": card("HYPERELASTIC, NEO HOOKE", (1923.0, 2.4e-4)),
    "mooney": card("HYPERELASTIC, MOONEY-RIVLIN", (1500.0, 423.0, 2.4e-4)),
    "yeoh": card("HYPERELASTIC, YEOH", (1923.0, -100.0, 50.0, 2.4e-4, 2.4e-4, 2.4e-4)),
    "ogden": card("HYPERELASTIC, OGDEN, N=3", (3500.0, 1.3, 20.0, 5.0, 326.0, -2.0, 2.4e-4, 0.0), (2.4e-4,)),
    "plastic": card("ELASTIC", (1e4, 0.3)) + card("PLASTIC", (10.0, 0.0), (20.0, 0.1)),
    "kinematic": card("ELASTIC", (1e4, 0.3)) + card("PLASTIC, HARDENING=KINEMATIC", (10.0, 0.0), (20.0, 0.1)),
}


def write(folder: Path, kind: str, law: str = "kirchhoff", dt: float = 0.01) -> None:
    """A bar of 10 x 1 flies, turns once in 6.3, and vibrates; bodies of revolution fly along the axis."""
    round_body = kind.startswith("CAX")
    bar = rectangle("BAR", kind, (2, 10) if round_body else (10, 2), (1.0, 10.0) if round_body else (10.0, 1.0))
    speeds = []
    for j in range(2 * bar.ny + 1):
        for i in range(2 * bar.nx + 1):
            x, y = bar.place(i, j)
            node = bar.node(i, j)
            if bar.quadratic and i % 2 and j % 2 and not bar.cut or not bar.quadratic and (i % 2 or j % 2):
                continue
            stretch = 0.5 * (y - 5.0) if round_body else 0.1 * (x - 5.0)
            if not round_body:
                speeds.append((node, 1, 1.0 - (y - 0.5) + stretch))
            speeds.append((node, 2, 2.0 + stretch if round_body else 2.0 + (x - 5.0)))
    cards = [
        card("HEADING", ("free flight",)),
        bar.cards(),
        card("MATERIAL, NAME=ONE") + LAWS[law] + card("DENSITY", (1.0,)),
        card("SOLID SECTION, ELSET=BAR, MATERIAL=ONE", *(() if round_body else ((1.0,),))),
        card("BOUNDARY", *((node, 1, 1) for node in bar.on("left"))) if round_body else "",
        card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
        step(dt, round(2.0 / dt)),
    ]
    write_deck(folder, "flight.inp", cards)
