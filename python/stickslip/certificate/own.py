"""What the program has checked itself in every increment, collected in one table."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stickslip.history import ENERGIES
from stickslip.result import Array, Result

CHECKS = (
    ("solver/residual", "force residual of the last pass, part of the largest force"),
    ("solver/overlap", "overlap of an open pair, lengths of its segment"),
    ("solver/gap_violation", "gap of a closed pair, lengths of its segment"),
    ("solver/slip_violation", "slip of a sticking pair, lengths of its segment"),
    ("solver/penetration", "penetration by nodes or edges, lengths of the edge"),
    ("cone_violation", "force outside Coulomb's cone, part of the largest normal force"),
    (
        "impulse_cone_violation",
        "impulse outside Coulomb's cone, part of the largest normal impulse",
    ),
)
"""Histories that check an increment, with what they measure; without a slash those of contacts."""


@dataclass(frozen=True)
class OwnCheck:
    """A check of every increment."""

    name: str
    """Its path below /history."""
    text: str
    contact: str
    """Name of the contact; empty for all of them together."""
    values: Array
    """[I]"""


def own_checks(result: Result) -> list[OwnCheck]:
    """All checks that the result has."""
    found = []
    for name, text in CHECKS:
        if name in result.histories:
            found.append(OwnCheck(name, text, "", result.history[name]))
        for contact in result.contact:
            path = f"contact/{contact}/{name}"
            if path in result.histories:
                found.append(OwnCheck(path, text, contact, result.history[path]))
    names = [name for name in ENERGIES if f"energy/{name}" in result.histories]
    largest = max(
        (
            float(np.nanmax(np.abs(result.history.energy[n]), initial=0.0))
            for n in names
            if n != "balance"
        ),
        default=0.0,
    )
    if largest > 0.0:
        text = "energy balance, part of the largest energy"
        found.append(OwnCheck("energy/balance", text, "", result.history.energy.balance / largest))
    return found


def write_table(result: Result, path: Path) -> None:
    """Writes the checks as CSV, one row for each increment."""
    checks = own_checks(result)
    time = result.history.time
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["increment", "time", *(check.name for check in checks)])
        for row, when in enumerate(time):
            writer.writerow([row, repr(float(when)), *(repr(float(c.values[row])) for c in checks)])
