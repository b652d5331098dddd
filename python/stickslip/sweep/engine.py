"""Runs the points of a study on a cluster of Dask distributed: that of this machine, or any other."""

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.deck import Deck
from stickslip.errors import Fault, one_line
from stickslip.program import DeckRejected, binary, check
from stickslip.sweep.point import Task, point_name, solve
from stickslip.sweep.points import Point
from stickslip.sweep.quantities import Quantity, usual
from stickslip.sweep.table import Table

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
    """How the points of a study are run."""

    scheduler: str | None = None
    """Address of a Dask scheduler, `tcp://host:8786`; without it workers are started here."""
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
    """Runs a deck at points, values of its parameters by name, and returns the table of the study.

    `output` is a folder that all workers see. Points that have ended there are not run again. A
    point that fails is a row with its message.
    """
    chosen = [Quantity.parse(text) for text in quantities] or usual()
    folder = Path(output).resolve()
    template = deck if isinstance(deck, Deck) else Deck.read(deck)
    tasks = _tasks(template, points, folder, settings)
    (folder / "points").mkdir(parents=True, exist_ok=True)
    path = template.write(folder / DECK)
    different = {task.name: task for task in tasks}
    waiting = [task for task in different.values() if settings.again or not task.has_ended]
    settings.tell(f"{len(tasks)} points, {len(tasks) - len(waiting)} have ended before")
    lost: dict[str, str] = {}
    if waiting:
        with _client(settings, len(waiting)) as client:
            lost = _run_all(client, waiting, path, settings)
    return Table.of(tasks, lost, chosen)


def _tasks(template: Deck, points: Sequence[Point], folder: Path, settings: Settings) -> list[Task]:
    """The runs of a study. Names that the deck does not know are told before the first run."""
    if not points:
        raise Fault("a study needs points")
    for names in {tuple(values): values for values in points}.values():
        _check_names(template, names)
    options = ("--threads", str(settings.threads), *settings.options)
    tasks = []
    for values in points:
        name = point_name(template, values, settings.options)
        tasks.append(Task(folder, name, values, options, settings.memory))
    return tasks


def _check_names(template: Deck, values: Point) -> None:
    """Parameters that the deck does not know, and those without a value, are Faults; other faults of it are rows."""
    try:
        check(template, values)
    except DeckRejected as rejected:
        of_names = [d.message for d in rejected.diagnostics if d.code in PARAMETER_CODES]
        if of_names:
            raise Fault("; ".join(of_names)) from None


@contextmanager
def _client(settings: Settings, count: int) -> "Iterator[Client]":
    """A client of the chosen cluster."""
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError:
        raise Fault("a study needs the package distributed: pip install distributed") from None
    dask.config.set({"distributed.scheduler.allowed-failures": FAILURES})
    if settings.scheduler is not None:
        try:
            with Client(settings.scheduler, set_as_default=False) as client:
                yield client
        except OSError as error:
            text = f"the scheduler {settings.scheduler} does not answer: {one_line(error)}"
            raise Fault(text) from None
        return
    binary()  # told here once, not by every worker
    processors = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    )
    workers = settings.workers or max(1, (processors or 1) // settings.threads)
    with (
        LocalCluster(
            n_workers=min(workers, count),
            threads_per_worker=1,
            memory_limit=None,
            dashboard_address=":0",
            silence_logs="CRITICAL",
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield client


def _run_all(
    client: "Client", tasks: Sequence[Task], template: Path, settings: Settings
) -> dict[str, str]:
    """Runs the tasks; returns why there is no row for some, by their names."""
    from distributed import as_completed

    start = time.monotonic()
    futures: dict[Any, Task] = {
        client.submit(solve, task, template, key=f"{task.name}-{time.time_ns()}", pure=False): task
        for task in tasks
    }
    lost = {}
    failed = 0
    for done, future in enumerate(as_completed(futures, loop=client.loop), start=1):
        task = futures[future]
        if future.status == "finished":
            failed += (task.row() or {}).get("exit_status") != 0
        else:
            failed += 1
            error = future.exception() if future.status == "error" else "it was cancelled"
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
    """Writes how far a study is: over and over into one line of a terminal, else line by line."""
    if sys.stderr.isatty():
        print(f"\r{text:<70}", end="", file=sys.stderr, flush=True)
    else:
        print(text, file=sys.stderr, flush=True)
