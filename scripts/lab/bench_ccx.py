"""Decks of CalculiX for the same meshes: two blocks pressed and sheared, without friction."""

from stickslip.decks import card, elastic, facing_blocks

STIFFNESS = 1e6
"""Pressure over penetration: a hundred times Young's modulus over the height of the blocks."""


def two_blocks(size: int) -> str:
    """The two blocks of `elastic_blocks.two_blocks` with frictionless penalty contact of their faces.

    It is quasi-static: with inertia CalculiX cuts the second increment until it gives up. Matrices and
    iterations are those of a dynamic increment.
    """
    upper, lower = facing_blocks(size, 0.1)
    return "".join(
        [
            card("HEADING", ("two blocks pressed and sheared; without friction",)),
            upper.mesh("CPE4"),
            lower.mesh("CPE4"),
            upper.side_nodes("TOP", "top"),
            lower.side_nodes("BOTTOM", "bottom"),
            upper.side_surface("FACE", "bottom"),
            lower.side_surface("GROUND", "top"),
            elastic(1e4, 0.3, 1.0, "UPPER", "LOWER"),
            card("SURFACE INTERACTION, NAME=SMOOTH"),
            card("SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", (STIFFNESS,)),
            card("CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE", ("FACE", "GROUND")),
            card("BOUNDARY", ("BOTTOM", 1, 2)),
            card("AMPLITUDE, NAME=PRESS", (0.0, 0.0), (0.1, 1.0), (1.0, 1.0)),
            card("AMPLITUDE, NAME=SHEAR", (0.0, 0.0), (0.1, 0.0), (0.2, 1.0)),
            card("STEP, NLGEOM, INC=1000"),
            card("STATIC", (0.01, 0.2, 1e-6, 0.01)),
            card("BOUNDARY, AMPLITUDE=PRESS", ("TOP", 2, 2, -0.01)),
            card("BOUNDARY, AMPLITUDE=SHEAR", ("TOP", 1, 1, 0.02)),
            card("NODE PRINT, NSET=TOP, FREQUENCY=1000", ("U",)),
            card("END STEP"),
        ]
    )
