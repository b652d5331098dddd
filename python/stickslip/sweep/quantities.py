"""Numbers that a study keeps of each run: reductions of histories, such as `nodes/TIP/U:2@min`."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array
from stickslip.errors import Fault
from stickslip.result import Result

REDUCTIONS: dict[str, Callable[[Array], np.floating]] = {
    "last": lambda values: values[-1],
    "min": np.nanmin,
    "max": np.nanmax,
    "mean": np.nanmean,
    "peak": lambda values: np.nanmax(np.abs(values)),
}
"""What may stand behind the @; `peak` is the largest magnitude."""

USUAL = ("kinetic", "strain", "external_work", "friction_dissipation")
"""Accounts that are kept when nothing is chosen."""


@dataclass(frozen=True)
class Quantity:
    """A number of a run: a history and its reduction."""

    history: str
    """Name of a history with one component (`Result.quantity`)."""
    reduction: str

    @classmethod
    def parse(cls, text: str) -> "Quantity":
        """Reads `HISTORY@REDUCTION`; the default reduction is the last value."""
        history, _, reduction = text.partition("@")
        reduction = reduction or "last"
        if reduction not in REDUCTIONS:
            raise Fault(f"{text}: after the @ stands one of {', '.join(REDUCTIONS)}")
        return cls(history, reduction)

    def __str__(self) -> str:
        return f"{self.history}@{self.reduction}"

    def series(self, result: Result) -> Array:
        """The values [I] of the history."""
        values = result.quantity(self.history)
        if values.ndim > 1:
            raise Fault(f"{self.history} is a vector: say which component, as {self.history}:1")
        return values

    def of(self, result: Result) -> float:
        """The number."""
        return float(REDUCTIONS[self.reduction](self.series(result)))


def usual() -> list[Quantity]:
    """The numbers that are kept by default."""
    return [Quantity(f"energy/{name}", "last") for name in USUAL]
