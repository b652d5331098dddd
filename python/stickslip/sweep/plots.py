"""Pictures of a study: histories of all points on top of each other, and numbers against parameters."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from stickslip.errors import Fault
from stickslip.result import Result
from stickslip.sweep.quantities import Quantity
from stickslip.sweep.table import Table
from stickslip.whole import whole

MOST = 12
"""Instead of a legend with more entries there is a scale of colours."""

SHADES = ListedColormap(matplotlib.colormaps["viridis"](np.linspace(0.0, 0.88, 256)))
"""From dark to light, but for what is too light to be seen on white."""


def draw_all(table: Table, folder: Path | str, colour: str | None = None) -> Iterator[Path]:
    """Writes a picture of each history, and of each number against each parameter that varies.

    Curves are coloured by a parameter; the default is the first parameter that varies.
    """
    varying = [name for name in table.parameters if len(set(table.column(name))) > 1]
    colour = colour or [*varying, table.parameters[0]][0]
    for history in dict.fromkeys(quantity.history for quantity in table.quantities):
        if figure := histories(table, Quantity(history, "last"), colour):
            yield _save(figure, Path(folder) / f"{_file_name(history)}.png")
    for quantity in table.quantities:
        for name in varying:
            others = [other for other in varying if other != name]
            if figure := against(table, quantity, name, others, colour):
                yield _save(
                    figure, Path(folder) / f"{_file_name(str(quantity))}_against_{name}.png"
                )


def histories(table: Table, quantity: Quantity, by: str) -> Figure | None:
    """A picture of a history of all points against the time, coloured by a parameter; None if no point has this
    history."""
    figure, axes = _axes("time", quantity.history)
    values = table.column(by)
    for row, colour in zip(table.rows, _colours(values)):
        if not row["result"]:
            continue
        label = ", ".join(f"{name} = {_text(row[name])}" for name in table.parameters)
        try:
            with Result(table.folder / row["result"]) as result:
                axes.plot(
                    result.history.time, quantity.series(result), lw=0.9, color=colour, label=label
                )
        except Fault:
            continue  # the table tells why
    if not axes.lines:
        return None
    _legend(axes, by, values)
    return figure


def against(
    table: Table, quantity: Quantity, name: str, others: Sequence[str], by: str
) -> Figure | None:
    """A picture of a number against a parameter, with one line for each combination of the other parameters, coloured
    by one of these parameters.

    Points that do not lie on a lattice are not joined by lines. The result is None if no point has the number.
    """
    if np.isnan(table.column(str(quantity))).all():
        return None
    figure, axes = _axes(name, str(quantity))
    groups: dict[tuple[Any, ...], list[tuple[Any, float]]] = {}
    for row in table.rows:
        key = tuple(row[other] for other in others)
        groups.setdefault(key, []).append((row[name], row[str(quantity)]))
    is_lattice = len(groups) < len(table.rows)
    if not is_lattice:
        groups = {(): [point for points in groups.values() for point in points]}
    if is_lattice and others:
        by = by if by in others else others[0]
        values = [key[others.index(by)] for key in groups]
        axes.set_prop_cycle(color=_colours(values))
    for key, points in groups.items():
        points.sort(key=lambda point: (isinstance(point[0], str), point[0]))
        label = ", ".join(f"{other} = {_text(value)}" for other, value in zip(others, key))
        axes.plot(*zip(*points), "o-" if is_lattice else "o", ms=3, lw=0.9, label=label)
    if is_lattice and others:
        _legend(axes, by, values)
    return figure


def _axes(across: str, up: str) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    axes = figure.add_subplot(xlabel=across, ylabel=up)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _legend(axes: Axes, by: str, values: list[Any]) -> None:
    """A legend beside the axes, if the legend is short; else the scale of the colours, if they represent numbers."""
    if 1 < len(axes.lines) <= MOST:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=8)
    elif len(axes.lines) > MOST and not any(isinstance(value, str) for value in values):
        scale = ScalarMappable(Normalize(min(values), max(values)), SHADES)
        axes.figure.colorbar(scale, ax=axes, label=by)


def _colours(values: list[Any]) -> list[Any]:
    """A colour for each value: numbers are placed on a colour scale, texts get one colour after the other."""
    if any(isinstance(value, str) for value in values):
        different = sorted(map(str, set(values)))
        return [SHADES(different.index(str(value)) / len(different)) for value in values]
    return list(SHADES(Normalize(min(values), max(values))(values)))


def _text(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _file_name(text: str) -> str:
    return re.sub(r"[^\w.@-]+", "_", text)


def _save(figure: Figure, path: Path) -> Path:
    with whole(path) as draft:
        figure.savefig(draft, dpi=130)
    return path
