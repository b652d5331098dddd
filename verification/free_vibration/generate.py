"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, elastic, step  # noqa: E402


def write(folder: Path, omega: float, scheme: str, name: str, count: int = 20) -> None:
    """A mass on a spring, of natural frequency 1, `count` increments of the length `omega`; `name` that of the scheme."""
    cards = [
        card("HEADING", (f"free vibration, {name} scheme",)),
        card("NODE, NSET=MASS", (1, 0.5, 0.5)),
        card("NODE", (2, 0.0, 0.0), (3, 1.0, 0.0), (4, 1.0, 1.0), (5, 0.0, 1.0)),
        card("ELEMENT, TYPE=CPE4, ELSET=BODY", (1, 2, 3, 4, 5)),
        elastic(1.0, 0.0, 1.0, "BODY"),
        card("RIGID BODY, ELSET=BODY, REF NODE=MASS"),
        card("ELEMENT, TYPE=SPRING1, ELSET=ESPRING", (2, 1)),
        card("SPRING, ELSET=ESPRING", (1,), (1.0,)),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", (1, 1, 1.0)),
        card("BOUNDARY", (1, 2, 2), (1, 6, 6)),
        step(omega, count, card(f"STICKSLIP, SCHEME={scheme}"), prints("MASS")),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "oscillator.inp").write_text("".join(cards))
