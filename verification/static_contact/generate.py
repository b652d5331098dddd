"""Writes the decks of static contact: `generate.py [-o FOLDER]`."""

import sys
from collections.abc import Callable
from math import cos, pi, radians, sin, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from meshes import graded, static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import Grid, card, dry, elastic  # noqa: E402

YOUNG, POISSON = 1000.0, 0.3
MODULUS = YOUNG / (1 - POISSON**2)
"""Of plane strain."""

RADIUS, HEIGHT, WIDTH = 1.0, 1.0, 0.8
"""Of the cylinders, which are cut off above their middle and at both sides (half of the width)."""
HALF_WIDTH = 0.0125
"""Of Hertz' contact."""
PRESS = pi / 4 * MODULUS * HALF_WIDTH**2 / RADIUS
"""Load of Hertz' contact, the same on a rigid plane and on a like cylinder."""
FRICTION = 0.3
SHARE = 0.6
"""Tangential load as a part of the largest that friction holds."""

STRIP, SLIP_LENGTH, STRAIN = 4.0, 2.0, 0.002
"""Length of the strip on a rough plane, how much of it slips, and its strain where it is pulled."""

BELT, TENSION, STROKE = 0.02, 1e-3, 0.03
"""Thickness of a strip around a cylinder of radius 1, strain at one end, way of the other."""

ARCH, PUNCH = (10.0, 0.4, 0.2), 0.3
"""Span, rise and depth of the arch, radius of the punch."""
FIT = {"bore": 0.4, "radius": 1.0, "rim": 2.0, "overlap": 2e-3}
"""Radii of a hollow shaft and the ring pressed on it, and their interference."""

BOLT = {"length": 4.0, "bolt": 1.0, "flange": 2.0, "preload": 0.1}
"""Length and widths of a bolt and of the flange that it clamps, and its preload."""

SNAP, DAMPING = 100.0, 0.3
"""Time in which the arch comes to rest after it has snapped through, and its damping (ALPHA)."""


def after(*grids: Grid) -> dict[str, int]:
    """First node and element of a grid after others."""
    return {"first_node": grids[-1].next_node, "first_element": grids[-1].next_element}


def block(name: str, size: tuple[int, int], lengths: tuple[float, float], **labels: int) -> Grid:
    """A rectangle of so many elements above y = 0, right of x = 0."""
    (nx, ny), (lx, ly) = size, lengths
    return Grid(name, nx, ny, lambda i, j: (lx * i / nx, ly * j / ny), **labels)


def plane(name: str, start: float, end: float) -> str:
    """A rigid plane at y = 0, which holds what lies above."""
    reference = 100_000
    return "".join(
        [
            card("NODE, NSET=REFERENCE", (reference, start, -1.0)),
            card(f"SURFACE, NAME={name}, TYPE=SEGMENTS", ("START", start, 0.0), ("LINE", end, 0.0)),
            card(f"RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE=REFERENCE"),
        ]
    )


def cylinder(name: str, size: float, *, half: bool, below: bool = False, **labels: int) -> Grid:
    """A cylinder that touches y = 0 at x = 0 from above or below; `size` of the elements there."""
    right = graded(size, 1.5 * HALF_WIDTH, WIDTH)
    x = right if half else [-place for place in reversed(right[1:])] + right
    t = graded(size, HALF_WIDTH, HEIGHT)
    rows = len(t) - 1

    def place(i: int, j: int) -> tuple[float, float]:
        foot = RADIUS - sqrt(RADIUS**2 - x[i] ** 2)
        up = foot + (HEIGHT - foot) * t[rows - j if below else j] / HEIGHT
        return x[i], -up if below else up

    return Grid(name, len(x) - 1, rows, place, **labels)


def guided(grid: Grid, *directions: int) -> str:
    """The top of a grid moves in these directions as its first node, HEAD, does."""
    top = [grid.node(i, grid.ny) for i in range(grid.nx + 1)]
    return "".join(
        [
            card("NSET, NSET=HEAD", (top[0],)),
            card("NSET, NSET=OTHERS, GENERATE", (top[1], top[-1], 1)),
            *(
                card("EQUATION", (2,), ("OTHERS", direction, 1.0, "HEAD", direction, -1.0))
                for direction in directions
            ),
        ]
    )


def hertz(
    division: int, friction: float = 0.0, like: bool = False, increments: int = 4
) -> str:
    """Half of a cylinder on a plane or on a like one, `division` elements in the half width."""
    size = HALF_WIDTH / division
    upper = cylinder("UPPER", size, half=True)
    lower = cylinder("LOWER", size, half=True, below=True, **after(upper))
    bodies = [upper, lower] if like else [upper]
    return "".join(
        [
            card("HEADING", ("a cylinder on a like one" if like else "a cylinder on a plane",)),
            *(body.mesh("CPE4") for body in bodies),
            upper.side_surface("FOOT", "bottom"),
            upper.side_nodes("MIDDLE", "left"),
            *(
                [lower.side_surface("GROUND", "top"), lower.side_nodes("BASE", "bottom")]
                + [lower.side_nodes("MIDDLE_BELOW", "left")]
                if like
                else [plane("GROUND", -0.1, WIDTH)]
            ),
            guided(upper, 1, 2),
            elastic(YOUNG, POISSON, 1.0, *(body.name for body in bodies)),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
            card(
                "BOUNDARY",
                ("MIDDLE", 1, 1),
                *(("MIDDLE_BELOW", 1, 1), ("BASE", 2, 2)) if like else (("REFERENCE", 1, 2),),
            ),
            static(
                card("CLOAD", ("HEAD", 2, -PRESS / 2)), dt=1.0 / increments, direct=True
            ),
        ]
    )


def mindlin(increments: int, friction: float = FRICTION, cycles: int = 0, division: int = 8) -> str:
    """Two like cylinders, pressed, then sheared in so many increments, then to and fro."""
    size = HALF_WIDTH / division
    upper = cylinder("UPPER", size, half=False)
    lower = cylinder("LOWER", size, half=False, below=True, **after(upper))
    shear = SHARE * FRICTION * PRESS
    steps = [card("CLOAD", ("HEAD", 2, -PRESS)) + card("NODE PRINT, NSET=HEAD", ("U",))]
    steps += [card("CLOAD", ("HEAD", 1, shear * (-1) ** k)) for k in range(1 + 2 * cycles)]
    return "".join(
        [
            card("HEADING", ("two cylinders, pressed and sheared",)),
            upper.mesh("CPE4"),
            lower.mesh("CPE4"),
            upper.side_surface("FOOT", "bottom"),
            lower.side_surface("GROUND", "top"),
            lower.side_nodes("BASE", "bottom"),
            guided(upper, 1, 2),
            elastic(YOUNG, POISSON, 1.0, "UPPER", "LOWER"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
            card("BOUNDARY", ("BASE", 1, 2)),
            static(steps[0], dt=0.25, direct=True),
            *(static(step, dt=1.0 / increments, direct=True) for step in steps[1:]),
        ]
    )


def shear_lag(thickness: float = 0.05) -> str:
    """A strip pressed on a rough plane, pulled at its end and let go."""
    size = thickness / 2
    strip = block("STRIP", (round(STRIP / size), 2), (STRIP, thickness))
    pull = STRAIN * YOUNG * thickness
    pressure = pull / (FRICTION * SLIP_LENGTH)
    return "".join(
        [
            card("HEADING", ("a strip pulled over a rough plane",)),
            strip.mesh("CPS4"),
            strip.side_surface("SOLE", "bottom"),
            strip.side_surface("ROOF", "top"),
            strip.side_surface("FRONT", "right"),
            strip.side_nodes("END", "right"),
            plane("GROUND", -1.0, STRIP + 1.0),
            elastic(YOUNG, 0.0, 1.0, "STRIP"),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "GROUND")),
            card("BOUNDARY", ("REFERENCE", 1, 2)),
            static(
                card("DSLOAD", ("ROOF", "P", pressure)),
                card("NODE PRINT, NSET=END", ("U",)),
            ),
            *(
                static(
                    card(
                        "DSLOAD, FOLLOWER=NO", ("FRONT", "TRVEC", load / thickness, 1.0, 0.0)
                    ),
                    dt=0.25,
                    direct=True,
                )
                for load in (pull, 0.0)
            ),
        ]
    )


def capstan(friction: float, degrees: int) -> str:
    """A strip around a part of a cylinder, dead load at the left, pulled at the right."""
    arc, tail = degrees // 2, 8
    half = radians(degrees) / 2
    size = radians(2.0)

    def place(i: int, j: int) -> tuple[float, float]:
        along = (i - tail - arc / 2) * size
        turn = max(-half, min(half, along))
        radius, straight = 1.0 + BELT * j / 2, along - turn
        x, y = radius * sin(turn), radius * cos(turn)
        return x + straight * cos(turn), y - straight * sin(turn)

    strip = Grid("STRIP", arc + 2 * tail, 2, place)
    reach = half + radians(10)
    shore = (sin(reach), cos(reach))
    pull = (cos(half), -sin(half))
    load = TENSION * YOUNG
    way = (STROKE * pull[0], STROKE * pull[1])
    return "".join(
        [
            card("HEADING", ("a strip around a cylinder",)),
            strip.mesh("CPS4"),
            strip.side_surface("INSIDE", "bottom"),
            strip.side_surface("LOADED", "left"),
            strip.side_nodes("PULLED", "right"),
            card("NODE, NSET=REFERENCE", (100_000, 0.0, 0.0)),
            card(
                "SURFACE, NAME=POST, TYPE=SEGMENTS",
                ("START", -shore[0], shore[1]),
                ("CIRCL", 0.0, 1.0, 0.0, 0.0),
                ("CIRCL", *shore, 0.0, 0.0),
            ),
            card("RIGID BODY, ANALYTICAL SURFACE=POST, REF NODE=REFERENCE"),
            elastic(YOUNG, 0.0, 1.0, "STRIP"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("INSIDE", "POST")),
            card("BOUNDARY", ("REFERENCE", 1, 2)),
            static(
                card("BOUNDARY", ("PULLED", 1, 2)),
                card("DSLOAD, FOLLOWER=NO", ("LOADED", "TRVEC", load, -pull[0], pull[1])),
                card("NODE PRINT, NSET=PULLED", ("U, RF",)),
                dt=0.1,
            ),
            static(
                card("BOUNDARY", ("PULLED", 1, 1, way[0]), ("PULLED", 2, 2, way[1])),
                dt=0.05,
            ),
        ]
    )


def arch(load: float, after_limit: float = 0.0) -> str:
    """Half of a shallow arch, pushed through by a rigid punch (load 0) or by a loaded block.

    Loads are parts of the largest force. With `after_limit` the load is at once so large in a
    dynamic step: the arch snaps through, comes to rest by damping and ends in a static step.
    """
    span, rise, depth = ARCH
    count, middle = 200, span / 2
    tip = rise + depth / 2

    def place(i: int, j: int) -> tuple[float, float]:
        x = middle * i / count
        return x, rise / 2 * (1 - cos(2 * pi * x / span)) + depth * (j - 1) / 2

    def punch(i: int, j: int) -> tuple[float, float]:
        x = PUNCH * (i - 2) / 4
        foot = PUNCH - sqrt(PUNCH**2 - x**2)
        return middle + x, tip + foot + (PUNCH - foot) * j / 2

    body = Grid("ARCH", count, 2, place)
    block = Grid("PUNCH", 2, 2, punch, **after(body))
    print_way = card("NODE PRINT, NSET=HEAD", ("U, RF",))
    if load:
        force = limit_load(*ARCH)[0] / 2
        pushes = "".join(
            [
                block.mesh("CPS4"),
                block.side_surface("FOOT", "bottom"),
                guided(block, 2),
                card("BOUNDARY", ("PUNCH", 1, 1)),
            ]
        )
        steps = [static(card("CLOAD", ("HEAD", 2, -load * force)), print_way, dt=0.1)]
    else:
        pushes = "".join(
            [
                card("NODE, NSET=HEAD", (100_000, middle, tip + PUNCH)),
                card(
                    "SURFACE, NAME=FOOT, TYPE=SEGMENTS",
                    ("START", middle + PUNCH, tip + PUNCH),
                    ("CIRCL", middle, tip, middle, tip + PUNCH),
                    ("CIRCL", middle - PUNCH, tip + PUNCH, middle, tip + PUNCH),
                ),
                card("RIGID BODY, ANALYTICAL SURFACE=FOOT, REF NODE=HEAD"),
                card("BOUNDARY", ("HEAD", 1, 1)),
            ]
        )
        push = card("BOUNDARY", ("HEAD", 2, 2, -2 * rise))
        steps = [static(push, print_way, dt=0.025, direct=True)]
    if after_limit:
        push = card("CLOAD", ("HEAD", 2, -after_limit * force))
        steps += [
            card("STEP, NLGEOM") + card("DYNAMIC, DIRECT", (SNAP / 200, SNAP)) + push,
            card("END STEP"),
            static(push),
        ]
    return "".join(
        [
            card("HEADING", ("a punch on a shallow arch",)),
            body.mesh("CPS4"),
            body.side_surface("BACK", "top"),
            body.side_nodes("HELD", "left"),
            body.side_nodes("CROWN", "right"),
            pushes,
            elastic(
                YOUNG,
                0.0,
                1.0,
                *(["ARCH", "PUNCH"] if load else ["ARCH"]),
                alpha=DAMPING if after_limit else 0.0,
            ),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("BACK", "FOOT")),
            card("BOUNDARY", ("HELD", 1, 2), ("CROWN", 1, 1)),
            *steps,
        ]
    )


def fit(
    division: int,
    friction: float = 0.0,
    surfaces: str = "faces",
    passes: int = 1,
    ring: float = 1.0,
    shrink: bool = True,
    units: float = 1.0,
    stiffer: float = 1.0,
) -> str:
    """A quarter of a ring pressed on a hollow shaft, both with symmetry.

    `division` elements around the quarter of the shaft, `ring` times as many around that of the
    ring; surfaces are the two cylinders (faces), the whole outlines (skins) or general contact.
    """

    def quarter(name: str, radii: tuple[float, float], around: int, **labels: int) -> Grid:
        across = max(2, round((radii[1] - radii[0]) * division / 2))

        def place(i: int, j: int) -> tuple[float, float]:
            radius = units * (radii[0] + (radii[1] - radii[0]) * i / across)
            angle = pi / 2 * j / around
            # both ends lie on the axes
            x = 0.0 if j == around else radius * cos(angle)
            return x, radius * sin(angle)

        return Grid(name, across, around, place, **labels)

    overlap = FIT["overlap"]
    shaft = quarter("SHAFT", (FIT["bore"], FIT["radius"] + overlap), division)
    hub = quarter("HUB", (FIT["radius"], FIT["rim"]), round(ring * division), **after(shaft))
    bodies = [shaft, hub]
    names = {"faces": ("BORE", "SEAT"), "skins": ("HUB", "SHAFT")}.get(surfaces)
    outlines = "".join(card(f"SURFACE, NAME={body.name}", (body.name,)) for body in bodies)
    if names is None:
        contact = "".join(
            [
                card("CONTACT"),
                card("CONTACT INCLUSIONS, ALL EXTERIOR"),
                card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
                card("CONTACT INITIALIZATION DATA, NAME=FIT, INTERFERENCE FIT"),
                card("CONTACT INITIALIZATION ASSIGNMENT", ("", "", "FIT")),
            ]
        )
        pressed = ""
    else:
        rows = [names, names[::-1]][:passes]
        contact = card("CONTACT PAIR, INTERACTION=DRY", *rows)
        if shrink:
            pressed = card("CONTACT INTERFERENCE, SHRINK", names)
        else:
            pressed = card("CONTACT INTERFERENCE", (*names, 1.5 * units * overlap))
    return "".join(
        [
            card("HEADING", ("a ring pressed on a shaft",)),
            *(body.mesh("CPS4") for body in bodies),
            hub.side_surface("BORE", "left"),
            shaft.side_surface("SEAT", "right"),
            outlines,
            hub.side_nodes("INSIDE", "left"),
            *(
                body.side_nodes(f"{body.name}_{side}".upper(), side)
                for body in bodies
                for side in ("bottom", "top")
            ),
            elastic(stiffer * YOUNG, POISSON, 1.0, "SHAFT", "HUB", thickness=units),
            dry(friction),
            contact,
            card(
                "BOUNDARY",
                *((f"{body.name}_BOTTOM", 2, 2) for body in bodies),
                *((f"{body.name}_TOP", 1, 1) for body in bodies),
            ),
            static(pressed, dt=0.5),
        ]
    )


def bolt(pull: float) -> str:
    """A bolt clamps a flange, is locked and pulled; `pull` beside the preload.

    The head, whose nodes move along y alike, presses a plate on the flange.
    """
    length = BOLT["length"]
    shank = block("BOLT", (2, 8), (BOLT["bolt"], length))
    size = BOLT["flange"] / 4

    def beside(i: int, j: int) -> tuple[float, float]:
        return 2 + size * i, length * j / 8

    flange = Grid("FLANGE", 4, 8, beside, **after(shank))
    above = after(flange)
    plate = Grid("PLATE", 4, 1, lambda i, j: (2 + size * i, length + j / 2), **above)
    head = plate.next_node
    cut = [(shank.element(i, 3),) for i in range(2)]
    load = BOLT["preload"]
    return "".join(
        [
            card("HEADING", ("a bolt clamps a flange, is locked and pulled",)),
            *(body.mesh("CPS4") for body in (shank, flange, plate)),
            card("NODE, NSET=HEAD", (head, 1.5, length + 1)),
            card("NODE, NSET=TIGHTENING", (head + 1, 0.0, 0.0)),
            card("ELSET, ELSET=BELOW", *cut),
            card("SURFACE, NAME=SECTION", ("BELOW", "S3")),
            card("PRE-TENSION SECTION, NODE=TIGHTENING, SURFACE=SECTION"),
            shank.side_nodes("FOOT", "bottom"),
            flange.side_nodes("GROUND", "bottom"),
            shank.side_nodes("TOP", "top"),
            flange.side_surface("SEAT", "top"),
            plate.side_surface("SOLE", "bottom"),
            elastic(YOUNG, 0.0, 1.0, "BOLT", "FLANGE", "PLATE"),
            dry(0.0),
            card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "SEAT")),
            *(card("EQUATION", (2,), (name, 2, 1.0, "HEAD", 2, -1.0)) for name in ("TOP", "PLATE")),
            card("BOUNDARY", ("FOOT", 1, 2), ("GROUND", 1, 2), ("PLATE", 1, 1)),
            static(
                card("CLOAD", ("TIGHTENING", 1, load)),
                card("NODE PRINT, NSET=TIGHTENING", ("U, RF",)),
            ),
            static(
                card("CLOAD, OP=NEW"),
                card("BOUNDARY, FIXED", ("TIGHTENING", 1, 1)),
                card("CLOAD", ("HEAD", 2, pull * load)),
                dt=0.1,
                direct=True,
            ),
        ]
    )


def lame() -> tuple[float, float]:
    """Pressure of the fit, and C of the hoop stress C (1 + b^2/r^2) of the ring beside it."""
    bore, rim = ((FIT[name] / FIT["radius"]) ** 2 for name in ("bore", "rim"))
    compliance = (rim + 1) / (rim - 1) + (1 + bore) / (1 - bore)
    return YOUNG * FIT["overlap"] / FIT["radius"] / compliance, 1 / (rim - 1)


def punch_forces(span: float, rise: float, depth: float) -> list[tuple[float, float]]:
    """Ways and forces of a punch in the middle of a clamped shallow arch, along its path.

    w = sum a_k (1 - cos b_k x), b_k = 2 pi k/span, from w0 = rise/2 (1 - cos b_1 x), has
    the thrust N

        (EI b_k^4 - N b_k^2) a_k span/2 = EI b_k^4 a0_k span/2 - 2 P (k odd)
        N = EA/4 sum b_k^2 (a0_k^2 - a_k^2)

    which is quadratic in P for each N.
    """
    terms = 200
    area, bending = YOUNG * depth, YOUNG * depth**3 / 12
    k = [2 * pi * (n + 1) / span for n in range(terms)]
    start = [rise / 2] + [0.0] * (terms - 1)
    found = []
    for part in range(1, 2000):
        thrust = part / 2000 * bending * k[1] ** 2
        stiff = [bending * b**4 - thrust * b**2 for b in k]
        if min(map(abs, stiff)) < 1e-9 * bending * k[0] ** 4:
            continue
        at_rest = [bending * b**4 * a / c for b, a, c in zip(k, start, stiff)]
        by_load = [-4 / span / c if n % 2 == 0 else 0.0 for n, c in enumerate(stiff)]
        # sum b^2 (a0^2 - (r + P q)^2) EA/4 = N
        square = sum(b * b * q * q for b, q in zip(k, by_load))
        linear = sum(b * b * r * q for b, r, q in zip(k, at_rest, by_load))
        rest = sum(b * b * (r * r - a * a) for b, r, a in zip(k, at_rest, start))
        rest += 4 * thrust / area
        root = linear**2 - square * rest
        if root < 0.0:
            continue
        for sign in (-1, 1):
            load = (-linear + sign * sqrt(root)) / square
            odd = zip(at_rest[::2], by_load[::2])
            found.append((rise - 2 * sum(r + load * q for r, q in odd), load))
    return sorted(found)


def limit_load(span: float, rise: float, depth: float) -> tuple[float, float]:
    """The largest force of the punch on its way to half of the rise, and the way there."""
    return max((load, way) for way, load in punch_forces(span, rise, depth) if 0 < way < rise)


PROBLEMS: dict[str, Callable[..., str]] = {
    "hertz": hertz,
    "mindlin": mindlin,
    "shear_lag": shear_lag,
    "capstan": capstan,
    "arch": arch,
    "fit": fit,
    "bolt": bolt,
}


def write(folder: Path, problem: str, **parameters: float | str | bool) -> None:
    """Writes the deck of a problem into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{problem}.inp").write_text(PROBLEMS[problem](**parameters))
