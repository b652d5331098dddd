"""Writes the decks of a wheel pressed on a shaft and twisted: `generate.py [-o FOLDER]`."""

import sys
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import GridMesh, card, dry, elastic, ring, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY = 210e3, 0.3, 7.85e-9
"""Steel in N, mm, s."""
BORE, RADIUS, RIM, WIDTH = 8.0, 20.0, 40.0, 30.0
"""Radii of the hollow shaft, of its seat and of the wheel, and their width."""
INTERFERENCE = 0.02
"""By how much the radius of the shaft is larger than that of the wheel's bore."""
FRICTION = {"press_fit_mu01": 0.1, "press_fit_mu02": 0.2}
AROUND, ACROSS = 128, (5, 7)
"""Elements around, and across the shaft and the wheel."""
TWIST, INCREMENTS = 0.0012, 24
"""Angle of the shaft's bore, rad, and increments in which it is reached."""

INCLUDE = "press_fit.inc"


def pressure() -> float:
    """Lame's pressure in plane stress; the bore of the shaft rides on its reference node."""
    bore, rim = (BORE / RADIUS) ** 2, (RIM / RADIUS) ** 2
    shaft = (1 - POISSON**2) * (1 - bore) / (1 + POISSON + (1 - POISSON) * bore)
    wheel = (rim + 1) / (rim - 1) + POISSON
    return YOUNG * INTERFERENCE / RADIUS / (shaft + wheel)


def model() -> str:
    """Everything but the friction and the steps."""
    # the middles of the shaft's facets lie at its radius, and face the nodes of the wheel
    half = pi / AROUND
    seat = (RADIUS + INTERFERENCE) / cos(half)
    shaft = ring("SHAFT", (0.0, 0.0), (BORE, seat), AROUND, ACROSS[0])
    turned = [
        (x * cos(half) - y * sin(half), x * sin(half) + y * cos(half)) for x, y in shaft.nodes
    ]
    shaft = GridMesh("SHAFT", turned, shaft.elements)
    labels = shaft.next_node, shaft.next_element
    wheel = ring("WHEEL", (0.0, 0.0), (RADIUS, RIM), AROUND, ACROSS[1], *labels)
    reference = wheel.next_node
    rim = wheel.first_node + ACROSS[1] * AROUND
    right, top, left, low = (rim + k * AROUND // 4 for k in range(4))
    outside = shaft.next_element - AROUND
    inside = shaft.next_element
    return "".join(
        [
            "** Written by generate.py; N, mm, s.\n",
            shaft.mesh("CPS4"),
            wheel.mesh("CPS4"),
            card("NODE, NSET=AXIS", (reference, 0.0, 0.0)),
            card("NSET, NSET=BORE, GENERATE", (1, AROUND, 1)),
            card("ELSET, ELSET=OUTSIDE, GENERATE", (outside, inside - 1, 1)),
            card("SURFACE, NAME=SEAT", ("OUTSIDE", "S2")),
            card("ELSET, ELSET=INSIDE, GENERATE", (inside, inside + AROUND - 1, 1)),
            card("SURFACE, NAME=HUB", ("INSIDE", "S4")),
            card("KINEMATIC COUPLING, REF NODE=AXIS", ("BORE", 1, 2)),
            elastic(YOUNG, POISSON, DENSITY, "SHAFT", "WHEEL", thickness=WIDTH),
            card("CONTACT PAIR, INTERACTION=DRY", ("HUB", "SEAT")),
            "** four bolts hold the wheel against turning\n",
            card("BOUNDARY", ("AXIS", 1, 2), (right, 2, 2), (left, 2, 2), (top, 1, 1), (low, 1, 1)),
        ]
    )


def problem(friction: float) -> str:
    """A deck: heading, include, friction, press and twist."""
    asked = card("NODE PRINT, NSET=AXIS", ("U, RF",))
    return "".join(
        [
            card("HEADING", (f"a wheel pressed on a shaft and twisted; friction {friction}",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            dry(friction),
            card("STEP, NLGEOM, NAME=PRESS"),
            card("STATIC", (0.25, 1.0)),
            card("CONTACT INTERFERENCE, SHRINK", ("HUB", "SEAT")),
            card("BOUNDARY", ("AXIS", 6, 6)),
            asked,
            card("END STEP"),
            card("STEP, NLGEOM, NAME=TWIST"),
            card("STATIC, DIRECT", (1.0 / INCREMENTS, 1.0)),
            card("BOUNDARY", ("AXIS", 6, 6, TWIST)),
            card("END STEP"),
        ]
    )


def largest_torque(friction: float) -> float:
    """Torque at which the fit slips: mu p 2 pi R^2 width."""
    return friction * pressure() * 2 * pi * RADIUS**2 * WIDTH


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, friction in FRICTION.items():
        (folder / f"{name}.inp").write_text(problem(friction))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
