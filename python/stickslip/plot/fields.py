"""Fields that colour pictures of the mesh, with their colour scale."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.colors import Normalize

from stickslip.arrays import Array
from stickslip.result import Result

Shown = tuple[Result, int]
"""A result and one of its frames."""


@dataclass(frozen=True)
class Field:
    """A scalar per element, or per edge of the outlines."""

    label: Callable[[Result], str]
    """What it is, as far as the result holds it."""
    values: Callable[[Result, int], Array]
    """Values per element or edge in a frame; NaN where there is none."""
    on_edges: bool = False


def magnitude(name: str, results: Result, frame: int) -> Array:
    """Element means of the magnitude of a vector at the nodes."""
    length = np.linalg.norm(results.frames[frame][name], axis=1)
    return np.array([length[cell].mean() for cell in results.cells])


def von_mises(results: Result, frame: int) -> Array:
    """Von Mises stress; without the stress across the thickness where the result has none."""
    if "MISES" in results.frames.fields:
        return results.frames[frame]["MISES"]
    xx, yy, xy = results.frames[frame]["S"].T
    # syy = 0 across the thickness: plane stress
    return np.sqrt(xx**2 - xx * yy + yy**2 + 3 * xy**2)


def von_mises_label(results: Result) -> str:
    """Says when the stress across the thickness is not in it."""
    if "MISES" in results.frames.fields:
        return "von Mises stress"
    return "von Mises stress of the stresses in the plane"


def mean_stress(results: Result, frame: int) -> Array:
    """Mean of the two normal stresses in the plane."""
    return results.frames[frame]["S"][:, :2].mean(axis=1)


def on_outline(name: str, results: Result, frame: int) -> Array:
    """Means of a scalar of slave nodes on the edges of the outlines.

    An edge with one node that has no value takes that of the other one.
    """
    ends = results.frames[frame][name][results.boundary]
    known = np.isfinite(ends)
    total = np.where(known, ends, 0.0).sum(axis=1)
    return np.where(known.any(axis=1), total / np.maximum(known.sum(axis=1), 1), np.nan)


def _plain(text: str) -> Callable[[Result], str]:
    return lambda _: text


FIELDS = {
    "von-mises": Field(von_mises_label, von_mises),
    "mean-stress": Field(_plain("mean stress in the plane"), mean_stress),
    "speed": Field(_plain("speed"), partial(magnitude, "V")),
    "displacement": Field(_plain("displacement"), partial(magnitude, "U")),
    "contact-force": Field(
        _plain("contact force on a node, mean of the element"), partial(magnitude, "CONTACT_FORCE")
    ),
    "contact-pressure": Field(
        _plain("contact pressure"), partial(on_outline, "CONTACT_PRESSURE"), on_edges=True
    ),
    "slip": Field(_plain("accumulated slip"), partial(on_outline, "SLIP"), on_edges=True),
}
"""Fields by their names on the command line."""


@dataclass(frozen=True)
class Colouring:
    """A field with one colour scale for all that is shown."""

    field: Field
    label: str
    norm: Normalize
    extend: str
    """Which ends of the scale have values beyond them: neither, min, max or both."""

    @classmethod
    def of(
        cls, name: str, shown: Sequence[Shown], ends: tuple[float, float] | None = None
    ) -> "Colouring":
        """Scale that holds 0 and the field in the given frames, or one with the given ends.

        Frames that rise far above the others do not set its ends: they would make all others
        dark. What lies beyond has the colour of the end, and the label says how far it goes.
        """
        field = FIELDS[name]
        finite = [values[np.isfinite(values)] for values in (field.values(*each) for each in shown)]
        least = np.array([min(0.0, float(values.min(initial=0.0))) for values in finite])
        most = np.array([max(0.0, float(values.max(initial=0.0))) for values in finite])
        low, high = ends or (-usual(-least), usual(most))
        if high <= low:
            high = low + 1.0
        below, above = bool(least.min() < low), bool(most.max() > high)
        label = " / ".join(dict.fromkeys(field.label(results) for results, _ in shown))
        if below:
            label += f", smallest {least.min():.3g}"
        if above:
            label += f", largest {most.max():.3g}"
        extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
        return cls(field, label, Normalize(low, high), extend)


PEAK = 3.0
"""A frame whose largest value is so many times that of most others is a peak."""


def usual(largest: Array) -> float:
    """The largest value of frames [frames] without the frames that are peaks."""
    values = largest[largest > 0.0]
    if len(values) == 0:
        return 0.0
    return float(min(values.max(), PEAK * np.quantile(values, 0.75)))
