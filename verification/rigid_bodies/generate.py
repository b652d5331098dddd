"""Writes a cam with a follower and a pair of gears: `generate.py [-o FOLDER]`."""

import sys
from collections.abc import Sequence
from math import acos, atan2, cos, hypot, pi, sin, sqrt, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.cards import card, dry, elastic, step  # noqa: E402
from stickslip.deck import write_to_folder  # noqa: E402

Point = tuple[float, float]

RADIUS, OFFSET = 1.0, 0.3
"""Of the cam, a disc that turns about a point beside its centre."""
CAM_SPEED = 2 * pi
CAM_INCREMENTS = 500
"""Of the one turn of the cam."""
CAM_FRICTION = 0.1
FOLLOWER = 1.6, 0.5
"""Width and height; its density makes its mass 1."""
SPRING, PRELOAD = 40.0, 5.0

MODULE, PRESSURE_ANGLE = 1.0, pi / 9
TEETH = 20, 30
MADE = 4
"""Teeth of each gear that are made: the gears turn by less than two."""
ROOT, TOP = 1.25, 1.0
"""Depth and height of the teeth, in modules."""
CHAMFER = 0.08
"""Of the tips, 45 degrees."""
BACKLASH = 0.02
"""Angle by which the idle flanks are set back."""
GEAR_SPEED, TURN = 1.0, 0.5
MOMENT = 30.0
GEAR_DENSITY = 1e-3


def fan(profile: Sequence[Point], centre: Point, first: int, name: str) -> str:
    """Triangles from a centre to a closed profile around it: node `first` is the centre."""
    n = len(profile)
    return "".join(
        [
            card(f"NODE, NSET=N{name}", (first, *centre)),
            card(f"NODE, NSET=N{name}", *((first + 1 + k, *p) for k, p in enumerate(profile))),
            card(
                f"ELEMENT, TYPE=CPE3, ELSET=E{name}",
                *((first + k, first, first + 1 + k, first + 1 + (k + 1) % n) for k in range(n)),
            ),
        ]
    )


def cam(sides: int) -> str:
    """An eccentric disc that turns under a guided follower with a flat face, pressed on it by a spring and a load."""
    # it starts at its lowest lift, its centre below the axis, a corner at the top
    angles = [pi / 2 + 2 * pi * k / sides for k in range(sides)]
    profile = [(RADIUS * cos(a), RADIUS * sin(a) - OFFSET) for a in angles]
    width, height = FOLLOWER
    face = RADIUS - OFFSET
    corners = [(x, y) for y in (face, face + height) for x in (-width / 2, width / 2)]
    first = 2 * sides
    return "".join(
        [
            card("HEADING"),
            "cam and follower: an eccentric disc under a flat face with a spring\n",
            fan(profile, (0.0, -OFFSET), 1, "CAM"),
            card("NODE, NSET=NFOLLOWER", *((first + k, *p) for k, p in enumerate(corners))),
            card("ELEMENT, TYPE=CPE4, ELSET=EFOLLOWER", (first + 1, first, first + 1, first + 3, first + 2)),
            card("NODE, NSET=AXIS", (first + 10, 0.0, 0.0)),
            card("NODE, NSET=GUIDE", (first + 11, 0.0, face + height)),
            elastic(1e5, 0.3, 1 / (width * height), "ECAM", "EFOLLOWER"),
            card("RIGID BODY, ELSET=ECAM, REF NODE=AXIS"),
            card("RIGID BODY, ELSET=EFOLLOWER, REF NODE=GUIDE"),
            card("ELEMENT, TYPE=SPRING1, ELSET=ESPRING", (first + 2, first + 11)),
            card("SPRING, ELSET=ESPRING", (2,), (SPRING,)),
            card("SURFACE, NAME=CAM", ("ECAM", "S2")),
            card("SURFACE, NAME=FACE", ("EFOLLOWER", "S1")),
            dry(CAM_FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("CAM", "FACE")),
            card("AMPLITUDE, NAME=TURN", (0.0, 0.0, 1.0, 1.0)),
            card("BOUNDARY", ("AXIS", 1, 2), ("GUIDE", 1), ("GUIDE", 6)),
            step(
                1 / CAM_INCREMENTS,
                CAM_INCREMENTS,
                card("BOUNDARY, AMPLITUDE=TURN", ("AXIS", 6, 6, CAM_SPEED)),
                card("CLOAD", ("GUIDE", 2, -PRELOAD)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
            ),
        ]
    )


def involute(angle: float) -> float:
    """Polar angle of an involute where its pressure angle is `angle`."""
    return tan(angle) - angle


def gear(teeth: int, flank: int, first_tooth: float, centre: Point) -> list[Point]:
    """Outline of a gear: its teeth are made from the angle `first_tooth` on, the rest is its root circle.

    The flank that drives is an involute of `flank` pieces of equal length; the other is set back.
    """
    pitch = MODULE * teeth / 2
    base, root, top = pitch * cos(PRESSURE_ANGLE), pitch - ROOT * MODULE, pitch + TOP * MODULE
    half = pi / (2 * teeth) + involute(PRESSURE_ANGLE)
    # the arc of an involute grows with the square of the angle by which its string has rolled
    last = sqrt(((top - CHAMFER) / base) ** 2 - 1)
    rolls = [last * sqrt(k / flank) for k in range(flank + 1)]
    curve = [(base * hypot(1.0, t), half - involute(atan2(t, 1.0))) for t in rolls]
    foot = (min(root, 0.99 * base), half + 0.01)
    tip = (top, curve[-1][1] - CHAMFER / top)
    drive = [foot, *curve, tip]
    idle = [(r, a - BACKLASH) for r, a in [foot, *curve[:: max(1, flank // 8)], tip]]
    polar: list[Point] = []
    for k in range(MADE):
        middle = first_tooth + 2 * pi * k / teeth
        polar += [(r, middle - a) for r, a in idle]
        polar += [(r, middle + a) for r, a in reversed(drive)]
    begin, end = polar[0][1] + 2 * pi, polar[-1][1]
    polar += [(foot[0], end + (begin - end) * k / 12) for k in range(1, 12)]
    return [(centre[0] + r * cos(a), centre[1] + r * sin(a)) for r, a in polar]


def gears(flank: int) -> str:
    """A gear that turns at a constant speed drives another against a moment."""
    distance = MODULE * sum(TEETH) / 2
    steps = [2 * pi / n for n in TEETH]
    # a tooth of the first points at the axis of the second, which has a gap there
    profiles = [
        gear(TEETH[0], flank, -2 * steps[0], (0.0, 0.0)),
        gear(TEETH[1], flank, pi - 1.5 * steps[1], (distance, 0.0)),
    ]
    far = 100_000
    driven = -GEAR_SPEED * TEETH[0] / TEETH[1]
    increments = 250
    return "".join(
        [
            card("HEADING"),
            "gears with involute teeth; the first drives the second\n",
            fan(profiles[0], (0.0, 0.0), 1, "DRIVE"),
            fan(profiles[1], (distance, 0.0), far, "DRIVEN"),
            card("NODE, NSET=AXES", (far - 2, 0.0, 0.0), (far - 1, distance, 0.0)),
            elastic(1e5, 0.3, GEAR_DENSITY, "EDRIVE", "EDRIVEN"),
            card(f"RIGID BODY, ELSET=EDRIVE, REF NODE={far - 2}"),
            card(f"RIGID BODY, ELSET=EDRIVEN, REF NODE={far - 1}"),
            card("SURFACE, NAME=DRIVE", ("EDRIVE", "S2")),
            card("SURFACE, NAME=DRIVEN", ("EDRIVEN", "S2")),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", ("DRIVE", "DRIVEN")),
            card("AMPLITUDE, NAME=TURN", (0.0, 0.0, TURN, 1.0)),
            card("BOUNDARY", ("AXES", 1, 2)),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", (far - 1, 6, driven)),
            step(
                TURN / GEAR_SPEED / increments,
                increments,
                card("BOUNDARY, AMPLITUDE=TURN", (far - 2, 6, 6, TURN)),
                card("CLOAD", (far - 1, 6, MOMENT)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
            ),
        ]
    )


def write(folder: Path, sides: int = 500, flank: int = 200) -> None:
    """Writes the decks into `folder`: `sides` those of the cam, `flank` the pieces of a gear's flank."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cam.inp").write_text(cam(sides))
    (folder / "gears.inp").write_text(gears(flank))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
