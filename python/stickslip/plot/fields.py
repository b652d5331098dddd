"""Fields that colour pictures of the mesh, with their colour scale."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, Normalize

from stickslip.arrays import Array
from stickslip.fields import AT_NODES
from stickslip.result import Result

Shown = tuple[Result, int]
"""A result and one of its frames."""

BANDS = 12
"""Bands of equal colour."""

COLOURS: Colormap = colormaps["viridis"].resampled(BANDS)
"""Their colours."""


@dataclass(frozen=True)
class Field:
    """A number that is drawn: at the places of nodes, for each element, or at nodes along the outlines."""

    name: str
    """Name with a component, as `fields` takes them."""
    at_nodes: bool = True
    """Whether values of elements are averaged at nodes."""

    def values(self, results: Result, frame: int) -> Array:
        """Values in a frame, at places [P] or of elements [E]; NaN at places and elements without a value."""
        shown, spelled = results.frames[frame], results.frames.known(self.name)
        field = spelled.partition(":")[0]
        rows = shown.at_places(field) if self.of_nodes(results) else shown[field]
        return np.asarray(results.frames.part(spelled).of(rows), np.float64)

    def of_nodes(self, results: Result) -> bool:
        """Whether the values stand at nodes."""
        return self.at_nodes or results.frames.kind(self.name) == "PointData"

    def on_outlines(self, results: Result) -> bool:
        """Whether only nodes of contact surfaces have values."""
        field = results.frames.known(self.name).partition(":")[0]
        if results.frames.kind(field) != "PointData" or field.endswith(AT_NODES):
            return False
        return bool(np.isnan(results.frames[0][field][results.in_cells]).any())


def on_lines(results: Result, values: Array) -> Array:
    """Means of the values at the two ends of each line of the outlines [., 2].

    If one end of a line has no value, the line gets the value of the other end.
    """
    ends = results.drawing.values(values)[results.drawing.outline]
    known = np.isfinite(ends)
    total = np.where(known, ends, 0.0).sum(axis=1)
    return np.where(known.any(axis=1), total / np.maximum(known.sum(axis=1), 1), np.nan)


@dataclass(frozen=True)
class Peak:
    """Place where the magnitude of a field is largest, in everything that is shown."""

    results: Result
    frame: int
    place: int
    """Place of a node, or element."""
    value: float

    @classmethod
    def of(cls, field: Field, shown: Sequence[Shown]) -> "Peak | None":
        """The result is None if the field is zero."""
        found: Peak | None = None
        for results, frame in shown:
            values = np.nan_to_num(field.values(results, frame))
            place = int(np.argmax(np.abs(values))) if len(values) else -1
            if place >= 0 and abs(values[place]) > (abs(found.value) if found else 0.0):
                found = cls(results, frame, place, float(values[place]))
        return found


@dataclass(frozen=True)
class Colouring:
    """A field with one colour scale for everything that is shown."""

    field: Field
    label: str
    norm: Normalize
    extend: str
    """Which ends of the scale have values beyond them: neither, min, max or both."""
    peak: Peak | None

    @classmethod
    def of(cls, field: Field, shown: Sequence[Shown], ends: tuple[float, float] | None = None) -> "Colouring":
        """A scale that contains 0 and the field in the given frames, or a scale with the given ends.

        Frames with values far above the values of other frames do not determine the ends of the scale, because they
        would make all other frames dark. Values beyond an end of the scale have the colour of the end, and the label
        gives the largest value.
        """
        finite = [values[np.isfinite(values)] for values in (field.values(*each) for each in shown)]
        least = np.array([min(0.0, float(values.min(initial=0.0))) for values in finite])
        most = np.array([max(0.0, float(values.max(initial=0.0))) for values in finite])
        low, high = ends or (-usual(-least), usual(most))
        if high <= low:
            high = low + 1.0
        below, above = bool(least.min() < low), bool(most.max() > high)
        label = " / ".join(dict.fromkeys(results.frames.part(field.name).label for results, _ in shown))
        if below:
            label += f", smallest {least.min():.3g}"
        if above:
            label += f", largest {most.max():.3g}"
        extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
        return cls(field, label, Normalize(low, high), extend, Peak.of(field, shown))

    @property
    def levels(self) -> Array:
        """Ends of the bands of colour."""
        return np.linspace(float(self.norm.vmin or 0.0), float(self.norm.vmax or 0.0), BANDS + 1)


PEAK = 3.0
"""A frame whose largest value is so many times that of most others is a peak."""


def usual(largest: Array) -> float:
    """The largest value of all frames [frames], without frames whose values are far above the others."""
    values = np.sort(largest[largest > 0.0])
    if len(values) == 0:
        return 0.0
    return float(min(values[-1], PEAK * values[int(0.95 * (len(values) - 1))]))
