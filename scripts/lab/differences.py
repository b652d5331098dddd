"""Differences between the results of two runs of one deck: datasets, attributes, status lines.

A run that was stopped is compared with the other up to the increments and frames that both have
finished (a `Span`). What identifies a run or tells of its times, all in /run, is left out but for
the totals.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

TOTALS = ("increments", "cutbacks", "events", "exit_status")
"""Attributes of /run that the computation decides."""

REWORDED = ("description", "rows")
"""Attributes for readers: what a dataset is, and how many rows it has."""

REMAINDERS = ("balance", "residual", "cone_violation", "impulse_cone_violation")
"""Datasets of terms that cancel: round-off, without a scale of their own."""

EVENT_TIMES = {"impacts": "time", "returns": "time", "touches": "end"}
"""Groups of the history with one row per event, and the dataset of its time."""

WORK = (
    "active_set_iterations",
    "factorizations",
    "gauss_seidel_sweeps",
    "lcp_size",
    "lcps",
    "lemke_calls",
    "passes",
    "pivots",
)
"""Counts of the solver's work: how answers were found, not what they are."""

NEGLIGIBLE = 1e-9
"""A dataset that is smaller than this part of the largest of its dimension is round-off as well."""

HEAD_LINES = 2
"""Lines before the first increment in the status file."""


@dataclass(frozen=True)
class Span:
    """The beginning of two histories: rows (row 0 is the start) and the frames up to there."""

    rows: int
    frames: tuple[int, int]
    """In the old and in the new file."""


@dataclass(frozen=True)
class Difference:
    """A dataset, an attribute or a line that is not the same."""

    name: str
    text: str
    first: tuple[int, ...] = ()
    """Index of the first value that differs."""
    worst: tuple[int, ...] = ()
    """Index of the largest difference."""
    relative: float = np.inf
    """Largest difference over the scale of the dataset; infinite where that has no meaning."""

    def __str__(self) -> str:
        if not np.isfinite(self.relative):
            return f"{self.name}{self.text}"
        size = f"largest {self.relative:.2e} of its scale, at {[*self.worst]}"
        return f"{self.name}{self.text}; {size}"


@dataclass
class Comparison:
    """Comparison of two result files: common span and differences."""

    datasets: int = 0
    differences: list[Difference] = field(default_factory=list)
    only_old: list[str] = field(default_factory=list)
    only_new: list[str] = field(default_factory=list)
    largest: tuple[float, str] = (0.0, "")
    """Largest relative difference and its dataset, also within a tolerance."""


class Files:
    """Two open result files, compared bit for bit or within a tolerance."""

    def __init__(
        self, old: h5py.File, new: h5py.File, span: Span | None, tolerance: float | None
    ) -> None:
        self.files = (old, new)
        self.span = span
        self.tolerance = tolerance

    @cached_property
    def scales(self) -> dict[str, float]:
        """Largest values by dimension, in the old file."""
        return _scales(self.files[0])

    def compare(self) -> Comparison:
        """Compares everything that both have; lists the rest."""
        found = Comparison()
        old, new = (_members(file) for file in self.files)
        found.only_old = [name for name in old if name not in new]
        found.only_new = [name for name in new if name not in old]
        for name in old:
            if name in new and not self._tells_of_work(name):
                self._compare_member(name, found)
        self._compare_totals(found)
        return found

    def _tells_of_work(self, name: str) -> bool:
        """Whether a dataset only counts work; what that is, a tolerance leaves open."""
        group, _, own = name.rpartition("/")
        return self.tolerance is not None and group == "history/solver" and own in WORK

    def _compare_member(self, name: str, found: Comparison) -> None:
        """Compares the attributes of a group or dataset, and the values of a dataset."""
        old, new = (file[name] for file in self.files)
        found.differences += self._attribute_differences(name, old, new)
        if isinstance(old, h5py.Dataset) and isinstance(new, h5py.Dataset):
            found.datasets += 1
            difference = self._value_difference(name)
            if difference is None:
                return
            if difference.relative > found.largest[0]:
                found.largest = difference.relative, name
            if self.tolerance is None or not difference.relative <= self.tolerance:
                found.differences.append(difference)

    def _attribute_differences(self, name: str, old: Any, new: Any) -> Iterator[Difference]:
        """Attributes that differ or are in one file only."""
        skipped = REWORDED if self.span is None else (*REWORDED, "NSteps")
        for key in sorted({*old.attrs, *new.attrs} - {*skipped}):
            a, b = (_text(item.attrs.get(key)) for item in (old, new))
            if a != b:
                yield Difference(name, f", attribute {key}: {a} / {b}")

    def _compare_totals(self, found: Comparison) -> None:
        """Compares the totals of whole runs."""
        if self.span is not None:
            return
        old, new = (file["run"].attrs for file in self.files)
        for key in TOTALS:
            if old.get(key) != new.get(key):
                text = f": {_text(old.get(key))} / {_text(new.get(key))}"
                found.differences.append(Difference(f"run, {key}", text))

    def _value_difference(self, name: str) -> Difference | None:
        """How the values of a dataset differ, if they do."""
        a, b = (self._beginning(which, name) for which in (0, 1))
        if a.dtype != b.dtype:
            return Difference(name, f": type {a.dtype} / {b.dtype}")
        if a.shape != b.shape:
            return Difference(name, f": shape {a.shape} / {b.shape}")
        if a.tobytes() == b.tobytes():
            return None
        first, deviations = _first_difference(a, b), _deviations(a, b)
        worst = _index(deviations.argmax(), a.shape)
        text = f"{[*first]}: {_text(a[first])} / {_text(b[first])}"
        relative = float(deviations[worst]) / self._scale(name, a)
        return Difference(name, text, first, worst, relative)

    def _beginning(self, which: int, name: str) -> NDArray[Any]:
        """The values of a dataset within the span."""
        data = self.files[which][name]
        return data[()] if self.span is None else data[: self._length(which, name)]

    def _length(self, which: int, name: str) -> int:
        """Number of rows of a dataset within the span."""
        assert self.span is not None
        file, frames = self.files[which], self.span.frames[which]
        group = name.split("/")
        if group[0] == "history" and group[1] in EVENT_TIMES:
            end = file["history/time"][self.span.rows - 1]
            times = file["history"][group[1]][EVENT_TIMES[group[1]]]
            return int((times[()] <= end).sum())
        if group[0] == "history" and self._has_a_row_per_increment(name):
            return self.span.rows
        if group[:2] == ["VTKHDF", "Steps"]:
            return frames
        if group[1] in ("PointData", "CellData"):
            return _field_length(file, group[1], group[2], frames)
        return len(file[name])

    def _has_a_row_per_increment(self, name: str) -> bool:
        return all(len(file[name]) == len(file["history/time"]) for file in self.files)

    def _scale(self, name: str, values: NDArray[Any]) -> float:
        """Largest value of a dataset; of its dimension, if it is round-off; never 0."""
        dimension = str(self.files[0][name].attrs.get("dimension", "1"))
        common = self.scales.get(dimension, 0.0)
        own = _largest(values)
        if name.rpartition("/")[2] in REMAINDERS or own < NEGLIGIBLE * common:
            own = common
        return own or float(np.finfo(float).tiny)


def status_difference(old: Path, new: Path, span: Span | None) -> Difference | None:
    """The first line of the status files that differs."""
    end = None if span is None else HEAD_LINES + span.rows - 1
    a, b = (path.read_text().splitlines()[:end] for path in (old, new))
    for number, (first, second) in enumerate(zip(a, b), start=1):
        if first != second:
            return Difference(old.name, f", line {number}: {first.strip()} / {second.strip()}")
    if len(a) != len(b):
        return Difference(old.name, f": {len(a)} / {len(b)} lines")
    return None


def frames_until(file: h5py.File, rows: int) -> int:
    """Number of frames up to a row of the history."""
    end = float(file["history/time"][rows - 1])
    return int((file["VTKHDF/Steps/Values"][()] <= end * (1.0 + 1e-9)).sum())


def _members(file: h5py.File) -> list[str]:
    """Groups and datasets outside /run."""
    names: list[str] = []
    file.visit(names.append)
    return [name for name in names if name.split("/")[0] != "run"]


def _field_length(file: h5py.File, kind: str, name: str, frames: int) -> int:
    """Rows of a field in the first frames; fields without offsets are there once."""
    offsets = f"VTKHDF/Steps/{kind}Offsets/{name}"
    if offsets not in file:
        return len(file[f"VTKHDF/{kind}/{name}"])
    count = {"PointData": "NumberOfPoints", "CellData": "NumberOfCells"}[kind]
    return int(file[offsets][frames - 1] + file[f"VTKHDF/{count}"][0])


def _scales(file: h5py.File) -> dict[str, float]:
    """Largest value of all float datasets of a dimension; 1 for pure numbers."""
    scales: dict[str, float] = {}

    def visit(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
            dimension = str(item.attrs.get("dimension", "1"))
            scales[dimension] = max(scales.get(dimension, 0.0), _largest(item[()]))

    file.visititems(visit)
    scales["1"] = 1.0
    # momenta of bodies may cancel, and bodies may not turn: the scale is that of a body that moves
    mass, length, velocity = (scales.get(name, 0.0) for name in ("mass", "length", "length/time"))
    for dimension, of_body in {
        "1/time": velocity / length if length > 0.0 else 0.0,
        "mass*length/time": mass * velocity,
        "mass*length^2/time": mass * velocity * length,
    }.items():
        scales[dimension] = max(scales.get(dimension, 0.0), of_body)
    return scales


def _largest(values: NDArray[Any]) -> float:
    """Largest finite absolute value."""
    if values.dtype.kind not in "fiu":
        return 0.0
    numbers = np.abs(values.astype(float))
    return float(numbers[np.isfinite(numbers)].max(initial=0.0))


def _first_difference(a: NDArray[Any], b: NDArray[Any]) -> tuple[int, ...]:
    """Index of the first entry whose bits differ."""
    size = a.dtype.itemsize
    bits = [np.ascontiguousarray(x).view(np.uint8).reshape(*x.shape, size) for x in (a, b)]
    differs = (bits[0] != bits[1]).any(axis=-1)
    return _index(differs.argmax(), a.shape)


def _index(place: np.intp, shape: tuple[int, ...]) -> tuple[int, ...]:
    """Index of an entry in an array from its place in the flat one."""
    return tuple(map(int, np.unravel_index(place, shape)))


def _deviations(a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.float64]:
    """Differences of all values; infinite where one is a number and the other is none."""
    if a.dtype.kind not in "fiu":
        return np.where(a == b, 0.0, np.inf)
    first, second = a.astype(float), b.astype(float)
    same = (first == second) | (np.isnan(first) & np.isnan(second))
    with np.errstate(invalid="ignore"):
        deviations = np.abs(first - second)
    deviations[np.isnan(deviations)] = np.inf
    deviations[same] = 0.0
    return deviations


def _text(value: Any) -> str:
    """A value with all its digits."""
    return repr(value.tolist()) if isinstance(value, (np.ndarray, np.generic)) else repr(value)
