"""Writes the decks of the brake pad on a spring: `generate.py [-o FOLDER]`."""

import sys
from math import copysign, exp
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, elastic, material, step, write_to_folder  # noqa: E402

LENGTH, LINING, PLATE = 1.0, 0.25, 0.125
"""Length of the pad, heights of lining and back plate."""
PAD = 16, 6
"""Elements along and up, two of them the back plate."""
SOFT, STIFF = (1e6, 0.3, 1.0), (1e7, 0.3, 8.0)
"""Young's modulus, Poisson's ratio and density of lining and slab, and of the back plate."""
BETA = 1e-3
"""Damping of pad and slab, which ends their vibrations and not the motion on the spring."""
SLAB = -1.5, 4.0, 0.25
"""Ends and depth of the slab."""
SLAB_ELEMENTS = 66, 2
SPRING = 100.0
NORMAL = 10.0
AT_REST, SLIDING, DECAY = 0.4, 0.2, 100.0
"""Coefficients of friction, and how fast the first falls to the second with the slip rate."""
SPEED = {"pad_slow": 0.05, "pad_fast": 0.2}
DT, TIME = 2e-3, 4.0

INCLUDE = "pad.inc"
MOVING = LENGTH * (SOFT[2] * LINING + STIFF[2] * PLATE)
"""Mass on the spring."""


def one_mass(speed: float, dt: float = 1e-5) -> list[float]:
    """Displacements of one mass in place of the pad, at every `dt` from 0 to TIME.

    m x'' = -k x + mu(|v - x'|) N sign(v - x') while it slides. It sticks when it has the speed v of the slab, as long as
    mu(0) N can hold the spring.
    """
    x, own, sticks = 0.0, 0.0, False
    places = [x]
    for _ in range(round(TIME / dt)):
        if sticks and SPRING * x > AT_REST * NORMAL:
            own, sticks = speed * (1 - 1e-9), False
        if sticks:
            own = speed
        else:
            slip = speed - own
            friction = SLIDING + (AT_REST - SLIDING) * exp(-DECAY * abs(slip))
            own += dt * (copysign(friction * NORMAL, slip) - SPRING * x) / MOVING
            sticks = slip * (speed - own) <= 0.0 and SPRING * abs(x) < AT_REST * NORMAL
        x += dt * own
        places.append(x)
    return places


def model() -> str:
    """Everything but the steps."""
    nx, ny = PAD
    pad = Grid("PAD", nx, ny, lambda i, j: (LENGTH * i / nx, (LINING + PLATE) * j / ny))
    start, end, depth = SLAB
    mx, my = SLAB_ELEMENTS

    def place(i: int, j: int) -> tuple[float, float]:
        return start + (end - start) * i / mx, depth * (j / my - 1)

    slab = Grid("SLAB", mx, my, place, pad.next_node, pad.next_element)
    holder, soft = slab.next_node, ny - 2
    return "".join(
        [
            "** Written by generate.py; any consistent units.\n",
            pad.mesh("CPE4"),
            pad.side_surface("FACE", "bottom"),
            pad.side_surface("BACK", "top"),
            slab.mesh("CPE4"),
            slab.side_surface("ROAD", "top"),
            slab.side_nodes("BASE", "bottom"),
            card("ELSET, ELSET=LINING, GENERATE", (1, pad.element(nx - 1, soft - 1), 1)),
            card("ELSET, ELSET=PLATE, GENERATE", (pad.element(0, soft), pad.next_element - 1, 1)),
            card("NODE, NSET=HOLDER", (holder, LENGTH / 2, LINING + PLATE)),
            card(f"COUPLING, CONSTRAINT NAME=CALIPER, REF NODE={holder}, SURFACE=BACK"),
            card("KINEMATIC"),
            card("ELEMENT, TYPE=SPRING1, ELSET=ESPRING", (slab.next_element, holder)),
            card("SPRING, ELSET=ESPRING", (1,), (SPRING,)),
            elastic(*SOFT, "LINING", "SLAB", beta=BETA),
            material("STEEL", *STIFF, beta=BETA),
            card("SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL", (1.0,)),
            card("SURFACE INTERACTION, NAME=DRY"),
            card("FRICTION, EXPONENTIAL DECAY", (AT_REST, SLIDING, DECAY)),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "ROAD")),
            card("BOUNDARY", ("HOLDER", 6), ("BASE", 2)),
        ]
    )


def problem(speed: float) -> str:
    """A deck: heading, include, steps."""
    return "".join(
        [
            card("HEADING", (f"brake pad on a spring on a slab that moves with {speed!r}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card("STEP, NLGEOM"),
            card("STATIC", (1.0, 1.0)),
            card("BOUNDARY", ("BASE", 1)),
            card("CLOAD", ("HOLDER", 2, -NORMAL)),
            card("OUTPUT, FIELD, NUMBER INTERVAL=1"),
            card("END STEP"),
            step(
                DT,
                round(TIME / DT),
                card("BOUNDARY, TYPE=VELOCITY", ("BASE", 1, 1, speed)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=60"),
                card("NODE PRINT, NSET=HOLDER", ("U", "V")),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, speed in SPEED.items():
        (folder / f"{name}.inp").write_text(problem(speed))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
