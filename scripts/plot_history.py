"""Draws the histories of results: energy, its balance, momentum and contact forces.

Several results stand side by side. Without -o the picture goes next to the first result, as
JOB_history.png.
"""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from results import Results

LEDGER = (
    ("kinetic", "kinetic", 1),
    ("strain", "strain", 1),
    ("friction_dissipation", "friction", 1),
    ("impact_loss", "impact loss", 1),
    ("numerical_dissipation", "numerical dissipation", 1),
    ("normal_contact_work", "normal contact (taken)", -1),
)
"""Accounts that together hold the energy put in: dataset, label, sign."""


def energy(axes: Axes, results: Results) -> None:
    """Where the energy is: the accounts stacked, against what was put in."""
    account = results.energy
    start = account["kinetic"][0] + account["strain"][0]
    parts = [sign * account[name] for name, _, sign in LEDGER]
    axes.stackplot(
        results.time, parts, labels=[label for _, label, _ in LEDGER], alpha=0.85, linewidth=0
    )
    axes.plot(results.time, start + account["external_work"], "k--", lw=1, label="put in")
    axes.set_ylabel("energy")
    axes.legend(loc="upper left", ncols=2)


def balance(axes: Axes, results: Results) -> None:
    """What is left of the energy balance, against the largest energy."""
    axes.semilogy(
        results.time,
        np.maximum(np.abs(results.energy["balance"]) / (results.largest_energy or 1.0), 1e-18),
        color="k",
        lw=0.7,
    )
    axes.set_ylabel("|balance| / largest energy")


def momentum(axes: Axes, results: Results) -> None:
    """Linear momentum, and angular momentum on a second axis."""
    lines = axes.plot(results.time, results.linear_momentum[:, 0], label="linear, x")
    lines += axes.plot(results.time, results.linear_momentum[:, 1], label="linear, y")
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    other.grid(False)
    lines += other.plot(
        results.time, results.angular_momentum, color="k", lw=0.9, ls=":", label="angular (right)"
    )
    axes.set_ylabel("linear momentum")
    other.set_ylabel("angular momentum about 0")
    axes.legend(handles=lines, loc="best")


def contact_force(axes: Axes, results: Results) -> None:
    """Normal and tangential resultant of each contact."""
    for contact in results.contacts.values():
        prefix = f"{contact.name}: " if len(results.contacts) > 1 else ""
        axes.plot(results.time, contact.normal, lw=0.8, label=f"{prefix}normal")
        axes.plot(results.time, contact.tangential, lw=0.8, label=f"{prefix}tangential")
    axes.set_ylabel("contact force")
    if results.contacts:
        axes.legend(loc="best")


def contact_state(axes: Axes, results: Results) -> None:
    """Number of closed and of sticking pairs."""
    for contact in results.contacts.values():
        prefix = f"{contact.name}: " if len(results.contacts) > 1 else ""
        axes.plot(results.time, contact.closed, lw=0.8, label=f"{prefix}closed")
        axes.plot(results.time, contact.sticking, lw=0.8, label=f"{prefix}sticking")
    axes.set_ylabel("pairs")
    if results.contacts:
        axes.legend(loc="best")


def draw(all_results: list[Results]) -> Figure:
    """One column per result."""
    rows = (energy, balance, momentum, contact_force, contact_state)
    figure, axes = plt.subplots(
        len(rows),
        len(all_results),
        figsize=(1.5 + 5.5 * len(all_results), 12),
        sharex="col",
        squeeze=False,
        height_ratios=(2, 1, 1.2, 1.2, 0.9),
    )
    for column, results in enumerate(all_results):
        axes[0, column].set_title(results.job)
        for row, plot in enumerate(rows):
            plot(axes[row, column], results)
        axes[-1, column].set_xlabel("time")
        axes[-1, column].set_xlim(results.time[0], results.time[-1])
    return figure


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument("-o", "--output", type=Path, help="picture to write")
    parser.add_argument("--dpi", type=float, help="pixels per inch of the picture")
    arguments = parser.parse_args()
    all_results = [Results(path) for path in arguments.result]
    first = arguments.result[0]
    path = arguments.output or first.with_name(f"{first.stem}_history.png")
    style.save(draw(all_results), path, arguments.dpi)


if __name__ == "__main__":
    main()
