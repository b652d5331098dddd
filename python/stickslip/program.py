"""Runs the program: `run` solves a deck, `check` only reads a deck; messages of the program become warnings and
exceptions."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from stickslip import notebook
from stickslip.deck import Deck, Value
from stickslip.errors import Fault, one_line
from stickslip.result import Result

STOPPED = 1
"""Exit code of a run that stopped in the solve: the results up to there are valid."""

REJECTED = 2
"""Exit code of a run whose deck was rejected."""

POLL = 0.1
"""Seconds between two looks at a running program."""

OPTIONS = ("frames", "every", "solver", "threads", "checkpoint", "extend", "oldjob")
"""Options of `stickslip run` with a value."""


FLAGS = ("strict", "lenient", "verbose", "resume")
"""Options of `stickslip run` without a value."""


@dataclass(frozen=True)
class Diagnostic:
    """An error or warning of the deck."""

    severity: str
    """`error` or `warning`."""
    code: str
    """Such as `D108`; `stickslip explain D108` tells what it means."""
    message: str
    file: str = ""
    line: int = 0
    """Line and column in the file, from 1; 0 where the message has no place."""
    column: int = 0


class RunFailed(Fault):
    """The program ended with an exit code other than 0."""

    def __init__(self, message: str, code: int, result: Path) -> None:
        super().__init__(message)
        self.message = message
        """What the program wrote to its standard error, lines kept."""
        self.code = code
        """Exit code (docs/output.md); minus the number of the signal that killed the program."""
        self.path = result
        """Where the result is, if there is one."""

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Errors and warnings of the deck."""
        return diagnostics(self.message)


class DeckRejected(RunFailed):
    """The deck has errors, which `diagnostics` holds."""


class RunStopped(RunFailed):
    """The run stopped during the solve, or by a signal; `result` is valid up to that point."""

    @property
    def result(self) -> Result:
        """The result up to the point where the run stopped; a run that stopped before its first frame raises a
        Fault."""
        return Result(self.path)


@dataclass(frozen=True)
class Progress:
    """Progress of a run."""

    time: float
    """Time at the end of the last increment."""
    end: float | None
    """Time at which the deck ends, where it can be told."""
    increment: int
    seconds: float
    """Wall-clock time since the start."""

    @property
    def part(self) -> float | None:
        """The part of the total time of the deck that has been computed."""
        return self.time / self.end if self.end else None

    def __str__(self) -> str:
        text = f"increment {self.increment}, t = {self.time:.6g}"
        if self.end:
            left = self.seconds * (self.end / self.time - 1.0) if self.time > 0.0 else 0.0
            text += f" of {self.end:.6g}, {left:.0f} s left"
        return text


def binary() -> Path:
    """Path of the program: $STICKSLIP, or the first existing one of these: the program installed with this package, on
    the search path, and built in a checkout."""
    if "STICKSLIP" in os.environ:
        return Path(os.environ["STICKSLIP"])
    name = "stickslip.exe" if os.name == "nt" else "stickslip"
    root = Path(__file__).resolve().parents[2]
    target = Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))
    found = shutil.which(name)
    places = [Path(sys.executable).with_name(name), target / "release" / name]
    if not (root / "Cargo.toml").exists():
        places.pop()
    for place in [*places, *([Path(found)] if found else [])]:
        if place.exists():
            return place
    raise Fault(
        "the program stickslip is not found: install it, name it in the environment variable"
        " STICKSLIP, or run 'cargo build --release' in a checkout"
    )


@cache
def version() -> str:
    """First line of `stickslip --version`: name, version and commit."""
    done = subprocess.run([binary(), "--version"], capture_output=True, text=True)
    return done.stdout.partition("\n")[0]


def run(
    deck: Deck | Path | str,
    output: Path | str = ".",
    *words: str,
    job: str = "job",
    overwrite: bool = True,
    parameters: Mapping[str, Value] | None = None,
    progress: bool | Callable[[Progress], object] = False,
    **options: object,
) -> Result:
    """Solves a deck, which is a file or a `Deck`, and returns its result.

    The results go to the folder `output`. The results have the name of the file of the deck; for a `Deck` the results
    have the name `job`, and the deck is also written to this folder. Existing results are replaced, unless `overwrite`
    is False or `resume` continues the run from its checkpoint. `options` are the options of `stickslip run`: frames,
    every, solver, threads, checkpoint, extend and oldjob have a value; strict, lenient, verbose and resume are True.
    `words` holds further options as they are typed on the command line. `parameters` gives values of parameters of the
    deck, which replace the values of its `*PARAMETER` cards. `progress` is True to show the progress of the run (as a
    bar in a notebook), or a function that is called with a `Progress` several times a second. A failed run raises
    DeckRejected, RunStopped or RunFailed.
    """
    folder = Path(output)
    values = dict(parameters or {})
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if isinstance(deck, Deck):
            deck, values = deck.filled(values)
            path = deck.write(folder / f"{job}.inp")
        else:
            path = Path(deck)
    except OSError as error:
        raise Fault(f"{folder} cannot be written: {one_line(error)}") from None
    command = [str(binary()), "run", str(path), "-o", str(folder), "-q"]
    command += [*settings(values), *_words(options), *words]
    if overwrite and not options.get("resume"):
        command.append("--overwrite")
    result = folder / f"{job_name(path)}.vtkhdf"
    end = None if "extend" in options else _duration(path)
    watch = _watch(result.with_suffix(".sta"), end, progress) if progress else None
    with tempfile.TemporaryFile("w+", errors="replace") as errors:
        code = _wait(subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=errors), watch)
        errors.seek(0)
        message = errors.read().strip()
    if code == 0:
        return Result(result)
    text = message or f"{' '.join(command)}: exit code {code}"
    if code == REJECTED:
        raise DeckRejected(text, code, result)
    if code == STOPPED or code > 128:
        raise RunStopped(text, code, result)
    raise RunFailed(text, code, result)


def settings(values: Mapping[str, Value]) -> list[str]:
    """The options that give parameters of a deck their values; numbers have all their digits."""
    words = []
    for name, value in values.items():
        match value:
            case str():
                written = f"'{value}'"
            case int():
                written = str(int(value))
            case _:
                written = repr(float(value))
        words += ["--set", f"{name}={written}"]
    return words


def check(
    deck: Deck | Path | str, parameters: Mapping[str, Value] | None = None
) -> list[Diagnostic]:
    """Reads a deck without solving it; returns its warnings, or raises DeckRejected."""
    values = dict(parameters or {})
    with tempfile.TemporaryDirectory() as folder:
        if isinstance(deck, Deck):
            deck, values = deck.filled(values)
            path = deck.write(Path(folder) / "job.inp")
        else:
            path = Path(deck)
        command = [str(binary()), "check", str(path), *settings(values)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode == REJECTED:
            raise DeckRejected(done.stderr.strip(), done.returncode, path)
        if done.returncode:
            raise RunFailed(done.stderr.strip(), done.returncode, path)
        return diagnostics(done.stdout + done.stderr)


@contextmanager
def first_frame(deck: Deck, parameters: Mapping[str, Value]) -> Iterator[Result | None]:
    """A result up to its first frame, which has the names of all histories; the result is None if the run writes no
    frame."""
    with tempfile.TemporaryDirectory() as folder:
        path = deck.write(Path(folder) / "job.inp")
        result = path.with_suffix(".vtkhdf")
        command = [str(binary()), "run", str(path), "-o", folder, "-q", *settings(parameters)]
        quiet = subprocess.DEVNULL
        with subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet) as process:
            while process.poll() is None and not result.exists():
                time.sleep(0.02)
            process.terminate()
        if not result.exists():
            yield None
            return
        with Result(result) as found:
            yield found


def diagnostics(text: str) -> list[Diagnostic]:
    """Errors and warnings of a deck, read from the output of the program."""
    pattern = re.compile(
        r"^(error|warning)\[(\w+)\]: (.*)(?:\n\s*--> (.*):(\d+):(\d+)$)?", flags=re.MULTILINE
    )
    found = []
    for severity, code, message, file, line, column in pattern.findall(text):
        found.append(Diagnostic(severity, code, message, file, int(line or 0), int(column or 0)))
    return found


def job_name(deck: Path) -> str:
    """Name of the job of a deck: the name of its file without `.inp`."""
    return deck.stem if deck.suffix.lower() == ".inp" else deck.name


def _words(options: dict[str, object]) -> list[str]:
    """Options of the command line for `options` of a run."""
    words = []
    for name, value in options.items():
        if name not in OPTIONS + FLAGS:
            raise TypeError(f"run has no option {name}: it has {', '.join(OPTIONS + FLAGS)}")
        if value is True and name in FLAGS:
            words.append(f"--{name}")
        elif value is not None and value is not False:
            words += [f"--{name}", str(value)]
    return words


def _wait(process: subprocess.Popen[bytes], watch: Callable[[bool], None] | None) -> int:
    """Waits for the end of a run; if this process is interrupted, the run ends in order."""
    try:
        while watch and process.poll() is None:
            watch(False)
            time.sleep(POLL)
        code = process.wait()
    except BaseException:
        process.send_signal(signal.SIGTERM)
        process.wait()
        raise
    if watch:
        watch(True)
    return code


def _duration(deck: Path) -> float | None:
    """Total time of all steps of a deck, if this time can be determined."""
    try:
        return Deck.read(deck).duration
    except (OSError, Fault):  # the program says what is wrong
        return None


def _watch(
    status: Path, end: float | None, progress: bool | Callable[[Progress], object]
) -> Callable[[bool], None]:
    """A function that reads the status file of a run and reports the progress."""
    tell = progress if callable(progress) else _told()
    start, old = time.monotonic(), _stamp(status)
    last = -1

    def watch(ended: bool) -> None:
        nonlocal last
        increment, when = (0, 0.0) if _stamp(status) == old else _last_increment(status)
        if increment > last:
            last = increment
            tell(Progress(when, end, increment, time.monotonic() - start))
        if ended and tell is _print:
            print(file=sys.stderr)

    return watch


def _stamp(file: Path) -> tuple[int, ...]:
    """A value that changes whenever a file is written; empty if the file does not exist."""
    try:
        found = file.stat()
    except OSError:
        return ()
    return found.st_ino, found.st_mtime_ns, found.st_size


def _last_increment(status: Path) -> tuple[int, float]:
    """Number and time of the last increment in a status file."""
    try:
        with status.open("rb") as file:
            file.seek(max(0, os.fstat(file.fileno()).st_size - 4096))
            lines = file.read().decode(errors="replace").splitlines(keepends=True)
        row = [line for line in lines if line.endswith("\n") and line[:1] == " "][-1].split()
        return int(row[1]), float(row[6])
    except (OSError, IndexError, ValueError):
        return 0, 0.0


def _print(progress: Progress) -> None:
    """A progress display in one line, which is overwritten each time."""
    print(f"\r{progress!s:<70}", end="", file=sys.stderr, flush=True)


def _told() -> Callable[[Progress], object]:
    """The default display of progress: a bar in a notebook, else a line."""
    return notebook.Bar() if notebook.runs_here() else _print
