"""Measures whole decks: processor time per increment, instructions per pass, passes, memory.

Runs have one thread. Two blocks of N x N/2 elements each write two frames, examples 100.
"""

import argparse
import platform
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from math import isfinite, nan
from pathlib import Path
from statistics import median

import numpy as np
from repository import ROOT
from stickslip.command import finish, positive_integer
from stickslip.errors import Fault
from stickslip.program import binary

from lab import bench_ccx, bench_reader
from lab.bench_decks import GROUPS, SIZES, Bench, group
from lab.bench_runs import PHASES, WORK, CcxRun, Measured, bandwidth, measure, run_ccx
from lab.measured_run import check_program
from lab.sample_decks import runner

PAGE = ROOT / "docs" / "performance.md"
BEGIN, END = "<!-- {name}: begin -->\n", "<!-- {name}: end -->\n"
"""Lines between which --write puts the tables."""

COUNTS = ("increments", "passes", "factorisations", *WORK)
HEADER = ("deck", "dofs", *COUNTS, "CPU [ms] per increment")
COUNTED = "instructions [10^6] per pass"
PEAK = "memory [MB]"
AGAINST = "of OTHER"
CCX = "of a CalculiX iteration"
GROWTH_FROM = 32
"""Smallest blocks from which the growth with the number of dofs is taken."""


@dataclass
class Row:
    """What was measured of a deck."""

    bench: Bench
    runs: list[Measured] = field(default_factory=list)
    others: list[Measured] = field(default_factory=list)
    ccx: CcxRun | None = None

    @property
    def measured(self) -> Measured:
        """The run with the median of the times."""
        ordered = sorted(self.runs, key=lambda one: one.seconds)
        return ordered[(len(ordered) - 1) // 2]

    @property
    def ratio(self) -> float:
        """Time of the program over that of the other one, median over the repetitions."""
        pairs = zip(self.runs, self.others)
        return median(one.per_increment / other.per_increment for one, other in pairs)

    def cells(self) -> list[str]:
        """Texts of the columns."""
        one = self.measured
        passes, per_increment = one.passes / one.increments, number(one.per_increment)
        cells = [self.bench.name, str(one.dofs), str(one.increments), f"{passes:.1f}"]
        work = (str(one.work.get(column, "")) for column in WORK)
        cells += [str(one.factorizations), *work, per_increment]
        counted = next((run.per_pass for run in self.runs if isfinite(run.instructions)), nan)
        cells.append(number(counted / 1e6) if isfinite(counted) else "")
        cells.append(number(one.peak / 1e6))
        cells.append(f"{self.ratio:.3f}" if self.others else "")
        ccx = one.per_increment / self.ccx.per_iteration if self.ccx else nan
        cells.append(f"{ccx:.3f} (of {number(self.ccx.per_iteration)} ms)" if self.ccx else "")
        return cells


def number(value: float) -> str:
    """Three digits, without exponent."""
    return f"{value:.0f}" if value >= 99.5 else f"{value:#.3g}"


def growth(rows: Sequence[Row]) -> str:
    """Exponent p of time per increment ~ dofs^p over the two blocks, by least squares."""
    used = [row.measured for row in rows if row.bench.size >= GROWTH_FROM]
    if len(used) < 2:
        return ""
    dofs = [one.dofs for one in used]
    of_increment = slope(dofs, [one.per_increment for one in used])
    of_pass = slope(dofs, [one.seconds / one.passes for one in used])
    return (
        f"Growth of the time with the dofs from N = {GROWTH_FROM}: exponent {of_increment:.2f} of an "
        f"increment, {of_pass:.2f} of a pass.\n"
    )


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """The exponent p of y ~ x^p, by least squares."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def tables(rows: Sequence[Row]) -> str:
    """The tables in Markdown, with machine and date."""
    header = [*HEADER, COUNTED, PEAK, AGAINST, CCX]
    cells = [row.cells() for row in rows]
    shown = [k for k in range(len(header)) if any(line[k] for line in cells)]
    main = runner.markdown([header[k] for k in shown], [[line[k] for k in shown] for line in cells])
    shares = [
        [row.bench.name, *(f"{100 * row.measured.phases[name]:.0f}" for name in PHASES)]
        for row in rows
    ]
    phases = runner.markdown(["share of the time [%]", *PHASES], shares)
    return f"{machine()}.\n\n{main}\n{growth(rows)}\n{phases}"


def machine() -> str:
    """Processor, cores, system and date."""
    name = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    cores = 0
    if info.exists():
        for line in info.read_text().splitlines():
            key, _, value = line.partition(":")
            name = value.strip() if key.strip() == "model name" else name
            cores += key.strip() == "processor"
    today = datetime.now(UTC).strftime("%Y-%m-%d")
    reads = f"{bandwidth() / 1e9:.0f} GB/s read from memory by one"
    system = f"{platform.system()} {platform.machine()}"
    return f"{name}, {cores} cores, {reads}, {system}, {today}"


def write_page(name: str, text: str) -> None:
    """Puts the tables between their markers in docs/performance.md."""
    page = PAGE.read_text()
    begin, end = BEGIN.format(name=name), END.format(name=name)
    if begin not in page or end not in page:
        raise Fault(f"{PAGE} has no lines {begin.strip()} and {end.strip()}")
    head, rest = page.split(begin)[0], page.split(end)[1]
    PAGE.write_text(f"{head}{begin}\n{text}\n{end}{rest}")


def run_all(arguments: argparse.Namespace, bench: Bench, folder: Path) -> Row:
    """Measures a deck: repetitions of both programs in turns, then CalculiX."""
    row = Row(bench)
    for repetition in range(arguments.repeat):
        count = arguments.instructions and repetition == 0
        row.runs.append(measure(arguments.program, bench, folder, count))
        if arguments.against:
            row.others.append(measure(arguments.against, bench, folder))
    if arguments.ccx and 0 < bench.size <= arguments.largest_ccx:
        row.ccx = run_ccx(bench_ccx.two_blocks(bench.size), bench.name, folder / "ccx")
    return row


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="bench", description=about)
    add = parser.add_argument
    add("program", type=Path, nargs="?", metavar="PROGRAM", help="instead of the release build")
    add("--against", type=Path, metavar="OTHER", help="program to compare with in the same run")
    help_ = "which decks (default examples blocks)"
    add(
        "--groups", nargs="+", choices=(*GROUPS, "read"), default=["examples", "blocks"], help=help_
    )
    help_ = f"elements along the two blocks (default {' '.join(map(str, SIZES))})"
    add("--sizes", type=positive_integer, nargs="+", default=SIZES, metavar="N", help=help_)
    help_ = "scheme of the two blocks (default the energy-momentum scheme)"
    add("--scheme", choices=("default", "ss22"), default="default", help=help_)
    add("--repeat", type=positive_integer, default=1, metavar="N", help="runs of each deck")
    add("--instructions", action="store_true", help="count instructions by valgrind")
    add("--ccx", action="store_true", help="run CalculiX on the two blocks without friction")
    help_ = "largest of the blocks that CalculiX runs (default 128)"
    add("--largest-ccx", type=positive_integer, default=128, metavar="N", help=help_)
    add("--write", action="store_true", help="write the tables to docs/performance.md")
    return parser.parse_args()


def run_tables(arguments: argparse.Namespace, name: str) -> str:
    """Measures the decks of a group."""
    rows = []
    for bench in group(name, arguments.scheme, tuple(arguments.sizes)):
        with tempfile.TemporaryDirectory(prefix="bench_") as folder:
            rows.append(run_all(arguments, bench, Path(folder)))
        print("  ".join(cell for cell in rows[-1].cells() if cell), flush=True)
    return tables(rows)


def reader_table(arguments: argparse.Namespace) -> str:
    """Measures the reading of decks."""
    table = bench_reader.table(arguments.program, arguments.repeat, arguments.instructions)
    return f"{machine()}.\n\n{table}"


def main() -> int:
    """Measures, prints a line for each deck and the tables."""
    arguments = parse()
    arguments.program = check_program(arguments.program or binary())
    arguments.against = check_program(arguments.against) if arguments.against else None
    for name in arguments.groups:
        text = reader_table(arguments) if name == "read" else run_tables(arguments, name)
        print(f"\n{text}")
        if arguments.write:
            write_page(name, text)
    return 0


if __name__ == "__main__":
    finish(main)
