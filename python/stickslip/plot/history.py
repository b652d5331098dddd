"""Draws the histories of results.

Without names the command draws the energy accounts, the energy balance, momentum and contact forces, and force against
displacement if a force moves something. Results stand side by side or, with --overlay, on top of each other. With --y
the command draws any histories, against the time or against the history of --x. With --y all results are drawn in the
same axes, and every --y has axes of its own:

    stickslip plot history A.vtkhdf B.vtkhdf --x nodes/TIP/U:2 --y contact/A_B/force:1

A name is the path of a history in the result file (--list prints all names); after a colon stands the
component of a vector, from 1. For a node set, displacements and velocities are means, and reactions are
sums; nodes/TIP[3]/U:2 is the displacement of node 3.

Without -o the picture is written next to the first result, as JOB_history.png.
"""

import argparse
from collections.abc import Callable, Sequence
from itertools import cycle
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from stickslip import command
from stickslip.arrays import Array
from stickslip.errors import Fault
from stickslip.fields import directions
from stickslip.plot import style
from stickslip.quantity import find, force_against_displacement, listed
from stickslip.result import Result

LEDGER = (
    ("kinetic", "kinetic", 1),
    ("strain", "strain", 1),
    ("friction_dissipation", "friction", 1),
    ("impact_loss", "impact loss", 1),
    ("landing_return", "landing return (given)", -1),
    ("release_loss", "release loss", 1),
    ("damping", "damping", 1),
    ("material_dissipation", "materials", 1),
    ("numerical_dissipation", "numerical dissipation", 1),
    ("normal_contact_work", "normal contact (taken)", -1),
)
"""Accounts that together hold the energy put in: dataset, label, sign."""

LINES = ("-", "--", ":", "-.")
"""Lines of the components of a vector."""

LEAST = 1e-18
"""Least value in logarithmic axes."""

Plot = Callable[[Axes, Result], None]


def energy(axes: Axes, results: Result) -> None:
    """Draws the energies of the ledger, stacked, with negative energies below zero, and the energy put in."""
    account = results.history.energy
    start = account["kinetic"][0] + account["strain"][0]
    coloured = zip(LEDGER, style.ACCOUNTS)
    entered = [(entry, colour) for entry, colour in coloured if account[entry[0]].any()]
    parts = np.array([sign * account[name] for (name, _, sign), _ in entered])
    labels = [label for (_, label, _), _ in entered]
    colours = [colour for _, colour in entered]
    look: dict[str, Any] = {"colors": colours, "alpha": 0.85, "linewidth": 0}
    axes.stackplot(results.history.time, np.maximum(parts, 0.0), labels=labels, **look)
    axes.stackplot(results.history.time, np.minimum(parts, 0.0), **look)
    axes.plot(results.history.time, start + account["external_work"], "k--", lw=1, label="put in")
    axes.set_ylabel("energy")


def relative_balance(results: Result) -> Array:
    """The energy balance, relative to the largest energy."""
    return np.abs(results.history.energy["balance"]) / (results.history.energy.largest or 1.0)


def balance(axes: Axes, results: Result) -> None:
    """Draws the relative energy balance."""
    axes.semilogy(
        results.history.time, np.maximum(relative_balance(results), LEAST), color="k", lw=0.7
    )
    axes.set_ylabel("|balance| /\nlargest energy")


def linear_momentum(axes: Axes, results: Result) -> None:
    """Draws both components of the momentum; round-off is drawn as zero."""
    for label, values in zip(directions(2, results.is_axisymmetric), results.history.momentum.linear.T):
        axes.plot(results.history.time, values, label=label)
    speed = np.linalg.norm(results.frames[0]["V"], axis=1).max()
    kinetic = 2.0 * results.history.energy["kinetic"][0]
    flat(axes, np.abs(results.history.momentum.linear).max(), kinetic / speed if speed else 0.0)
    axes.set_ylabel("linear\nmomentum")


def angular_momentum(axes: Axes, results: Result) -> None:
    """Draws the angular momentum; round-off is drawn as zero."""
    axes.plot(results.history.time, results.history.momentum.angular, color="k")
    flat(
        axes,
        np.ptp(results.history.momentum.angular),
        np.abs(results.history.momentum.angular).max(),
    )
    axes.set_ylabel("angular momentum\nabout the origin")


def flat(axes: Axes, change: float, scale: float) -> None:
    """Widens the axes to a given scale if the change is only round-off of this scale."""
    if change < 1e-9 * scale:
        left, low, _, high = axes.dataLim.extents
        middle = 0.5 * (low + high)
        axes.update_datalim([(left, middle - scale), (left, middle + scale)])
        axes.autoscale_view()
    axes.ticklabel_format(axis="y", useOffset=False)


def contact_force(axes: Axes, results: Result) -> None:
    """Draws the normal and the tangential resultant of each contact."""
    axes.set_prop_cycle(color=style.colours(max(2 * len(results.contact), 2)))
    for contact in results.contact.values():
        prefix = f"{contact.name}: " if len(results.contact) > 1 else ""
        axes.plot(results.history.time, contact.normal, lw=0.8, label=f"{prefix}normal")
        axes.plot(results.history.time, contact.tangential, lw=0.8, label=f"{prefix}tangential")
    axes.set_ylabel("contact force")


def contact_state(axes: Axes, results: Result) -> None:
    """Draws the numbers of closed and of sticking pairs."""
    axes.set_prop_cycle(color=style.colours(max(2 * len(results.contact), 2)))
    for contact in results.contact.values():
        prefix = f"{contact.name}: " if len(results.contact) > 1 else ""
        axes.plot(results.history.time, contact.closed, lw=0.8, label=f"{prefix}closed")
        axes.plot(results.history.time, contact.sticking, lw=0.8, label=f"{prefix}sticking")
    axes.update_datalim([(results.history.time[0], 0.0), (results.history.time[0], 1.0)])
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, integer=True))
    axes.set_ylabel("pairs")


def legend_beside(axes: Sequence[Axes]) -> None:
    """One legend on the right of a row of axes for all lines in these axes; equal labels appear once."""
    entries: dict[str, Any] = {}
    for each in axes:
        handles, labels = each.get_legend_handles_labels()
        entries |= dict(zip(labels, handles))
    if entries:
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "borderaxespad": 0.0}
        legend = axes[-1].legend(list(entries.values()), list(entries), **place)
        for line in legend.get_lines():
            line.set_linewidth(1.8)  # thin ones have pale colours


@style.styled
def draw(all_results: list[Result]) -> Figure:
    """A page with one column per result; all columns have the same scales."""
    rows: list[tuple[Plot, float]] = [(energy, 2.0), (balance, 1.0)]
    if any(results.history.momentum.linear.any() for results in all_results):
        rows += [(linear_momentum, 1.0), (angular_momentum, 1.0)]
    if any(results.contact for results in all_results):
        rows += [(contact_force, 1.2), (contact_state, 0.9)]
    over_time = len(rows)
    if any(map(force_against_displacement, all_results)):
        rows.append((force_displacement, 1.6))
    heights = [height for _, height in rows]
    size = (3.2 + 4.5 * len(all_results), 1.0 + 1.5 * sum(heights))
    figure, axes = style.subplots(
        len(rows), len(all_results), size, sharey="row", squeeze=False, height_ratios=heights
    )
    for at in axes[:over_time].flat:
        if at is not axes[0, 0]:
            at.sharex(axes[0, 0])
        at.tick_params(labelbottom=at in axes[over_time - 1])
    for row, (plot, _) in zip(axes, rows):
        for at, results in zip(row, all_results):
            plot(at, results)
        for at in row[1:]:
            at.set_ylabel("")
        legend_beside(row)
    for column, (name, results) in enumerate(zip(names(all_results), all_results)):
        axes[0, column].set_title(name)
        axes[over_time - 1, column].set_xlabel("time")
        axes[over_time - 1, column].set_xlim(*span(all_results))
    return figure


def force_displacement(axes: Axes, results: Result) -> None:
    """Draws the force that does the largest work, against the displacement in its direction."""
    for names in force_against_displacement(results)[:1]:
        moved, force = (find(results, name) for name in names)
        axes.plot(*moved.parts.values(), *force.parts.values(), color="k")
        axes.set_xlabel(fill(moved.title, 60))
        axes.set_ylabel(fill(force.title, 30))


def losses(results: Result) -> Array:
    """Energy that was lost to impacts, the scheme and the normal contact forces."""
    account = results.history.energy
    others = account["impact_loss"] + account["numerical_dissipation"]
    return others - account["normal_contact_work"]


def total(results: Result, field: str) -> Array:
    """Sum of a resultant over all contacts."""
    contacts = results.contact.values()
    return sum((getattr(contact, field) for contact in contacts), np.zeros(results.rows))


COMPARED: tuple[tuple[str, Callable[[Result], Array]], ...] = (
    ("kinetic energy", lambda results: results.history.energy["kinetic"]),
    ("strain energy", lambda results: results.history.energy["strain"]),
    (
        "energy dissipated\nby friction",
        lambda results: results.history.energy["friction_dissipation"],
    ),
    ("energy lost to impacts,\nscheme, contact", losses),
    ("|balance| /\nlargest energy", lambda results: np.maximum(relative_balance(results), LEAST)),
    ("normal contact force", lambda results: total(results, "normal")),
    ("tangential contact force", lambda results: total(results, "tangential")),
)
"""What is compared between results: title, values."""


@style.styled
def compare(all_results: list[Result]) -> Figure:
    """A page with the results on top of each other, with one line for each result."""
    touching = any(results.contact for results in all_results)
    rows = COMPARED if touching else COMPARED[:5]
    figure, axes = style.subplots(len(rows), 1, (9.0, 1.0 + 1.6 * len(rows)), sharex=True)
    for at, (title, values) in zip(axes, rows):
        at.set_prop_cycle(color=style.colours(len(all_results)))
        for name, results in zip(names(all_results), all_results):
            at.plot(results.history.time, values(results), lw=0.9, label=name)
        at.set_ylabel(title)
        if title.startswith("|"):
            at.set_yscale("log")
    legend_beside(axes[:1])
    axes[-1].set_xlabel("time")
    axes[-1].set_xlim(*span(all_results))
    return figure


@style.styled
def draw_named(all_results: list[Result], along: str, rows: list[list[str]]) -> Figure:
    """A page of histories against another history, with axes for each row of names and a line for each name."""
    figure, axes = style.subplots(
        len(rows), 1, (9.0, 0.8 + 3.4 * len(rows)), sharex=True, squeeze=False
    )
    titles: list[str] = []
    for at, shown in zip(axes[:, 0], rows):
        titles = draw_row(at, all_results, along, shown)
        legend_beside([at])
    axes[-1, 0].set_xlabel(fill(" / ".join(titles), 90))
    return figure


def draw_row(axes: Axes, all_results: list[Result], along: str, shown: list[str]) -> list[str]:
    """Draws the histories of one row; returns the titles of the abscissa."""
    abscissae: dict[str, None] = {}
    ordinates: dict[str, None] = {}
    colours = iter(style.colours(len(all_results) * len(shown)))
    for job, results in zip(names(all_results), all_results):
        across = find(results, along)
        if not across.alone:
            raise Fault(f"{along} is a vector: say which component, as in {along}:1")
        (x,) = across.parts.values()
        abscissae[across.title] = None
        for name in shown:
            history, colour = find(results, name), next(colours)
            ordinates[history.title] = None
            for (part, values), line in zip(history.parts.items(), cycle(LINES)):
                words = [job] if len(all_results) > 1 else []
                words += [history.title] if len(shown) > 1 else []
                words += [] if history.alone else [part]
                axes.plot(x, values, line, color=colour, label=fill(", ".join(words), 36) or None)
    axes.set_ylabel(fill(" / ".join(ordinates), 44))
    return list(abscissae)


def names(all_results: Sequence[Result]) -> list[str]:
    """Names of the jobs, with their folders if two names are the same."""
    jobs = [results.job for results in all_results]
    if len(set(jobs)) == len(jobs):
        return jobs
    return [str(results.path.with_suffix("")) for results in all_results]


def span(all_results: list[Result]) -> tuple[float, float]:
    """Limits from the first to the last time of all results."""
    first = min(results.history.time[0] for results in all_results)
    last = max(results.history.time[-1] for results in all_results)
    return float(first), float(last if last > first else first + 1.0)


def run() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="stickslip plot history",
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument("--x", default="time", metavar="NAME", help="abscissa of --y")
    parser.add_argument(
        "--y", nargs="+", action="append", metavar="NAME", help="histories of one pair of axes"
    )
    parser.add_argument("--overlay", action="store_true", help="results on top of each other")
    parser.add_argument("--list", action="store_true", help="print the names of the histories")
    parser.add_argument("-o", "--output", type=Path, help="picture to write")
    parser.add_argument("--dpi", type=command.positive, help="pixels per inch of the picture")
    arguments = parser.parse_args()
    if arguments.x != "time" and not arguments.y:
        parser.error("--x needs --y")
    all_results = [Result(path) for path in arguments.result]
    if arguments.list:
        print("\n".join(name for results in all_results for name in listed(results)))
        return
    if arguments.y:
        figure = draw_named(all_results, arguments.x, arguments.y)
    else:
        figure = compare(all_results) if arguments.overlay else draw(all_results)
    first = arguments.result[0]
    path = arguments.output or first.with_name(f"{first.stem}_history.png")
    style.save(figure, path, arguments.dpi)
