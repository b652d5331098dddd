"""Compares results of a deck with those of the same deck moved, turned, mirrored, boosted.

Each deck is written flat and run for a limited processor time: as it is, twice with random numbers
of 1e-15 of its size added to its coordinates, and in every other form. What has one answer agrees
to 1e-9 of the largest value of its dimension (to the deck's own TOLERANCE where that is larger),
decisions agree exactly, over the increments in which the random numbers have not grown to 2e-11.
The exit code is 1 when anything differs by more.
"""

import argparse
import datetime
import re
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from math import cos, sin
from pathlib import Path

import numpy as np
from repository import ROOT
from rescale import Units, rescale
from stickslip.arrays import Array
from stickslip.command import finish, positive, positive_integer
from stickslip.deck import Card, Deck
from stickslip.errors import Fault, one_line
from stickslip.program import binary

from lab import changed_decks as changed
from lab.changed_decks import Unchangeable
from lab.expected_results import Change, Deviations, Seen, deviations
from lab.measured_run import Run, run
from lab.sample_decks import Sample, all_samples, given

TOLERANCE = 1e-9
"""Largest deviation of what has one answer, relative to the largest value of its dimension."""

NOISE = 1e-15
"""Random numbers added to coordinates, relative to the size of the model."""

GROWN = 0.02 * TOLERANCE
"""Deviation through this noise from which on a history is no longer compared."""

LIMIT = 0.3
"""Seconds of processor time of a run."""

LONGER = 1.5
"""The other runs may take longer by this factor."""

SHARED = ("history/contact/", "history/impacts", "history/returns", "history/touches")
"""Histories of single contacts."""

GOOD_ENDS = (0, 1)
"""Exit codes of runs that leave results."""

UNITS = Units(length=0.3048, mass=7.0, time=1.1)
"""No powers of two: every number is rounded."""

PAGE = ROOT / "docs" / "reliability.md"
MARKS = ("<!-- invariance -->\n", "<!-- end of invariance -->\n")


@dataclass(frozen=True)
class Form:
    """A deck in another form, and how its results follow from those of the first."""

    deck: Deck
    change: Change


def rotation(angle: float) -> Array:
    """Matrix of a rotation."""
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


FIRST_FRAMES = 10
"""Frames of a run whose velocities bound the speed of a boost."""

QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])
MIRROR = np.array([[-1.0, 0.0], [0.0, 1.0]])


def _keeps_its_axis(deck: Deck) -> bool:
    """Whether its bodies are bodies of revolution: only a motion along their axis leaves them as they are."""
    cards = deck.find("ELEMENT")
    return any(card.parameters.get("TYPE", "").upper().startswith("CAX") for card in cards)


def _along(deck: Deck, vector: Array) -> Array:
    """A vector, of bodies of revolution its part along their axis."""
    return vector * [0.0, 1.0] if _keeps_its_axis(deck) else vector


def _moved(deck: Deck, _: Seen) -> Form:
    shift = _along(deck, np.array([0.7, -0.9])) * changed.size(deck)
    return Form(changed.moved(deck, shift), Change(shift=shift))


def _turned(matrix: Array) -> Callable[[Deck, Seen], Form]:
    def form(deck: Deck, _: Seen) -> Form:
        if _keeps_its_axis(deck):
            raise Unchangeable("bodies of revolution keep their axis")
        return Form(changed.turned(deck, matrix), Change(matrix=matrix))

    return form


def _mirrored(deck: Deck, _: Seen) -> Form:
    matrix = -MIRROR if _keeps_its_axis(deck) else MIRROR
    return Form(changed.turned(deck, matrix), Change(matrix=matrix))


def _boosted(deck: Deck, base: Seen) -> Form:
    # no faster than the model, and no further than its size: displacements lose no digits. The run may have been stopped
    # for its time, which depends on the machine: only its first frames count.
    way = changed.size(deck) / (deck.duration or 1.0)
    velocities = base["VTKHDF/PointData/V"][: FIRST_FRAMES * base.nodes]
    speed = min(float(np.abs(velocities).max()) or way, way)
    velocity = _along(deck, np.array([0.6, -0.8])) * speed
    return Form(changed.boosted(deck, velocity), Change(velocity=velocity))


def _renumbered(deck: Deck, _: Seen) -> Form:
    new, *maps = changed.renumbered(deck)
    nodes, elements = ({int(a): int(b) for a, b in each.items()} for each in maps)
    return Form(new, Change(nodes=nodes, elements=elements))


SOLVED_OTHERWISE = "solved otherwise"
"""The same problem with another way to its solution: what differs is no matter of the form."""


def _solved_otherwise(deck: Deck, _: Seen) -> Form:
    settings = {"FACTORIZATION=KEEP": "FACTORIZATION=EVERY PASS", "SOLVER=FAER": "SOLVER=SPRS"}
    new = Deck([Card(card.keyword, card.head, card.rows) for card in deck.cards])
    for card in new.find("STICKSLIP"):
        for old, other in settings.items():
            card.head = card.head.replace(old, other)
    return Form(new, Change())


FORMS: dict[str, Callable[[Deck, Seen], Form]] = {
    SOLVED_OTHERWISE: _solved_otherwise,
    "moved": _moved,
    "turned by 90 degrees": _turned(QUARTER),
    "turned by 0.3 rad": _turned(rotation(0.3)),
    "mirrored": _mirrored,
    "boosted": _boosted,
    "renumbered": _renumbered,
    "reordered": lambda deck, _: Form(changed.reordered(deck), Change()),
    "exchanged": lambda deck, _: Form(changed.exchanged(deck), Change()),
    "units": lambda deck, _: Form(rescale(deck, UNITS), Change(units=UNITS)),
}


@dataclass
class Outcome:
    """A deck in one other form."""

    largest: float = 0.0
    where: str = ""
    """History or field with the largest deviation, its first row above the tolerance."""
    is_close: bool = True
    """Whether no deviation is above the tolerance."""
    refused: str = ""
    """Why the deck cannot be written so."""
    decisions: list[str] = field(default_factory=list)
    """Decisions that differ."""

    @property
    def is_good(self) -> bool:
        """Whether what has one answer has it."""
        return self.is_close and not self.decisions

    @property
    def text(self) -> str:
        """In a table."""
        decided = f" {len(self.decisions)} decisions" if self.decisions else ""
        return "-" if self.refused else f"{self.largest:.0e}{decided}"


@dataclass
class Verdict:
    """What the comparison of one deck found."""

    name: str
    increments: int = 0
    touching: int = 0
    """Increments with contact."""
    compared: int = 0
    """Increments over which every history is compared."""
    growth: float = 0.0
    """Largest deviation through noise of what is compared, over the noise."""
    first: str = ""
    """The history that noise changes first."""
    outcomes: dict[str, Outcome] = field(default_factory=dict)
    fault: str = ""

    @property
    def is_good(self) -> bool:
        """Whether nothing differs."""
        return not self.fault and all(outcome.is_good for outcome in self.outcomes.values())


@dataclass(frozen=True)
class Settings:
    """What to run."""

    program: Path
    limit: float
    forms: tuple[str, ...]


def judge(sample: Sample, settings: Settings) -> Verdict:
    """Runs a deck in all forms."""
    verdict = Verdict(sample.name)
    with tempfile.TemporaryDirectory(prefix="invariance_") as folder:
        try:
            _judge(sample, settings, Path(folder), verdict)
        except (Fault, OSError, KeyError, ValueError, RuntimeError) as error:
            verdict.fault = f"{type(error).__name__}: {one_line(error)}"
    return verdict


def _judge(sample: Sample, settings: Settings, folder: Path, verdict: Verdict) -> None:
    deck = flat(settings.program, sample.write(folder))
    theta = _theta(deck)
    first, base = _seen(settings.program, deck, folder / "base", settings.limit)
    longer = LONGER * settings.limit
    grown: dict[str, Array] = {}
    ends_alike = True
    for sign in (1.0, -1.0):
        # nodes on the axis stay there
        largest = _along(deck, np.full(2, sign * NOISE * changed.size(deck)))
        noisy = changed.noisy(deck, largest)
        ended, seen = _seen(settings.program, noisy, folder / f"noise{sign}", longer)
        ends_alike &= not _other_ends(first, ended, base, seen)
        _add(grown, deviations(base, seen, Change(), theta, set()))
    _end_all(base, grown)
    _tell_growth(verdict, base, grown)
    for name in settings.forms:
        outcome = verdict.outcomes[name] = Outcome()
        try:
            form = FORMS[name](deck, base)
        except Unchangeable as refused:
            outcome.refused = one_line(refused)
            continue
        ended, seen = _seen(settings.program, form.deck, folder / name.replace(" ", "_"), longer)
        if ends_alike:
            outcome.decisions += _other_ends(first, ended, base, seen)
        tied = _tied_nodes(form.deck) - _tied_nodes(deck)
        found = deviations(base, seen, form.change, theta, tied)
        _compare(found, grown, max(TOLERANCE, _tolerance(deck)), outcome)
        if name == SOLVED_OTHERWISE:
            _add(grown, found)
            _end_all(base, grown)


def flat(program: Path, deck: Path) -> Deck:
    """The deck as one flat deck, which is written beside it."""
    done = subprocess.run([program, "flatten", deck], capture_output=True, text=True)
    if done.returncode != 0:
        raise Fault(f"flatten ends with exit code {done.returncode}: {done.stderr}")
    output = deck.with_name("flat.inp")
    output.write_text(done.stdout)
    return Deck.read(output)


def _theta(deck: Deck) -> float:
    """Where within an increment forces act."""
    return float(deck.find("STICKSLIP")[0].parameters.get("THETA1", 0.5))


def _tolerance(deck: Deck) -> float:
    """The largest tolerance of its steps."""
    return max(float(card.parameters["TOLERANCE"]) for card in deck.find("STICKSLIP"))


def _tied_nodes(deck: Deck) -> set[int]:
    """Nodes of equations: what holds them may stand at others."""
    rows = [row for card in deck.find("EQUATION") for row in card.rows if len(row) > 1]
    return {int(label) for row in rows for label in row[::3]}


def _seen(program: Path, deck: Deck, folder: Path, limit: float) -> tuple[Run, Seen]:
    folder.mkdir()
    ended = run(program, deck.write(folder / "job.inp"), folder, limit)
    if ended.was_stopped and not ended.result.exists():  # before its first increment
        ended = run(program, deck.write(folder / "job.inp"), folder, 10.0 * limit)
    if ended.code not in GOOD_ENDS and not ended.was_stopped:
        raise Fault(f"{folder.name} ends with exit code {ended.code}: {ended.complaint}")
    return ended, Seen(ended.result, deck, ended.was_stopped)


def _add(grown: dict[str, Array], found: Deviations) -> None:
    """Joins the deviations of another run with noise: the largest so far of each history."""
    for name, away in found.by_name.items():
        largest = np.maximum.accumulate(away)
        before = grown.get(name, largest)
        rows = min(len(largest), len(before))
        grown[name] = np.maximum(largest[:rows], before[:rows])


def _end_all(base: Seen, grown: dict[str, Array]) -> None:
    """Ends the comparison of everything where one history has changed by more than the tolerance.

    Forces of single contacts are excepted: where two passes hold the same nodes, only their sums
    have one answer.
    """
    time = base["history/time"]
    end = float(time[-1])
    for name, away in grown.items():
        if name.startswith("history/") and not name.startswith(SHARED):
            beyond = np.flatnonzero((away > TOLERANCE) & np.isfinite(away))
            if len(beyond):
                end = min(end, float(time[max(beyond[0] - 1, 0)]))
    for name, away in grown.items():
        grown[name] = away[: base.rows_until(name, end)]


def _tell_growth(verdict: Verdict, base: Seen, grown: dict[str, Array]) -> None:
    """How far noise grows, and which history it changes first."""
    verdict.increments = verdict.compared = base.rows - 1
    closed = [base[name][: base.rows] for name in base.names() if name.endswith("/closed")]
    verdict.touching = int((np.sum(closed, axis=0) > 0).sum()) if closed else 0
    for name, away in grown.items():
        small = away[away <= GROWN]
        verdict.growth = max(verdict.growth, float(small.max(initial=0.0)) / NOISE)
        if name.startswith("history/") and len(small) <= verdict.compared:
            verdict.compared = max(len(small) - 1, 0)
            verdict.first = name


def _other_ends(first: Run, ended: Run, base: Seen, seen: Seen) -> list[str]:
    """What differs in the ends of two runs, if both went to their end."""
    if first.was_stopped or ended.was_stopped:
        return []
    counts = (
        ("exit code", first.code, ended.code),
        ("increments", base.rows - 1, seen.rows - 1),
        ("cutbacks", base.cutbacks, seen.cutbacks),
    )
    return [f"{what} {a} / {b}" for what, a, b in counts if a != b]


def _compare(
    found: Deviations, grown: dict[str, Array], tolerance: float, outcome: Outcome
) -> None:
    """Judges each history over the rows in which noise has not grown."""
    outcome.decisions += [f"only in one result: {name}" for name in found.missing]
    for name, away in found.by_name.items():
        rows = int((grown.get(name, np.zeros(0)) <= GROWN).sum())
        compared = away[:rows]
        decided = np.flatnonzero(np.isinf(compared))
        if len(decided):
            outcome.decisions.append(f"{name} from row {decided[0]} on")
        largest = float(compared[np.isfinite(compared)].max(initial=0.0))
        if largest > outcome.largest:
            outcome.largest, outcome.where = largest, name
            beyond = np.flatnonzero(compared > tolerance)
            if len(beyond):
                outcome.is_close = False
                outcome.where += f" from row {beyond[0]} on"


def judge_all(samples: Iterable[Sample], settings: Settings, jobs: int) -> Iterator[Verdict]:
    """Judges the decks, some at a time, in their order."""
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda sample: judge(sample, settings), samples)


def tell(verdict: Verdict) -> None:
    """Prints what was found of a deck."""
    if verdict.fault:
        print(f"failed  {verdict.name}: {verdict.fault}", flush=True)
        return
    noise = f", noise first in {verdict.first}" if verdict.first else ""
    print(
        f"{'same' if verdict.is_good else 'differs':<7} {verdict.name}: {verdict.compared} of "
        f"{verdict.increments} increments, {verdict.touching} in contact, "
        f"noise grows by {verdict.growth:.0e}{noise}"
    )
    for name, outcome in verdict.outcomes.items():
        print(f"    {name:<21} {outcome.refused or f'{outcome.largest:.1e} {outcome.where}'}")
        for text in outcome.decisions:
            print(f"        {text}")
    print(end="", flush=True)


def deck_table(verdicts: list[Verdict], forms: Iterable[str]) -> str:
    """Deck x form, largest deviation."""
    header = ["deck", "increments", "in contact", "compared", "noise grows by", *forms]
    rows = [
        [
            verdict.name,
            *map(str, (verdict.increments, verdict.touching, verdict.compared)),
            f"{verdict.growth:.0e}",
            *(outcome.text for outcome in verdict.outcomes.values()),
        ]
        for verdict in verdicts
        if not verdict.fault
    ]
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def form_table(verdicts: list[Verdict], forms: Iterable[str]) -> str:
    """Largest deviation of each form over all decks."""
    lines = ["| form | decks | largest deviation | where | above 1e-9, or decided otherwise |"]
    lines.append("|---|---|---|---|---|")
    for name in forms:
        pairs = [(v, v.outcomes[name]) for v in verdicts if name in v.outcomes]
        pairs = [(verdict, outcome) for verdict, outcome in pairs if not outcome.refused]
        good = [pair for pair in pairs if pair[1].is_good]
        bad = ", ".join(verdict.name for verdict, outcome in pairs if not outcome.is_good)
        if good:
            verdict, outcome = max(good, key=lambda pair: pair[1].largest)
            field_ = outcome.where.rpartition("/")[2]
            worst = f"{outcome.largest:.0e} | {verdict.name}, {field_}" if field_ else "0 |"
            lines.append(f"| {name} | {len(pairs)} | {worst} | {bad or 'none'} |")
    return "\n".join(lines) + "\n"


def write(verdicts: list[Verdict], settings: Settings) -> None:
    """Puts the table of the forms into docs/reliability.md."""
    increments = sum(verdict.compared for verdict in verdicts)
    date = datetime.date.today().isoformat()
    text = (
        f"`scripts/lab/run invariance` on {date}: {len(verdicts)} decks, {settings.limit:g} s of processor "
        f"time each,\n{increments} increments in which every history was compared.\n\n"
    )
    page = PAGE.read_text()
    head, _, rest = page.partition(MARKS[0])
    _, _, tail = rest.partition(MARKS[1])
    table = form_table(verdicts, settings.forms)
    PAGE.write_text(f"{head}{MARKS[0]}{text}{table}{MARKS[1]}{tail}")


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="invariance", description=about)
    help_ = "instead of the decks of input/ and the quick ones of verification/"
    parser.add_argument("decks", type=Path, nargs="*", metavar="DECK", help=help_)
    parser.add_argument("--all", action="store_true", help="all cases of verification/")
    help_ = f"seconds of processor time of a run (default {LIMIT:g})"
    parser.add_argument("--limit", type=positive, default=LIMIT, metavar="SECONDS", help=help_)
    parser.add_argument("--only", choices=FORMS, action="append", help="this form only")
    help_ = "decks whose name matches this regular expression"
    parser.add_argument("--like", default="", metavar="PATTERN", help=help_)
    help_ = "decks at a time (default 2)"
    parser.add_argument("--jobs", type=positive_integer, default=2, metavar="N", help=help_)
    parser.add_argument("--write", action="store_true", help="table into docs/reliability.md")
    parser.add_argument("--table", type=Path, metavar="FILE", help="table of all decks")
    return parser.parse_args()


def main() -> int:
    """Compares, prints what was found of each deck and a table."""
    arguments = parse()
    start = time.monotonic()
    settings = Settings(binary(), arguments.limit, tuple(arguments.only or FORMS))
    samples = given(arguments.decks) if arguments.decks else all_samples()
    if not (arguments.decks or arguments.all):
        samples = [sample for sample in samples if sample.case is None or sample.case.quick]
    verdicts = []
    for verdict in judge_all(
        [sample for sample in samples if re.search(arguments.like, sample.name)],
        settings,
        arguments.jobs,
    ):
        tell(verdict)
        verdicts.append(verdict)
    if arguments.table:
        arguments.table.write_text(deck_table(verdicts, settings.forms))
    if arguments.write:
        write(verdicts, settings)
    print(form_table(verdicts, settings.forms), end="")
    bad = sum(not verdict.is_good for verdict in verdicts)
    print(f"{len(verdicts)} decks, {bad} differ or failed; {time.monotonic() - start:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    finish(main)
