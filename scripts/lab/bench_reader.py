"""The group `read` of scripts/lab/run bench: reading and checking decks of a million nodes."""

import math
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from stickslip.decks import Grid, card, dry, elastic, step
from stickslip.errors import Fault

from lab.bench_runs import COLLECTED, MISSING_VALGRIND
from lab.measured_run import Usage, wait
from lab.sample_decks import runner

NODES = 1_000_000
COUNTED = 100_000
"""Nodes of the decks under valgrind."""
GAP = 1e-6
ASIDE = 0.001
"""The upper block lies so far above the lower one and beside it."""

Place = tuple[float, float]


@dataclass(frozen=True)
class Form:
    """A way of writing two blocks of square elements, one on the other."""

    name: str
    text: Callable[[int], str]
    """The deck with so many nodes in all."""


def wave(side: int, i: int, j: int) -> Place:
    """Node (i, j) of a unit square of side x side elements, bent inside."""
    x, y = i / side, j / side
    size = 0.1 * math.sin(math.pi * x) * math.sin(math.pi * y)
    return x + size * (0.5 - y), y + size * y * (1 - y)


def elements_along(nodes: int) -> int:
    """Elements along a block, of two with so many nodes."""
    return max(math.isqrt(nodes // 2) - 1, 4)


def conditions(side: int, base: str, surfaces: tuple[str, str], body: str) -> str:
    """Friction, contact, support and a step with gravity."""
    return "".join(
        [
            dry(0.3),
            card("CONTACT PAIR, INTERACTION=DRY", surfaces),
            card("BOUNDARY", (base, 1, 2)),
            step(0.1 / side, 5, card("DLOAD", (body, "GRAV", 10.0, 0.0, -1.0))),
        ]
    )


def flat(nodes: int, decimals: int) -> str:
    """A flat deck; coordinates have this many decimals."""
    side = elements_along(nodes)

    def at(left: float, base: float, i: int, j: int) -> Place:
        x, y = wave(side, i, j)
        return round(left + x, decimals), round(base + y, decimals)

    lower = Grid("LOWER", side, side, lambda i, j: at(0.0, -1.0, i, j))
    labels = lower.next_node, lower.next_element
    upper = Grid("UPPER", side, side, lambda i, j: at(ASIDE, GAP, i, j), *labels)
    return "".join(
        [
            card("HEADING", (f"two blocks of {side} x {side} elements",)),
            *(grid.mesh("CPE4") for grid in (lower, upper)),
            lower.side_nodes("BASE", "bottom"),
            lower.side_surface("ROAD", "top"),
            upper.side_surface("SOLE", "bottom"),
            elastic(1e4, 0.3, 1.0, "LOWER", "UPPER"),
            conditions(side, "BASE", ("SOLE", "ROAD"), "UPPER"),
        ]
    )


def instances(nodes: int) -> str:
    """One part and two instances of it."""
    side = elements_along(nodes)
    block = Grid("ALL", side, side, lambda i, j: wave(side, i, j))
    material, *sections = elastic(1e4, 0.3, 1.0, "ALL").partition("*SOLID SECTION")
    return "".join(
        [
            card("HEADING", (f"two blocks of {side} x {side} elements",)),
            card("PART, NAME=BLOCK"),
            block.mesh("CPE4"),
            block.side_nodes("BASE", "bottom"),
            block.side_surface("TOP", "top"),
            block.side_surface("BOTTOM", "bottom"),
            *sections,
            card("END PART"),
            card("ASSEMBLY, NAME=BOTH"),
            card("INSTANCE, NAME=LOWER, PART=BLOCK", (0.0, -1.0, 0.0)),
            card("END INSTANCE"),
            card("INSTANCE, NAME=UPPER, PART=BLOCK", (ASIDE, GAP, 0.0)),
            card("END INSTANCE"),
            card("END ASSEMBLY"),
            material,
            conditions(side, "LOWER.BASE", ("UPPER.BOTTOM", "LOWER.TOP"), "UPPER.ALL"),
        ]
    )


FORMS = (
    Form("9 decimals", lambda nodes: flat(nodes, 9)),
    Form("16 decimals", lambda nodes: flat(nodes, 16)),
    Form("two instances of a part", instances),
)


def write(form: Form, nodes: int, deck: Path) -> int:
    """Writes a deck; returns its size in bytes.

    A process of its own does so: the system counts the memory of this one as that of the programs
    that it starts.
    """

    def in_child() -> None:
        deck.write_text(form.text(nodes))

    child = get_context("fork").Process(target=in_child)
    child.start()
    child.join()
    return deck.stat().st_size


def used_by(*command: Path | str) -> Usage:
    """What a command uses."""
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    usage = wait(process)
    if process.returncode != 0:
        raise Fault(f"{command[0]} ended with {process.returncode}")
    return usage


def fastest(repeat: int, *command: Path | str) -> Usage:
    """What a command uses in the fastest of several runs."""
    return min((used_by(*command) for _ in range(repeat)), key=lambda usage: usage.seconds)


def instructions(program: Path, form: Form, folder: Path) -> float:
    """Instructions of `check` per byte of a smaller deck, counted by valgrind."""
    deck = folder / "counted.inp"
    size = write(form, COUNTED, deck)
    count = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    try:
        done = subprocess.run([*count, program, "check", deck], capture_output=True, text=True)
    except FileNotFoundError as error:
        raise Fault(MISSING_VALGRIND) from error
    found = COLLECTED.search(done.stderr)
    if found is None:
        raise Fault("valgrind counted nothing")
    return int(found[1]) / size


def cells(program: Path, form: Form, repeat: int, count: bool, folder: Path) -> list[str]:
    """One line of the table."""
    deck = folder / "blocks.inp"
    size = write(form, NODES, deck)
    floor = fastest(repeat, "wc", "-l", deck)
    usage = fastest(repeat, program, "check", deck)
    line = [
        form.name,
        f"{size / 1e6:.1f}",
        f"{usage.seconds:.2f}",
        f"{size / 1e6 / usage.seconds:.0f}",
        f"{usage.peak / size:.1f}",
        f"{floor.seconds:.3f}",
    ]
    return [*line, f"{instructions(program, form, folder):.0f}"] if count else line


def table(program: Path, repeat: int, count: bool) -> str:
    """What `check` takes for each form of the deck, and `wc -l` for the same bytes."""
    header = ["coordinates", "size [MB]", "CPU [s]", "MB/s", "memory over size", "`wc -l` [s]"]
    lines = []
    for form in FORMS:
        with tempfile.TemporaryDirectory(prefix="bench_") as folder:
            lines.append(cells(program, form, repeat, count, Path(folder)))
        print("  ".join(lines[-1]), flush=True)
    return runner.markdown([*header, *(["instructions per byte"] if count else [])], lines)
