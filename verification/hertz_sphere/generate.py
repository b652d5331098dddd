"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import static  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic  # noqa: E402


from form import load

flat = load(Path(__file__).resolve().parents[1] / "static_contact" / "generate.py")


def write(folder: Path, division: int, radius: float = 0.025) -> None:
    """The lower part of a sphere that a force presses on a rigid plane; `division` elements in the radius of the contact."""
    young, poisson = 1000.0, 0.3
    flat.HALF_WIDTH = radius
    sphere = flat.cylinder("SPHERE", radius / division, half=True)
    force = 4 / 3 * young / (1 - poisson**2) * radius**3
    cards = [
        card("HEADING", ("a sphere on a plane",)),
        sphere.mesh("CAX4"),
        sphere.side_surface("FOOT", "bottom"),
        sphere.side_nodes("FOOT", "bottom"),
        sphere.side_nodes("AXIS", "left"),
        flat.plane("GROUND", -0.1, 0.9),
        flat.guided(sphere, 1, 2),
        elastic(young, poisson, 1.0, "SPHERE"),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", ("FOOT", "GROUND")),
        card("BOUNDARY", ("AXIS", 1, 1), ("REFERENCE", 1, 2)),
        static(card("CLOAD", ("HEAD", 2, -force)), dt=0.25, direct=True),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sphere.inp").write_text("".join(cards))
