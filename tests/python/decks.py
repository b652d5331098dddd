"""Decks of the tests: the shipped ones, shortened, and some made here."""

import runpy
from math import cos, pi, sin
from pathlib import Path

from stickslip.decks import Grid, card, elastic, step
from stickslip.deck import Card, Deck

ROOT = Path(__file__).resolve().parents[2]
BLOCK = ROOT / "input" / "block_slope"
CANTILEVERS = ROOT / "input" / "two_cantilevers"
RINGS = ROOT / "input" / "bouncing_rings"
PILE = ROOT / "input" / "disc_pile"
DISCS = ROOT / "input" / "bouncing_discs"
SHAPES = ROOT / "input" / "shapes_in_a_box"
IMPACT = ROOT / "verification" / "impact"
COLUMN = ROOT / "input" / "buckling_self_contact"
CORNERS = ROOT / "input" / "corner_to_corner"
WEDGES = ROOT / "input" / "folding_wedges"
ROLLER = ROOT / "input" / "roller"
CAM = ROOT / "input" / "cam_follower"
PAD = ROOT / "input" / "pad_on_a_spring"
BULLET = ROOT / "input" / "fast_bullet"
BAR = ROOT / "verification" / "elastic_bar"

SS22 = {"SCHEME": "SS22", "THETA1": "1.", "THETA2": "1."}
DEFAULT: dict[str, str] = {}
SCHEMES = {"ss22": SS22, "default": DEFAULT}


def shortened(path: Path, increments: int, scheme: str = "ss22") -> Deck:
    """A deck with fewer increments, with the given scheme."""
    deck = Deck.read(path)
    deck.set_increments(deck.dt, increments)
    deck.set_settings(**SCHEMES[scheme])
    return deck


def generated(folder: Path) -> dict[str, object]:
    """Names of a folder's generate.py."""
    return runpy.run_path(str(folder / "generate.py"))


def body(
    grid: Grid, velocity: tuple[float, float], spin: float, centre: tuple[float, float]
) -> str:
    """Mesh of a free body with a rigid-body velocity about `centre`."""
    rows = []
    for j in range(grid.ny + 1):
        for i in range(grid.nx + 1):
            x, y = grid.place(i, j)
            rows.append((grid.node(i, j), 1, velocity[0] - spin * (y - centre[1])))
            rows.append((grid.node(i, j), 2, velocity[1] + spin * (x - centre[0])))
    return grid.mesh("CPS4") + card("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)


def parse(text: str, folder: Path) -> Deck:
    """A deck from its text."""
    path = folder / "deck.inp"
    path.write_text(text)
    return Deck.read(path)


def spinning_bar(folder: Path) -> Deck:
    """A free bar that travels, spins and vibrates: 10 x 1, one turn per 2 pi, stretching at 1."""
    bar = Grid("BAR", 20, 2, lambda i, j: (0.5 * i - 5.0, 0.5 * j - 0.5))
    rows = [
        (bar.node(i, j), 1, 1.0 - bar.place(i, j)[1] + sin(pi * bar.place(i, j)[0] / 10.0))
        for j in range(3)
        for i in range(21)
    ]
    rows += [(bar.node(i, j), 2, 2.0 + bar.place(i, j)[0]) for j in range(3) for i in range(21)]
    text = card("HEADING", ("spinning, vibrating bar",)) + bar.mesh("CPS4")
    text += card("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)
    text += elastic(1e4, 0.3, 1.0, "BAR") + step(0.02, 300)
    return parse(text, folder)


def oblique_impact(friction: float, folder: Path) -> Deck:
    """A spinning block flies obliquely onto a free beam; nothing is supported."""
    beam = Grid("BEAM", 24, 3, lambda i, j: (0.5 * i - 6.0, 0.4 * j - 1.2))
    angle, centre = 0.04, (-1.0, 1.3)

    def place(i: int, j: int) -> tuple[float, float]:
        x, y = 0.5 * i - 1.0, 0.5 * j - 1.0
        turned = (x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle))
        return centre[0] + turned[0], centre[1] + turned[1]

    block = Grid("BLOCK", 4, 4, place, beam.next_node, beam.next_element)
    text = "".join(
        [
            card("HEADING", (f"oblique impact of two free bodies, friction {friction}",)),
            body(beam, (0.0, 0.4), 0.0, (0.0, 0.0)),
            body(block, (0.8, -1.0), 0.05, centre),
            elastic(1000.0, 0.3, 1.0, "BEAM", "BLOCK"),
            block.side_surface("BLOCK_FACE", "bottom"),
            beam.side_surface("BEAM_FACE", "top"),
            card("SURFACE INTERACTION, NAME=INTERFACE"),
            card("FRICTION", (friction,)),
            card("CONTACT PAIR, INTERACTION=INTERFACE", ("BLOCK_FACE", "BEAM_FACE")),
            step(0.01, 300),
        ]
    )
    return parse(text, folder)


def with_history(deck: Deck, name: str) -> Deck:
    """The deck with a history of a node set."""
    place = deck.cards.index(deck.one("END STEP"))
    deck.cards.insert(place, Card("NODEPRINT", f"*NODE PRINT, NSET={name}", [["U", "V", "RF"]]))
    return deck
