"""Loads that are put on and taken off: every body ends where it began.

A cantilever of every element is bent by a load that grows and goes back to zero, in every procedure,
with increments of three lengths; then a cantilever of three elements by loads on a node that its end
hangs on by every joint. The run must end with exit code 0, every check of the program must
hold, and the displacements of the end must be zero beside the largest of the run.

A line for each failure, then how many of the runs have failed. The exit code is 1 when one has.
"""

import argparse
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import h5py
import numpy as np
from oracle.checks import broken
from stickslip.command import finish
from stickslip.program import binary

ELEMENTS = (
    *("CPE3", "CPE4", "CPS4", "CPE4H", "CPE4R", "CPE4I", "CPS4I", "CAX4", "CAX4I"),
    *("CPE6", "CPE8", "CPE8R", "CPE8H", "CPE8RH", "CAX8R"),
)

PROCEDURES = ("static", "quasi-static", "fixed", "automatic")

LOADS = {
    "force": ("*CLOAD{}\nTIP, 2, {}", -0.2),
    "moment": ("*CLOAD{}\nREF, 6, {}", 3.0),
    "pressure": ("*DSLOAD{}\nTOP, P, {}", 0.3),
    "gravity": ("*DLOAD{}\nBODY, GRAV, {}, 0., -1.", 0.3),
    "motion": ("*BOUNDARY{}\nTIP, 2, 2, {}", 0.15),
    "contact": ("*BOUNDARY{}\nDRIVEN, 2, 2, {}", -0.1),
    "push": ("*CLOAD{}\nREF, 2, {}", -0.6),
    "shift": ("*BOUNDARY{}\nREF, 2, 2, {}", 0.15),
    "turn": ("*BOUNDARY{}\nREF, 6, 6, {}", 0.1),
}
"""Card of each load, with places for its amplitude and its value, and the largest value."""

PLAIN = ("force", "moment", "pressure", "gravity", "motion", "contact")
"""Loads of cantilevers without a joint; a moment needs a coupling."""

JOINTS = {
    "kinematic": (
        "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=REF, SURFACE=RIGHT\n*KINEMATIC",
        ("push", "moment", "shift", "turn"),
    ),
    "distributing": (
        "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=REF, SURFACE=RIGHT\n*DISTRIBUTING",
        ("push", "shift"),
    ),
    "rigid": ("*RIGID BODY, REF NODE=REF, ELSET=END", ("push", "moment", "shift", "turn")),
    "equation": (
        "*EQUATION\n2\nTIP, 1, 1., REF, 1, -1.\n2\nTIP, 2, 1., REF, 2, -1.",
        ("push", "shift"),
    ),
    "pin": ("*MPC\nTIE, TIP, REF", ("push", "shift")),
    "tie": (
        "*TIE, NAME=BOND\nNEAR, RIGHT\n"
        "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=REF, SURFACE=FAR\n*KINEMATIC",
        ("push", "moment", "shift", "turn"),
    ),
}
"""Cards of each joint between the end and the node REF, and the loads that it carries."""

JOINED = ("CPE3", "CPE4I", "CPE8R")
"""Elements of cantilevers with a joint."""

STATIC = {"coarse": 1.0, "medium": 0.25, "fine": 0.05}
"""Largest increment of static steps of length 1: one puts the load on, one takes it off, one does
nothing."""

MOVING = {"coarse": 0.1, "medium": 0.05, "fine": 0.02}
"""First increment of a dynamic step; automatic ones may be ten times as long."""

PERIOD = 20.0
"""Length of a dynamic step, of which the load takes two units."""

ZERO = {"static": 1e-9, "quasi-static": 1e-9, "fixed": 1e-3, "automatic": 1e-3}
"""Largest displacement at the end beside the largest of the run. What a dynamic step has left is a
vibration of stiff modes, of which long increments take little."""

POSITION = 16 * np.finfo(float).eps * 5.0
"""Round-off of the positions of nodes, which is that of couplings and contacts."""

COUNT = (4, 2)
"""Elements along and across."""

LENGTH, HEIGHT = 4.0, 1.0
GAP = 0.01
"""Between the body and the punch that bends it by contact."""

LIMIT = 300.0
"""Seconds that a run may take."""


@dataclass(frozen=True)
class Case:
    """A run of the table."""

    element: str
    procedure: str
    load: str
    size: str
    joint: str = "none"

    @property
    def name(self) -> str:
        """Name of its deck."""
        parts = [self.element, self.procedure, self.load, self.size]
        if self.joint != "none":
            parts.append(self.joint)
        return "_".join(parts).replace("-", "")


def cases(
    elements: Sequence[str],
    procedures: Sequence[str],
    loads: Sequence[str],
    sizes: Sequence[str],
    joints: Sequence[str],
) -> Iterator[Case]:
    """All cases; a ring takes no moment in its plane."""
    for joint in joints:
        allowed = JOINTS[joint][1] if joint in JOINTS else PLAIN
        for element, procedure, load, size in product(elements, procedures, loads, sizes):
            if load not in allowed or (joint in JOINTS and element not in JOINED):
                continue
            if not (element.startswith("CAX") and load == "moment"):
                yield Case(element, procedure, load, size, joint)


class Mesh:
    """A rectangle of elements; labels of nodes and elements begin with `first`."""

    def __init__(
        self,
        element: str,
        first: int,
        corner: tuple[float, float],
        size: tuple[float, float],
        count: tuple[int, int],
    ) -> None:
        self.element, self.first = element, first
        self.nodes: dict[int, tuple[float, float]] = {}
        self.elements: list[list[int]] = []
        columns, rows = 2 * count[0], 2 * count[1]
        self.corners = 3 if element[3] in "36" else 4

        def node(i: int, j: int) -> int:
            label = first + i * (rows + 1) + j
            self.nodes[label] = (corner[0] + size[0] * i / columns, corner[1] + size[1] * j / rows)
            return label

        for i, j in product(range(0, columns, 2), range(0, rows, 2)):
            ends = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
            middles = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
            inside = (i + 1, j + 1)
            shapes = {
                "3": [ends[:3], [ends[0], *ends[2:]]],
                "6": [
                    [*ends[:3], *middles[:2], inside],
                    [ends[0], *ends[2:], inside, *middles[2:]],
                ],
                "8": [ends + middles],
            }.get(element[3], [ends])
            self.elements += [[node(*place) for place in shape] for shape in shapes]

    def text(self, name: str) -> str:
        """Its cards."""
        nodes = [f"{label}, {x!r}, {y!r}" for label, (x, y) in sorted(self.nodes.items())]
        rows = [", ".join(map(str, (self.first + k, *e))) for k, e in enumerate(self.elements)]
        return "\n".join(
            ["*NODE", *nodes, f"*ELEMENT, TYPE={self.element}, ELSET={name}", *rows]
            + [f"*SOLID SECTION, ELSET={name}, MATERIAL=SOFT", "1."]
        )

    def side(self, axis: int, value: float) -> list[int]:
        """Nodes of a side."""
        return [label for label, x in self.nodes.items() if abs(x[axis] - value) < 1e-9]

    def set(self, name: str, nodes: Sequence[int]) -> str:
        """A node set."""
        return "\n".join([f"*NSET, NSET={name}", *map(str, nodes)])

    def surface(self, name: str, axis: int, value: float) -> str:
        """The faces of a side."""
        nodes, rows = set(self.side(axis, value)), []
        for k, element in enumerate(self.elements):
            for face in range(self.corners):
                if {element[face], element[(face + 1) % self.corners]} <= nodes:
                    rows.append(f"{self.first + k}, S{face + 1}")
        return "\n".join([f"*SURFACE, NAME={name}", *rows])


def deck(case: Case, scale: float) -> str:
    """The deck of a case with its load times `scale`."""
    left = 1.0 if case.element.startswith("CAX") else 0.0
    right = left + LENGTH
    body = Mesh(case.element, 1, (left, 0.0), (LENGTH, HEIGHT), COUNT)
    vibrates = case.procedure in ("fixed", "automatic")
    cards = [
        f"*HEADING\n{case.name}",
        "*MATERIAL, NAME=SOFT\n*ELASTIC\n1000., .3\n*DENSITY",
        "0.04\n*DAMPING, ALPHA=20., BETA=0.002" if vibrates else "1.E-4",
        body.text("BODY"),
        body.set("HELD", body.side(0, left)),
        body.set("TIP", body.side(0, right)),
        body.set("ALL", list(body.nodes)),
        body.surface("TOP", 1, HEIGHT),
        body.surface("RIGHT", 0, right),
        "*BOUNDARY\nHELD, 1, 2",
    ]
    joint = case.joint
    if joint == "none" and case.load == "moment":
        joint = "kinematic"
    if joint == "tie":
        block = Mesh(case.element, 1001, (right, 0.0), (0.5, HEIGHT), (1, 2 * COUNT[1] - 1))
        cards += [
            block.text("BLOCK"),
            block.surface("NEAR", 0, right),
            block.surface("FAR", 0, right + 0.5),
        ]
    if joint == "rigid":
        last = body.elements[-len(body.elements) // COUNT[0] :]
        labels = range(1 + len(body.elements) - len(last), 1 + len(body.elements))
        cards.append("\n".join(["*ELSET, ELSET=END", *map(str, labels)]))
    if joint in JOINTS:
        cards += [f"*NODE, NSET=REF\n9001, {right + 0.5!r}, 0.6", JOINTS[joint][0]]
    if case.load == "contact":
        bottom = HEIGHT + GAP * scale
        punch = Mesh(case.element, 1001, (right - 1.3, bottom), (1.0, 0.5), (1, 1))
        cards += [
            punch.text("PUNCH"),
            punch.set("DRIVEN", punch.side(1, bottom + 0.5)),
            punch.surface("FOOT", 1, bottom),
            "*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.2",
            "*CONTACT PAIR, INTERACTION=DRY\nFOOT, TOP\n*BOUNDARY\nDRIVEN, 1, 2",
        ]
    card, most = LOADS[case.load]
    for procedure, amplitude, factor in steps(case):
        cards += [
            f"*STEP, NLGEOM, INC=100000\n{procedure}",
            card.format(amplitude, repr(scale * factor * most)),
            "*OUTPUT, FIELD, NUMBER INTERVAL=1\n*NODE OUTPUT\nU",
            "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*END STEP",
        ]
    if case.procedure != "static":
        cards.insert(1, "*AMPLITUDE, NAME=ONOFF, DEFINITION=SMOOTH STEP\n0., 0., 1., 1., 2., 0.")
    return "\n".join([*cards, ""])


def steps(case: Case) -> list[tuple[str, str, float]]:
    """Procedure, parameter of the load and its factor, step by step."""
    if case.procedure == "static":
        dt = STATIC[case.size]
        return [(f"*STATIC\n{dt!r}, 1., , {dt!r}", "", factor) for factor in (1.0, 0.0, 0.0)]
    dt = MOVING[case.size]
    kind, rest = {
        "fixed": (", DIRECT", ""),
        "automatic": ("", f", , {10 * dt!r}"),
        "quasi-static": (", APPLICATION=QUASI-STATIC", f", , {10 * dt!r}"),
    }[case.procedure]
    return [(f"*DYNAMIC{kind}\n{dt!r}, {PERIOD!r}{rest}", ", AMPLITUDE=ONOFF", 1.0)]


def faults(case: Case, folder: Path, scale: float, certifies: bool) -> list[str]:
    """What is wrong in a case."""
    path = folder / f"{case.name}.inp"
    path.write_text(deck(case, scale))
    command = [binary(), "run", path, "-o", folder, "--overwrite", "-q", "--threads", "1"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return [f"is not done in {LIMIT:g} s"]
    if done.returncode != 0:
        return [f"exit code {done.returncode}: {' '.join(done.stderr.split())[:150]}"]
    result = path.with_suffix(".vtkhdf")
    found = []
    if certifies and (wrong := broken(result)):
        found.append(f"certificate or oracle of elements: {', '.join(sorted(wrong))}")
    with h5py.File(result) as file:
        for name, values in file["history/certificate"].items():
            worst, bound = np.max(values[:]), values.attrs["bound"]
            if not (worst <= bound or np.isnan(bound)):
                found.append(f"{name} {worst:.1e} above {bound:.0e}")
        u = np.abs(file["history/nodes/ALL/U"][:])
    result.unlink()
    most, left = u.max(), u[-1].max()
    if not left <= max(ZERO[case.procedure] * most, POSITION):
        found.append(f"{left:.1e} of the largest displacement {most:.1e} is left")
    return found


def main() -> int:
    """Runs the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    levels = {
        "element": ELEMENTS,
        "procedure": PROCEDURES,
        "load": LOADS,
        "size": STATIC,
        "joint": ("none", *JOINTS),
    }
    for name, values in levels.items():
        parser.add_argument(f"--{name}", action="append", choices=tuple(values))
    parser.add_argument("--every", type=int, default=1, help="runs one of so many")
    parser.add_argument("--scale", type=float, default=1.0, help="factor of all loads")
    parser.add_argument("--certify", action="store_true", help="certificate and oracle of elements")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--deck", action="store_true", help="write the decks to the screen")
    arguments = parser.parse_args()
    chosen = [getattr(arguments, name) or tuple(values) for name, values in levels.items()]
    table = list(cases(*chosen))[:: arguments.every]
    if arguments.deck:
        print("".join(deck(case, arguments.scale) for case in table), end="")
        return 0
    failed = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(arguments.jobs) as pool:
        settings = (Path(folder), arguments.scale, arguments.certify)
        for case, found in zip(table, pool.map(lambda c: faults(c, *settings), table), strict=True):
            if found:
                failed += 1
                print(f"{case.name}: {'; '.join(found)}", flush=True)
    print(f"{len(table)} runs, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    finish(main)
