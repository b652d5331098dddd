"""The table of a study, with one row for each point, as CSV and Parquet."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any

from stickslip.errors import Fault, one_line
from stickslip.result import Result
from stickslip.sweep.point import Task
from stickslip.sweep.quantities import Quantity
from stickslip.whole import whole

TABLE = "table.csv"
"""The table in the folder of a study."""

KNOWN = ("exit_status", "warnings", "message", "seconds")
"""Columns of every table, behind those of the parameters."""

LOST = -1
"""Exit status of a point whose run has not ended."""


@dataclass(frozen=True)
class Table:
    """Rows in the order of the points."""

    parameters: list[str]
    quantities: list[Quantity]
    rows: list[dict[str, Any]]
    """Parameters, exit_status, warnings, message, seconds, quantities, result (a path from the folder, or empty)."""
    folder: Path = Path()
    """Folder of the study."""

    @classmethod
    def of(
        cls, folder: Path, tasks: Sequence[Task], lost: Mapping[str, str], quantities: list[Quantity]
    ) -> "Table":
        """Reads the rows that the runs have written. `lost` gives the reasons for points without a row."""
        rows = [_row(task, lost, quantities) for task in tasks]
        return cls(list(tasks[0].values), quantities, rows, folder)

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return columns(self.parameters, self.quantities)

    @property
    def failed(self) -> int:
        """Points with an error message: their run failed, or a quantity is missing."""
        return sum(bool(row["message"]) for row in self.rows)

    def column(self, name: str) -> list[Any]:
        """The values of a column."""
        return [row[name] for row in self.rows]

    def write(self, folder: Path | str) -> list[Path]:
        """Writes `table.csv`, and `table.parquet` if the package pyarrow is installed."""
        path = Path(folder) / TABLE
        with whole(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.columns)
            writer.writeheader()
            writer.writerows(self.rows)
        try:
            import pyarrow
            import pyarrow.parquet
        except ImportError:
            return [path]
        data = {name: self.column(name) for name in self.columns}
        parquet = path.with_suffix(".parquet")
        with whole(parquet) as draft:
            pyarrow.parquet.write_table(pyarrow.table(data), draft)
        return [path, parquet]


def columns(parameters: Sequence[str], quantities: Sequence[Quantity]) -> list[str]:
    """Names of the columns of a table; a parameter with the name of another column raises a Fault."""
    own = [*KNOWN, *map(str, quantities), "result"]
    if same := [name for name in parameters if name in own]:
        raise Fault(f"the table has a column {same[0]} of its own: give the parameter another name")
    return [*parameters, *own]


def _row(task: Task, lost: Mapping[str, str], quantities: list[Quantity]) -> dict[str, Any]:
    """The row of the result table for a point of the study."""
    known = task.row() or {}
    if task.name in lost:
        known = {"exit_status": LOST, "message": lost[task.name]}
    found = {str(quantity): nan for quantity in quantities}
    message = known.get("message", "the point was not run")
    path = ""
    if task.result.exists() and task.name not in lost:
        path = task.relative_result
        try:
            with Result(task.result) as result:
                found = {str(quantity): quantity.of(result) for quantity in quantities}
        except Fault as fault:
            message = message or one_line(fault)
    seconds = known.get("seconds")
    return {
        **task.values,
        "exit_status": known.get("exit_status", LOST),
        "warnings": len(known.get("warnings", ())),
        "message": message.partition("\n")[0],
        "seconds": None if seconds is None else round(seconds, 3),
        **found,
        "result": path,
    }
