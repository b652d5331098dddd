"""Writes the decks of the static steps: `generate.py [-o FOLDER]`."""

import sys
from math import cos, radians, sin, tan
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, elastic, write_to_folder  # noqa: E402

YOUNG = 1e6
LENGTH, DEPTH = 10.0, 0.2
ELEMENTS = 400
"""Along the elastica; there are two across."""
STIFFNESS = YOUNG * DEPTH**3 / 12
"""E I of the elastica."""
LOADS = (2, 5)
"""P L^2/(E I)."""

SOFT = 1000.0
SLOPE = 20.0
"""Of the incline (degrees)."""
MARGIN = 1e-5
"""Of its friction coefficient above the tangent of the slope."""
PRESSURE, FRICTION = 20.0, 0.3
SHARE = 0.6
"""Shear load as a part of the largest that friction holds."""
PATHS = (1, 4, 16)
SPAN = 5.2
SUPPORTED = 1.0
"""Traction on the block on two supports."""


def static(*cards: str, dt: float = 1.0, direct: bool = False) -> str:
    """A static step of the duration 1."""
    keyword = "STATIC, DIRECT" if direct else "STATIC"
    return "".join([card("STEP, NLGEOM"), card(keyword, (dt, 1.0)), *cards, card("END STEP")])


def block(name: str, size: tuple[int, int], lengths: tuple[float, float], **at) -> Grid:
    """A rectangle of so many elements with its lower left corner at `corner`."""
    (nx, ny), (lx, ly) = size, lengths
    x, y = at.pop("corner", (0.0, 0.0))
    return Grid(name, nx, ny, lambda i, j: (x + lx * i / nx, y + ly * j / ny), **at)


def after(*grids: Grid) -> dict[str, int]:
    """First node and element of a grid after others."""
    return {"first_node": grids[-1].next_node, "first_element": grids[-1].next_element}


def elastica(load: int) -> str:
    """A cantilever with a dead load P L^2/(E I) across its end."""
    bar = block("BAR", (ELEMENTS, 2), (LENGTH, DEPTH))
    force = load * STIFFNESS / LENGTH**2
    return "".join(
        [
            card("HEADING", (f"cantilever with the dead load P L^2/(E I) = {load}",)),
            bar.mesh("CPE4"),
            bar.side_nodes("HELD", "left"),
            card("NSET, NSET=END", (bar.node(ELEMENTS, 1),)),
            elastic(YOUNG, 0.0, 1.0, "BAR"),
            card("BOUNDARY", ("HELD", 1, 2)),
            static(
                card("CLOAD", ("END", 2, -force)), card("NODE PRINT, NSET=END", ("U",)), dt=0.1
            ),
        ]
    )


def released() -> str:
    """A cantilever that is bent statically and let go."""
    bar = block("BAR", (20, 2), (LENGTH, 1.0))
    return "".join(
        [
            card("HEADING", ("a cantilever is bent statically and let go",)),
            bar.mesh("CPE4"),
            bar.side_nodes("HELD", "left"),
            card("NSET, NSET=END", (bar.node(20, 1),)),
            elastic(SOFT, 0.3, 1.0, "BAR"),
            card("BOUNDARY", ("HELD", 1, 2)),
            static(
                card("CLOAD", ("END", 2, -0.3)), card("NODE PRINT, NSET=END", ("U",)), dt=0.5
            ),
            card("STEP, NLGEOM"),
            card("DYNAMIC, DIRECT", (0.02, 8.0)),
            card("CLOAD, OP=NEW"),
            card("END STEP"),
        ]
    )


def on_floor(title: str, width: float, friction: float, *steps: str) -> str:
    """A block that nothing but contact holds, on a floor."""
    floor = block("FLOOR", (16, 4), (4.0, 1.0), corner=(-1.0, -1.0))
    body = block("BLOCK", (6, 3), (width, 0.5), **after(floor))
    return "".join(
        [
            card("HEADING", (title,)),
            floor.mesh("CPE4"),
            body.mesh("CPE4"),
            floor.side_surface("GROUND", "top"),
            floor.side_nodes("BASE", "bottom"),
            body.side_surface("SOLE", "bottom"),
            body.side_surface("ROOF", "top"),
            body.side_nodes("TOP", "top"),
            elastic(SOFT, 0.3, 1.0, "FLOOR", "BLOCK"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "GROUND")),
            card("BOUNDARY", ("BASE", 1, 2)),
            *steps,
        ]
    )


def incline() -> str:
    """The friction coefficient is just above the tangent of the slope."""
    angle = radians(SLOPE)
    gravity = card("DLOAD", ("BLOCK", "GRAV", 1.0, sin(angle), -cos(angle)))
    friction = tan(angle) + MARGIN
    return on_floor(
        f"block on a slope of {SLOPE} degrees", 1.0, friction, static(gravity, direct=True)
    )


def path(increments: int) -> str:
    """Pressed, then sheared in so many increments."""
    shear = SHARE * FRICTION * PRESSURE
    pressed = card("DSLOAD", ("ROOF", "P", PRESSURE))
    sheared = card("DSLOAD, FOLLOWER=NO", ("ROOF", "TRVEC", shear, 1.0, 0.0))
    return on_floor(
        f"block pressed, then sheared in {increments} increments",
        1.0,
        FRICTION,
        static(pressed, card("NODE PRINT, NSET=TOP", ("U",)), direct=True),
        static(sheared, dt=1.0 / increments, direct=True),
    )


def supports() -> str:
    """A block on two blocks under a load, held by friction alone."""
    left = block("LEFT", (4, 4), (1.0, 1.0))
    right = block("RIGHT", (4, 4), (1.0, 1.0), corner=(4.0, 0.0), **after(left))
    body = block("BLOCK", (26, 6), (SPAN, 1.5), corner=(-0.1, 1.0), **after(right))
    return "".join(
        [
            card("HEADING", ("block on two supports",)),
            *(grid.mesh("CPE4") for grid in (left, right, body)),
            left.side_surface("LEFT_TOP", "top"),
            right.side_surface("RIGHT_TOP", "top"),
            left.side_nodes("LEFT_BASE", "bottom"),
            right.side_nodes("RIGHT_BASE", "bottom"),
            body.side_surface("SOLE", "bottom"),
            body.side_surface("ROOF", "top"),
            elastic(SOFT, 0.3, 1.0, "LEFT", "RIGHT", "BLOCK"),
            dry(FRICTION),
            card(
                "CONTACT PAIR, INTERACTION=DRY", ("SOLE", "LEFT_TOP"), ("SOLE", "RIGHT_TOP")
            ),
            card("BOUNDARY", ("LEFT_BASE", 1, 2), ("RIGHT_BASE", 1, 2)),
            static(
                card("DSLOAD, FOLLOWER=NO", ("ROOF", "TRVEC", SUPPORTED, 0.0, -1.0)),
                dt=0.5,
                direct=True,
            ),
        ]
    )


def decks() -> dict[str, str]:
    """All decks by their names."""
    return {
        **{f"elastica_{load}": elastica(load) for load in LOADS},
        "released": released(),
        "incline": incline(),
        **{f"path_{increments}": path(increments) for increments in PATHS},
        "supports": supports(),
    }


def write(folder: Path) -> None:
    """Writes all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in decks().items():
        (folder / f"{name}.inp").write_text(text)


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
