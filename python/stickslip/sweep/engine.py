"""Runs the points of a study, in parallel on this machine or on a cluster of Dask distributed."""

import hashlib
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from stickslip.deck import Deck
from stickslip.errors import Fault, not_installed, one_line
from stickslip.program import DeckRejected, binary, check, first_frame
from stickslip.result import Result
from stickslip.sweep.point import Task, identity, solve, stop_runs
from stickslip.sweep.points import Point, check_points, point_name
from stickslip.sweep.quantities import Quantity, usual
from stickslip.sweep.table import Table, columns

if TYPE_CHECKING:
    from distributed import Client

DECK = "deck.inp"
"""The deck with its parameters, in one file, in the folder of a study."""

PARAMETER_CODES = ("D123", "D124", "D125")
"""Codes of messages about parameters."""

FAILURES = 3
"""A point whose worker has died more often than this is given up."""


@dataclass(frozen=True)
class Settings:
    """Settings for running the points of a study."""

    scheduler: str | None = None
    """Address of a Dask scheduler, `tcp://host:8786`; without it the points run on this machine."""
    threads: int = 1
    """Threads of a point's run."""
    memory: int | None = None
    """Bytes of address space that a point's run may have."""
    workers: int | None = None
    """Runs at a time on this machine; without it one for each `threads` processors."""
    options: tuple[str, ...] = ()
    """More options of `stickslip run`, such as `--frames 5`."""
    again: bool = False
    """Whether points that have ended are run again."""
    tell: Callable[[str], object] = field(default=lambda _: None)
    """Is told how far the study is."""


def sweep(
    deck: Deck | Path | str,
    points: Sequence[Point],
    output: Path | str,
    quantities: Iterable[str] = (),
    settings: Settings = Settings(),
) -> Table:
    """Runs a deck at some points (values of its parameters by name) and returns the table of the study.

    `output` is a folder that all workers can access. Points that have already ended in the folder `output` are not run
    again. A point that fails has a row with its error message.
    """
    chosen = [Quantity.parse(text) for text in dict.fromkeys(quantities)]
    if not points:
        raise Fault("a study needs points")
    check_points(points)
    columns(list(points[0]), chosen)
    if settings.memory is not None and os.name != "posix":
        raise Fault("the memory of a run can be bounded on Unix alone")
    folder = Path(output).resolve()
    template = deck if isinstance(deck, Deck) else Deck.read(deck)
    studies = _tasks(template, points, folder, settings)
    tasks = [task for task, _ in studies]
    different = {task.name: task for task in tasks}
    waiting = [task for task in different.values() if settings.again or not task.has_ended]
    if chosen:
        _check_quantities(chosen, studies)
    (folder / "points").mkdir(parents=True, exist_ok=True)
    template.write(folder / DECK)
    for task, own in {task.deck: (task, own) for task, own in studies}.values():
        own.write(task.deck)
    settings.tell(f"{len(tasks)} points, {len(tasks) - len(waiting)} have ended before")
    lost: dict[str, str] = {}
    if waiting:
        with _runs(settings, len(waiting)) as runs:
            lost = _run_all(runs, waiting, settings)
    return Table.of(folder, tasks, lost, chosen or usual())


def _tasks(
    template: Deck, points: Sequence[Point], folder: Path, settings: Settings
) -> list[tuple[Task, Deck]]:
    """The runs of a study, each with its deck. Unknown names of parameters and histories are reported before the first
    run."""
    options = ("--threads", str(settings.threads), *settings.options)
    studies = []
    checked = set()
    for values in points:
        own, given = template.filled(values)
        path = folder / DECK
        if own is not template:
            path = path.with_name(f"deck-{hashlib.sha256(own.text().encode()).hexdigest()[:12]}.inp")
        if path not in checked:
            checked.add(path)
            _check_names(own, given)
        own_identity = identity(own, given, settings.options)
        task = Task(
            folder, path, point_name(values), own_identity, values, given, options, settings.memory
        )
        studies.append((task, own))
    return studies


def _check_quantities(chosen: Sequence[Quantity], studies: Sequence[tuple[Task, Deck]]) -> None:
    """Raises a Fault if the first point with a result lacks a history. If no point has a result yet, points are run up
    to their first frame."""
    for task, own in studies:
        has_result = task.has_ended and task.result.exists()
        with Result(task.result) if has_result else first_frame(own, task.given) as result:
            if result is None:
                continue  # the row of the point tells why
            for quantity in chosen:
                quantity.series(result)
            return


def _check_names(template: Deck, values: Point) -> None:
    """Parameters that the deck does not know, and parameters without a value, raise Faults; other faults of the deck
    become rows of the table."""
    try:
        check(template, values)
    except DeckRejected as rejected:
        of_names = [d.message for d in rejected.diagnostics if d.code in PARAMETER_CODES]
        if of_names:
            raise Fault("; ".join(of_names)) from None


class Runs(Protocol):
    """Base class of the places (this machine or a cluster) where points run."""

    def submit(self, task: Task) -> Any:
        """Begins a run; the returned object has the `exception` with which the run has ended."""

    def ended(self, futures: Iterable[Any]) -> Iterator[Any]:
        """The submitted runs, in the order in which they end."""


@contextmanager
def _runs(settings: Settings, count: int) -> Iterator[Runs]:
    """The place to run: this machine, or the chosen cluster."""
    if settings.scheduler is not None:
        with _cluster(settings.scheduler) as client:
            yield _OnCluster(client)
        return
    binary()  # told here once, not by every point
    processors = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    )
    workers = settings.workers or max(1, (processors or 1) // settings.threads)
    pool = ThreadPoolExecutor(min(workers, count))
    try:
        yield _OnThreads(pool)
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        stop_runs()
        raise
    finally:
        pool.shutdown()


@dataclass(frozen=True)
class _OnThreads:
    """Threads of this process that wait for the program; no port is opened."""

    pool: ThreadPoolExecutor

    def submit(self, task: Task) -> Any:
        return self.pool.submit(solve, task)

    def ended(self, futures: Iterable[Any]) -> Iterator[Any]:
        return as_completed(futures)


@dataclass(frozen=True)
class _OnCluster:
    """Runs points on the workers of a Dask scheduler."""

    client: "Client"

    def submit(self, task: Task) -> Any:
        return self.client.submit(solve, task, key=f"{task.name}-{time.time_ns()}", pure=False)

    def ended(self, futures: Iterable[Any]) -> Iterator[Any]:
        from distributed import as_completed as ended

        return iter(ended(futures, loop=self.client.loop))


@contextmanager
def _cluster(scheduler: str) -> "Iterator[Client]":
    """A client of a Dask scheduler."""
    try:
        import dask
        from distributed import Client
    except ImportError:
        raise not_installed("distributed") from None
    dask.config.set({"distributed.scheduler.allowed-failures": FAILURES})
    try:
        with Client(scheduler, set_as_default=False) as client:
            yield client
    except OSError as error:
        text = f"the scheduler {scheduler} does not answer: {one_line(error)}"
        raise Fault(text) from None


def _run_all(runs: Runs, tasks: Sequence[Task], settings: Settings) -> dict[str, str]:
    """Runs the tasks of a study. Returns, by the names of the points, the reason for each task without a row in the
    table."""
    start = time.monotonic()
    futures: dict[Any, Task] = {runs.submit(task): task for task in tasks}
    lost = {}
    failed = 0
    for done, future in enumerate(runs.ended(futures), start=1):
        task = futures[future]
        error = "it was cancelled" if future.cancelled() else future.exception()
        if error is None:
            failed += (task.row() or {}).get("exit_status") != 0
        else:
            failed += 1
            lost[task.name] = f"the point has no result: {' '.join(str(error).split())}"
        left = (time.monotonic() - start) * (len(tasks) / done - 1.0)
        text = f"{done} of {len(tasks)} points, {failed} failed, {duration(left)} left"
        settings.tell(text if done < len(tasks) else f"{done} points, {failed} failed")
    return lost


def duration(seconds: float) -> str:
    """A time in words: `3 h 20 min`, `40 s`."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def told_on_screen(text: str) -> None:
    """Writes the progress of a study: in a terminal into one line, which is overwritten, else line by line."""
    if sys.stderr.isatty():
        print(f"\r{text:<70}", end="", file=sys.stderr, flush=True)
    else:
        print(text, file=sys.stderr, flush=True)
