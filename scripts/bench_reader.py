#!/usr/bin/env python3
"""Measures the reading and checking of a deck of a million nodes.

    scripts/bench_reader.py [PROGRAM ...] [--nodes N] [--instructions]

Prints for each program the processor time of `check`, megabytes per second and the largest memory
over the size of the deck, and before them the time in which `wc -l` reads the same bytes. Valgrind
counts the instructions (20 000 nodes are enough for these).
"""

import argparse
import math
import re
import subprocess
import tempfile
from pathlib import Path

from cards import card, dry, elastic, step
from command import Fault
from measured_run import Usage, check_program, wait
from program import ROOT
from quads import Grid


def blocks(nodes: int) -> str:
    """Two blocks with this many nodes in all, one on the other, with sets and surfaces."""
    side = max(math.isqrt(nodes // 2) - 1, 4)

    def at(left: float, base: float, i: int, j: int) -> tuple[float, float]:
        x, y = i / side, j / side
        wave = 0.1 * math.sin(math.pi * x) * math.sin(math.pi * y)
        return round(left + x + wave * (0.5 - y), 9), round(base + y + wave * y * (1 - y), 9)

    lower = Grid("LOWER", side, side, lambda i, j: at(0.0, -1.0, i, j))
    labels = lower.next_node, lower.next_element
    upper = Grid("UPPER", side, side, lambda i, j: at(0.001, 1e-6, i, j), *labels)
    return "".join(
        [
            card("HEADING", (f"two blocks of {side} x {side} elements",)),
            *(grid.mesh("CPE4") for grid in (lower, upper)),
            lower.side_nodes("BASE", "bottom"),
            lower.side_surface("ROAD", "top"),
            upper.side_surface("SOLE", "bottom"),
            elastic(1e4, 0.3, 1.0, "LOWER", "UPPER"),
            dry(0.3),
            card("CONTACT PAIR, INTERACTION=DRY", ("SOLE", "ROAD")),
            card("BOUNDARY", ("BASE", 1, 2)),
            step(0.1 / side, 5, card("DLOAD", ("UPPER", "GRAV", 10.0, 0.0, -1.0))),
        ]
    )


def used_by(*command: Path | str) -> Usage:
    """What a command uses."""
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    usage = wait(process)
    if process.returncode != 0:
        raise Fault(f"{command[0]} ended with {process.returncode}")
    return usage


def instructions(program: Path, deck: Path) -> int:
    """Instructions of `check`, counted by valgrind."""
    count = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    done = subprocess.run([*count, program, "check", deck], capture_output=True, text=True)
    found = re.search(r"Collected *: *(\d+)", done.stderr)
    if found is None:
        raise Fault("valgrind counted nothing")
    return int(found[1])


def report(name: str, usage: Usage, size: int) -> None:
    """One line of figures."""
    speed = size / 1e6 / max(usage.seconds, 1e-3)
    print(f"{name}: {usage.seconds:.2f} s, {speed:.0f} MB/s, memory {usage.peak / size:.1f} bytes per byte")


def main() -> None:
    """Writes the deck and measures the programs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("programs", nargs="*", type=Path, default=[ROOT / "target/release/stickslip"])
    parser.add_argument("--nodes", type=int, default=1_000_000)
    parser.add_argument("--instructions", action="store_true")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "blocks.inp"
        deck.write_text(blocks(args.nodes))
        size = deck.stat().st_size
        report("wc -l", used_by("wc", "-l", deck), size)
        for program in map(check_program, args.programs):
            report(str(program), used_by(program, "check", deck), size)
            if args.instructions:
                print(f"  {instructions(program, deck) / size:.0f} instructions per byte")


if __name__ == "__main__":
    main()
