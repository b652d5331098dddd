"""Common style of all figures."""

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from cycler import cycler
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from PIL import Image

from stickslip.errors import Fault, one_line
from stickslip.whole import whole

MOST_PIXELS = 1e8
"""Larger pictures are refused: they would need gigabytes of memory."""

COLOURS = ("#0b559f", "#d1495b", "#2e8b57", "#e08e0b", "#6a4c93", "#5c6b73", "#17a2b8")
ACCOUNTS = (*COLOURS[:4], "#9acd32", "#c38d5a", "#222222", *COLOURS[4:])
"""Colours of the accounts of the energy ledger."""


def colours(count: int) -> list[str]:
    """`count` different colours: the standard colours of figures, or colours of a colour map if more colours are
    needed."""
    if count <= len(COLOURS):
        return list(COLOURS[:count])
    return [
        to_hex(colour) for colour in matplotlib.colormaps["turbo"](np.linspace(0.04, 0.96, count))
    ]


LOOK: dict[Any, Any] = {
    "figure.dpi": 110,
    "savefig.dpi": 160,
    "figure.constrained_layout.use": True,
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=COLOURS),
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.fontsize": 8,
}
"""Parameters of matplotlib in which figures are drawn; those of the user stay as they are."""

styled = matplotlib.rc_context(LOOK)
"""Decorator of functions that draw or write figures."""


@styled
def subplots(rows: int = 1, columns: int = 1, figsize: tuple[float, float] | None = None, **options: Any) -> tuple[Figure, Any]:
    """A figure that is not registered in pyplot, and its axes, as from `pyplot.subplots`."""
    figure = Figure(figsize=figsize)
    return figure, figure.subplots(rows, columns, **options)


@styled
def save(figure: Figure, path: Path | str, dpi: float | None = None) -> Path:
    """Writes a figure and prints its path; a .png gets a palette of 256 colours, which halves the size of the file."""
    path, dpi = Path(path), dpi or float(LOOK["savefig.dpi"])
    if figure.get_size_inches().prod() * dpi**2 > MOST_PIXELS:
        raise Fault(f"{path} would have more than {MOST_PIXELS:.0e} pixels: lower --dpi")
    with whole(path) as draft:
        try:
            figure.savefig(draft, dpi=dpi)
        except ValueError as error:  # a format that does not exist, a picture that is too large
            raise Fault(f"{path} cannot be written: {one_line(error)}") from None
        if path.suffix == ".png":
            with Image.open(draft) as picture:
                small = picture.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, 3, dither=Image.Dither.NONE)
            small.save(draft, optimize=True)
    print(f"wrote {path}")
    return path
