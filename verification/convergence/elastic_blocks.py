"""Elastic bodies that are pressed on each other: blocks sheared, at rest, or dropped; a long bar."""

from settings import ramp, settings
from stickslip.decks import Grid, card, dry, elastic, facing_blocks, outline, step


def two_blocks(
    elements: int = 32,
    friction: float = 0.3,
    passes: int = 2,
    segments: float | None = None,
    offset: float | None = None,
    scheme: str = "default",
    kind: str = ", TYPE=NODE TO SURFACE",
) -> str:
    """Two blocks 1 x 0.5, the upper one pressed down by 0.01 and then sheared by 0.02.

    `passes`: contact passes, with one surface as slave or with each of them. `segments`: shear
    in each of ten increments, in segments of the surfaces. `offset`: of the facing nodes, in
    segments; without it the upper block stands 0.1 to the right. `kind`: discretisation of the
    pairs. The surfaces are whole skins.
    """
    size = 1.0 / elements
    upper, lower = facing_blocks(elements, 0.1 if offset is None else offset * size)
    pairs = [("UPPER", "LOWER"), ("LOWER", "UPPER")][:passes]
    shear = 0.02 if segments is None else 10.0 * segments * size
    return "".join(
        [
            card("HEADING", (f"two blocks pressed and sheared; friction {friction}",)),
            upper.mesh("CPE4"),
            lower.mesh("CPE4"),
            upper.side_nodes("TOP", "top"),
            lower.side_nodes("BOTTOM", "bottom"),
            outline("UPPER", "LOWER"),
            elastic(1e4, 0.3, 1.0, "UPPER", "LOWER"),
            dry(friction),
            card(f"CONTACT PAIR, INTERACTION=DRY{kind}", *pairs),
            card("BOUNDARY", ("BOTTOM", 1, 2)),
            card("AMPLITUDE, NAME=PRESS", (0.0, 0.0), (0.1, 1.0), (1.0, 1.0)),
            card("AMPLITUDE, NAME=SHEAR", (0.0, 0.0), (0.1, 0.0), (0.2, 1.0)),
            step(
                0.01,
                20,
                settings(scheme),
                card("BOUNDARY, AMPLITUDE=PRESS", ("TOP", 2, 2, -0.01)),
                card("BOUNDARY, AMPLITUDE=SHEAR", ("TOP", 1, 1, shear)),
            ),
        ]
    )


def block_at_rest(
    friction: float = 0.0, tolerance: float | None = None, scheme: str = "default"
) -> str:
    """A light block on another one, pressed by a load that rises and then stays: they rest."""
    upper = Grid("UPPER", 5, 4, lambda i, j: (i / 5, j / 8))
    labels = upper.next_node, upper.next_element
    lower = Grid("LOWER", 4, 4, lambda i, j: (i / 4, j / 8 - 0.5), *labels)
    return "".join(
        [
            card("HEADING", ("a block on another one, pressed until both rest",)),
            upper.mesh("CPE4"),
            lower.mesh("CPE4"),
            lower.side_nodes("BOTTOM", "bottom"),
            upper.side_nodes("UPPER_LEFT", "left"),
            lower.side_nodes("LOWER_LEFT", "left"),
            upper.side_surface("FACE", "bottom"),
            lower.side_surface("GROUND", "top"),
            upper.side_surface("LOADED", "top"),
            elastic(1e4, 0.3, 1e-3, "UPPER", "LOWER"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "GROUND"), ("GROUND", "FACE")),
            card("BOUNDARY", ("BOTTOM", 2), ("UPPER_LEFT", 1), ("LOWER_LEFT", 1)),
            ramp("LOAD", 0.0, 0.5),
            step(
                0.02,
                50,
                settings(scheme, tolerance),
                card("DSLOAD, AMPLITUDE=LOAD", ("LOADED", "P", 50.0)),
            ),
        ]
    )


def dropped_block(scheme: str = "default") -> str:
    """A block that falls on a wider one, both symmetric about one line, without friction.

    Their middle nodes meet at a convex and a hollow corner and come back to each other.
    """
    base = Grid("BASE", 4, 2, lambda i, j: (0.5 * i, 0.5 * j))
    labels = base.next_node, base.next_element
    block = Grid("BLOCK", 2, 2, lambda i, j: (0.5 + 0.5 * i, 1.01 + 0.5 * j), *labels)
    return "".join(
        [
            card("HEADING", ("a block that falls on a wider one",)),
            base.mesh("CPS4"),
            block.mesh("CPS4"),
            base.side_nodes("BOTTOM", "bottom"),
            elastic(1e3, 0.3, 1.0, "BASE", "BLOCK"),
            dry(0.0),
            card("CONTACT"),
            card("CONTACT INCLUSIONS, ALL EXTERIOR"),
            card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
            card("BOUNDARY", ("BOTTOM", 1, 2)),
            step(
                0.005,
                200,
                settings(scheme),
                card("DLOAD", ("", "GRAV", 9.81, 0.0, -1.0)),
            ),
        ]
    )


def compressed_bar(
    young: float = 2e4, force: float = -10.0, friction: float = 0.5, scheme: str = "default"
) -> str:
    """A thin bar 8 x 0.05, pressed on rigid ground, its free end pushed or pulled by two forces.

    With the defaults the force is far beyond its Euler load: contact alone keeps it straight.
    """
    bar = Grid("BAR", 80, 1, lambda i, j: (0.1 * i, 0.05 * j))
    reference = bar.next_node
    return "".join(
        [
            card("HEADING", (f"a bar on the ground, loaded along it; friction {friction}",)),
            bar.mesh("CPS4"),
            bar.side_nodes("HELD", "left"),
            bar.side_nodes("END", "right"),
            bar.side_surface("FACE", "bottom"),
            bar.side_surface("LOADED", "top"),
            card("NODE, NSET=REF", (reference, -3.0, 0.0)),
            card("SURFACE, NAME=GROUND, TYPE=SEGMENTS", ("START", -3.0, 0.0), ("LINE", 11.0, 0.0)),
            card(f"RIGID BODY, ANALYTICAL SURFACE=GROUND, REF NODE={reference}"),
            elastic(young, 0.0, 0.01, "BAR"),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "GROUND")),
            card("BOUNDARY", (reference, 1, 2), ("HELD", 1)),
            ramp("PRESS", 0.0, 2.0),
            ramp("PUSH", 2.0, 6.0),
            step(
                0.1,
                80,
                settings(scheme),
                card("DSLOAD, AMPLITUDE=PRESS", ("LOADED", "P", 1.0)),
                card("CLOAD, AMPLITUDE=PUSH", ("END", 1, force)),
            ),
        ]
    )
