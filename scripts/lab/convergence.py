"""Counts increments, cutbacks, passes and factorisations on decks, of one program or of two.

Of two programs every column shows OLD / NEW. A run that reaches the limit of processor time is
asked to end. Where a run does not get to its end, only the time that every run has reached is
counted, and the line says so. The exit code is 1 when a run leaves no results.
"""

import argparse
import re
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import takewhile
from math import inf
from pathlib import Path

import numpy as np
from stickslip.arrays import Array, Integers
from stickslip.command import finish, positive, positive_integer
from stickslip.deck import Deck
from stickslip.errors import Fault, one_line
from stickslip.result import Result

from lab.measured_run import Run, check_program, run
from lab.sample_decks import Sample, examples, given, runner, verification_cases

LIMIT = 60.0
"""Seconds of processor time of a run."""

GOOD_ENDS = (0, 1)
"""Exit codes of runs that leave results: to the end, stopped in the solve."""

ROUND_OFF = 1e-9
"""Difference of times that are the same, as a part of them."""

HEADER = ("increments", "cutbacks", "passes", "max", "cut", "factorisations", "CPU [s]", "deck")
"""Titles; the passes are the mean and the largest number of an increment, and those of all
attempts that were cut back."""

CUTBACK = re.compile(r"(?:cutback|repeated) +increment (\d+) ")
TABLE = re.compile(r" +pass +residual ")
BELOW = ("     ", "advice ")
"""Lines of a log: a cutback, the head of a table of passes; how lines below a cutback begin."""


@dataclass(frozen=True)
class Counts:
    """What the run of a deck took, up to some time."""

    increments: int = 0
    cutbacks: int = 0
    passes: int = 0
    """Of all increments."""
    most_passes: int = 0
    """Of one increment."""
    cut_passes: int = 0
    """Of the attempts that were cut back."""
    factorizations: int = 0
    seconds: float = 0.0
    """Processor time; not a number when the run was longer than what is counted."""

    def __add__(self, other: "Counts") -> "Counts":
        """The counts of several runs."""
        mine, others = vars(self), vars(other)
        sums = {name: mine[name] + others[name] for name in mine}
        sums["most_passes"] = max(self.most_passes, other.most_passes)
        return Counts(**sums)

    def cells(self) -> list[str]:
        """Texts of the columns."""
        mean = f"{self.passes / self.increments:.1f}" if self.increments else "-"
        seconds = f"{self.seconds:.2f}" if np.isfinite(self.seconds) else "-"
        counts = (self.increments, self.cutbacks, mean, self.most_passes, self.cut_passes)
        return [*map(str, counts), str(self.factorizations), seconds]


@dataclass(frozen=True)
class Convergence:
    """How the increments of a run converged: one row per increment, without the start."""

    time: Array
    passes: Integers
    factorizations: Integers
    cut: list[tuple[int, int]]
    """The increment, from 1, and the passes of each attempt that was cut back."""
    run: Run

    @classmethod
    def read(cls, ended: Run) -> "Convergence":
        """Reads the result file and the log of a run."""
        if ended.code not in GOOD_ENDS and not ended.was_stopped:
            raise Fault(f"exit code {ended.code}: {ended.complaint}")
        with Result(ended.result) as results:
            solver = results.history.solver
            columns = results.history.time, solver["passes"], solver["factorizations"]
        log = ended.result.with_suffix(".log").read_text().splitlines()
        return cls(*(column[1:] for column in columns), cut_attempts(log), ended)

    @property
    def reached(self) -> float:
        """Time that the run has reached; infinite when it went to its end."""
        if self.run.code == 0:
            return inf
        return float(self.time[-1]) if len(self.time) else 0.0

    def until(self, end: float) -> Counts:
        """The counts up to a time."""
        rows = int((self.time <= end * (1.0 + ROUND_OFF)).sum())
        is_whole = rows == len(self.time)
        cut = [passes for increment, passes in self.cut if increment <= rows or is_whole]
        return Counts(
            rows,
            len(cut),
            int(self.passes[:rows].sum()),
            int(self.passes[:rows].max(initial=0)),
            sum(cut),
            int(self.factorizations[:rows].sum()),
            self.run.seconds if is_whole else np.nan,
        )


def cut_attempts(log: Sequence[str]) -> list[tuple[int, int]]:
    """The increment and the number of passes of each attempt that was cut back, from a log."""
    cut = []
    for row, line in enumerate(log):
        if found := CUTBACK.match(line):
            # the cause, advice, and the table of the passes
            below = list(takewhile(lambda text: text.startswith(BELOW), log[row + 1 :]))
            heads = [place for place, text in enumerate(below, 1) if TABLE.match(text)]
            cut.append((int(found[1]), len(below) - heads[0] if heads else 0))
    return cut


@dataclass(frozen=True)
class Line:
    """The counts of a deck, of each program."""

    name: str
    counts: tuple[Counts, ...] = ()
    """None when a run has no results."""
    note: str = ""
    """What was not run, or why it failed."""

    def cells(self) -> list[str]:
        """Texts of the columns."""
        columns = zip(*(counts.cells() for counts in self.counts))
        name = f"{self.name} ({self.note})" if self.note else self.name
        numbers = [" / ".join(cells) for cells in columns] or ["-"] * (len(HEADER) - 1)
        return [*numbers, name]


def count(sample: Sample, programs: Sequence[Path], limit: float) -> Line:
    """Runs the programs on a deck."""
    with tempfile.TemporaryDirectory(prefix="convergence_") as name:
        folder = Path(name)
        try:
            deck = sample.write(folder)
            runs = [
                Convergence.read(run(program, deck, folder / str(which), limit))
                for which, program in enumerate(programs)
            ]
            end = min(one.reached for one in runs)
            counts = tuple(one.until(end) for one in runs)
            return Line(sample.name, counts, part(runs, end, Deck.read(deck)))
        except (Fault, OSError, KeyError, ValueError, RuntimeError) as error:
            return Line(sample.name, note=f"failed: {one_line(error)}")


def part(runs: Sequence[Convergence], end: float, deck: Deck) -> str:
    """Which part of a deck is counted and why; nothing when that is all of it."""
    if end == inf:
        return ""
    first = next(which for which, one in enumerate(runs) if one.reached == end)
    why = "at the limit" if runs[first].run.was_stopped else "stopped"
    who = f"{('OLD', 'NEW')[first]} {why}" if len(runs) > 1 else why
    period = deck.duration or inf
    return f"to time {end:.4g} of {period:.4g}: {who}"


def count_all(
    samples: Iterable[Sample], programs: Sequence[Path], limit: float, jobs: int
) -> Iterator[Line]:
    """Counts on the decks, some at a time, in their order."""
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda sample: count(sample, programs, limit), samples)


def total(lines: Sequence[Line]) -> Line:
    """The counts of all decks that have them."""
    counted = [line.counts for line in lines if line.counts]
    sums = tuple(sum(column, Counts()) for column in zip(*counted))
    return Line(f"all: {len(counted)} decks", sums)


def text(cells: Sequence[str], widths: Sequence[int]) -> str:
    """A line of the table on the screen: the name of the deck is last."""
    numbers = (cell.rjust(width) for cell, width in zip(cells[:-1], widths))
    return "  ".join([*numbers, cells[-1]])


def print_table(lines: Iterable[Line], programs: int) -> list[Line]:
    """Prints lines as they come and their total."""
    widths = [max(len(title), 7 * programs + 3 * (programs - 1)) for title in HEADER[:-1]]
    print(text(HEADER, widths))
    printed = []
    for line in lines:
        printed.append(line)
        print(text(line.cells(), widths), flush=True)
    print(text(total(printed).cells(), widths))
    return printed


def print_markdown(lines: Iterable[Line]) -> list[Line]:
    """Prints a table in Markdown, the name of the deck first."""
    listed = list(lines)
    rows = [HEADER, *(line.cells() for line in [*listed, total(listed)])]
    rows = [[row[-1], *row[:-1]] for row in rows]
    print(runner.markdown(rows[0], rows[1:]), end="")
    return listed


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="convergence", description=about)
    help_ = "one or two programs; decks (.inp), instead of all of input/ and verification/"
    parser.add_argument("paths", type=Path, nargs="+", metavar="PROGRAM or DECK", help=help_)
    help_ = f"seconds of processor time of a run (default {LIMIT:g})"
    parser.add_argument("--limit", type=positive, default=LIMIT, metavar="SECONDS", help=help_)
    help_ = "decks at a time (default 2)"
    parser.add_argument("--jobs", type=positive_integer, default=2, metavar="N", help=help_)
    parser.add_argument("--markdown", action="store_true", help="print a table in Markdown")
    arguments = parser.parse_intermixed_args()
    is_deck = [path.suffix.lower() == ".inp" for path in arguments.paths]
    arguments.decks = [path for path, is_one in zip(arguments.paths, is_deck) if is_one]
    arguments.programs = [path for path, is_one in zip(arguments.paths, is_deck) if not is_one]
    if not 1 <= len(arguments.programs) <= 2:
        parser.error("one program is needed, or two")
    return arguments


def main() -> int:
    """Runs, prints a line for each deck and the sums."""
    arguments = parse()
    programs = [check_program(path) for path in arguments.programs]
    samples = given(arguments.decks) if arguments.decks else [*examples(), *verification_cases()]
    lines = count_all(samples, programs, arguments.limit, arguments.jobs)
    printed = print_markdown(lines) if arguments.markdown else print_table(lines, len(programs))
    return 0 if all(line.counts for line in printed) else 1


if __name__ == "__main__":
    finish(main)
