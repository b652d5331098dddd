"""The picture of a case: computed curves beside the references, errors over sizes, errors over tolerances."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from form import Curve, Order
from runner import Study, curve_points, errors, observed_order
from stickslip.plot import style

LARGEST = 3
"""Panels of a picture."""

APART = 1.5
"""Least ratio of two sizes whose labels stand on an axis."""


@style.styled
def draw(study: Study, path: Path) -> None:
    """Draws the picture of a case; none where it has nothing to compare."""
    form = study.form
    curves = [curve for curve in form.curves if any(run in study.results for run in curve.runs)]
    orders = [order for order in form.orders if all(run in study.results for run in order.runs)]
    panels = [lambda ax, one=one: draw_curve(study, one, ax) for one in curves]
    if orders:
        panels.append(lambda ax: draw_orders(study, orders, ax))
    if len(panels) < 2:
        panels.append(lambda ax: draw_parts(study, ax))
    panels = panels[:LARGEST]
    figure, axes = plt.subplots(1, len(panels), figsize=(4.2 * len(panels), 3.2), squeeze=False, layout="tight")
    for panel, ax in zip(panels, axes[0]):
        try:
            panel(ax)
        except Exception as error:  # noqa: BLE001  (expressions are data; the checks tell)
            ax.set_title(f"{type(error).__name__}: {error}", fontsize=6)
        ax.tick_params(labelsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    style.save(figure, path, dpi=80)
    plt.close(figure)


def draw_curve(study: Study, curve: Curve, ax: Axes) -> None:
    """Computed curves, the reference as points."""
    drawn = set()
    ends: list[float] = []
    for run in filter(study.results.__contains__, curve.runs):
        name = study.values(run).named(curve.reference)
        reference = study.form.references[name]
        if name not in drawn:
            label = f"reference [{reference.tag}]" if not drawn else None
            ax.plot(reference.x, reference.value, "k.", markersize=4, label=label, zorder=3)
            drawn.add(name)
            ends += [reference.x.min(), reference.x.max()]
        ax.plot(*curve_points(study, curve, run), linewidth=1, label=run)
    margin = 0.15 * (max(ends) - min(ends))
    ax.set_xlim(min(ends) - margin, max(ends) + margin)
    ax.set_title(curve.name, fontsize=8)
    ax.set_xlabel(curve.label, fontsize=7)
    ax.legend(fontsize=6)


def draw_orders(study: Study, orders: list[Order], ax: Axes) -> None:
    """Errors over sizes."""
    every: list[float] = []
    for order in orders:
        sizes, off = errors(study, order)
        slope = observed_order(sizes, off)
        ax.loglog(sizes, off, "o-", markersize=3, linewidth=1, label=f"{order.name}: {slope:.2f}")
        every += map(float, sizes)
    ticks: list[float] = []
    for size in sorted(every):
        if not ticks or size > APART * ticks[-1]:
            ticks.append(size)
    ax.set_xticks(ticks, [f"{tick:.3g}" for tick in ticks])
    ax.set_xticks([], minor=True)
    ax.set_xlabel("size", fontsize=7)
    ax.set_title("error over size, observed order", fontsize=8)
    ax.legend(fontsize=6)


def draw_parts(study: Study, ax: Axes) -> None:
    """Errors of the quantities with a reference, as parts of their tolerances."""
    checks = [check for check in study.checks if not check.common and np.isfinite(check.part)]
    names = list(dict.fromkeys(check.quantity for check in checks))
    for row, name in enumerate(names):
        parts = [max(check.part, 1e-4) for check in checks if check.quantity == name]
        ax.plot(parts, [row] * len(parts), "o", color="C0", markersize=3)
    ax.axvline(1.0, color="C3", linewidth=1)
    ax.set_xscale("log")
    ax.set_yticks(range(len(names)), [name if len(name) <= 42 else f"{name[:40]}..." for name in names], fontsize=5)
    ax.invert_yaxis()
    ax.set_title("error / tolerance", fontsize=8)
