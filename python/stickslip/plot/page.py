"""Pages of panels that fill the paper: all panels show the same box, and legends stand beside the panels."""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from stickslip.arrays import Array
from stickslip.plot.fields import COLOURS

WIDTH, HEIGHT = 11.0, 7.7
"""Largest page that is filled; one with very many panels is higher."""
LEFT, RIGHT, TOP, BOTTOM = 0.33, 0.1, 0.05, 0.42
"""Margins for titles of the axes and tick labels, the width of those on the left apart."""
TITLE, ROW_GAP, COLUMN_GAP = 0.22, 0.08, 0.18
"""Room for a panel's title, and between panels."""
BAR, LOW_BAR = 0.95, 0.7
"""Width of a colour bar beside the panels; height of one below low pages."""
CHARACTER, LINE = 0.068, 0.18
"""Width of a character and height of a line of the legends."""
LEAST_BESIDE = 3.2
"""Pages lower than this have their legends below."""
TICKS = 8
"""At most so many ticks on an axis."""
LEAST = 0.9
"""Least size of a panel's longer side."""

# All lengths in inches of paper.


@dataclass(frozen=True)
class Grid:
    """Rows and columns of panels of one size."""

    rows: int
    columns: int
    width: float
    """Width and height of a panel, without its title."""
    height: float

    @classmethod
    def fitted(cls, rows: int, columns: int, ratio: float, beside: float) -> "Grid":
        """The largest panels with a given ratio of height to width that fit on a page.

        `beside` is the width of the space on the left and right of the panels.
        """
        across = WIDTH - beside - COLUMN_GAP * (columns - 1)
        up = HEIGHT - TOP - BOTTOM - TITLE * rows - ROW_GAP * (rows - 1)
        width = max(min(across / columns, up / rows / ratio), LEAST / max(ratio, 1.0))
        return cls(rows, columns, width, width * ratio)

    @classmethod
    def best(cls, count: int, ratio: float, beside: float) -> "Grid":
        """The arrangement of some panels that makes them largest, with few places left empty."""
        grids = [cls.fitted(-(-count // n), n, ratio, beside) for n in range(1, count + 1)]
        return max(grids, key=lambda grid: grid.width * count / (grid.rows * grid.columns))

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of all panels with their titles."""
        return (
            self.columns * self.width + COLUMN_GAP * (self.columns - 1),
            self.rows * (self.height + TITLE) + ROW_GAP * (self.rows - 1),
        )

    def corner(self, row: int, column: int) -> tuple[float, float]:
        """Lower left corner of a panel, relative to the lower left corner of the first panel in the last row."""
        above = self.rows - 1 - row
        return column * (self.width + COLUMN_GAP), above * (self.height + TITLE + ROW_GAP)


@dataclass(frozen=True)
class Legends:
    """Legend entries and the colour bar beside the panels."""

    entries: Sequence[Artist] = ()
    norm: Normalize | None = None
    """Scale of the colour bar."""
    label: str = ""
    """Title of the colour bar."""
    extend: str = "neither"
    """Ends of the colour bar that have values beyond them."""

    def __bool__(self) -> bool:
        return bool(self.entries) or self.norm is not None

    @property
    def lines(self) -> list[str]:
        """Lines of text of the labels of the entries."""
        labels = [str(entry.get_label()) for entry in self.entries]
        return [line for label in labels for line in label.split("\n")]

    @property
    def width(self) -> float:
        """Space that legend entries and colour bar need beside the panels."""
        bar = BAR if self.norm is not None else 0.0
        return max(bar, self.column if self.entries else 0.0)

    @property
    def column(self) -> float:
        """Width of a column of legend entries."""
        return 0.45 + CHARACTER * max(map(len, self.lines))

    @property
    def columns(self) -> int:
        """Number of columns of entries below the panels, beside the colour bar if there is one."""
        if self.norm is not None:
            return -(-len(self.lines) // 3)
        return max(1, min(len(self.entries), int((WIDTH - 1.0) / self.column)))

    @property
    def height(self) -> float:
        """Space that legend entries and colour bar need below the panels."""
        if self.norm is not None or not self.entries:
            return LOW_BAR if self else 0.0
        return 0.1 + LINE * -(-len(self.lines) // self.columns)


def longest_tick(low: float, high: float) -> int:
    """Number of characters of the longest tick label of an axis, for any number of ticks."""
    formatter = ScalarFormatter(useMathText=False)
    formatter.create_dummy_axis()
    labels = []
    for bins in range(1, TICKS + 1):
        labels += formatter.format_ticks(list(MaxNLocator(bins).tick_values(low, high)))
    return max(map(len, labels))


class Page:
    """Makes a figure with a grid of panels, which all show the box between two corners."""

    def __init__(
        self,
        places: int | tuple[int, int],
        box: tuple[Array, Array],
        legends: Legends,
        titles: Sequence[str] = ("x", "y"),
    ) -> None:
        """`places` is the number of panels, or the numbers of rows and columns; `titles` holds the titles of the
        axes."""
        self.box = box
        self.titles = titles
        across, up = box[1] - box[0]
        ratio = float(up / across)
        self.left = LEFT + CHARACTER * longest_tick(float(box[0][1]), float(box[1][1]))
        for beside in (True, False):
            strip = RIGHT + (legends.width if beside else 0.0)
            room = self.left + strip
            if isinstance(places, int):
                self.grid = Grid.best(places, ratio, room)
            else:
                self.grid = Grid.fitted(*places, ratio, room)
            if self.grid.size[1] > LEAST_BESIDE:
                break
        width, height = self.grid.size
        below = 0.0 if beside else legends.height
        self.width = self.left + width + strip
        self.height = TOP + height + BOTTOM + below
        self.bottom = BOTTOM + below
        self.figure = Figure(figsize=(self.width, self.height))
        self.figure.set_layout_engine("none")  # every place is given
        if legends and beside:
            self._beside(legends, self.left + width + 0.15)
        elif legends:
            self._below(legends)

    def panel(self, row: int, column: int, last: bool = True) -> Axes:
        """Axes of a panel; `last` says that no other panel stands below this panel."""
        x, y = self.grid.corner(row, column)
        axes = self._axes(self.left + x, self.bottom + y, self.grid.width, self.grid.height)
        self.frame(axes)
        axes.tick_params(labelleft=column == 0, labelbottom=last)
        axes.set_xlabel(self.titles[0] if last else "", labelpad=0)
        axes.set_ylabel(self.titles[1] if column == 0 else "", labelpad=2)
        return axes

    def frame(self, axes: Axes) -> None:
        """Limits of a panel."""
        low, high = self.box
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        bins = np.clip(np.array((self.grid.width, self.grid.height)) / 0.45, 1, TICKS).astype(int)
        axes.locator_params(axis="x", nbins=bins[0])
        axes.locator_params(axis="y", nbins=bins[1])

    def _axes(self, x: float, y: float, width: float, height: float) -> Axes:
        size = np.array((self.width, self.height, self.width, self.height))
        return self.figure.add_axes(tuple(np.array((x, y, width, height)) / size))

    def _beside(self, legends: Legends, left: float) -> None:
        """Draws the legend entries, and the colour bar below these."""
        top = self.height - TOP - TITLE
        if legends.entries:
            self._list(legends.entries, (left / self.width, top / self.height), 1)
            top -= LINE * len(legends.lines) + 0.2
        if legends.norm is not None:
            height = top - self.bottom
            self.figure.colorbar(
                ScalarMappable(legends.norm, COLOURS),
                self._axes(left, self.bottom, 0.2, height),
                label=fill(legends.label, round(height / CHARACTER)),
                extend=legends.extend,
            )

    def _below(self, legends: Legends) -> None:
        """Draws the colour bar, and the legend entries to the right of the bar."""
        left = self.left
        if legends.norm is not None:
            axes = self._axes(left, 0.4, 0.55 * self.width, 0.15)
            self.figure.colorbar(
                ScalarMappable(legends.norm, COLOURS),
                axes,
                label=legends.label,
                orientation="horizontal",
                extend=legends.extend,
            )
            left += 0.55 * self.width + 0.3
        top = legends.height - 0.1
        self._list(legends.entries, (left / self.width, top / self.height), legends.columns)

    def _list(self, entries: Sequence[Artist], place: tuple[float, float], columns: int) -> None:
        """Draws legend entries with their upper left corner at a place."""
        if entries:
            self.figure.legend(
                handles=entries,
                loc="upper left",
                bbox_to_anchor=place,
                borderaxespad=0.0,
                borderpad=0.0,
                handletextpad=0.4,
                ncols=columns,
            )
