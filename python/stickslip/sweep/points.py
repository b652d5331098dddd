"""Points of a parameter study: values of the deck's parameters by name."""

import csv
import hashlib
import itertools
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stickslip.deck import Value
from stickslip.errors import Fault

Point = dict[str, Value]

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eEdD][-+]?\d+)?")
DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eEdD][-+]?\d+)?")

LONGEST = 100
"""Characters that the name of a point may have; a longer one is cut."""

VARIED = re.compile(r"(?P<name>[A-Za-z]\w*)=(?P<values>.+)")


def product(values: Mapping[str, Sequence[Value]]) -> list[Point]:
    """All combinations of the values of the parameters; the last parameter changes fastest."""
    return [dict(zip(values, chosen)) for chosen in itertools.product(*values.values())]


def latin_hypercube(
    ranges: Mapping[str, tuple[float, float]], count: int, seed: int = 0
) -> list[Point]:
    """A Latin hypercube of `count` points: for each parameter, each of `count` equal parts of its range contains one
    point.

    M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979) 239-245.
    """
    generator = np.random.default_rng(seed)
    columns = {}
    for name, (low, high) in ranges.items():
        parts = (generator.permutation(count) + generator.random(count)) / count
        # digits beyond a hundred-millionth of the range would only lengthen names and tables
        digits = 8 - math.floor(math.log10(abs(high - low) or 1.0))
        columns[name] = np.round(low + (high - low) * parts, digits)
    return [{name: float(column[i]) for name, column in columns.items()} for i in range(count)]


def read_points(path: Path | str) -> list[Point]:
    """Points of a CSV file: its first line names the parameters, every other line is a point."""
    with Path(path).open(newline="", encoding="utf-8-sig") as file:
        lines = csv.reader(file, skipinitialspace=True)
        rows = [(lines.line_num, [text.strip() for text in row]) for row in lines if row]
    if len(rows) < 2:
        raise Fault(f"{path} has no points: a line of names and lines of values are needed")
    (line, names), *rows = rows
    if twice := {name for name in names if names.count(name) > 1}:
        raise Fault(f"{path}:{line}: {', '.join(sorted(twice))} is named twice")
    for line, row in rows:
        if len(row) != len(names):
            raise Fault(f"{path}:{line}: as many values are needed as names")
        for name, text in zip(names, row):
            if fault := _fault(text):
                raise Fault(f"{path}:{line}: {name}: {fault}")
    columns = [_values([row[at] for _, row in rows]) for at in range(len(names))]
    return [dict(zip(names, values)) for values in zip(*columns)]


def check_points(points: Sequence[Point]) -> None:
    """Raises a Fault unless all points have the same parameters, with values that a deck accepts."""
    for values in points:
        if values.keys() != points[0].keys():
            names = ", ".join(values), ", ".join(points[0])
            raise Fault(f"a point has values of {names[0]}, the first one of {names[1]}")
        for name, value in values.items():
            if fault := _fault(str(value)):
                raise Fault(f"{name}: {fault}")


def point_name(values: Point) -> str:
    """The name of a point: its values, as far as they can be part of the name of a folder."""
    text = "_".join(f"{name}={short(value)}" for name, value in values.items())
    name = re.sub(r"[^\w.+=-]", "-", text)
    if name == text and len(name) <= LONGEST:
        return name
    return f"{name[:LONGEST]}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"


def short(value: Value) -> str:
    """A value with as few digits as distinguish the value from all other values."""
    if not isinstance(value, float):
        return str(value)
    text = f"{value:.12g}"
    return text if float(text) == value else repr(value)


def varied(text: str) -> tuple[str, list[Value]]:
    """Reads `mu=0:0.5:11` (from, to, number of values), `mu=0,0.2,0.4` or `file=a.inc,b.inc`."""
    name, values = _split(text)
    parts = values.split(":")
    if len(parts) == 1:
        return name, _values([part.strip() for part in values.split(",")])
    try:
        low, high, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (IndexError, ValueError):
        count = 0
    if count < 1 or len(parts) != 3:
        raise Fault(f"{text}: FROM:TO:COUNT or values between commas are needed, as mu=0:0.5:11")
    between = [float(f"{value:.12g}") for value in np.linspace(low, high, count)[1:-1]]
    return name, [low, *between, high][:count]


def ranged(text: str) -> tuple[str, tuple[float, float]]:
    """Reads `mu=0:0.5`, the range of a parameter in a Latin hypercube."""
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


def _values(texts: Sequence[str]) -> list[Value]:
    """The values as numbers, or all values as texts if one value is not a number."""
    if all(map(NUMBER.fullmatch, texts)):
        return [float(re.sub("[dD]", "e", text)) for text in texts]
    return list(texts)


def _fault(text: str) -> str:
    """The fault of the text of a value; empty if a deck accepts the value."""
    if not text.strip():
        return "a value is missing"
    if DECIMAL_COMMA.fullmatch(text.strip()):
        return f"{text} has a comma: the decimal sign is a point"
    if text.strip().lower().lstrip("+-") in ("nan", "inf", "infinity"):
        return f"{text} is no number for a deck"
    return ""
