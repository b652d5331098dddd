#!/usr/bin/env python3
"""Loads that are put on and taken off: every body ends where it began.

A cantilever of every element is bent by a load that grows and goes back to zero, in every procedure,
with increments of three lengths. The run must end with exit code 0, every check of the program must
hold, and the displacements of the end must be zero beside the largest of the run.

A line for each failure, then how many of the runs have failed. The exit code is 1 when one has.
"""

import argparse
import json
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import h5py
import numpy as np
from stickslip.command import finish
from stickslip.errors import Fault
from stickslip.program import binary

LINEAR = ("CPE3", "CPE4", "CPS4", "CPE4H", "CPE4R", "CPE4I", "CPS4I", "CAX4", "CAX4I")
QUADRATIC = ("CPE6", "CPE8", "CPE8R", "CPE8H", "CPE8RH", "CAX8R")
ELEMENTS = (*LINEAR, *QUADRATIC)

LOADS = ("force", "moment", "pressure", "gravity", "motion", "contact")

STATIC = {"coarse": 1.0, "medium": 0.25, "fine": 0.05}
"""First and largest increment of a step of length 1, which puts the load on or takes it off."""

MOVING = {"coarse": 0.1, "medium": 0.05, "fine": 0.02}
"""The same in dynamic steps, of length REST."""

PROCEDURES = ("static", "quasi-static", "fixed", "automatic")

REST = 20.0
"""Time in a dynamic step, of which the load takes the first two units."""

ZERO = {"static": 1e-9, "quasi-static": 1e-9, "fixed": 1e-3, "automatic": 1e-3}
"""Largest displacement at the end beside the largest of the run. What a dynamic step has left is a
vibration of stiff modes, of which long increments take little."""

COUNT = (4, 2)
"""Elements along and across."""

LENGTH, HEIGHT = 4.0, 1.0


@dataclass(frozen=True)
class Case:
    """A run of the table."""

    element: str
    procedure: str
    load: str
    size: str

    @property
    def name(self) -> str:
        """Name of its deck."""
        return "_".join((self.element, self.procedure, self.load, self.size)).replace("-", "")


def cases(
    elements: Sequence[str], procedures: Sequence[str], loads: Sequence[str], sizes: Sequence[str]
) -> Iterator[Case]:
    """All cases; a ring takes no moment in its plane."""
    for element, procedure, load, size in product(elements, procedures, loads, sizes):
        if not (element.startswith("CAX") and load == "moment"):
            yield Case(element, procedure, load, size)


class Mesh:
    """A rectangle of elements, nodes numbered along its columns, in half elements where that is needed."""

    def __init__(self, element: str, corner: tuple[float, float], first: int, size=(LENGTH, HEIGHT), count=COUNT):
        self.nodes: dict[int, tuple[float, float]] = {}
        self.elements: list[list[int]] = []
        self.first = first
        columns, rows = 2 * count[0], 2 * count[1]

        def node(i: int, j: int) -> int:
            label = first + i * (rows + 1) + j
            self.nodes[label] = (corner[0] + size[0] * i / columns, corner[1] + size[1] * j / rows)
            return label

        for i, j in product(range(0, columns, 2), range(0, rows, 2)):
            corners = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
            middles = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
            inside = (i + 1, j + 1)
            if "3" in element:
                shapes = [[corners[k] for k in t] for t in ((0, 1, 2), (0, 2, 3))]
            elif "6" in element:
                shapes = [
                    [corners[0], corners[1], corners[2], middles[0], middles[1], inside],
                    [corners[0], corners[2], corners[3], inside, middles[2], middles[3]],
                ]
            elif "8" in element:
                shapes = [corners + middles]
            else:
                shapes = [corners]
            self.elements += [[node(*place) for place in shape] for shape in shapes]
        self.triangles = "3" in element or "6" in element

    def text(self, element: str, name: str) -> str:
        """Its cards."""
        nodes = [f"{label}, {x!r}, {y!r}" for label, (x, y) in sorted(self.nodes.items())]
        rows = [", ".join(map(str, (self.first + k, *e))) for k, e in enumerate(self.elements)]
        return "\n".join(
            ["*NODE", *nodes, f"*ELEMENT, TYPE={element}, ELSET={name}", *rows]
            + [f"*SOLID SECTION, ELSET={name}, MATERIAL=SOFT", "1."]
        )

    def at(self, axis: int, value: float) -> list[int]:
        """Nodes of a side."""
        return [label for label, x in self.nodes.items() if abs(x[axis] - value) < 1e-9]

    def faces(self, name: str, axis: int, value: float) -> str:
        """A surface of the faces of a side."""
        nodes, rows = set(self.at(axis, value)), []
        for k, element in enumerate(self.elements):
            corners = 3 if self.triangles else 4
            ends = [(element[s], element[(s + 1) % corners]) for s in range(corners)]
            rows += [f"{self.first + k}, S{s + 1}" for s, e in enumerate(ends) if nodes >= set(e)]
        return "\n".join([f"*SURFACE, NAME={name}", *rows])


def deck(case: Case, scale: float = 1.0) -> str:
    """The deck of a case; its loads are multiplied by `scale`."""
    is_ring = case.element.startswith("CAX")
    x0 = 1.0 if is_ring else 0.0
    body = Mesh(case.element, (x0, 0.0), 1)
    end = x0 + LENGTH
    moves = case.procedure in ("fixed", "automatic")
    density = 0.04 if moves else 1e-4
    cards = [
        f"*HEADING\n{case.name}",
        f"*MATERIAL, NAME=SOFT\n*ELASTIC\n1000., .3\n*DENSITY\n{density}",
        *(["*DAMPING, ALPHA=20., BETA=0.002"] if moves else []),
        body.text(case.element, "BODY"),
        "*NSET, NSET=HELD\n" + "\n".join(map(str, body.at(0, x0))),
        "*NSET, NSET=TIP\n" + "\n".join(map(str, body.at(0, end))),
        "*NSET, NSET=ALL\n" + "\n".join(map(str, body.nodes)),
        body.faces("TOP", 1, HEIGHT),
        body.faces("RIGHT", 0, end),
        "*BOUNDARY\nHELD, 1, 2",
    ]
    if case.load == "moment":
        cards.append(
            f"*NODE\n9001, {end + 0.5!r}, 0.6\n*NSET, NSET=REF\n9001\n"
            "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=REF, SURFACE=RIGHT\n*KINEMATIC"
        )
    if case.load == "contact":
        other = Mesh(case.element, (end - 1.3, HEIGHT + 0.01), 1001, (1.0, 0.5), (1, 1))
        cards += [
            other.text(case.element, "PUNCH"),
            "*NSET, NSET=DRIVEN\n" + "\n".join(map(str, other.at(1, HEIGHT + 0.51))),
            other.faces("FOOT", 1, HEIGHT + 0.01),
            "*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.2\n"
            "*CONTACT PAIR, INTERACTION=DRY\nFOOT, TOP\n*BOUNDARY\nDRIVEN, 1, 2",
        ]

    def load(factor: float, amplitude: str) -> str:
        value = repr(scale * factor)
        kinds = {
            "force": ("*CLOAD{}\nTIP, 2, {}", -0.2),
            "moment": ("*CLOAD{}\nREF, 6, {}", 3.0),
            "pressure": ("*DSLOAD{}\nTOP, P, {}", 0.3),
            "gravity": ("*DLOAD{}\nBODY, GRAV, {}, 0., -1.", 0.3),
            "motion": ("*BOUNDARY{}\nTIP, 2, 2, {}", 0.15),
            "contact": ("*BOUNDARY{}\nDRIVEN, 2, 2, {}", -0.1),
        }
        card, most = kinds[case.load]
        value = repr(scale * factor * most)
        return card.format(amplitude, value)

    if moves or case.procedure == "quasi-static":
        dt = MOVING[case.size]
        cards.append("*AMPLITUDE, NAME=ONOFF, DEFINITION=SMOOTH STEP\n0., 0., 1., 1., 2., 0.")
        procedure = {
            "fixed": f"*DYNAMIC, DIRECT\n{dt!r}, {REST!r}",
            "automatic": f"*DYNAMIC\n{dt!r}, {REST!r}, , {10 * dt!r}",
            "quasi-static": f"*DYNAMIC, APPLICATION=QUASI-STATIC\n{dt!r}, {REST!r}, , {10 * dt!r}",
        }[case.procedure]
        steps = [(procedure, load(1.0, ", AMPLITUDE=ONOFF"))]
    else:
        dt = STATIC[case.size]
        procedure = f"*STATIC\n{dt!r}, 1., , {dt!r}"
        steps = [(procedure, load(factor, "")) for factor in (1.0, 0.0, 0.0)]
    for procedure, loads in steps:
        cards.append(
            f"*STEP, NLGEOM, INC=100000\n{procedure}\n{loads}\n"
            "*OUTPUT, FIELD, NUMBER INTERVAL=1\n*NODE OUTPUT\nU\n*OUTPUT, HISTORY\n"
            "*NODE OUTPUT, NSET=ALL\nU\n*END STEP"
        )
    return "\n".join([*cards, ""])


def failure(case: Case, folder: Path, scale: float) -> str:
    """What is wrong in a case; empty where all is well."""
    path = folder / f"{case.name}.inp"
    path.write_text(deck(case, scale))
    command = [binary(), "run", path, "-o", folder, "--overwrite", "--threads", "1"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "is not done in 60 s"
    if done.returncode != 0:
        first = [line for line in done.stderr.splitlines() + done.stdout.splitlines() if "error" in line or "stopped" in line]
        return f"exit code {done.returncode}: {' '.join(first[:2])}"
    result = folder / f"{case.name}.vtkhdf"
    with h5py.File(result) as file:
        certificate = file["history/certificate"]
        broken = []
        for name, values in certificate.items():
            worst, bound = np.max(values[:]), values.attrs["bound"]
            if not worst <= bound and not np.isnan(bound):
                broken.append(f"{name} {worst:.1e} above {bound:.0e}")
        u = np.abs(file["history/nodes/ALL/U"][:])
    result.unlink()
    left = u[-1].max() / u.max()
    if not left <= ZERO[case.procedure]:
        broken.append(f"{left:.1e} of the largest displacement {u.max():.1e} is left")
    return ", ".join(broken)


def main() -> int:
    """Runs the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    for name, values in (("element", ELEMENTS), ("procedure", PROCEDURES), ("load", LOADS), ("size", tuple(STATIC))):
        parser.add_argument(f"--{name}", action="append", choices=values)
    parser.add_argument("--scale", type=float, default=1.0, help="factor of all loads")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--deck", action="store_true", help="write the decks to the screen")
    arguments = parser.parse_args()
    table = list(
        cases(
            arguments.element or ELEMENTS,
            arguments.procedure or PROCEDURES,
            arguments.load or LOADS,
            arguments.size or tuple(STATIC),
        )
    )
    if arguments.deck:
        print("".join(deck(case, arguments.scale) for case in table), end="")
        return 0
    failed = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(arguments.jobs) as pool:
        found = pool.map(lambda case: failure(case, Path(folder), arguments.scale), table)
        for case, text in zip(table, found):
            if text:
                failed += 1
                print(f"{case.name}: {text}", flush=True)
    print(f"{len(table)} runs, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    finish(main)
