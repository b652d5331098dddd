"""One point of a study, as a worker of the cluster runs it.

A point has a folder whose name gives its values. A run has its own folder, which gets the name of the point when the
run has ended. So files of a killed worker are never mistaken for a result.
"""

import glob
import hashlib
import json
import os
import shutil
import subprocess
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stickslip.deck import Deck
from stickslip.errors import Fault, one_line
from stickslip.program import REJECTED, STOPPED, binary, settings, version
from stickslip.result import Result
from stickslip.sweep.points import Point

ROW = "row.json"
"""What is known of a point that has ended: identity, exit status, warnings, message, seconds."""

RUNNING: set[subprocess.Popen[str]] = set()
"""Runs of this process."""

ENDED = (0, STOPPED, REJECTED)
"""Exit codes that the same deck has every time: such points are not run again."""


@dataclass(frozen=True)
class Task:
    """A run of a study."""

    folder: Path
    """Folder of the study, which all workers see."""
    deck: Path
    """The deck, in which files whose names are parameters of the point are in place."""
    name: str
    """Name of the point's folder and of its files."""
    identity: str
    """What changes with the deck, its parameters, the options that change the result, and the program."""
    values: Point
    """What tells the point from others."""
    given: Point
    """The values that the deck still needs."""
    options: tuple[str, ...]
    """Options of `stickslip run`."""
    memory: int | None
    """Bytes of address space that the run may have."""

    @property
    def place(self) -> Path:
        """Folder of the point."""
        return self.folder / "points" / self.name

    @property
    def result(self) -> Path:
        """The result file of the point, if it exists."""
        return self.folder / self.relative_result

    @property
    def relative_result(self) -> str:
        """Path of the result file, relative to the folder of the study."""
        return f"points/{self.name}/{self.name}.vtkhdf"

    def row(self) -> dict[str, Any] | None:
        """The row of a point that has ended. A row that comes from another deck, other options or another program does
        not count."""
        try:
            row = json.loads((self.place / ROW).read_text())
        except (OSError, ValueError):
            return None
        return row if row.get("identity") == self.identity else None

    @property
    def has_ended(self) -> bool:
        """Whether the point need not run again."""
        row = self.row()
        return row is not None and row["exit_status"] in ENDED


def identity(deck: Deck, values: Point, options: Sequence[str]) -> str:
    """A text that changes with the deck, its parameters, the options that change the result, and the program."""
    text = "\n".join([version(), *options, *settings(values), deck.text()])
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def solve(task: Task) -> str:
    """Runs a point; errors are recorded in its row. Returns the name of the point."""
    own = task.place.with_name(f".{task.name}~{uuid.uuid4().hex[:8]}")
    own.mkdir(parents=True)
    try:
        row = _run(task, own)
        (own / ROW).write_text(json.dumps(row))
        shutil.rmtree(task.place, ignore_errors=True)
        try:
            own.rename(task.place)
        except OSError:
            if task.row() is None:  # else another worker has run the same point
                raise
    finally:
        for left in task.place.parent.glob(f".{glob.escape(task.name)}~*"):  # also of workers that were killed
            shutil.rmtree(left, ignore_errors=True)
    return task.name


def _run(task: Task, folder: Path) -> dict[str, Any]:
    """Runs the program in a folder."""
    row: dict[str, Any] = {"identity": task.identity, "values": task.values}
    try:
        path = Path(shutil.copy(task.deck, folder / f"{task.name}.inp"))
        command = [str(binary()), "run", str(path), "-o", str(folder), "-q"]
        command += [*settings(task.given), *task.options]
    except Fault as fault:
        return {**row, "exit_status": REJECTED, "message": one_line(fault), "warnings": []}
    code, said = _said(_bounded(command, task.memory))
    warnings: list[str] = []
    seconds = None
    try:
        with Result(folder / f"{task.name}.vtkhdf") as result:
            warnings, seconds = result.warnings, float(result.run.get("seconds_total", "nan"))
    except Fault:
        pass  # there is none: the exit status tells why
    message = said.strip().replace(str(folder), f"points/{task.name}")
    return {
        **row,
        "exit_status": code,
        "message": (message or f"the run ended with code {code}") if code else "",
        "warnings": warnings,
        "seconds": seconds,
    }


def _said(command: list[str]) -> tuple[int, str]:
    """Runs a command; returns its exit code and its standard error output."""
    quiet = subprocess.DEVNULL
    with subprocess.Popen(
        command, stdin=quiet, stdout=quiet, stderr=subprocess.PIPE, text=True, errors="replace"
    ) as process:
        RUNNING.add(process)
        try:
            _, said = process.communicate()
        finally:
            RUNNING.discard(process)
    return process.returncode, said


def stop_runs() -> None:
    """Ends all runs of this process in order, so that each run writes its last good state."""
    for process in list(RUNNING):
        process.terminate()


def _bounded(command: list[str], memory: int | None) -> list[str]:
    """The command with a limit of its memory; on Linux the command also ends when the worker is killed."""
    if memory is not None:
        command = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(memory // 1024), *command]
    if os.name == "posix" and (setpriv := shutil.which("setpriv")):
        command = [setpriv, "--pdeathsig", "KILL", *command]
    return command
