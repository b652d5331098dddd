"""Compares the results of two programs, bit for bit: histories, frames, status files.

Runs both on decks (default: all of input/, the cases of verification/ and small decks of the tests)
and compares all datasets of the result files and the lines of the status files. A run that reaches
the limit of processor time is asked to end, and compared up to the last increment that both
have finished. The exit code is 1 when anything differs.
"""

import argparse
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from math import ceil
from pathlib import Path

import h5py
from stickslip.command import finish, positive, positive_integer
from stickslip.deck import Deck
from stickslip.errors import Fault, one_line

from lab.differences import Comparison, Difference, Files, Span, frames_until, status_difference
from lab.measured_run import Run, check_program, run
from lab.sample_decks import Sample, all_samples, given, quick_samples

LIMIT = 20.0
QUICK_LIMIT = 4.0
"""Seconds of processor time of a run, of all decks and with --quick."""

SHOWN = 5
"""Differences that are printed of a deck."""

GOOD_ENDS = (0, 1)
"""Exit codes of runs that leave results: to the end, stopped in the solve."""


@dataclass(frozen=True)
class Settings:
    """What to run and how to compare."""

    programs: tuple[Path, Path]
    limit: float
    tolerance: float | None
    until: float
    allow_new: bool


@dataclass
class Verdict:
    """What the comparison of one deck found."""

    name: str
    faults: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    summary: str = ""
    is_failure: bool = False
    """Whether a run failed or was too short, so that nothing was compared."""

    @property
    def word(self) -> str:
        """The verdict."""
        return "failed" if self.is_failure else "different" if self.faults else "same"

    def __str__(self) -> str:
        lines = [f"{self.word:<9} {self.name}   {self.summary}".rstrip()]
        lines += [f"          {text}" for text in [*self.faults, *self.notes]]
        return "\n".join(lines)


def judge(sample: Sample, settings: Settings) -> Verdict:
    """Runs both programs on a deck and compares."""
    verdict = Verdict(sample.name)
    with tempfile.TemporaryDirectory(prefix="same_histories_") as name:
        folder = Path(name)
        try:
            deck = sample.write(folder)
            runs = [
                run(program, deck, folder / which, settings.limit)
                for program, which in zip(settings.programs, ("old", "new"))
            ]
            _compare_runs(runs[0], runs[1], Deck.read(deck), settings, verdict)
        except (Fault, OSError, KeyError, ValueError, RuntimeError) as error:
            verdict.is_failure = True
            verdict.faults.append(one_line(error))
    return verdict


def _compare_runs(old: Run, new: Run, deck: Deck, settings: Settings, verdict: Verdict) -> None:
    """Compares two runs that have ended."""
    for which, ended in (("OLD", old), ("NEW", new)):
        if ended.code not in GOOD_ENDS and not ended.was_stopped:
            raise Fault(f"{which} ends with exit code {ended.code}: {ended.complaint}")
    ends = old.code, new.code
    if ends[0] != ends[1] and not (old.was_stopped or new.was_stopped):
        verdict.faults.append(f"exit code {ends[0]} / {ends[1]}")
    with h5py.File(old.result) as first, h5py.File(new.result) as second:
        span = common_span((old, new), (first, second), settings.until, verdict)
        comparison = Files(first, second, span, settings.tolerance).compare()
        verdict.summary = _summary(first, second, span, comparison, deck)
    if settings.tolerance is None:
        line = status_difference(old.status, new.status, span)
        comparison.differences += [line] if line else []
    _tell(comparison, settings, verdict)


def common_span(
    runs: tuple[Run, Run], files: tuple[h5py.File, h5py.File], until: float, verdict: Verdict
) -> Span | None:
    """The rows and frames that both runs have; None when both went to their ends."""
    # The last increment before a stop may have been cut back.
    rows = [len(file["history/time"]) - ended.was_stopped for ended, file in zip(runs, files)]
    for this, other in ((0, 1), (1, 0)):
        if rows[this] < rows[other] and not runs[this].was_stopped:
            verdict.faults.append(f"{('OLD', 'NEW')[this]} ends after {rows[this] - 1} increments")
    common = ceil(until * min(rows))
    if common < 2:
        raise Fault("nothing to compare before the limit of processor time: raise --limit")
    if until == 1.0 and not any(ended.was_stopped for ended in runs):
        return None
    return Span(common, (frames_until(files[0], common), frames_until(files[1], common)))


def _summary(
    old: h5py.File, new: h5py.File, span: Span | None, comparison: Comparison, deck: Deck
) -> str:
    """How much was compared."""
    rows = len(old["history/time"]) if span is None else span.rows
    frames = len(old["VTKHDF/Steps/Values"]) if span is None else span.frames[0]
    part = ""
    if span is not None:
        end = float(old["history/time"][rows - 1])
        period = deck.duration or float("inf")
        part = f"SHORTENED to time {end:.4g} of {period:.4g} ({100 * end / period:.0f} %), "
    return f"{part}{rows - 1} increments, {frames} frames, {comparison.datasets} datasets"


def _tell(comparison: Comparison, settings: Settings, verdict: Verdict) -> None:
    """Puts what was found into the verdict: earliest, largest and some other differences."""
    found = comparison.differences
    if found:
        first = _earliest(found)
        largest = max(found, key=lambda difference: difference.relative)
        plural = "s" if len(found) > 1 else ""
        verdict.faults.append(f"{len(found)} difference{plural}; OLD / NEW:")
        ordered = [first, *([largest] if largest is not first else [])]
        ordered += [difference for difference in found if difference not in ordered]
        verdict.faults += [f"  {difference}" for difference in ordered[:SHOWN]]
        if len(ordered) > SHOWN:
            verdict.faults.append(f"  and {len(ordered) - SHOWN} more")
    verdict.faults += [f"only in OLD: {name}" for name in comparison.only_old]
    others = verdict.notes if settings.allow_new else verdict.faults
    others += [f"only in NEW: {name}" for name in comparison.only_new]
    if settings.tolerance is not None:
        size, name = comparison.largest
        verdict.summary += f"; largest relative difference {size:.2e}"
        verdict.summary += f" in {name}" if name else ""


def _earliest(found: list[Difference]) -> Difference:
    """The history that differs in the earliest increment, else the first difference."""
    histories = [one for one in found if one.name.startswith("history/") and one.first]
    return min(histories, key=lambda one: one.first[0], default=found[0])


def judge_all(samples: Iterable[Sample], settings: Settings, jobs: int) -> Iterator[Verdict]:
    """Judges the decks, some at a time, in their order."""
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda sample: judge(sample, settings), samples)


def fraction(text: str) -> float:
    """A number above 0, up to 1, as a type of argparse."""
    number = positive(text)
    if number > 1.0:
        raise argparse.ArgumentTypeError(f"{text} is above 1")
    return number


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="same_histories", description=about)
    parser.add_argument("old", type=Path, metavar="OLD", help="program")
    parser.add_argument("new", type=Path, metavar="NEW", help="program to compare with it")
    parser.add_argument("decks", type=Path, nargs="*", metavar="DECK", help="instead of all decks")
    parser.add_argument("--quick", action="store_true", help="one deck of each kind, cut short")
    help_ = f"seconds of processor time of a run (default {LIMIT:g}; {QUICK_LIMIT:g} with --quick)"
    parser.add_argument("--limit", type=positive, metavar="SECONDS", help=help_)
    help_ = "allow differences up to this part of the largest value of a dataset"
    parser.add_argument("--tolerance", type=positive, metavar="PART", help=help_)
    help_ = "compare only the first part of each run"
    parser.add_argument("--until", type=fraction, default=1.0, metavar="FRACTION", help=help_)
    parser.add_argument("--allow-new", action="store_true", help="datasets only in NEW are right")
    help_ = "decks at a time (default 2)"
    parser.add_argument("--jobs", type=positive_integer, default=2, metavar="N", help=help_)
    return parser.parse_intermixed_args()


def main() -> int:
    """Compares, prints a line for each deck and a summary."""
    arguments = parse()
    start = time.monotonic()
    settings = Settings(
        (check_program(arguments.old), check_program(arguments.new)),
        arguments.limit or (QUICK_LIMIT if arguments.quick else LIMIT),
        arguments.tolerance,
        arguments.until,
        arguments.allow_new,
    )
    if arguments.decks:
        samples = given(arguments.decks)
    else:
        samples = quick_samples() if arguments.quick else all_samples()
    counts = {"same": 0, "different": 0, "failed": 0}
    shortened = 0
    for verdict in judge_all(samples, settings, arguments.jobs):
        print(verdict, flush=True)
        counts[verdict.word] += 1
        shortened += "SHORTENED" in verdict.summary
    numbers = ", ".join(f"{count} {word}" for word, count in counts.items())
    seconds = time.monotonic() - start
    print(f"{len(samples)} decks: {numbers}; {shortened} shortened; {seconds:.0f} s")
    return 0 if counts["same"] == len(samples) else 1


if __name__ == "__main__":
    finish(main)
