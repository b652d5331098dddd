"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from math import pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import follower, prints, rectangle, static, write_deck  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402

LENGTH, DURATION, PRESSURE, FRICTION = 1.0, 1.0, 1e-6, 0.5
"""Of each column; of the pulse; E = 2, nu = 0, rho = 1: the shear wave has the speed 1 and the impedance 1."""


def write(folder: Path, n: int, share: float = 2.0, settings: str = "") -> None:
    """Two columns, pressed; a half sine of shear of `share` mu p runs up; `n` elements along each."""
    size = LENGTH / n
    lower = rectangle("LOWER", "CPE4", (1, n), (size, LENGTH))
    upper = rectangle("UPPER", "CPE4", (1, n), (size, LENGTH), (0.0, LENGTH), lower)
    pairs = [(b.on("left")[k], b.on("right")[k]) for b in (lower, upper) for k in range(n + 1)]
    count = 4 * n
    table = [(k / 400, sin(pi * k / 400)) for k in range(400)] + [(1.0, 0.0)] + [(10.0, 0.0)]
    rows = [table[k : k + 4] for k in range(0, len(table), 4)]
    cards = [
        card("HEADING", ("a pulse of shear through an interface with friction",)),
        lower.cards(),
        upper.cards(),
        lower.surface("FOOT", "bottom"),
        lower.surface("BELOW", "top"),
        upper.surface("ABOVE", "bottom"),
        upper.surface("HEAD", "top"),
        lower.nset("BASE", "bottom"),
        lower.nset("FACE_BELOW", "top"),
        upper.nset("FACE_ABOVE", "bottom"),
        *(card("EQUATION", (2,), (b, d, 1.0, a, d, -1.0)) for a, b in pairs for d in (1, 2)),
        elastic(2.0, 0.0, 1.0, "LOWER", "UPPER"),
        dry(FRICTION),
        card("CONTACT PAIR, INTERACTION=DRY", ("ABOVE", "BELOW")),
        card("BOUNDARY", (lower.on("bottom")[0], 2, 2)),
        card("AMPLITUDE, NAME=PULSE", *([x for pair in row for x in pair] for row in rows)),
        static(
            card(f"STICKSLIP, {settings}") if settings else "",
            card("BOUNDARY", (lower.on("bottom")[0], 1, 1)),
            follower("HEAD", PRESSURE),
        ),
        step(
            size / 2,
            count,
            card("BOUNDARY, OP=NEW", (lower.on("bottom")[0], 2, 2)),
            card("DSLOAD, AMPLITUDE=PULSE, FOLLOWER=NO", ("FOOT", "TRVEC", share * FRICTION * PRESSURE, 1.0, 0.0)),
            prints("FACE_BELOW", "FACE_ABOVE"),
        ),
    ]
    write_deck(folder, "pulse.inp", cards)
