"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import acos, cos, radians, sin, tan
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import mapped, prints, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

ANGLE, SPEED, TORQUE, FIRST, LAST = radians(20.0), 1.0, 10.0, -0.08, 0.08
"""Pressure angle, speed of the pinion, torque on the gear, angles of the pinion at start and end."""


def involute(angle: float) -> float:
    """inv(alpha)."""
    return tan(angle) - angle


def write(folder: Path, n: int, teeth: int = 20, others: int = 30, count: int = 1000, swap: int = 0) -> None:
    """A tooth of a pinion pushes one of a gear, module 1, `n` elements along each flank; the normals turn with them."""
    blocks = []
    for k, (z, low, high) in enumerate(((teeth, 0.4, 0.8), (others, 0.6, 0.6))):
        radius, base = z / 2, z / 2 * cos(ANGLE)
        turn = FIRST - 2e-5 if k == 0 else -FIRST * teeth / others
        radii = [radius - low + (low + high) * i / n for i in range(n + 1)]

        def place(r: float, t: float, z=z, base=base, turn=turn, k=k) -> tuple[float, float]:
            angle = involute(ANGLE) - involute(acos(base / r)) + turn - (0.5 / z) * (1 - t)
            x, y = r * cos(angle), r * sin(angle)
            return (x, y) if k == 0 else ((teeth + others) / 2 - x, -y)

        blocks.append(mapped("PINION" if k == 0 else "GEAR", "CPE4", radii, [0.0, 1.0], place, blocks[-1] if blocks else None))
    pinion, gear = blocks
    period = (LAST - FIRST) / SPEED
    pair = ("FLANK2", "FLANK1") if swap else ("FLANK1", "FLANK2")
    cards = [
        card("HEADING", ("involute teeth",)),
        pinion.cards(),
        gear.cards(),
        pinion.surface("FLANK1", "top"),
        gear.surface("FLANK2", "top"),
        card("NODE, NSET=SHAFT1", (100_000, 0.0, 0.0)),
        card("NODE, NSET=SHAFT2", (100_001, (teeth + others) / 2, 0.0)),
        elastic(1e6, 0.3, 1e-3, "PINION", "GEAR"),
        card("RIGID BODY, ELSET=PINION, REF NODE=SHAFT1"),
        card("RIGID BODY, ELSET=GEAR, REF NODE=SHAFT2"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", pair),
        card("BOUNDARY", ("SHAFT1", 1, 2), ("SHAFT2", 1, 2)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("SHAFT2", 6, -SPEED * teeth / others)),
        step(
            period / count,
            count,
            card("BOUNDARY, TYPE=VELOCITY", ("SHAFT1", 6, 6, SPEED)),
            card("CLOAD", ("SHAFT2", 6, TORQUE)),
            prints("SHAFT1", "SHAFT2"),
        ),
    ]
    write_deck(folder, "gears.inp", cards)
