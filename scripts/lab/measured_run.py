"""Runs a program on a deck with its processor time measured, or up to a limit of it."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stickslip.errors import Fault

POLL = 0.02
"""Seconds between two looks at a running program."""

GRACE = 60.0
"""Seconds in which a program has to end after a signal."""


@dataclass(frozen=True)
class Run:
    """A run that has ended."""

    result: Path
    code: int
    seconds: float
    """Processor time, user and system."""
    was_stopped: bool
    """Whether the limit was reached: the last increment may be a part of one."""
    complaint: str
    """First line of what the program wrote to its standard error."""
    peak: int
    """Largest memory resident at a time, in bytes."""

    @property
    def status(self) -> Path:
        """The status file."""
        return self.result.with_suffix(".sta")


def check_program(path: Path) -> Path:
    """The absolute path of a program; a Fault when it cannot be run."""
    if not path.is_file() or not os.access(path, os.X_OK):
        raise Fault(f"there is no program {path}")
    return path.resolve()


def run(
    program: Path, deck: Path, output: Path, limit: float | None = None, options: Sequence[str] = ()
) -> Run:
    """Runs a deck in one thread; asks the run to end when its processor time reaches `limit`."""
    output.mkdir(parents=True, exist_ok=True)
    errors = output / f"{deck.stem}.err"
    command = [program, "run", deck, "-o", output, "--overwrite", "-q", "--threads", "1", *options]
    with errors.open("wb") as stream:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=stream
        )
    try:
        was_stopped = limit is not None and _stop_at(limit, process.pid)
        usage = wait(process)
    except BaseException:
        process.kill()
        raise
    lines = errors.read_text(errors="replace").splitlines()
    result = output / f"{deck.stem}.vtkhdf"
    was_stopped = was_stopped and process.returncode != 0
    complaint = lines[0] if lines else ""
    return Run(result, process.returncode, usage.seconds, was_stopped, complaint, usage.peak)


@dataclass(frozen=True)
class Usage:
    """What a process has used."""

    seconds: float
    """Processor time, user and system."""
    peak: int
    """Largest memory resident at a time, in bytes."""


def wait(process: subprocess.Popen[bytes]) -> Usage:
    """Waits for the end of a process."""
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    unit = 1 if sys.platform == "darwin" else 1024
    return Usage(usage.ru_utime + usage.ru_stime, usage.ru_maxrss * unit)


def _stop_at(limit: float, pid: int) -> bool:
    """Waits for the end or the limit; true when the process was asked to end."""
    start = time.monotonic()
    while not _has_ended(pid):
        if _processor_seconds(pid, start) >= limit:
            os.kill(pid, signal.SIGTERM)
            _kill_after_grace(pid)
            return True
        time.sleep(POLL)
    return False


def _kill_after_grace(pid: int) -> None:
    """Kills a process that does not end after a signal."""
    end = time.monotonic() + GRACE
    while not _has_ended(pid):
        if time.monotonic() > end:
            os.kill(pid, signal.SIGKILL)
            return
        time.sleep(POLL)


def _has_ended(pid: int) -> bool:
    """Whether a child has ended; it stays to be waited for."""
    return os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


def _processor_seconds(pid: int, start: float) -> float:
    """Processor time of a child so far; where the system has no /proc, the time since its start."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return time.monotonic() - start
    # Fields 14 and 15 of proc(5); the name of the program, field 2, may hold blanks.
    user, system = text.rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")
