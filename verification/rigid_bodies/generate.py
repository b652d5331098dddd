"""Writes a cam with a follower, a pair of gears and linkages: `generate.py [-o FOLDER]`."""

import sys
from collections.abc import Sequence
from math import acos, atan2, cos, hypot, pi, sin, sqrt, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import card, dry, elastic, material, step, write_to_folder  # noqa: E402

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

THICKNESS, GRAVITY = 0.1, 9.81
HANGING = 0.3, -0.4, 0.1, -0.2, 0.5
"""Angles of the bars that hang; each has length and mass 1."""
CHAIN_TIME, FLIGHT = 2.0, (0.3, 0.2)

CRANK, ROD, CRANK_SPEED = 1.0, 3.0, 2 * pi
SLIDER, PRESS = (1.0, 0.4), 40.0
"""Width and height of the slider, and the load that presses it on its guide."""
LIGHT = 1e-3
"""Density of crank and rod."""


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


def bar(first: int, start: Point, angle: float, length: float, name: str, reference: Point) -> str:
    """A bar along its axis from `first` to `first + 1`, of two elements in its height; `first + 6` is its reference node."""
    along, across = (cos(angle), sin(angle)), (-sin(angle), cos(angle))
    points = [(s, t) for t in (0.0, -THICKNESS / 2, THICKNESS / 2) for s in (0.0, length)]
    rows = [
        (first + k, *(start[i] + s * along[i] + t * across[i] for i in (0, 1)))
        for k, (s, t) in enumerate(points)
    ]
    elements = [
        (first, first + 2, first + 3, first + 1, first),
        (first + 1, first, first + 1, first + 5, first + 4),
    ]
    return "".join(
        [
            card("NODE", *rows, (first + 6, *reference)),
            card(f"ELEMENT, TYPE=CPE4, ELSET=E{name}", *elements),
            card(f"RIGID BODY, ELSET=E{name}, REF NODE={first + 6}"),
        ]
    )


def chain(angles: Sequence[float], rates: Sequence[float], increments: int, scheme: str) -> str:
    """Bars on hinges: at rest at the start they hang on the origin under gravity, else they fly."""
    at: Point = (0.0, 0.0)
    pieces, velocities = [], []
    hangs = not rates
    v = FLIGHT
    for k, angle in enumerate(angles):
        middle = (at[0] + cos(angle) / 2, at[1] + sin(angle) / 2)
        first = 10 * k + 1
        pieces.append(bar(first, at, angle, 1.0, f"BAR{k + 1}", at if hangs and k == 0 else middle))
        if not hangs:
            half = (-rates[k] * sin(angle) / 2, rates[k] * cos(angle) / 2)
            velocities += [(first + 6, i + 1, v[i] + half[i]) for i in (0, 1)]
            velocities.append((first + 6, 6, rates[k]))
            v = (v[0] + 2 * half[0], v[1] + 2 * half[1])
        at = (at[0] + cos(angle), at[1] + sin(angle))
    names = [f"EBAR{k + 1}" for k in range(len(angles))]
    pins = [("PIN", 10 * k + 2, 10 * k + 11) for k in range(len(angles) - 1)]
    return "".join(
        [
            card("HEADING"),
            "rigid bars on hinges\n",
            *pieces,
            elastic(1e5, 0.3, 1 / THICKNESS, *names),
            card("MPC", *pins),
            card("BOUNDARY", (7, 1, 2)) if hangs else card("INITIAL CONDITIONS, TYPE=VELOCITY", *velocities),
            step(
                CHAIN_TIME / increments,
                increments,
                card(f"STICKSLIP, SCHEME={scheme}"),
                card("DLOAD", *((name, "GRAV", GRAVITY, 0.0, -1.0) for name in names)) if hangs else "",
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
            ),
        ]
    )


def box(first: int, corner: Point, size: Point, name: str) -> str:
    """An element with four nodes from its lower left corner on."""
    (x, y), (width, height) = corner, size
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return card("NODE", *((first + k, *p) for k, p in enumerate(corners))) + card(
        f"ELEMENT, TYPE=CPE4, ELSET={name}", (first, first, first + 1, first + 2, first + 3)
    )


def slider_crank(friction: float, increments: int) -> str:
    """A crank that turns at a constant speed, a light rod and a slider of mass 1 that a load presses on a guide."""
    width, height = SLIDER
    end = CRANK + ROD
    heavy = 1 / (width * height)
    return "".join(
        [
            card("HEADING"),
            "slider-crank driven by its angle\n",
            bar(1, (0.0, 0.0), 0.0, CRANK, "CRANK", (0.0, 0.0)),
            bar(11, (CRANK, 0.0), 0.0, ROD, "ROD", (CRANK + ROD / 2, 0.0)),
            box(21, (end - width / 2, -height / 2), SLIDER, "ESLIDER"),
            card("NODE", (27, end, 0.0)),
            card("RIGID BODY, ELSET=ESLIDER, REF NODE=27"),
            box(31, (-2 * ROD, -height / 2 - 1.0), (4 * ROD, 1.0), "EGUIDE"),
            card("NSET, NSET=FIXED, GENERATE", (31, 34)),
            elastic(1e5, 0.3, LIGHT, "ECRANK", "EROD", "EGUIDE"),
            material("HEAVY", 1e5, 0.3, heavy),
            card("SOLID SECTION, ELSET=ESLIDER, MATERIAL=HEAVY", (1.0,)),
            card("MPC", ("PIN", 2, 11), ("PIN", 12, 27)),
            card("SURFACE, NAME=SLIDER", ("ESLIDER",)),
            card("SURFACE, NAME=GUIDE", ("EGUIDE", "S3")),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("SLIDER", "GUIDE")),
            card("AMPLITUDE, NAME=TURN", (0.0, 0.0), (1.0, 1.0)),
            card("BOUNDARY", ("FIXED", 1, 2), (7, 1, 2)),
            step(
                1 / increments,
                increments,
                card("BOUNDARY, AMPLITUDE=TURN", (7, 6, 6, CRANK_SPEED)),
                card("CLOAD", (27, 2, -PRESS)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=20"),
            ),
        ]
    )


def write(
    folder: Path,
    sides: int = 500,
    flank: int = 200,
    parts: int = 400,
    scheme: str = "ENERGY-MOMENTUM",
    friction: float = 0.0,
) -> None:
    """Writes the decks into `folder`.

    `sides` those of the cam, `flank` the pieces of a gear's flank, `parts` the increments of the linkages, `scheme` that
    of the chains, `friction` that of the slider.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "hanging_chain.inp").write_text(chain(HANGING[:2], (), parts, scheme))
    (folder / "hanging_chain_of_five.inp").write_text(chain(HANGING, (), parts, scheme))
    (folder / "flying_chain.inp").write_text(chain((0.3, 1.4), (2.0, -5.0), parts, scheme))
    (folder / "slider_crank.inp").write_text(slider_crank(friction, parts))
    (folder / "cam.inp").write_text(cam(sides))
    (folder / "gears.inp").write_text(gears(flank))


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
