"""Stiff bodies that turn and travel: increments are long against the waves in them.

The Courant number c dt / h, with c = sqrt(E / rho), sets the stiffness; h is an element's length.
"""

from math import cos, sin

from settings import ramp, settings
from stickslip.decks import Grid, card, dry, elastic, outline, step

GRAVITY = 10.0


def young(courant: float, size: float, dt: float) -> float:
    """Young's modulus at a Courant number, for density 1."""
    return (courant * size / dt) ** 2


def rotating_bar(courant: float = 100.0, angle: float = 0.05, scheme: str = "default") -> str:
    """A free bar 10 x 1 that turns by an angle (rad) in each of 60 increments."""
    bar = Grid("BAR", 20, 2, lambda i, j: (0.5 * i - 5.0, 0.5 * j - 0.5))
    places = {bar.node(i, j): bar.place(i, j) for j in range(3) for i in range(21)}
    velocity = [(node, 1, -y) for node, (_, y) in places.items()]
    velocity += [(node, 2, x) for node, (x, _) in places.items()]
    return "".join(
        [
            card("HEADING", (f"a bar turns by {angle} rad per increment; Courant {courant:g}",)),
            bar.mesh("CPS4"),
            elastic(young(courant, 0.5, angle), 0.3, 1.0, "BAR"),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", *velocity),
            step(angle, 60, settings(scheme)),
        ]
    )


def pendulum(courant: float = 1000.0, scheme: str = "default") -> str:
    """A bar 5 x 0.5, pinned at one end, that swings down from the horizontal."""
    dt = 0.05
    bar = Grid("BAR", 20, 2, lambda i, j: (0.25 * i, 0.25 * j - 0.25))
    return "".join(
        [
            card("HEADING", (f"a pinned bar swings; Courant number {courant:g}",)),
            bar.mesh("CPS4"),
            card("NSET, NSET=PIVOT", (bar.node(0, 1),)),
            elastic(young(courant, 0.25, dt), 0.3, 1.0, "BAR"),
            card("BOUNDARY", ("PIVOT", 1, 2)),
            step(dt, 80, settings(scheme), card("DLOAD", ("BAR", "GRAV", GRAVITY, 0.0, -1.0))),
        ]
    )


def thrown_block(courant: float = 1000.0, friction: float = 0.3, scheme: str = "default") -> str:
    """A tilted unit block is thrown on rigid ground, corner first, and slides."""
    dt, tilt = 0.01, 0.1

    def place(i: int, j: int) -> tuple[float, float]:
        x, y = i / 8 - 0.5, j / 8 - 0.5
        return x * cos(tilt) - y * sin(tilt), 0.5524 + x * sin(tilt) + y * cos(tilt)

    block = Grid("BLOCK", 8, 8, place)
    return "".join(
        [
            card("HEADING", (f"a tilted block thrown on the ground; Courant number {courant:g}",)),
            block.mesh("CPE4"),
            outline("BLOCK"),
            ground(block.next_node),
            elastic(young(courant, 0.125, dt), 0.3, 1.0, "BLOCK"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("BLOCK", "GROUND")),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BLOCK", 1, 1.0), ("BLOCK", 2, -1.0)),
            step(dt, 40, settings(scheme), card("DLOAD", ("BLOCK", "GRAV", GRAVITY, 0.0, -1.0))),
        ]
    )


def pushed_block(courant: float = 1000.0, friction: float = 1.0, scheme: str = "default") -> str:
    """A bar 4 x 0.25, driven at its far end, pushes a unit block; it tips if friction is large."""
    dt = 0.02
    block = Grid("BLOCK", 8, 8, lambda i, j: (i / 8, j / 8))
    labels = block.next_node, block.next_element
    bar = Grid("BAR", 32, 2, lambda i, j: (i / 8 - 4.01, 0.625 + j / 8), *labels)
    return "".join(
        [
            card("HEADING", (f"a bar pushes a block; Courant number {courant:g}",)),
            block.mesh("CPE4"),
            bar.mesh("CPE4"),
            outline("BLOCK", "BAR"),
            bar.side_nodes("DRIVEN", "left"),
            ground(bar.next_node),
            elastic(young(courant, 0.125, dt), 0.3, 1.0, "BLOCK", "BAR"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("BLOCK", "GROUND"), ("BAR", "BLOCK")),
            ramp("PUSH", 0.0, 60 * dt),
            card("BOUNDARY", ("DRIVEN", 2)),
            step(
                dt,
                60,
                settings(scheme),
                card("BOUNDARY, AMPLITUDE=PUSH", ("DRIVEN", 1, 1, 1.0)),
                card("DLOAD", ("BLOCK", "GRAV", GRAVITY, 0.0, -1.0)),
            ),
        ]
    )


def ground(reference: int) -> str:
    """Rigid ground at y = 0 with its reference node."""
    return "".join(
        [
            card("NODE, NSET=REF", (reference, -5.0, 0.0)),
            card("SURFACE, NAME=GROUND, TYPE=SEGMENTS", ("START", -5.0, 0.0), ("LINE", 9.0, 0.0)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=GROUND, REF NODE={reference}"),
            card("BOUNDARY", (reference, 1, 2)),
        ]
    )
