"""A check of the certificate: the worst value of a quantity, compared with its bound.

Values are rounded up and bounds down, also in the digits that are shown.
"""

from dataclasses import dataclass, field
from decimal import ROUND_UP, Context

import numpy as np
from numpy.typing import ArrayLike


@dataclass
class Check:
    """Check of one quantity, at all places in the file where it can be computed."""

    name: str
    text: str
    """What is compared, in a few words."""
    value: float = 0.0
    """Worst value, as a part of the scale that `text` names."""
    bound: float = 0.0
    """Its bound there; round-off of positions makes bounds differ from place to place."""
    place: str = ""
    """Where it is."""
    count: int = 0
    """How many values were compared."""
    scale: float = 0.0
    """What values and bounds are shown as a part of; 0 where they are pure numbers."""
    reasons: list[str] = field(default_factory=list)
    """Why it could not be told, or not everywhere."""

    @property
    def is_told(self) -> bool:
        """Whether the check has compared any value."""
        return self.count > 0

    @property
    def holds(self) -> bool:
        """Whether every compared value is at most its bound."""
        return self.value <= self.bound

    def add(self, value: ArrayLike, bound: ArrayLike, place: str) -> None:
        """Compares values with their bounds; a value that is NaN counts as above any bound."""
        values, bounds = np.broadcast_arrays(
            np.asarray(value, dtype=np.float64), np.asarray(bound, dtype=np.float64)
        )
        if values.size == 0:
            return
        self.count += values.size
        values = np.where(np.isnan(values), np.inf, np.maximum(values, 0.0))
        values = np.where(values > 0.0, np.nextafter(values, np.inf), 0.0)
        bounds = np.where(bounds > 0.0, np.nextafter(bounds, 0.0), bounds)
        above = np.where(values > bounds, np.inf, 0.0)
        ratio = np.divide(values, bounds, out=above, where=bounds > 0.0)
        worst = int(ratio.argmax())
        if not self.place or ratio.flat[worst] > self._ratio:
            self._ratio = float(ratio.flat[worst])
            self.value, self.bound = float(values.flat[worst]), float(bounds.flat[worst])
            self.place = place.format(worst)

    _ratio: float = 0.0

    def shown(self, digits: int = 2) -> tuple[float, float]:
        """Worst value and bound relative to the scale; the value is rounded up to `digits` digits."""
        scale = self.scale or 1.0
        value = np.nextafter(self.value / scale, np.inf) if self.value > 0.0 else 0.0
        up = Context(prec=digits, rounding=ROUND_UP)
        return float(up.create_decimal(float(value))), self.bound / scale

    def skip(self, reason: str) -> None:
        """Notes the reason why something could not be checked."""
        if reason not in self.reasons:
            self.reasons.append(reason)


class Checks:
    """The checks by name, in the order in which they were first used."""

    def __init__(self, texts: dict[str, str]) -> None:
        self._texts = texts
        self._checks = {name: Check(name, text) for name, text in texts.items()}

    def __getitem__(self, name: str) -> Check:
        return self._checks[name]

    def all(self) -> list[Check]:
        """All checks."""
        return list(self._checks.values())
