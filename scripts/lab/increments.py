"""Compares automatic increments with the best fixed ones of the same error.

Every deck is run with fixed increments of several lengths, and without DIRECT at several tolerances.
The error is that of the centres of the bodies beside a run with the shortest increments: the root of
its mean square in time over the largest way. The cost is the number of passes and factorisations of
all attempts; that of fixed increments of the same error is interpolated.
"""

import argparse
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from math import exp, log
from pathlib import Path

import numpy as np
from repository import ROOT
from stickslip.arrays import Array
from stickslip.command import finish, positive_integer
from stickslip.deck import Deck
from stickslip.errors import Fault, one_line
from stickslip.result import Result

from lab.convergence import cut_attempts
from lab.measured_run import check_program, run

TOLERANCES = (1e-3, 1e-4, 1e-5)
"""Of the truncation error of automatic increments."""

DEFAULT = 1e-4

AROUND = (0.7, 0.85, 1.0, 1.2, 1.4)
"""Tolerances about each of them, whose figures are averaged: errors of single runs jump with the
place of a landing in its increment."""

FACTORS = tuple(16.0 / 2 ** (k / 3) for k in range(22))
"""Lengths of fixed increments beside those of a deck."""

REFERENCE = 1.0 / 64.0
"""Length of the increments of the run that is taken for exact."""

NEAR = 7
"""Lengths of fixed increments that are compared with a run."""

SAMPLES = 400
"""Times at which two runs are compared."""


@dataclass(frozen=True)
class Case:
    """A deck with its increment."""

    name: str
    deck: Deck
    dt: float
    factors: Sequence[float] = FACTORS
    reference: float = REFERENCE


@dataclass(frozen=True)
class Outcome:
    """The motion of a run and what it took."""

    time: Array
    center: Array
    velocity: Array
    increments: int
    repeated: int
    factorizations: int
    cost: int
    seconds: float

    def at(self, times: Array) -> Array:
        """Centres at some times, by cubics between the ends of increments."""
        k = np.clip(np.searchsorted(self.time, times) - 1, 0, len(self.time) - 2)
        length = (self.time[k + 1] - self.time[k])[:, None, None]
        s = (times - self.time[k])[:, None, None] / length
        x, v = self.center, self.velocity
        start, end = x[k], x[k + 1]
        first, last = length * v[k], length * v[k + 1]
        way = end - start
        return start + s * first + s**2 * (3 * way - 2 * first - last) + s**3 * (first + last - 2 * way)

    def error(self, exact: "Outcome") -> float:
        """Distance of the centres from those of another run, beside the largest way."""
        times = np.linspace(0.0, min(self.time[-1], exact.time[-1]), SAMPLES)
        mine, other = self.at(times), exact.at(times)
        way = np.abs(other - other[0]).max()
        return float(np.sqrt(((mine - other) ** 2).sum(axis=(1, 2)).mean()) / way)


def bar(elements: int) -> Deck:
    """An elastic bar that flies, hits a wall and flies back."""
    size, count = 1.0 / elements, elements + 1
    low = [(0.3 + k * size, 0.0) for k in range(count)]
    high = [(x, 0.1) for x, _ in low]
    deck = Deck.titled(f"a bar of {elements} elements flies, hits a wall and flies back")
    deck.add("NODE, NSET=BAR", *((k + 1, *at) for k, at in enumerate(low + high)))
    deck.add("NODE, NSET=WALL", (1001, 0.0, -0.5), (1002, 0.0, 0.6), (1003, -0.5, 0.6), (1004, -0.5, -0.5))
    quads = ((k + 1, k + 1, k + 2, count + k + 2, count + k + 1) for k in range(elements))
    deck.add("ELEMENT, TYPE=CPS4, ELSET=BAR", *quads)
    deck.add("ELEMENT, TYPE=CPS4, ELSET=WALL", (1001, 1001, 1002, 1003, 1004))
    deck.add("SURFACE, NAME=FACE", (1, "S4")).add("SURFACE, NAME=GROUND", (1001, "S1"))
    deck.elastic("M", 100.0, 0.0, 1.0).section("BAR", "M").section("WALL", "M")
    deck.contact("FACE", "GROUND").velocity("BAR", -1.0, 0.0)
    deck.support("WALL")
    with deck.step(0.004, 1.0, landing="PLASTIC"):
        pass
    return deck


def bounce() -> Deck:
    """A stiff block that bounces on the ground like a point mass."""
    deck = Deck.titled("a stiff block bounces on the ground")
    deck.add("NODE, NSET=BLOCK", (1, 0.0, 1.0), (2, 1.0, 1.0), (3, 1.0, 2.0), (4, 0.0, 2.0))
    deck.add("NODE, NSET=WALL", (11, -1.0, -0.5), (12, 2.0, -0.5), (13, 2.0, 0.0), (14, -1.0, 0.0))
    deck.add("ELEMENT, TYPE=CPS4, ELSET=BLOCK", (1, 1, 2, 3, 4))
    deck.add("ELEMENT, TYPE=CPS4, ELSET=WALL", (11, 11, 12, 13, 14))
    deck.add("SURFACE, NAME=FOOT", (1, "S1")).add("SURFACE, NAME=GROUND", (11, "S3"))
    deck.elastic("M", 1e9, 0.0, 1.0).section("BLOCK", "M").section("WALL", "M")
    deck.contact("FOOT", "GROUND").support("WALL")
    with deck.step(0.01, 4.0, landing="RETURN", impact="NONE") as step:
        step.gravity("BLOCK", 10.0)
    return deck


def pendulum() -> Deck:
    """A block that swings on a spring."""
    deck = Deck.titled("a block swings on a spring")
    deck.add("NODE, NSET=BLOCK", (1, 1.0, 0.0), (2, 1.1, -0.05), (3, 1.2, 0.0), (4, 1.1, 0.05))
    deck.add("NODE, NSET=PIVOT", (5, 0.0, 0.0)).add("ELEMENT, TYPE=CPE4, ELSET=BLOCK", (1, 1, 2, 3, 4))
    deck.add("ELEMENT, TYPE=SPRINGA, ELSET=SPRING", (2, 5, 1)).add("SPRING, ELSET=SPRING", ("",), (2.0,))
    deck.elastic("M", 1e2, 0.3, 1.0).section("BLOCK", "M").support("PIVOT")
    with deck.step(0.01, 3.0) as step:
        step.gravity("BLOCK", 10.0)
    return deck


def cases() -> Iterator[Case]:
    """The decks of the table."""
    yield Case("pendulum", pendulum(), 0.01)
    yield Case("bounce", bounce(), 0.02)
    for elements in (20, 80):
        yield Case(f"bar of {elements}", bar(elements), 0.004)
    own = (
        ("input/two_cantilevers/A_mu02", 0.03),
        ("input/corner_to_corner/corners_left_mu02", 0.005),
        ("input/bouncing_rings/rings_mu02", 0.005),
        ("input/rubber_ring/rubber_ring_mu05", 0.002),
        ("input/snap_fit/snap_fit_damped", 2e-5),
        ("verification/elastic_bar/em_impulse", 0.006),
    )
    for name, dt in own:
        yield Case(name, Deck.read(ROOT / f"{name}.inp"), dt, FACTORS[:-6], 1.0 / 8.0)


def fixed(deck: Deck, dt: float) -> Deck:
    """The deck with fixed increments."""
    changed = Deck.parse(deck.text())
    step = changed.one("DYNAMIC")
    step.head, step.rows = "*DYNAMIC, DIRECT", [[repr(dt), step.rows[0][1]]]
    return changed


def automatic(deck: Deck, dt: float, tolerance: float) -> Deck:
    """The deck with automatic increments."""
    changed = fixed(deck, dt)
    usual = 1e4 if any(changed.find(name) for name in ("CONTACT PAIR", "CONTACT")) else 1e3
    factor = "" if tolerance == DEFAULT else f", HALFINC SCALE FACTOR={usual * tolerance / DEFAULT!r}"
    changed.one("DYNAMIC").head = f"*DYNAMIC{factor}"
    return changed


def outcome(program: Path, deck: Deck, folder: Path) -> Outcome:
    """Runs a deck."""
    ended = run(program, deck.write(folder / "deck.inp"), folder)
    if ended.code != 0:
        raise Fault(f"exit code {ended.code}: {ended.complaint}")
    cut = cut_attempts(ended.result.with_suffix(".log").read_text().splitlines())
    with Result(ended.result) as results:
        history = results.history
        passes, factorizations = history.solver["passes"], history.solver["factorizations"]
        center, velocity = history.bodies["center"], history.bodies["velocity"]
        time = np.array(history.time)
        shape = (len(time), -1, 2)
        work = int(factorizations.sum()) + len(cut)
        return Outcome(
            time,
            np.array(center).reshape(shape),
            np.array(velocity).reshape(shape),
            len(time) - 1,
            len(cut),
            work,
            int(passes.sum()) + sum(one for _, one in cut) + work,
            ended.seconds,
        )


def mean(values: Iterable[float]) -> float:
    """The geometric mean."""
    return exp(float(np.log(list(values)).mean()))


def interpolated(points: Sequence[tuple[float, float]], error: float) -> float:
    """Cost of fixed increments with an error, by a power law through (error, cost) of the lengths near it."""
    near = sorted(points, key=lambda point: abs(log(point[0] / error)))[:NEAR]
    x, y = np.log(near).T
    slope = min(float(np.polyfit(x, y, 1)[0]), 0.0)
    return exp(float(y.mean()) + slope * (log(error) - float(x.mean())))


def rows(program: Path, case: Case) -> list[list[str]]:
    """The lines of a deck."""
    with tempfile.TemporaryDirectory(prefix="increments_") as name:
        try:
            folder = Path(name)
            exact = outcome(program, fixed(case.deck, case.reference * case.dt), folder / "exact")
            points, seconds, counts = [], [], []
            for factor in case.factors:
                try:
                    found = outcome(program, fixed(case.deck, factor * case.dt), folder / f"fixed{factor}")
                except Fault:
                    continue
                points.append((found.error(exact), found.cost))
                seconds.append((found.error(exact), found.seconds))
                counts.append((found.error(exact), found.increments))
            lines = []
            for tolerance in TOLERANCES:
                found = [
                    outcome(
                        program,
                        automatic(case.deck, case.dt, near * tolerance),
                        folder / f"automatic{near * tolerance}",
                    )
                    for near in AROUND
                ]
                error = mean(one.error(exact) for one in found)
                attempts = mean(one.increments + one.repeated for one in found)
                middle = found[len(AROUND) // 2]
                lines.append(
                    [
                        case.name,
                        f"{tolerance:.0e}",
                        f"{error:.1e}",
                        f"{middle.increments} + {middle.repeated}",
                        f"{middle.factorizations}",
                        f"{attempts / interpolated(counts, error):.2f}",
                        f"{mean(one.cost for one in found) / interpolated(points, error):.2f}",
                        f"{mean(one.seconds for one in found) / interpolated(seconds, error):.2f}",
                    ]
                )
            return lines
        except (Fault, OSError, KeyError, ValueError, RuntimeError) as error:
            return [[case.name, f"failed: {one_line(error)}"]]


def parse() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="increments", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("program", type=Path, metavar="PROGRAM")
    parser.add_argument("names", nargs="*", metavar="DECK", help="decks of the table (default: all)")
    parser.add_argument("--jobs", type=positive_integer, default=2, metavar="N", help="decks at a time")
    return parser.parse_intermixed_args()


def main() -> int:
    """Runs and prints the table."""
    arguments = parse()
    program = check_program(arguments.program)
    chosen = [case for case in cases() if not arguments.names or case.name in arguments.names]
    head = ["deck", "tolerance", "error", "increments", "factorisations", "attempts", "cost", "CPU time"]
    print("| " + " | ".join(head) + " |")
    print("|---" * len(head) + "|")
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for lines in pool.map(lambda case: rows(program, case), chosen):
            for line in lines:
                print("| " + " | ".join(line) + " |", flush=True)
    return 0


if __name__ == "__main__":
    finish(main)
