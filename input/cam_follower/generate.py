"""Writes the decks of the cam and its tappet on a spring: `generate.py [-o FOLDER]`."""

import sys
from math import asin, cos, pi, radians, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, material, write_to_folder  # noqa: E402

Point = tuple[float, float]

BASE, LIFT, NOSE, HALF = 18.0, 8.0, 10.0, radians(70.0)
"""Radius of the base circle, lift, radius of the nose, half of the angle of the lift; N, mm, t, s."""
REACH = BASE + LIFT - NOSE
"""From the axis to the centre of the nose."""
ARM = (REACH**2 - (BASE - NOSE) ** 2) / (2 * (BASE - NOSE - REACH * cos(HALF)))
"""From the axis to the centre of a flank, whose radius is BASE + ARM: the arcs meet without corners."""
FLANK = asin(REACH * sin(HALF) / (ARM + BASE - NOSE))
"""Angle of a flank."""
CHORD = 0.2
"""Longest of the profile."""

YOUNG, POISSON, DENSITY, THICKNESS, BETA = 2800.0, 0.35, 1.4e-9, 4.0, 2e-5
"""Of the tappet, acetal."""
WIDTH, HEIGHT = 28.0, 10.0
ALONG, UP = 140, 6
GRADE = 2.0
"""Rows are closer at the face: their heights go with this power."""
MASS = 1e-4
"""Of the stem on the tappet."""
SPRING, PRELOAD = 10.0, 40.0
FRICTION = 0.1
SPEED = {"cam_slow": 60.0, "cam_fast": 260.0}
"""In radians per time."""
INCREMENTS, DWELL = 1200, radians(18.0)
"""Of the half turn; angle in which the spring is set."""

INCLUDE = "cam.inc"


def lift(angle: float) -> tuple[float, float, float]:
    """Lift, and its first and second derivative, where the nose is `angle` behind the tappet's line."""
    past = HALF - abs(angle)
    sign = -1.0 if angle > 0.0 else 1.0
    if past <= 0.0:
        return 0.0, 0.0, 0.0
    if past < FLANK:
        return ARM * (1 - cos(past)), sign * ARM * sin(past), ARM * cos(past)
    return LIFT - REACH * (1 - cos(angle)), -REACH * sin(angle), -REACH * cos(angle)


def arc(centre: Point, radius: float, start: float, end: float) -> list[Point]:
    """Points after the first of an arc between two angles, clockwise."""
    pieces = max(1, round(radius * (start - end) / CHORD))
    angles = [start + (end - start) * k / pieces for k in range(1, pieces + 1)]
    return [(centre[0] + radius * cos(a), centre[1] + radius * sin(a)) for a in angles]


def profile() -> list[Point]:
    """The outline of the cam, clockwise from its left; the nose points to the right."""
    first, second = (-ARM * cos(HALF), -ARM * sin(HALF)), (-ARM * cos(HALF), ARM * sin(HALF))
    origin = 0.0, 0.0
    return [
        (-BASE, 0.0),
        *arc(origin, BASE, pi, HALF),
        *arc(first, BASE + ARM, HALF, HALF - FLANK),
        *arc((REACH, 0.0), NOSE, HALF - FLANK, FLANK - HALF),
        *arc(second, BASE + ARM, FLANK - HALF, -HALF),
        *arc(origin, BASE, -HALF, -pi),
    ]


def model() -> str:
    """Everything but the step."""

    def place(i: int, j: int) -> Point:
        return WIDTH * (i / ALONG - 0.5), BASE + HEIGHT * (j / UP) ** GRADE

    tappet = Grid("TAPPET", ALONG, UP, place)
    node, element = tappet.next_node, tappet.next_element
    axis, stem, seat = node, node + 1, node + 2
    start, *rest = profile()
    return "".join(
        [
            "** Written by generate.py; N, mm, t, s.\n",
            tappet.mesh("CPS4"),
            tappet.side_surface("FACE", "bottom"),
            tappet.side_surface("HEAD", "top"),
            card("NODE, NSET=AXIS", (axis, 0.0, 0.0)),
            card("NODE, NSET=STEM", (stem, 0.0, BASE + HEIGHT)),
            card("NODE, NSET=SEAT", (seat, 0.0, BASE + 3 * HEIGHT)),
            card("SURFACE, NAME=CAM, TYPE=SEGMENTS", ("START", *start), *(("LINE", *p) for p in rest)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=CAM, REF NODE={axis}"),
            card(f"COUPLING, CONSTRAINT NAME=GUIDE, REF NODE={stem}, SURFACE=HEAD"),
            card("KINEMATIC"),
            card("ELEMENT, TYPE=MASS, ELSET=EMASS", (element, stem)),
            card("MASS, ELSET=EMASS", (MASS,)),
            card("ELEMENT, TYPE=SPRING2, ELSET=ESPRING", (element + 1, stem, seat)),
            card("SPRING, ELSET=ESPRING", (2, 2), (SPRING,)),
            material("ACETAL", YOUNG, POISSON, DENSITY, beta=BETA),
            card("SOLID SECTION, ELSET=TAPPET, MATERIAL=ACETAL", (THICKNESS,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "CAM")),
            card("BOUNDARY", ("AXIS", 1, 2), ("STEM", 1), ("STEM", 6), ("SEAT", 1)),
        ]
    )


def problem(speed: float) -> str:
    """A deck: heading, include, step."""
    duration = pi / speed
    return "".join(
        [
            card("HEADING", (f"half a turn of a cam under a tappet on a spring; {speed!r} rad/s",)),
            card(f"INCLUDE, INPUT={INCLUDE}"),
            card("AMPLITUDE, NAME=SET, DEFINITION=SMOOTH STEP", (0.0, 0.0, DWELL / speed, 1.0)),
            card(f"STEP, NLGEOM, INC={INCREMENTS}"),
            card("DYNAMIC, DIRECT", (duration / INCREMENTS, duration)),
            card("BOUNDARY, TYPE=VELOCITY", ("AXIS", 6, 6, speed)),
            card("BOUNDARY, AMPLITUDE=SET", ("SEAT", 2, 2, -PRELOAD / SPRING)),
            card("OUTPUT, FIELD, NUMBER INTERVAL=40"),
            card("NODE PRINT, NSET=STEM", ("U",)),
            card("NODE PRINT, NSET=AXIS", ("RF",)),
            card("END STEP"),
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
