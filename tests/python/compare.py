"""Compares result files."""

from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
from rescale import BASE, Dimension, Units, dimension

SAME = Units()


def datasets(file: h5py.File) -> Iterator[tuple[str, h5py.Dataset]]:
    """All datasets outside /run, with their paths."""
    found: list[tuple[str, h5py.Dataset]] = []

    def visit(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and not name.startswith("run"):
            found.append((name, item))

    file.visititems(visit)
    yield from found


def attributes(item: h5py.HLObject) -> dict[str, bytes]:
    """Attributes as bytes."""
    return {name: np.asarray(value).tobytes() for name, value in item.attrs.items()}


def differences(first: Path, second: Path) -> list[str]:
    """Everything outside /run in which two files differ, bit for bit."""
    found: list[str] = []
    with h5py.File(first, locking=False) as a, h5py.File(second, locking=False) as b:
        names: list[set[str]] = []
        for file in (a, b):
            members: list[str] = []
            file.visit(members.append)
            names.append({name for name in members if not name.startswith("run")})
        found += [f"only in one file: {name}" for name in sorted(names[0] ^ names[1])]
        for name in sorted(names[0] & names[1]):
            if attributes(a[name]) != attributes(b[name]):
                found.append(f"attributes of {name}")
            if isinstance(a[name], h5py.Dataset):
                if a[name].dtype != b[name].dtype or a[name][()].tobytes() != b[name][()].tobytes():
                    found.append(name)
    return found


def scaled_differences(first: Path, second: Path, units: Units) -> list[str]:
    """Datasets of `second` that are not `first` in the other units, bit for bit."""
    found: list[str] = []
    with h5py.File(first, locking=False) as a, h5py.File(second, locking=False) as b:
        for name, data in datasets(a):
            expected = data[()]
            if data.dtype.kind == "f":
                expected = expected * units.factor(dimension(data.attrs["dimension"]))
            if not np.array_equal(expected, b[name][()], equal_nan=data.dtype.kind == "f"):
                found.append(name)
    return found


def largest_deviations(first: Path, second: Path, units: Units = SAME) -> dict[str, float]:
    """Largest difference of each history from `first` in the other units.

    It is relative to the largest value among all histories of the same dimension, so that a force
    or an energy that vanishes but for round-off does not count; that of a turn is at least the largest
    velocity over the largest length, as bodies may not turn at all. Pure numbers (residuals, cone
    violation) and the lists of events are left out.
    """
    errors: dict[str, tuple[Dimension, float]] = {}
    scales: dict[Dimension, float] = {}
    with h5py.File(first, locking=False) as a, h5py.File(second, locking=False) as b:
        for name, data in datasets(a["history"]):
            unit = dimension(data.attrs["dimension"])
            if unit == BASE["1"] or name.startswith(("impacts", "returns", "touches")):
                continue
            expected = data[()] * units.factor(unit)
            actual = b["history"][name][()]
            same = expected.shape == actual.shape
            error = np.nanmax(np.abs(actual - expected), initial=0.0) if same else np.inf
            errors[name] = unit, float(error)
            largest = float(np.nanmax(np.abs(expected), initial=0.0))
            scales[unit] = max(scales.get(unit, 0.0), largest)
    speed, length = scales[dimension("length/time")], scales[dimension("length")]
    rate = dimension("1/time")
    scales[rate] = max(scales.get(rate, 0.0), speed / length)
    return {name: error / (scales[unit] or 1.0) for name, (unit, error) in errors.items()}
