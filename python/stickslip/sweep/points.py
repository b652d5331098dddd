"""Points of a parameter study: values of the deck's parameters by name."""

import csv
import itertools
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stickslip.errors import Fault

Value = float | str
Point = dict[str, Value]

VARIED = re.compile(r"(?P<name>[A-Za-z]\w*)=(?P<values>.+)")


def product(values: Mapping[str, Sequence[Value]]) -> list[Point]:
    """All combinations; the last parameter changes first."""
    return [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())]


def latin_hypercube(
    ranges: Mapping[str, tuple[float, float]], count: int, seed: int = 0
) -> list[Point]:
    """So many points of which each parameter has one in each of `count` equal parts of its range.

    M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979) 239-245.
    """
    generator = np.random.default_rng(seed)
    columns = {
        name: low + (high - low) * (generator.permutation(count) + generator.random(count)) / count
        for name, (low, high) in ranges.items()
    }
    return [{name: float(column[i]) for name, column in columns.items()} for i in range(count)]


def read_points(path: Path | str) -> list[Point]:
    """Points of a CSV file: its first line names the parameters, every other one is a point."""
    with Path(path).open(newline="", encoding="utf-8-sig") as file:
        rows = csv.DictReader(file, skipinitialspace=True)
        points = []
        for row in rows:
            if None in row or None in row.values():
                raise Fault(f"{path}:{rows.line_num}: as many values are needed as names")
            points.append({name.strip(): _value(text) for name, text in row.items()})
    if not points:
        raise Fault(f"{path} has no points: a line of names and lines of values are needed")
    return points


def varied(text: str) -> tuple[str, list[Value]]:
    """`mu=0:0.5:11` (from, to, how many), `mu=0,0.2,0.4` or `file=a.inc,b.inc`."""
    name, values = _split(text)
    parts = values.split(":")
    if len(parts) == 1:
        return name, [_value(part) for part in values.split(",")]
    try:
        low, high, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (IndexError, ValueError):
        count = 0
    if count < 1 or len(parts) != 3:
        raise Fault(f"{text}: FROM:TO:COUNT or values between commas are needed, as mu=0:0.5:11")
    return name, [float(value) for value in np.linspace(low, high, count)]


def ranged(text: str) -> tuple[str, tuple[float, float]]:
    """`mu=0:0.5`, a range of a Latin hypercube."""
    name, values = _split(text)
    try:
        low, high = map(float, values.split(":"))
    except ValueError:
        raise Fault(f"{text}: a Latin hypercube needs FROM:TO, as mu=0:0.5") from None
    return name, (low, high)


def _split(text: str) -> tuple[str, str]:
    found = VARIED.fullmatch(text)
    if found is None:
        raise Fault(f"{text}: NAME=VALUES is needed, as mu=0:0.5:11")
    return found["name"], found["values"]


def _value(text: str) -> Value:
    """A number, or any other text."""
    try:
        return float(text)
    except ValueError:
        return text.strip()
