"""Measures the run of a deck: processor time, instructions, passes, phases, memory."""

import re
import subprocess
from dataclasses import dataclass
from math import nan
from pathlib import Path
from shutil import which
from time import process_time

import numpy as np
from stickslip.errors import Fault
from stickslip.result import Result

from lab.bench_decks import Bench
from lab.measured_run import Run, run, wait

COLLECTED = re.compile(r"Collected : (\d+)")
"""What callgrind writes to its standard error: the instructions."""

MISSING_VALGRIND = "valgrind is not installed (Debian: apt-get install valgrind)"
MISSING_CCX = "CalculiX (ccx) is not installed (Debian: apt-get install calculix-ccx)"

WORK = {"pivots": "pivots", "iterations": "active_set_iterations", "LUs": "lcp_factorizations"}
"""Columns of the work of the complementarity problems, and their names in the results."""

PHASES = ("assembly", "factorization", "solve", "search", "contact", "lcp", "output")


@dataclass(frozen=True)
class Measured:
    """What a run took."""

    seconds: float
    """Processor time."""
    increments: int
    passes: int
    factorizations: int
    peak: int
    """Bytes."""
    phases: dict[str, float]
    """Parts of the run's time."""
    dofs: int
    work: dict[str, int]
    """What the complementarity problems took, by WORK."""
    instructions: float = nan

    @property
    def per_increment(self) -> float:
        """Milliseconds of processor time."""
        return 1e3 * self.seconds / self.increments

    @property
    def per_pass(self) -> float:
        """Instructions."""
        return self.instructions / self.passes


def measure(program: Path, bench: Bench, folder: Path, count: bool = False) -> Measured:
    """Runs a deck; with `count` once more under valgrind, for the instructions."""
    deck = bench.write(folder)
    ended = run(program, deck, folder / "results", options=bench.options)
    if ended.code != 0:
        raise Fault(f"{bench.name}: exit code {ended.code}: {ended.complaint}")
    instructions = count_instructions(program, bench, deck, folder) if count else nan
    return read(ended, instructions)


def read(ended: Run, instructions: float) -> Measured:
    """Reads what a run has counted from its results."""
    with Result(ended.result) as results:
        solver, record = results.history.solver, results.run
        total = float(record["seconds_total"])
        return Measured(
            ended.seconds,
            len(results.history.time) - 1,
            int(solver["passes"].sum()),
            int(solver["factorizations"].sum()),
            # the system's figure contains what the process was before it became the program
            int(record.get("peak_memory", ended.peak)),
            {name: float(record[f"seconds_{name}"]) / total for name in PHASES},
            2 * len(results.coordinates),
            {column: int(solver[name].sum()) for column, name in WORK.items() if name in solver},
            instructions,
        )


def count_instructions(program: Path, bench: Bench, deck: Path, folder: Path) -> float:
    """Instructions of a run in one thread, counted by callgrind."""
    if which("valgrind") is None:
        raise Fault(MISSING_VALGRIND)
    command: list[str | Path] = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    command += [program, "run", deck, "-o", folder / "counted", "--overwrite", "-q"]
    command += ["--threads", "1", *bench.options]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    found = COLLECTED.search(done.stderr)
    if done.returncode != 0 or found is None:
        raise Fault(f"{bench.name}: valgrind ends with exit code {done.returncode}")
    return float(found[1])


def bandwidth() -> float:
    """Bytes per second that one processor reads from memory, the best of some times."""
    values = np.ones(1 << 26)

    def seconds() -> float:
        start = process_time()
        values.max()
        return process_time() - start

    return values.nbytes / min(seconds() for _ in range(7))


@dataclass(frozen=True)
class CcxRun:
    """A run of CalculiX."""

    seconds: float
    iterations: int

    @property
    def per_iteration(self) -> float:
        """Milliseconds of processor time."""
        return 1e3 * self.seconds / self.iterations


def run_ccx(text: str, name: str, folder: Path) -> CcxRun:
    """Runs a deck of CalculiX in one thread."""
    program = which("ccx")
    if program is None:
        raise Fault(MISSING_CCX)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.inp").write_text(text)
    with (folder / f"{name}.out").open("wb") as stream:
        process = subprocess.Popen(
            [program, name],
            cwd=folder,
            env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"},
            stdin=subprocess.DEVNULL,
            stdout=stream,
            stderr=stream,
        )
        usage = wait(process)
    table = folder / f"{name}.cvg"
    lines = table.read_text().splitlines() if table.exists() else []
    iterations = sum(line.split()[:1] == ["1"] for line in lines)
    if process.returncode != 0 or iterations == 0:
        raise Fault(f"CalculiX ends with exit code {process.returncode} on {name}")
    return CcxRun(usage.seconds, iterations)
