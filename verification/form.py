"""What a case of the verification consists of: `case.toml` and `reference.csv` of its folder, read and checked."""

import csv
import fnmatch
import importlib.util
import itertools
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from stickslip.arrays import Array
from stickslip.deck import Deck
from stickslip.errors import Fault

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

TAGS = {
    "F": "published, in the source that is named",
    "D": "closed form, derived from the theory that is named",
    "C": "computed independently of this program, not published",
    "K": "from the literature, not read in the original",
}
"""Provenance of a reference."""


@dataclass(frozen=True)
class Run:
    """A deck with changes."""

    name: str
    deck: str
    """The deck's name within the folder of the decks."""
    scheme: str = "deck"
    """The deck's, or "default": without its STICKSLIP card."""
    settings: dict[str, str] = field(default_factory=dict)
    """The only settings of all steps (STICKSLIP), in place of the deck's."""
    formulation: str = "deck"
    """The deck's, or the discretisation of all contacts, as TYPE of CONTACT PAIR."""
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
    """What the run is for."""

    @property
    def changes_deck(self) -> bool:
        """Whether the run takes anything but the deck as it stands."""
        plain = Run(self.name, self.deck, frames=self.frames, every=self.every)
        return replace(self, quick=False, group="") != plain

    def changed_deck(self, decks: Path, made: Path) -> Deck:
        """The deck of a folder with the changes; one with parameters, or without a file, is generated in `made`."""
        changes = dict(self.parameters)
        changes |= {"refine": self.refine} if self.refine > 1 else {}
        changes |= {"flight": self.flight} if self.flight > 0.0 else {}
        generated = bool(changes) or not (decks / self.deck).exists()
        if generated:
            load(decks / "generate.py").write(made, **changes)
        deck = Deck.read((made if generated else decks) / self.deck)
        if self.scheme == "default":
            deck.set_settings()
        if self.settings:
            deck.set_settings(**self.settings)
        if self.formulation != "deck":
            deck.set_formulation(self.formulation)
        if self.divide != 1.0 or self.until is not None:
            dt = deck.dt / self.divide
            period = deck.period if self.until is None else self.until
            deck.set_increments(dt, round(period / dt))
        return deck


@dataclass(frozen=True)
class Quantity:
    """A number of runs and what it has to satisfy."""

    name: str
    why: str
    """Why this tolerance or bound."""
    runs: tuple[str, ...] = ()
    """The runs it is taken of; none where the case's `measure.py` computes it."""
    value: str = ""
    """Expression over the result of a run (see README.md)."""
    reference: str = ""
    """Its row in `reference.csv`; `{run}` and parameters of the run stand for their values."""
    tolerance: float | None = None
    norm: str = "relative"
    """Of the error: `relative` to the reference, or `absolute`."""
    at_most: float | None = None
    at_least: float | None = None


@dataclass(frozen=True)
class Curve:
    """A curve of runs beside a curve of `reference.csv`."""

    name: str
    why: str
    runs: tuple[str, ...]
    x: str
    y: str
    """Expressions over the result of a run, equally long."""
    reference: str
    tolerance: float
    norm: str = "largest"
    """Of the error over the largest reference: `largest`, or `rms`, over the points of the reference."""
    label: str = ""
    """Of the abscissa."""


@dataclass(frozen=True)
class Order:
    """Observed order of convergence of an error in a size."""

    name: str
    why: str
    runs: tuple[str, ...]
    size: str
    """Expression over the parameters of a run."""
    error: str
    """Expression over the result of a run; `reference(NAME)` is a row of `reference.csv`."""
    at_least: float


@dataclass(frozen=True)
class Reference:
    """A reference: a number, or a curve with its abscissae."""

    value: Array
    x: Array | None
    tag: str
    source: str
    formulas: tuple[str, ...]
    """The closed forms in Python of the rows that have one."""


@dataclass(frozen=True)
class Form:
    """All that `case.toml` and `reference.csv` say."""

    folder: Path
    title: str
    decks: Path
    """Folder of the decks; its `generate.py` makes those with parameters."""
    runs: list[Run]
    quantities: dict[str, Quantity]
    curves: list[Curve]
    orders: list[Order]
    constants: Mapping[str, float | str]
    references: Mapping[str, Reference]

    @property
    def name(self) -> str:
        """That of the folder."""
        return self.folder.name


def read(folder: Path) -> Form:
    """The case of a folder; a Fault says what is wrong with it."""
    data = tomllib.loads((folder / "case.toml").read_text())
    common = tomllib.loads((HERE / "limits.toml").read_text())
    try:
        runs = _runs(data)
        names = [run.name for run in runs]

        def with_runs(entry: dict[str, Any]) -> dict[str, Any]:
            return entry | {"runs": _named(entry, names)}

        quantities = [Quantity(**with_runs(entry)) for entry in data.get("quantity", [])]
        form = Form(
            folder,
            data["title"],
            ROOT / data.get("decks", f"verification/{folder.name}"),
            runs,
            {one.name: one for one in [*(Quantity(**entry) for entry in common["quantity"]), *quantities]},
            [Curve(**with_runs(entry)) for entry in data.get("curve", [])],
            [Order(**with_runs(entry)) for entry in data.get("order", [])],
            data.get("constants", {}),
            references(folder / "reference.csv"),
        )
    except (TypeError, KeyError) as error:
        raise Fault(f"{folder / 'case.toml'}: {error}") from None
    for one in [*quantities, *form.curves, *form.orders]:
        unknown = [run for run in one.runs if run not in names]
        if unknown:
            raise Fault(f"{folder / 'case.toml'}: {one.name} asks for the run {unknown[0]}, which is none")
    return form


def _named(entry: dict[str, Any], names: list[str]) -> tuple[str, ...]:
    """The run or the runs of an entry, which it takes; a name with * stands for all that are like it."""
    one = entry.pop("run", None)
    wanted = (one,) if one else tuple(entry.pop("runs", ()))
    return tuple(name for want in wanted for name in (fnmatch.filter(names, want) if "*" in want else (want,)))


def _runs(data: dict[str, Any]) -> list[Run]:
    """The runs, with what their groups have in common."""
    runs: dict[str, Run] = {}
    for entry in data["run"]:
        shared = data.get("defaults", {}).get(entry.get("group"), {})
        entry = shared | entry | {"parameters": shared.get("parameters", {}) | entry.get("parameters", {})}
        each = entry.pop("each", {})
        for values in itertools.product(*each.values()):
            own = dict(zip(each, values, strict=True))
            run = Run(**entry | {"name": entry["name"].format(**own), "parameters": entry["parameters"] | own})
            runs.setdefault(run.name, run)
    return list(runs.values())


def references(path: Path) -> dict[str, Reference]:
    """The references of a file by their names: rows of one name are the points of a curve."""
    rows: dict[str, list[dict[str, str]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["name"], []).append(row)
    found = {}
    for name, those in rows.items():
        tag, source = those[0]["tag"], those[0]["source"]
        if tag not in TAGS or not source:
            raise Fault(f"{path}: {name} needs a source and one of the tags {', '.join(TAGS)}")
        places = [row["x"] for row in those if row["x"]]
        if len(places) not in (0, len(those)) or (not places and len(those) > 1):
            raise Fault(f"{path}: {name} has rows with and without x, or several without")
        x = np.array(places, dtype=float) if places else None
        try:
            value = np.array([row["value"] for row in those], dtype=float)
        except ValueError as error:
            raise Fault(f"{path}: {name}: {error}") from None
        found[name] = Reference(value, x, tag, source, tuple(row.get("formula") or "" for row in those))
    return found


def all_folders() -> list[Path]:
    """The folders of all cases."""
    return sorted(path.parent for path in HERE.glob("*/case.toml"))


def load(path: Path) -> ModuleType:
    """A Python file as a module, a new one every time."""
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
