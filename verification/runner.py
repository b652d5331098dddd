"""Runs the cases of a verification folder, checks quantities against limits, writes a report.

`cases.toml` of the folder lists the cases (decks with changes) and the limits of its quantities;
`limits.toml` beside this file lists the limits that hold for every case.
"""

import argparse
import importlib.util
import sys
import tomllib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "scripts")]

from stickslip import program  # noqa: E402
from stickslip.deck import Deck  # noqa: E402
from stickslip.result import Result  # noqa: E402


@dataclass(frozen=True)
class Case:
    """A deck with changes."""

    name: str
    deck: str
    """The deck's name within the folder of the decks."""
    scheme: str = "deck"
    """The deck's, or "default": without its STICKSLIP card."""
    impact_time: str = "deck"
    """The deck's, or the value of IMPACT TIME on the only setting of all steps."""
    refine: int = 1
    """Divides the edges of all elements."""
    flight: float = 0.0
    """Time of free flight that the generator leaves out."""
    parameters: dict[str, float | str] = field(default_factory=dict)
    """Other parameters of the generator."""
    divide: float = 1.0
    """Divides the increment."""
    until: float | None = None
    """Duration, if not the deck's."""
    frames: int | None = None
    every: float | None = None
    """Frames of the result: how many, or how far apart in time."""
    quick: bool = False
    """Also run with --quick."""
    group: str = ""
    """What the case is for."""

    @property
    def changes_deck(self) -> bool:
        """Whether the case runs anything but the deck as it stands."""
        plain = Case(self.name, self.deck, frames=self.frames, every=self.every)
        return replace(self, quick=False, group="") != plain

    def changed_deck(self, decks: Path, made: Path) -> Deck:
        """The deck of a folder with the changes; one with parameters is generated in `made`."""
        changes = dict(self.parameters)
        changes |= {"refine": self.refine} if self.refine > 1 else {}
        changes |= {"flight": self.flight} if self.flight > 0.0 else {}
        if changes:
            load(decks / "generate.py").write(made, **changes)
        deck = Deck.read((made if changes else decks) / self.deck)
        if self.scheme == "default":
            deck.set_settings()
        if self.impact_time != "deck":
            deck.set_settings(IMPACT_TIME=self.impact_time)
        if self.divide != 1.0 or self.until is not None:
            dt = deck.dt / self.divide
            period = deck.period if self.until is None else self.until
            deck.set_increments(dt, round(period / dt))
        return deck


@dataclass(frozen=True)
class Limit:
    """What a quantity has to satisfy."""

    quantity: str
    source: str
    """Where the limit comes from."""
    reference: float | None = None
    tolerance: float | None = None
    at_most: float | None = None
    at_least: float | None = None

    def holds(self, value: float) -> bool:
        """Whether a value satisfies the limit; never for a value that is not a number."""
        if self.reference is not None and self.tolerance is not None:
            return abs(value - self.reference) <= self.tolerance
        if self.at_most is not None:
            return value <= self.at_most
        return self.at_least is not None and value >= self.at_least

    def __str__(self) -> str:
        if self.reference is not None:
            return f"{self.reference:.6g} +- {self.tolerance:.3g}"
        if self.at_most is not None:
            return f"<= {self.at_most:.3g}"
        return f">= {self.at_least:.3g}"


@dataclass
class Verification:
    """One verification folder: its cases, their results, the checks done so far."""

    folder: Path
    decks: Path
    """Folder of the decks; its generate.py makes refined ones."""
    output: Path
    title: str
    cases: list[Case]
    limits: dict[str, Limit]
    reuse: bool
    results: dict[str, Result] = field(default_factory=dict)
    failures: int = 0
    checks: list[Sequence[str]] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)

    def run(self) -> None:
        """Runs all cases, two at a time; those without any result are left out."""
        with ThreadPoolExecutor(2) as pool:
            for case, (path, code) in zip(self.cases, pool.map(self._run_case, self.cases)):
                self.check("exit code of the run", case.name, code)
                if path is not None:
                    self.results[case.name] = Result(path)
        self.cases = [case for case in self.cases if case.name in self.results]

    def _run_case(self, case: Case) -> tuple[Path | None, int]:
        """The result file, up to where a run stopped; the exit code."""
        output = self.output / "runs"
        path = output / f"{case.name}.vtkhdf"
        if self.reuse and path.exists():
            with Result(path) as results:
                return path, int(results.run["exit_status"])
        print(f"running {case.name}", flush=True)
        options = ["--threads", "1"]
        if case.frames is not None:
            options += ["--frames", str(case.frames)]
        if case.every is not None:
            options += ["--every", repr(case.every)]
        changed = case.changed_deck(self.decks, self.output / "decks" / case.name)
        deck = changed.write(output / f"{case.name}.inp")
        try:
            return program.run(deck, output, *options).path, 0
        except program.RunFailed as failure:
            print(failure)
            return path if failure.code == program.STOPPED else None, failure.code

    def group(self, name: str) -> Iterator[tuple[Case, Result]]:
        """The cases of a group with their results."""
        for case in self.cases:
            if case.group == name:
                yield case, self.results[case.name]

    def check(self, quantity: str, case: str, value: float) -> None:
        """Compares a value with its limit and prints the verdict."""
        limit = self.limits[quantity]
        holds = limit.holds(value)
        self.failures += not holds
        verdict = "pass" if holds else "FAIL"
        print(f"{verdict}  {case:28} {quantity:42} {value:12.6g}   {limit}")
        self.checks.append((verdict, case, quantity, f"{value:.6g}", str(limit), limit.source))

    def check_run(self, name: str, edge: float, accuracy: str = "") -> None:
        """What every run has to satisfy; `edge` is the length of the smallest element edge.

        `accuracy` is added to the name of the energy balance: for runs with a limit of their own.
        """
        results = self.results[name]
        failed = int((results.history.solver["converged"] == 0).sum())
        self.check("increments not converged", name, failed)
        if results.contact:
            gaps = [np.nan_to_num(contact.min_gap) for contact in results.contact.values()]
            self.check("deepest gap / element size", name, min(float(np.min(gaps)), 0.0) / edge)
            cones = [contact.cone_violation for contact in results.contact.values()]
            self.check("violation of Coulomb's cone", name, float(np.max(cones)))
        balance = np.abs(results.history.energy["balance"]).max() / results.history.energy.largest
        self.check(f"energy balance / largest energy{accuracy}", name, float(balance))

    def table(self, title: str, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Adds a table to the report and prints it."""
        texts = [[f"{x:.5g}" if isinstance(x, float) else str(x) for x in row] for row in rows]
        self.tables.append(f"## {title}\n\n{markdown(header, texts)}")
        widths = [max(map(len, column)) for column in zip(header, *texts)]
        print(f"\n{title}")
        for row in [header, *texts]:
            print("  " + "  ".join(text.rjust(width) for text, width in zip(row, widths)))

    def finish(self) -> int:
        """Writes the report; the exit code."""
        header = ("", "case", "quantity", "computed", "limit", "source")
        verdict = f"{len(self.checks)} checks, {self.failures} failed"
        parts = [f"# {self.title}\n\n{verdict}\n\n{markdown(header, self.checks)}", *self.tables]
        self.output.mkdir(parents=True, exist_ok=True)
        report = self.output / "results.md"
        report.write_text("\n".join(parts))
        print(f"\n{verdict}; wrote {report}")
        return 1 if self.failures else 0


def load(path: Path) -> ModuleType:
    """A Python file as a module."""
    spec = importlib.util.spec_from_file_location(f"{path.parent.name}_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} cannot be loaded")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def markdown(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    escaped = [[text.replace("|", "\\|") for text in line] for line in lines]
    return "".join("| " + " | ".join(line) + " |\n" for line in escaped)


def read(folder: Path) -> dict[str, Any]:
    """What the folder's `cases.toml` says."""
    return tomllib.loads((folder / "cases.toml").read_text())


def cases_of(data: dict[str, Any]) -> list[Case]:
    """The cases, with what their groups have in common."""
    cases = []
    for entry in data["case"]:
        shared = data.get("defaults", {}).get(entry.get("group"), {})
        parameters = shared.get("parameters", {}) | entry.get("parameters", {})
        cases.append(Case(**shared | entry | {"parameters": parameters}))
    return cases


def start(folder: Path) -> Verification:
    """Reads the command line and the folder's cases, runs them."""
    parser = argparse.ArgumentParser(description=f"Verification {folder.name}")
    parser.add_argument("--quick", action="store_true", help="only the short cases")
    parser.add_argument("--reuse", action="store_true", help="keep results that exist")
    arguments = parser.parse_args()
    data = read(folder)
    common = tomllib.loads((HERE / "limits.toml").read_text())
    limits = [Limit(**entry) for entry in common["limit"] + data.get("limit", [])]
    verification = Verification(
        folder,
        ROOT / data["decks"],
        ROOT / "results" / "verification" / ("quick" if arguments.quick else "") / folder.name,
        data["title"],
        [case for case in cases_of(data) if case.quick or not arguments.quick],
        {limit.quantity: limit for limit in limits},
        arguments.reuse,
    )
    verification.run()
    return verification
