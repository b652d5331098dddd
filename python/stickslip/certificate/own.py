"""Checks that the program itself has made in every increment: the table `/history/certificate`."""

import csv
from dataclasses import dataclass
from pathlib import Path

from stickslip.arrays import Array
from stickslip.result import Result
from stickslip.whole import whole


@dataclass(frozen=True)
class OwnCheck:
    """A check that the program makes in every increment."""

    name: str
    """Its path below /history."""
    text: str
    bound: float
    """Largest value that counts as none; NaN where nothing holds it down."""
    values: Array
    """[I]"""


def own_checks(result: Result) -> list[OwnCheck]:
    """All checks in a result that the program has made itself."""
    table = result.history.certificate
    found = []
    for name in table:
        path = f"certificate/{name}"
        about = result.file[f"history/{path}"].attrs
        found.append(OwnCheck(path, about["description"], float(about["bound"]), table[name]))
    return found


def write_table(result: Result, path: Path) -> None:
    """Writes the checks as CSV, one row for each increment."""
    checks = own_checks(result)
    time = result.history.time
    with whole(path) as draft, draft.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["increment", "time", *(check.name for check in checks)])
        for row, when in enumerate(time):
            writer.writerow([row, repr(float(when)), *(repr(float(c.values[row])) for c in checks)])
