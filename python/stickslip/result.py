"""Results of runs: histories, frames and the record of the run, from the file `JOB.vtkhdf` (see docs/output.md)."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip import convert
from stickslip.arrays import Array
from stickslip.frame import Frame, Frames
from stickslip.history import Contacts, History
from stickslip.notebook import Paged
from stickslip.quantity import find
from stickslip.result_file import ResultFile

if TYPE_CHECKING:
    import pandas
    import xarray

NONE, OPEN, STICK, SLIP = range(4)
"""Values of CONTACT_STATUS."""


class Result(ResultFile, Paged):
    """A result file.

    >>> result = Result("job.vtkhdf")
    >>> result.history.energy.kinetic          # one row per increment
    >>> result.contact["SLAVE_MASTER"].force
    >>> result.frame(0.5)["MISES"]             # one value per element
    """

    # Histories.

    @cached_property
    def history(self) -> History:
        """Histories: `history.energy.kinetic`, `history.nodes["TIP"].U`, `history["energy/kinetic"]`."""
        return History(self, "history")

    @property
    def contact(self) -> Contacts:
        """Histories of the contacts by name, `SLAVE_MASTER`."""
        return self.history.contact

    def quantity(self, name: str) -> Array:
        """The history with a name as in plots and sweeps, such as `nodes/TIP/U:2` (see `quantity`).

        The shape of the history is [I], or [I, components] for a vector.
        """
        parts = list(find(self, name).parts.values())
        return parts[0] if len(parts) == 1 else np.column_stack(parts)

    def to_dataframe(self) -> "pandas.DataFrame":
        """All histories as a table, one row per increment. The table needs the package pandas."""
        return convert.to_dataframe(self)

    def to_xarray(self, *fields: str) -> "xarray.Dataset":
        """All histories and the named fields of all frames, as a dataset of xarray. The dataset needs the package
        xarray."""
        times = self.frames.times if fields else None
        return convert.to_xarray(self, times, {name: self.frames.field(name) for name in fields})

    # Frames.

    @cached_property
    def frames(self) -> Frames:
        """All complete frames."""
        return Frames(self)

    def frame(self, time: float) -> Frame:
        """The frame nearest to a time of the run; a time before or after all frames raises a Fault."""
        return self.frames.at(time)

    # The run.

    @property
    def deck(self) -> str:
        """Full text of the deck."""
        return str(self.file["run"].attrs["deck"])

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run, from the log beside the result; empty if there is no log."""
        log = self.path.with_suffix(".log")
        if not log.exists():
            return []
        found: list[str] = []
        is_open = False
        for line in log.read_text(errors="replace").splitlines():
            if line.startswith("warning"):
                found.append(line.removeprefix("warning").strip())
            elif is_open and line.startswith("         "):
                found[-1] += " " + line.strip()
            is_open = line.startswith("warning") or is_open and line.startswith("         ")
        return found

    @property
    def run(self) -> dict[str, Any]:
        """Attributes of the run record."""
        return dict(self.file["run"].attrs)
