"""The decks that scripts/lab/run bench measures: examples, two blocks, large models, many contacts."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from repository import ROOT
from stickslip.deck import Deck
from stickslip.decks import Grid, card, dry, elastic, step

from lab.bench_dense import arch, lattice, long_block, thrown, wall

sys.path.insert(0, str(ROOT / "verification" / "convergence"))

import elastic_blocks  # noqa: E402

EXAMPLES = (
    "two_cantilevers/A_mu02",
    "block_slope/block_slope_mu02",
    "bouncing_rings/rings_mu02",
    "brake_pad/brake_pad_damped",
    "buckling_self_contact/column_mu02",
    "disc_pile/disc_pile",
    "rubber_ring/rubber_ring_mu05",
    "shapes_in_a_box/shapes_five",
    "snap_fit/snap_fit_damped",
)
STATICS = (
    "bumper/bumper",
    "disc_spring/disc_spring_mu014",
    "o_ring/o_ring_groove",
    "press_fit/press_fit_mu01",
    "roller/roller_free",
)
"""Examples with static steps."""

SHORT = 300
"""Increments of an example at most, but for the first one, which has 1000."""

SIZES = (16, 32, 64, 128, 256)
"""Elements along the blocks."""

GRAVITY = ("", "GRAV", 10.0, 0.0, -1.0)


@dataclass(frozen=True)
class Bench:
    """A deck to measure."""

    name: str
    text: Callable[[], str]
    options: tuple[str, ...] = ("--frames", "1")
    """Of the command line; models that are large write the first frame and the last."""
    size: int = 0
    """Elements along two blocks, 0 for others."""

    def write(self, folder: Path) -> Path:
        """Writes the deck into a folder."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.name.rpartition('/')[2]}.inp"
        path.write_text(self.text())
        return path


def example(name: str) -> Bench:
    """A deck of input/, up to SHORT increments of its first step."""

    def text() -> str:
        deck = Deck.read(ROOT / "input" / f"{name}.inp")
        rows = deck.find("DYNAMIC")[0].rows
        dt, period = (float(value) for value in rows[0][:2])
        most = SHORT if name != EXAMPLES[0] else 1000
        rows[0][1] = repr(min(period, most * dt))
        return deck.text()

    return Bench(name, text, ())


def whole(name: str) -> Bench:
    """A deck of input/ as it stands."""
    return Bench(name, lambda: Deck.read(ROOT / "input" / f"{name}.inp").text(), ())


def two_blocks(size: int, scheme: str, passes: int = 1) -> Bench:
    """Two blocks of size x size/2 elements each, pressed and sheared, friction 0.3: nodes of one on segments of the
    other, or pairs in both orders whose discretisation the program chooses."""
    kind = ", TYPE=NODE TO SURFACE" if passes == 1 else ""

    def text() -> str:
        return elastic_blocks.two_blocks(size, 0.3, passes=passes, scheme=scheme, kind=kind)

    sides = "_two_sided" if passes == 2 else ""
    return Bench(f"two_blocks_{size}{sides}", text, size=size if passes == 1 else 0)


def waves(size: int) -> Bench:
    """Two blocks whose increments are so short that their waves are resolved."""

    def text() -> str:
        deck = Deck.parse(elastic_blocks.two_blocks(size, 0.3, passes=1))
        deck.set_increments(2e-4, 1000)
        return deck.text()

    return Bench(f"two_blocks_{size}_waves", text)


def static_blocks(size: int, friction: float) -> Bench:
    """Two blocks pressed and sheared in a static step of 20 increments, surface to surface."""

    def text() -> str:
        kind = ", TYPE=SURFACE TO SURFACE"
        deck = Deck.parse(elastic_blocks.two_blocks(size, friction, passes=1, kind=kind))
        (card_of_step,) = deck.find("DYNAMIC")
        card_of_step.keyword, card_of_step.head = "STATIC", "*STATIC, DIRECT"
        return deck.text()

    return Bench(f"two_blocks_{size}_static_mu{round(10 * friction):02}", text)


def dense_decks(scheme: str) -> list[Bench]:
    """Walls, lattices, arches, faces that are both slaves, many pairs between two bodies."""
    sides = {1: "one_sided", 2: "two_sided"}
    decks = [
        (f"wall_{n * n}_{name}", partial(wall, n, n, k))
        for n in (3, 5, 7, 10)
        for k, name in sides.items()
    ]
    decks += [("lattice_100", partial(lattice, 10, 10, 10))]
    decks += [("lattice_1000", partial(lattice, 25, 40, 5))]
    decks += [(f"thrown_{n * n}", partial(thrown, n, n)) for n in (10, 20)]
    decks += [(f"arch_{n}", partial(arch, n)) for n in (5, 11, 21)]
    decks += [(f"long_block_{n}", partial(long_block, n)) for n in (250, 500, 1000, 2000, 4000)]
    blocks = [two_blocks(size, scheme, 2) for size in (32, 256, 512)]
    return [Bench(name, text) for name, text in decks] + blocks


def large_blocks() -> Bench:
    """Two blocks of 512 x 256 elements each: half a million dofs, 512 contacts."""

    def text() -> str:
        deck = elastic_blocks.two_blocks(512, 0.3, passes=1)
        return deck.replace("0.01, 0.2\n", "0.01, 0.05\n")

    return Bench("two_blocks_512", text)


def large_block() -> Bench:
    """A block of 1000 x 500 elements without contact, pressed and let go: a million dofs."""

    def text() -> str:
        block = Grid("BLOCK", 1000, 500, lambda i, j: (i / 1000, j / 1000))
        return "".join(
            [
                card("HEADING", ("a block that falls on its held base; a million dofs",)),
                block.mesh("CPE4"),
                block.side_nodes("BASE", "bottom"),
                elastic(1e4, 0.3, 1.0, "BLOCK"),
                card("BOUNDARY", ("BASE", 1, 2)),
                step(0.01, 5, card("DLOAD", ("BLOCK", *GRAVITY[1:]))),
            ]
        )

    return Bench("one_block_1000", text)


def block_at(left: float, size: float) -> Callable[[int, int], tuple[float, float]]:
    """Places of the nodes of a block just above y = 0."""
    return lambda i, j: (left + i * size, (j + 1e-5) * size)


def strip_and_blocks(blocks: int, across: int, *, is_rigid: bool = False) -> Bench:
    """A strip with a surface of 10 000 segments, on which blocks lie that close 2000 pairs in all.

    Each of the `blocks` is `across` segments of the strip long and 4 elements high, its nodes amid
    the segments. All nodes of a rigid strip are fixed, else those at its bottom.
    """
    segments, size = 10_000, 0.01

    def text() -> str:
        strip = Grid("STRIP", segments, 4, lambda i, j: (i * size, (j - 4) * size))
        parts, labels = [strip], (strip.next_node, strip.next_element)
        for k in range(blocks):
            left = (k + 0.5) * segments / blocks * size - across * size / 2 + 0.5 * size
            parts.append(Grid(f"B{k}", across, 4, block_at(left, size), *labels))
            labels = parts[-1].next_node, parts[-1].next_element
        names = [part.name for part in parts[1:]]
        soles = [(part.element(0, 0), part.element(across - 1, 0), 1) for part in parts[1:]]
        return "".join(
            [
                card("HEADING", (f"{blocks} blocks on a strip; 2000 pairs",)),
                *(part.mesh("CPE4") for part in parts),
                strip.side_nodes("BASE", "bottom"),
                strip.side_surface("ROAD", "top"),
                card("ELSET, ELSET=SOLES, GENERATE", *soles),
                card("SURFACE, NAME=SOLES", ("SOLES", "S1")),
                elastic(1e4, 0.3, 1.0, "STRIP", *names),
                dry(0.3),
                card("CONTACT PAIR, INTERACTION=DRY", ("SOLES", "ROAD")),
                card("BOUNDARY", ("STRIP" if is_rigid else "BASE", 1, 2)),
                step(0.001, 20, card("DLOAD", *((name, *GRAVITY[1:]) for name in names))),
            ]
        )

    kind = "rigid_strip" if is_rigid else "strip"
    return Bench(f"{kind}_{blocks}_blocks", text)


def group(name: str, scheme: str, sizes: tuple[int, ...]) -> list[Bench]:
    """The decks of a group."""
    groups: dict[str, Callable[[], list[Bench]]] = {
        "examples": lambda: [example(deck) for deck in EXAMPLES],
        "blocks": lambda: [two_blocks(size, scheme) for size in sizes],
        "scale": lambda: [large_blocks(), large_block()],
        "many": lambda: [
            strip_and_blocks(200, 9, is_rigid=True),
            strip_and_blocks(200, 9),
            strip_and_blocks(10, 199),
            strip_and_blocks(1, 1999),
        ],
        "dense": lambda: dense_decks(scheme),
        "waves": lambda: [waves(size) for size in (32, 64)],
        "static": lambda: [whole(name) for name in STATICS]
        + [static_blocks(size, friction) for friction in (0.0, 0.3) for size in (32, 64, 128)],
    }
    return groups[name]()


GROUPS = ("examples", "blocks", "scale", "many", "dense", "waves", "static")
