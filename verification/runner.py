"""Runs the cases of the verification, checks their quantities, draws them; scripts/verify says which."""

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(HERE), str(ROOT / "python"), str(ROOT / "scripts")]

from form import Curve, Form, Order, Quantity, Run, all_folders, load, markdown, read  # noqa: E402
from stickslip import program  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.result import Result  # noqa: E402
from values import Values  # noqa: E402

__all__ = ["Check", "Form", "Run", "Study", "all_folders", "load", "markdown", "read"]


@dataclass(frozen=True)
class Check:
    """A computed value beside what it has to satisfy."""

    run: str
    quantity: str
    computed: float
    limit: Quantity
    reference: float | None = None
    source: str = ""
    failure: str = ""
    """Why there is no value."""

    @property
    def error(self) -> float | None:
        """Against the reference, in the norm of the quantity."""
        if self.reference is None:
            return None
        scale = abs(self.reference) if self.limit.norm == "relative" else 1.0
        return abs(self.computed - self.reference) / scale

    @property
    def holds(self) -> bool:
        """Whether the value satisfies the limit; never for one that is not a number."""
        if self.failure:
            return False
        if self.error is not None and self.limit.tolerance is not None:
            return bool(self.error <= self.limit.tolerance)
        if self.limit.at_most is not None:
            return bool(self.computed <= self.limit.at_most)
        return self.limit.at_least is not None and bool(self.computed >= self.limit.at_least)

    @property
    def common(self) -> bool:
        """Whether every run of every case has it."""
        return self.quantity in COMMON

    @property
    def part(self) -> float:
        """How much of the tolerance or bound is used: 1 is all of it."""
        if self.failure or not np.isfinite(self.computed):
            return np.inf
        if self.error is not None and self.limit.tolerance:
            return self.error / self.limit.tolerance
        if self.limit.at_most:
            return self.computed / self.limit.at_most
        if self.limit.at_least:
            return 1.0 - (self.computed - self.limit.at_least) / abs(self.limit.at_least)
        return 0.0 if self.holds else np.inf

    def shown(self) -> tuple[str, str, str, str]:
        """Reference, computed, error, tolerance."""
        computed = self.failure or f"{self.computed:.6g}"
        limit = self.limit
        if self.error is not None and limit.tolerance is not None:
            relative = limit.norm == "relative"
            error = f"{100 * self.error:.2g} %" if relative else f"{self.error:.2g}"
            tolerance = f"{100 * limit.tolerance:.2g} %" if relative else f"{limit.tolerance:.2g}"
            return f"{self.reference:.6g}", computed, error, tolerance
        bounds = [("<=", limit.at_most), (">=", limit.at_least), ("within", limit.tolerance)]
        return "", computed, "", next((f"{sign} {bound:.3g}" for sign, bound in bounds if bound is not None), "")


COMMON = (
    "exit code of the run",
    "increments not converged",
    "deepest gap / element size",
    "violation of Coulomb's cone",
    "energy balance / largest energy",
)
"""Quantities of `limits.toml`."""


@dataclass
class Study:
    """One case: its results, the checks done so far."""

    form: Form
    output: Path
    runs: list[Run]
    reuse: bool = False
    draws: bool = True
    """Whether `measure.py` draws its own pictures, which takes longer than many runs."""
    results: dict[str, Result] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)

    def run(self, run: Run) -> tuple[Path | None, int]:
        """Runs a deck: the result file, up to where a run stopped; the exit code."""
        output = self.output / "runs"
        path = output / f"{run.name}.vtkhdf"
        if self.reuse and path.exists():
            with Result(path) as results:
                return path, int(results.run["exit_status"])
        options = ["--threads", "1"]
        if run.frames is not None:
            options += ["--frames", str(run.frames)]
        if run.every is not None:
            options += ["--every", repr(run.every)]
        try:
            changed = run.changed_deck(self.form.decks, self.output / "decks" / run.name)
            deck = changed.write(output / f"{run.name}.inp")
            return program.run(deck, output, *options).path, 0
        except program.RunFailed as failure:
            print(f"{self.form.name}/{run.name}: {failure}")
            return path if failure.code == program.STOPPED else None, failure.code

    def take(self, run: Run, path: Path | None, code: int) -> None:
        """Takes the result of a run."""
        self.check("exit code of the run", run.name, code)
        if path is not None:
            self.results[run.name] = Result(path)

    def evaluate(self) -> None:
        """Checks all quantities of the runs that are there: those of `case.toml`, then those of `measure.py`."""
        self.runs = [run for run in self.runs if run.name in self.results]
        measures = self.form.folder / "measure.py"
        if measures.exists():
            try:
                load(measures).measure(self)
            except Exception as error:  # noqa: BLE001  (one case must not end the others)
                text = f"{type(error).__name__}: {error}"
                self.checks.append(Check("", "measure.py", np.nan, Quantity("measure.py", "it ends"), failure=text))
        else:
            for run in self.runs:
                self.check_run(run.name, self.results[run.name].edge_length)
        for quantity in self.form.quantities.values():
            for run in quantity.runs:
                self._evaluate(quantity, run)
        for curve in self.form.curves:
            limit = Quantity(curve.name, curve.why, at_most=curve.tolerance)
            for run in filter(self.results.__contains__, curve.runs):
                self._try(limit, run, lambda: curve_error(self, curve, run))
        for order in self.form.orders:
            if all(run in self.results for run in order.runs):
                limit = Quantity(order.name, order.why, at_least=order.at_least)
                last = order.runs[-1]
                self._try(limit, last, lambda: observed_order(*errors(self, order)))

    def _evaluate(self, quantity: Quantity, run: str) -> None:
        if run in self.results:
            self._try(quantity, run, lambda: float(self.values(run)(quantity.value)))

    def _try(self, limit: Quantity, run: str, value: Callable[[], float]) -> None:
        """Adds a check; an expression that cannot be evaluated is one that fails."""
        try:
            self._add(limit, run, value())
        except Exception as error:  # noqa: BLE001  (expressions are data)
            text = f"{type(error).__name__}: {error}"
            self.checks.append(Check(run, limit.name, np.nan, limit, failure=text))

    def values(self, run: str) -> Values:
        """What evaluates expressions over a run."""
        found = next(one for one in self.form.runs if one.name == run)
        return Values(self.form, found, self.results.get(run))

    def group(self, name: str) -> Iterator[tuple[Run, Result]]:
        """The runs of a group with their results."""
        for run in self.runs:
            if run.group == name:
                yield run, self.results[run.name]

    def check(self, quantity: str, run: str, value: float) -> None:
        """Compares a value with its limit."""
        self._add(self.form.quantities[quantity], run, float(value))

    def _add(self, limit: Quantity, run: str, value: float) -> None:
        reference, source = None, ""
        if limit.reference:
            row = self.form.references[self.values(run).named(limit.reference)]
            reference, source = float(row.value[0]), f"[{row.tag}] {row.source}"
        self.checks.append(Check(run, limit.name, value, limit, reference, source))

    def check_run(self, name: str, edge: float, accuracy: str = "", place: str = "") -> None:
        """What every run has to satisfy; `edge` is the length of the smallest element edge.

        `accuracy` is added to the name of the energy balance, `place` to that of the deepest gap: for runs with limits of
        their own.
        """
        results = self.results[name]
        failed = int((results.history.solver["converged"] == 0).sum())
        self.check("increments not converged", name, failed)
        if results.contact:
            gaps = [np.nan_to_num(contact.min_gap) for contact in results.contact.values()]
            self.check(f"deepest gap / element size{place}", name, min(float(np.min(gaps)), 0.0) / edge)
            cones = [contact.cone_violation for contact in results.contact.values()]
            self.check("violation of Coulomb's cone", name, float(np.max(cones)))
        energy = results.history.energy
        largest = energy.largest
        balance = np.abs(energy["balance"]).max() / largest if largest > 0.0 else 0.0
        self.check(f"energy balance / largest energy{accuracy}", name, float(balance))

    def table(self, title: str, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Adds a table to the case's page of results."""
        texts = [[f"{x:.5g}" if isinstance(x, float) else str(x) for x in row] for row in rows]
        self.tables.append(f"## {title}\n\n{markdown(header, texts)}")

    @property
    def failures(self) -> list[Check]:
        """The checks that do not hold."""
        return [check for check in self.checks if not check.holds]

    def increments(self, run: str) -> str:
        """How many increments a run has."""
        return str(len(self.results[run].history.dt) - 1) if run in self.results else ""

    def seconds(self, run: str) -> str:
        """How long a run took."""
        return f"{float(self.results[run].run['seconds_total']):.1f}" if run in self.results else ""

    def finish(self) -> None:
        """Writes the page of the case: every check, and the tables."""
        header = ("", "run", "quantity", "reference", "computed", "error", "tolerance", "why")
        rows = [
            ("pass" if check.holds else "FAIL", check.run, check.quantity, *check.shown(), check.limit.why)
            for check in self.checks
        ]
        verdict = f"{len(self.checks)} checks, {len(self.failures)} failed"
        parts = [f"# {self.form.title}\n\n{verdict}\n\n{markdown(header, rows)}", *self.tables]
        self.output.mkdir(parents=True, exist_ok=True)
        (self.output / "results.md").write_text("\n".join(parts))


def curve_points(study: Study, curve: Curve, run: str) -> tuple[Array, Array]:
    """Abscissae, in order, and ordinates of a computed curve."""
    values = study.values(run)
    x, y = (np.asarray(values(text), dtype=float) for text in (curve.x, curve.y))
    order = np.argsort(x, kind="stable")
    return x[order], y[order]


def curve_error(study: Study, curve: Curve, run: str) -> float:
    """Error of a curve over the points of the reference, as a part of the largest reference."""
    reference = study.form.references[study.values(run).named(curve.reference)]
    x, y = curve_points(study, curve, run)
    off = np.interp(reference.x, x, y) - reference.value
    size = np.abs(off).max() if curve.norm == "largest" else np.sqrt((off**2).mean())
    return float(size / np.abs(reference.value).max())


def errors(study: Study, order: Order) -> tuple[Array, Array]:
    """Sizes and errors of the runs of an order."""
    pairs = []
    for run in order.runs:
        values = study.values(run)
        pairs.append((float(values(order.size)), float(values(order.error))))
    sizes, off = np.array(pairs).T
    return sizes, np.abs(off)


def observed_order(sizes: Array, off: Array) -> float:
    """Slope of the errors over the sizes, both in logarithms, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(off), 1)[0])
