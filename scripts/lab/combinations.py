"""Runs small decks made of all pairs of levels and judges them without stored answers.

scripts/lab/run combinations                the short part, some two minutes
scripts/lab/run combinations --all          every pair; --seed for another array, several times for several
scripts/lab/run combinations --deck 17      prints a deck of an array
scripts/lab/run combinations --shrink       drops levels of failing decks and writes what is left
"""

import argparse
import json
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from stickslip.command import finish, positive_integer
from stickslip.errors import one_line
from stickslip.program import binary

from lab.covering import Choice, Covering, pairs_of
from lab.levels import FACTORS, RULES, SIMPLEST, allows, known
from lab.mutations import Found, find_all
from lab.oracles import ALWAYS, FORMS, READERS, Trial, Untold, runs
from lab.scene import Scene
from lab.single import SINGLE

SHORT = 40
"""Decks of the short part: the first of the array, which hold most pairs."""

SEED = 1
"""The array of the short part."""


@dataclass
class Verdict:
    """What was found of a deck."""

    name: str
    choice: Choice
    code: int = 0
    failures: dict[str, str] = field(default_factory=dict)
    """What is wrong, by oracle."""
    known: dict[str, str] = field(default_factory=dict)
    """Failures that are documented, with what is wrong and the reason."""
    told: list[str] = field(default_factory=list)
    """Oracles that had something to say."""
    seconds: float = 0.0

    @property
    def is_good(self) -> bool:
        """Whether nothing is wrong but what is known."""
        return not self.failures


def judge(name: str, choice: Choice, program: Path, only: str | None = None) -> Verdict:
    """Runs a deck and asks all oracles, or one."""
    verdict = Verdict(name, choice)
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="combinations_") as folder:
        trial = Trial(choice, program, Path(folder))
        oracles = {"runs": runs}
        if trial.base.code == 0:
            # forms first: they read the file of a result that is not open yet
            oracles |= {
                choice["form"]: FORMS[choice["form"]],
                **ALWAYS,
                choice["reader"]: READERS[choice["reader"]],
            }
        else:
            oracles["check"] = ALWAYS["check"]
        verdict.code = trial.base.code
        for oracle, ask in oracles.items():
            if only not in (None, oracle):
                continue
            try:
                said = ask(trial)
            except Untold:
                continue
            except Exception as error:  # noqa: BLE001 - no deck may end the laboratory
                said = one_line(error) or type(error).__name__
            verdict.told.append(oracle)
            if said:
                if reason := known(oracle, choice):
                    verdict.known[oracle] = f"{said} ({reason})"
                else:
                    verdict.failures[oracle] = said
    verdict.seconds = time.monotonic() - start
    return verdict


def _judge(job: tuple[str, Choice, Path]) -> Verdict:
    return judge(*job)


def judge_all(decks: Iterable[tuple[str, Choice]], program: Path, jobs: int) -> Iterator[Verdict]:
    """Judges decks, some at a time, in their order."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(_judge, ((name, choice, program) for name, choice in decks))


def shrunk(verdict: Verdict, oracle: str, program: Path) -> Choice:
    """The choice with as many levels as possible the simplest ones, which fails the same oracle."""
    choice = dict(verdict.choice)
    fixed = {"form"} if oracle in FORMS else {"reader"} if oracle in READERS else set()
    has_changed = True
    while has_changed:
        has_changed = False
        for factor, level in SIMPLEST.items():
            simpler = {**choice, factor: level}
            if factor in fixed or choice[factor] == level or not allows(simpler):
                continue
            if oracle in judge("", simpler, program, oracle).failures:
                choice, has_changed = simpler, True
    return choice


def write_shrunk(verdict: Verdict, oracle: str, program: Path, folder: Path) -> str:
    """Shrinks a failing deck into a folder; tells which levels are left."""
    choice = shrunk(verdict, oracle, program)
    said = judge("", choice, program, oracle).failures.get(oracle, verdict.failures[oracle])
    left = {name: level for name, level in choice.items() if level != SIMPLEST.get(name)}
    folder.mkdir(parents=True, exist_ok=True)
    name = f"{verdict.name}_{oracle}".replace(" ", "_").replace(":", "_")
    scene = Scene(choice)
    text = scene.deck()
    head = f"** {oracle}: {said}\n** {', '.join(f'{a} {b}' for a, b in left.items())}\n"
    (folder / f"{name}.inp").write_text(head + text)
    if scene.include:
        (folder / "mesh.inc").write_text(scene.include)
    return f"{oracle}: {', '.join(left.values())}: {said}"


def decks_of(seed: int, count: int | None) -> tuple[Covering, list[tuple[str, Choice]]]:
    """Decks of an array, all or the first, by their names `seed:number`."""
    covering = Covering(FACTORS, allows, seed)
    chosen = islice(covering.choices(), count)
    return covering, [(f"{seed}:{number}", choice) for number, choice in enumerate(chosen)]


@dataclass
class Counts:
    """What was covered and found."""

    pairs: int = 0
    impossible: int = 0
    in_decks: set[object] = field(default_factory=set)
    in_runs: set[object] = field(default_factory=set)
    verdicts: list[Verdict] = field(default_factory=list)

    def add(self, verdict: Verdict) -> None:
        """Counts a deck."""
        self.verdicts.append(verdict)
        pairs = set(pairs_of(verdict.choice))
        self.in_decks |= pairs
        if verdict.code == 0:
            self.in_runs |= pairs

    def tables(self) -> str:
        """Coverage, and failures by oracle."""
        ran = sum(verdict.code == 0 for verdict in self.verdicts)
        refused = sum(verdict.code == 2 for verdict in self.verdicts)
        levels = sum(map(len, FACTORS.values()))
        lines = [
            "| levels | pairs allowed | in decks | in decks that ran | decks | ran | refused | stopped |",
            "|---|---|---|---|---|---|---|---|",
            f"| {levels} | {self.pairs} | {len(self.in_decks)} | {len(self.in_runs)} | {len(self.verdicts)} "
            f"| {ran} | {refused} | {len(self.verdicts) - ran - refused} |",
            "",
            "| oracle | asked | failures | known |",
            "|---|---|---|---|",
        ]
        told = Counter(oracle for verdict in self.verdicts for oracle in verdict.told)
        failed = Counter(oracle for verdict in self.verdicts for oracle in verdict.failures)
        excused = Counter(oracle for verdict in self.verdicts for oracle in verdict.known)
        for oracle in ("runs", *ALWAYS, *READERS, *FORMS):
            lines.append(f"| {oracle} | {told[oracle]} | {failed[oracle]} | {excused[oracle]} |")
        return "\n".join(lines) + "\n"


def tell(verdict: Verdict) -> None:
    """Prints what was found of a deck that fails."""
    if not verdict.is_good:
        print(f"{verdict.name}: {', '.join(verdict.choice.values())}")
        for oracle, said in verdict.failures.items():
            print(f"    {oracle}: {said}")
        print(end="", flush=True)


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="combinations", description=about)
    parser.add_argument("--all", action="store_true", help="whole arrays")
    help_ = f"number of an array (default {SEED}); may be repeated"
    parser.add_argument("--seed", type=int, action="append", metavar="N", help=help_)
    help_ = "print a deck of the array and judge nothing"
    parser.add_argument("--deck", type=int, metavar="NUMBER", help=help_)
    help_ = "judge the deck of this number alone"
    parser.add_argument("--number", type=int, metavar="NUMBER", help=help_)
    help_ = "shrink failing decks, one for each oracle and message, into the folder of --output"
    parser.add_argument("--shrink", action="store_true", help=help_)
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("combinations"), help="folder of shrunk decks"
    )
    parser.add_argument("--program", type=Path, help="the program to run")
    parser.add_argument(
        "--jobs", type=positive_integer, default=2, metavar="N", help="decks at a time (default 2)"
    )
    parser.add_argument("--table", type=Path, metavar="FILE", help="all verdicts as JSON")
    help_ = "build the program with faults, one at a time, which the short part must find"
    parser.add_argument("--mutations", action="store_true", help=help_)
    return parser.parse_args()


def main() -> int:
    """Judges decks and prints what fails, and tables."""
    arguments = parse()
    if arguments.mutations:
        return min(find_all(lambda program: failures(program, arguments.jobs)), 1)
    seeds = arguments.seed or [SEED]
    if arguments.deck is not None:
        print_deck(seeds[0], arguments.deck)
        return 0
    program = (arguments.program or binary()).resolve()
    start, counts, bad = time.monotonic(), Counts(), 0
    for seed in seeds:
        covering, decks = decks_of(
            seed, None if arguments.all else max(SHORT, (arguments.number or 0) + 1)
        )
        counts.pairs, counts.impossible = len(covering.pairs), len(covering.impossible)
        if arguments.number is not None:
            decks = decks[arguments.number : arguments.number + 1]
        for verdict in judge_all(decks, program, arguments.jobs):
            tell(verdict)
            counts.add(verdict)
            if arguments.table:
                rows = [vars(verdict) for verdict in counts.verdicts]
                arguments.table.write_text(json.dumps(rows, indent=1))
    if arguments.number is None:
        bad += tell_single(program)
    print(counts.tables())
    if arguments.shrink:
        shrink_all(counts.verdicts, program, arguments.output)
    bad += sum(not verdict.is_good for verdict in counts.verdicts)
    print(
        f"{len(counts.verdicts)} decks, {bad} fail; {len(RULES)} rules; {time.monotonic() - start:.0f} s"
    )
    return 1 if bad else 0


def failures(program: Path, jobs: int) -> Found:
    """What the short part finds."""
    _, decks = decks_of(SEED, SHORT)
    verdicts = judge_all(decks, program, jobs)
    return {(verdict.name, oracle) for verdict in verdicts for oracle in verdict.failures} | {
        (name, name) for name, said in single(program) if said
    }


def single(program: Path) -> Iterator[tuple[str, list[str]]]:
    """What the comparisons of single models find wrong, by their names."""
    for name, ask in SINGLE.items():
        with tempfile.TemporaryDirectory(prefix="combinations_") as folder:
            try:
                yield name, ask(program, Path(folder))
            except Exception as error:  # noqa: BLE001 - no comparison may end the laboratory
                yield name, [one_line(error) or type(error).__name__]


def print_deck(seed: int, number: int) -> None:
    """Writes a deck of an array to the screen, and what it includes behind it."""
    _, decks = decks_of(seed, number + 1)
    scene = Scene(decks[number][1])
    print(scene.deck(), end="")
    if scene.include:
        print("** mesh.inc:\n" + scene.include, end="")


def tell_single(program: Path) -> int:
    """Prints what the comparisons of single models find wrong, and counts them."""
    bad = 0
    for name, said in single(program):
        for text in said:
            print(f"{name}: {text}", flush=True)
        bad += bool(said)
    return bad


def shrink_all(verdicts: Iterable[Verdict], program: Path, folder: Path) -> None:
    """Shrinks one deck for each oracle and the beginning of its message."""
    seen: set[tuple[str, str]] = set()
    for verdict in verdicts:
        for oracle, said in verdict.failures.items():
            kind = (oracle, "".join(letter for letter in said if not letter.isdigit())[:40])
            if kind not in seen:
                seen.add(kind)
                print(write_shrunk(verdict, oracle, program, folder), flush=True)


if __name__ == "__main__":
    os.environ.setdefault("MPLBACKEND", "Agg")
    sys.setrecursionlimit(10000)
    finish(main)
