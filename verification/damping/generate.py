"""Writes the decks of the bar that vibrates freely in its first mode: `generate.py [-o FOLDER]`."""

import sys
from math import pi, sin, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, elastic, step, write_to_folder  # noqa: E402

YOUNG = 1000.0
DENSITY = 1.0
LENGTH, DEPTH, THICKNESS = 10.0, 1.0, 1.0
ELEMENTS = 20
SPEED = 1e-4
"""Speed of the free end at the start: the strains are below 1e-5."""

OMEGA = 0.5 * pi * sqrt(YOUNG / DENSITY) / LENGTH
"""Frequency of the first mode, sin(pi x/(2 L)), of a bar held at one end."""
PERIOD = 2 * pi / OMEGA
RATIO = 0.05
"""Damping ratio of the first mode in all decks."""
DT = PERIOD / 100
PERIODS = 6

INCLUDE = "bar_mode.inc"
DAMPING = {
    "alpha": {"alpha": 2 * RATIO * OMEGA},
    "beta": {"beta": 2 * RATIO / OMEGA},
    "both": {"alpha": RATIO * OMEGA, "beta": RATIO / OMEGA},
}
SCHEMES = {"em": "SCHEME=ENERGY-MOMENTUM", "ss22": "SCHEME=SS22, THETA1=0.5, THETA2=0.5"}


def model() -> str:
    """Everything but the material and the step."""
    bar = Grid("BAR", ELEMENTS, 1, lambda i, j: (LENGTH * i / ELEMENTS, DEPTH * j))
    speeds = [
        (bar.node(i, j), 1, SPEED * sin(0.5 * pi * i / ELEMENTS))
        for j in range(2)
        for i in range(1, ELEMENTS + 1)
    ]
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            bar.mesh("CPS4"),
            bar.side_nodes("HELD", "left"),
            bar.side_nodes("END", "right"),
            card("BOUNDARY", ("HELD", 1, 1), ("BAR", 2, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *speeds),
        ]
    )


def problem(scheme: str, kind: str) -> str:
    """A deck: heading, include, material, step."""
    increments = round(PERIODS * PERIOD / DT)
    settings = card(f"STICKSLIP, {SCHEMES[scheme]}")
    return "".join(
        [
            card("HEADING", (f"first mode of a bar; {scheme}, damping by {kind}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            elastic(YOUNG, 0.0, DENSITY, "BAR", thickness=THICKNESS, **DAMPING[kind]),
            step(DT, increments, settings, card("NODE PRINT, NSET=END", ("U", "V"))),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for scheme in SCHEMES:
        for kind in DAMPING:
            (folder / f"bar_mode_{scheme}_{kind}.inp").write_text(problem(scheme, kind))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
