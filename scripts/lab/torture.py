"""Kills runs, at any time and before each of many writes, lets them race, sends them signals and fills their disk.

After each trial the files have to be what docs/output.md promises: a result file is there with at
least one frame or not at all, what it counts is the beginning of an undisturbed run's results bit by
bit, an earlier result is there until a new one takes its place, and exit codes tell what happened.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
from repository import ROOT
from stickslip.program import binary

DECK = ROOT / "tests" / "decks" / "drop.inp"
JOB = "job"
FULL = ("no space left on device", "larger than files may become here")
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
DISK_FULL = 4
KILLER = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long writes;

static void count(int file)
{
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0)
        return;
    path[length] = 0;
    const char *last = getenv("KILL_BEFORE_WRITE");
    if (strstr(path, ".vtkhdf") && last && ++writes == atol(last))
        raise(SIGKILL);
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("WRITES");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file)
        fprintf(file, "%ld", writes), fclose(file);
}

#define COUNTED(name, arguments, values) \
    int name arguments \
    { \
        count(file); \
        return ((int(*) arguments)dlsym(RTLD_NEXT, #name)) values; \
    }
#define COUNTED_WRITE(name, place) \
    ssize_t name(int file, const void *bytes, size_t size, place at) \
    { \
        count(file); \
        return ((ssize_t(*)(int, const void *, size_t, place))dlsym(RTLD_NEXT, #name))(file, bytes, size, at); \
    }
COUNTED_WRITE(pwrite, off_t)
COUNTED_WRITE(pwrite64, off64_t)
COUNTED(ftruncate, (int file, off_t size), (file, size))
COUNTED(ftruncate64, (int file, off64_t size), (file, size))
"""


@dataclass
class Counts:
    """Trials of one kind and what went wrong in them."""

    name: str
    trials: int = 0
    seen: dict[str, int] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def saw(self, what: str) -> None:
        """Counts an outcome."""
        self.seen[what] = self.seen.get(what, 0) + 1

    def check(self, is_right: bool, what: str) -> None:
        """Notes a fault unless all is right."""
        if not is_right:
            self.faults.append(f"trial {self.trials}: {what}")

    def line(self) -> str:
        """One line of the summary."""
        seen = ", ".join(f"{count} {what}" for what, count in sorted(self.seen.items()))
        return f"{self.name:<9} {self.trials:>3} trials  {len(self.faults):>3} wrong   {seen}"


@dataclass
class Bench:
    """A deck, its undisturbed results, and a folder for trials."""

    folder: Path
    increments: int
    random: random.Random
    seconds: float = 0.0
    size: int = 0

    @property
    def deck(self) -> Path:
        """The deck of all trials."""
        return self.folder / f"{JOB}.inp"

    @property
    def reference(self) -> Path:
        """Result of an undisturbed run."""
        return self.folder / "reference"

    def prepare(self) -> None:
        """Writes the deck and runs it undisturbed."""
        text = DECK.read_text().replace("0.002, 0.1", f"0.002, {0.002 * self.increments:g}")
        self.deck.write_text(text.replace("FREQUENCY=10", "FREQUENCY=150"))
        start = time.monotonic()
        done = self.start(self.reference)
        if done.wait() != 0:
            raise SystemExit(f"the undisturbed run fails: {done.communicate()[1]}")
        self.seconds = time.monotonic() - start
        self.size = (self.reference / f"{JOB}.vtkhdf").stat().st_size

    def start(
        self, output: Path, *options: str, limit: int | None = None, **more: str
    ) -> subprocess.Popen[str]:
        """Starts a run; `limit` is the largest size of a file in bytes, `more` belongs to its environment."""
        command = [str(binary()), "run", str(self.deck), "-o", str(output), "-q", *options]
        if limit is not None:
            # The shell counts in blocks of 1024 bytes.
            command = ["bash", "-c", f'ulimit -f {limit // 1024}; exec "$@"', "bash", *command]
        return subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **more},
        )

    def end(self, run: subprocess.Popen[str]) -> tuple[int, str]:
        """Waits for the end of a run: its exit code and what it complained of."""
        _, complaint = run.communicate(timeout=120)
        return run.returncode, complaint

    def earlier(self, output: Path) -> bytes:
        """Puts complete results of an earlier run, told apart by one byte more, into a folder."""
        output.mkdir(parents=True)
        old = (self.reference / f"{JOB}.vtkhdf").read_bytes() + b"\0"
        (output / f"{JOB}.vtkhdf").write_bytes(old)
        for name in (f"{JOB}.sta", f"{JOB}.log"):
            (output / name).write_bytes((self.reference / name).read_bytes())
        return old

    def fault(self, output: Path, old: bytes | None, last_is_extra: bool = False) -> str | None:
        """What is wrong with the results in a folder, where `old` stood before."""
        path = output / f"{JOB}.vtkhdf"
        if not path.exists():
            return "the earlier result is lost" if old is not None else None
        if old is not None and path.read_bytes() == old:
            return None
        try:
            return self.difference(path, last_is_extra)
        except (OSError, KeyError, RuntimeError, ValueError) as error:
            return f"unreadable result: {error}"

    def difference(self, path: Path, last_is_extra: bool) -> str | None:
        """Where a result is not the beginning of the undisturbed one."""
        with (
            h5py.File(path, locking=False) as file,
            h5py.File(self.reference / path.name) as reference,
        ):
            frames = int(file["VTKHDF/Steps"].attrs["NSteps"])
            if frames == 0:
                return "a result without frames"
            sound = frames - 1 if last_is_extra else frames
            for group in ("PointData", "CellData"):
                for name, values in file["VTKHDF"][group].items():
                    whole = reference["VTKHDF"][group][name]
                    rows = len(whole) // int(reference["VTKHDF/Steps"].attrs["NSteps"])
                    if len(values) < frames * rows:
                        return f"{name} has {len(values)} rows in {frames} frames"
                    if not same(values[: sound * rows], whole[: sound * rows]):
                        return f"{name} differs"
            return history_difference(file["history"], reference["history"])


def same(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two arrays are the same, NaN for NaN."""
    return a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")


def history_difference(history: h5py.Group, reference: h5py.Group) -> str | None:
    """Where the rows that a history counts are not the beginning of another."""
    fault: list[str] = []

    def compare(name: str, values: h5py.Group | h5py.Dataset) -> None:
        if isinstance(values, h5py.Dataset):
            grows = values.maxshape[0] is None
            counting = values.parent if "rows" in values.parent.attrs else history
            rows = int(counting.attrs["rows"]) if grows else len(reference[name])
            if not same(values[:rows], reference[name][:rows]):
                fault.append(f"history/{name} differs")

    history.visititems(compare)
    return fault[0] if fault else None


def read(path: Path) -> str:
    """Text of a file, empty if there is none."""
    return path.read_text() if path.exists() else ""


def exit_status(output: Path) -> int | None:
    """The exit status that a result file tells of, if it is readable."""
    try:
        with h5py.File(output / f"{JOB}.vtkhdf", locking=False) as file:
            return int(file["run"].attrs["exit_status"])
    except OSError:
        return None


def kills(bench: Bench, counts: Counts, number: int) -> None:
    """Runs that are killed, every other one while it replaces earlier results."""
    for trial in range(number):
        output = bench.folder / f"kill{trial}"
        old = bench.earlier(output) if trial % 2 else None
        counts.trials += 1
        longest = bench.seconds if trial % 3 else 0.04
        run = bench.start(output, "--overwrite")
        time.sleep(bench.random.uniform(0.0, longest))
        run.kill()
        code, _ = bench.end(run)
        fault = bench.fault(output, old)
        counts.check(fault is None, f"{fault}")
        is_there = (output / f"{JOB}.vtkhdf").exists()
        kept = "without a result" if old is None else "with the earlier result"
        is_new = is_there and (output / f"{JOB}.vtkhdf").read_bytes() != old
        counts.saw("finished" if code == 0 else "with a new result" if is_new else kept)
        # What is left of a killed run is in nobody's way.
        options = ["--overwrite"] if is_there else []
        again = bench.start(output, *options)
        code, complaint = bench.end(again)
        counts.check(code == 0, f"the next run ends with {code}: {complaint}")
        counts.check(not list(output.glob("*.part")), "the next run leaves a draft behind")
        fault = bench.fault(output, None)
        counts.check(fault is None, f"the next run: {fault}")


def writes(bench: Bench, counts: Counts, number: int) -> None:
    """Runs that are killed before one of their writes to the result, from the middle of the run on."""
    source, killer, told = (bench.folder / name for name in ("killer.c", "killer.so", "writes"))
    source.write_text(KILLER)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", killer, source, "-ldl"], check=True)
    run = bench.start(
        bench.folder / "counted", LD_PRELOAD=str(killer), KILL_BEFORE_WRITE="0", WRITES=str(told)
    )
    bench.end(run)
    last = int(told.read_text())
    for trial, write in enumerate(np.linspace(last / 2, last, number).astype(int)):
        output = bench.folder / f"write{trial}"
        counts.trials += 1
        run = bench.start(output, LD_PRELOAD=str(killer), KILL_BEFORE_WRITE=str(write))
        code, _ = bench.end(run)
        fault = bench.fault(output, None)
        counts.check(fault is None, f"before write {write}: {fault}")
        counts.saw("killed" if code == -signal.SIGKILL else "finished")


def races(bench: Bench, counts: Counts, number: int) -> None:
    """Two runs of one job, every other pair over earlier results.

    They are started together, or the second while the first has the job and is stopped.
    """
    for trial in range(number):
        output = bench.folder / f"race{trial}"
        options = ["--overwrite"] if trial % 2 else []
        if options:
            bench.earlier(output)
        counts.trials += 1
        runs = [bench.start(output, *options)]
        is_held = trial % 4 >= 2
        if is_held:
            wait_for_claim(output, runs[0])
            runs[0].send_signal(signal.SIGSTOP)
            is_held = runs[0].poll() is None
        runs.append(bench.start(output, *options))
        ends = [bench.end(runs[1])] if is_held else []
        runs[0].send_signal(signal.SIGCONT)
        ends = [bench.end(runs[0]), *(ends or [bench.end(runs[1])])]
        codes = [code for code, _ in ends]
        counts.saw(f"with {min(codes)} and {max(codes)}")
        if is_held:
            counts.check(codes == [0, 4], f"exit codes {codes}")
        else:
            # Where the machine starts one after the other has ended, it replaces results.
            both = [[0, 0]] if options else []
            counts.check(sorted(codes) in [[0, 4], *both], f"exit codes {codes}")
        for code, complaint in ends:
            counts.check(code != 4 or len(complaint.splitlines()) == 1, complaint)
        fault = bench.fault(output, None)
        counts.check(fault is None and exit_status(output) == 0, f"{fault}")
        lines = read(output / f"{JOB}.sta").splitlines()
        counts.check(len(lines) == bench.increments + 2, f"{len(lines)} lines in the status file")
        log = read(output / f"{JOB}.log")
        last = log.rstrip().rpartition("\n")[2]
        is_whole = log.startswith("stickslip") and last.startswith("wrote ")
        counts.check(is_whole, "the log is not that of one run")


def wait_for_claim(output: Path, run: subprocess.Popen[str]) -> None:
    """Waits until a run holds its job, or has ended."""
    result = output / f"{JOB}.vtkhdf"

    def number() -> int | None:
        try:
            return result.stat().st_ino
        except FileNotFoundError:
            return None

    earlier = number()
    draft = result.with_name(f"{result.name}.part")
    while run.poll() is None and not draft.exists() and number() == earlier:
        time.sleep(5e-4)


def signals(bench: Bench, counts: Counts, number: int) -> None:
    """Runs that are asked to end."""
    for trial in range(number):
        output = bench.folder / f"signal{trial}"
        wanted = SIGNALS[trial % len(SIGNALS)]
        counts.trials += 1
        run = bench.start(output)
        time.sleep(bench.random.uniform(0.0, 1.05 * bench.seconds))
        run.send_signal(wanted)
        code, complaint = bench.end(run)
        fault = bench.fault(output, None, last_is_extra=code > 128)
        counts.check(fault is None, f"{fault}")
        counts.saw(f"with exit code {code}")
        if not output.exists() and code in (-wanted, 128 + wanted):
            # It came before the run had begun.
            continue
        counts.check(code in (0, 128 + wanted), f"exit code {code}: {complaint}")
        counts.check(exit_status(output) == code, f"the file says {exit_status(output)}")
        if code > 0 and fault is None:
            check_last_frame(output, counts)
            named = f"{wanted.name} asked for the end"
            counts.check(named in read(output / f"{JOB}.log"), "not in the log")


def check_last_frame(output: Path, counts: Counts) -> None:
    """The last increment of a run that was asked to end is a frame."""
    with h5py.File(output / f"{JOB}.vtkhdf") as file:
        last = float(file["VTKHDF/Steps/Values"][-1])
        counts.check(last == float(file["history/time"][-1]), "the last increment is no frame")


@contextmanager
def small_disk(bench: Bench, size: int) -> Iterator[tuple[Path, int | None]]:
    """A folder with room for `size` bytes, or one where files may not become larger."""
    folder = bench.folder / "disk"
    folder.mkdir(exist_ok=True)
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    if os.name == "posix" and os.geteuid() == 0 and subprocess.call(mount, **quiet) == 0:
        try:
            yield folder / "out", None
        finally:
            subprocess.run(["umount", str(folder)], check=True)
    else:
        output = folder / f"out{size}"
        yield output, size


def disks(bench: Bench, counts: Counts, number: int) -> None:
    """Runs on disks of many sizes, every third one over results of an earlier run."""
    whole = 2 * bench.size + 2_000_000
    sizes = np.linspace(16_384, whole, number).astype(int)
    for trial, size in enumerate(sizes.tolist()):
        counts.trials += 1
        with small_disk(bench, size) as (output, limit):
            old = None
            if trial % 3 == 2 and size > 3 * bench.size:
                old = bench.earlier(output)
            code, complaint = bench.end(bench.start(output, "--overwrite", limit=limit))
            is_there = (output / f"{JOB}.vtkhdf").exists()
            what = "with a result" if is_there else "without a result"
            counts.saw("complete" if code == 0 else f"full {what}")
            counts.check(code in (0, DISK_FULL), f"{size} bytes: exit code {code}: {complaint}")
            if code != 0:
                is_told = len(complaint.splitlines()) == 1 and any(t in complaint for t in FULL)
                counts.check(is_told and str(output) in complaint, f"{size} bytes: {complaint}")
            fault = bench.fault(output, old)
            counts.check(fault is None, f"{size} bytes: {fault}")
            drafts = list(output.glob("*.part"))
            counts.check(not drafts, f"{size} bytes: a draft is left")


def screens(bench: Bench, counts: Counts, number: int) -> None:
    """A full disk behind the standard output, and a pipe that is closed."""
    del number
    program, result = binary(), bench.reference / f"{JOB}.vtkhdf"
    run = f"'{program}' run '{bench.deck}' --overwrite -o '{bench.folder}/screen'"
    commands = {
        f"{run} > /dev/full": 4,
        f"'{program}' info '{result}' > /dev/full": 4,
        f"'{program}' check '{bench.deck}' > /dev/full": 4,
        f"'{program}' --help > /dev/full": 4,
        f"{run} | head -1": 0,
        f"'{program}' info '{result}' | true": 0,
    }
    for command, wanted in commands.items():
        counts.trials += 1
        script = f"{command}; exit ${{PIPESTATUS[0]}}"
        done = subprocess.run(
            ["bash", "-c", script], stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
        counts.saw(f"with exit code {done.returncode}")
        counts.check(done.returncode == wanted, f"{command}: {done.returncode}: {done.stderr}")
        counts.check(len(done.stderr.splitlines()) == (wanted != 0), f"{command}: {done.stderr}")
        if command.startswith(run):
            fault = bench.fault(bench.folder / "screen", None)
            counts.check(fault is None, f"{command}: {fault}")


def main() -> int:
    """All trials; 0 if nothing went wrong."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--short", action="store_true", help="a few trials of each kind")
    parser.add_argument("--seed", type=int, default=1, help="of the random times")
    parser.add_argument("-o", "--output", type=Path, help="keep the files in this folder")
    args = parser.parse_args()
    kinds: list[tuple[str, Callable[[Bench, Counts, int], None], int]] = [
        ("kills", kills, 4 if args.short else 25),
        ("writes", writes, 30 if args.short else 150),
        ("races", races, 4 if args.short else 24),
        ("signals", signals, 4 if args.short else 20),
        ("disks", disks, 6 if args.short else 40),
        ("screens", screens, 0),
    ]
    with tempfile.TemporaryDirectory() as folder:
        folder = args.output or Path(folder)
        Path(folder).mkdir(parents=True, exist_ok=True)
        bench = Bench(Path(folder), 600 if args.short else 3000, random.Random(args.seed))
        bench.prepare()
        all_counts = [torture(bench, *kind) for kind in kinds]
    for counts in all_counts:
        for fault in counts.faults:
            print(f"{counts.name}: {fault}")
    print("\n".join(counts.line() for counts in all_counts))
    wrong = sum(len(counts.faults) for counts in all_counts)
    print(f"torture: {wrong} wrong")
    return int(wrong > 0)


def torture(
    bench: Bench, name: str, trials: Callable[[Bench, Counts, int], None], number: int
) -> Counts:
    """Trials of one kind."""
    counts = Counts(name)
    trials(bench, counts, number)
    return counts


if __name__ == "__main__":
    sys.exit(main())
