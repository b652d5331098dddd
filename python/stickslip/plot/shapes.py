"""Draws one frame of a result: deformed bodies, rigid surfaces, nodes in contact, arrows."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.tri import Triangulation

from stickslip.arrays import Array, Flags, Integers
from stickslip.fields import words
from stickslip.plot.fields import COLOURS, Colouring, Shown, on_lines
from stickslip.result import SLIP, STICK, Result

BACKGROUND, EDGE, MARK, ARROW, UNDEFORMED = "#eef1f4", "#40464d", "#d1495b", "#111111", "#8a94a0"

MESH_LINE = 0.25
"""Widest lines of the mesh in points."""

POINTS_PER_INCH = 72.0

AROUND = 4.0
"""Corners of rigid surfaces farther from the bodies, in sizes of these, are not shown."""

CROWD = 40
"""At most so many arrows of a field that is everywhere stand side by side."""


@dataclass(frozen=True)
class Arrows:
    """A vector field with one scale for everything that is shown."""

    name: str
    largest: float
    per_length: float
    """Magnitude of an arrow of the length 1."""
    spacing: float
    """Arrows of a field that is everywhere are about so far apart."""

    @classmethod
    def of(cls, name: str, shown: Sequence[Shown]) -> "Arrows":
        """Scale that makes the largest arrow a tenth of the picture."""
        largest = max(
            float(np.linalg.norm(results.frames[frame][name], axis=1).max())
            for results, frame in shown
        )
        low, high = limits(shown)
        extent = float((high - low).max()) or 1.0
        return cls(name, largest, (largest or 1.0) / (0.1 * extent), extent / CROWD)

    def draw(self, axes: Axes, results: Result, frame: int) -> None:
        """The arrows of a frame; forces have arrows at all nodes where they act."""
        vector = results.frames[frame][self.name]
        position = results.frames[frame].positions
        nodes = results.drawn[np.linalg.norm(vector[results.drawn], axis=1) > 0.0]
        if self.name in ("U", "V", "A"):
            nodes = self._thinned(nodes, position)
        axes.quiver(
            *position[nodes].T,
            *vector[nodes].T,
            angles="xy",
            scale_units="xy",
            scale=self.per_length,
            units="inches",
            width=0.013,
            color=ARROW,
            zorder=6,
        )

    def tips(self, results: Result, frame: int) -> Array:
        """Ends of the arrows [nodes, 2]."""
        vector = results.frames[frame][self.name][results.drawn]
        return results.frames[frame].positions[results.drawn] + vector / self.per_length

    def _thinned(self, nodes: Integers, position: Array) -> Integers:
        """One node from each square of a lattice."""
        squares = np.floor(position[nodes] / self.spacing).astype(np.int64)
        return nodes[np.unique(squares, axis=0, return_index=True)[1]]

    def legend(self) -> list[Artist]:
        """Description of the arrows for the legend."""
        label = f"{words(self.name)},\nlongest {self.largest:.3g}"
        look: dict[str, Any] = {"color": ARROW, "marker": r"$\rightarrow$", "markersize": 11, "linestyle": "none"}
        return [Line2D([], [], label=label, **look)]


def draw_shape(
    axes: Axes, results: Result, frame: int, colouring: Colouring | None, undeformed: bool = False
) -> None:
    """The deformed mesh in one frame, its outline and the nodes in contact."""
    drawing = results.drawing
    at = drawing.positions(results.frames[frame].positions)
    bodies = PolyCollection([at[ring] for ring in drawing.rings], zorder=1.2)
    bodies.set_linewidth(mesh_line(axes, results))
    bodies.set_edgecolor("#ffffff80" if colouring else "#b8c0c8")
    bodies.set_facecolor(BACKGROUND)
    axes.add_collection(bodies)
    axes.add_collection(LineCollection(list(at[drawing.outline]), colors=EDGE, linewidths=0.8))
    if undeformed:
        before = drawing.positions(results.coordinates)[drawing.outline]
        axes.add_collection(LineCollection(list(before), colors=UNDEFORMED, linewidths=0.8, linestyles="--"))
    on_edges = colouring is not None and colouring.field.on_outlines(results)
    if colouring is not None:
        draw_field(axes, results, frame, colouring, at, bodies)
    rigid = results.frames[frame].positions[results.rigid]
    axes.add_collection(LineCollection(list(rigid), colors=EDGE, linewidths=1.6))
    if on_edges:
        return  # marks of the nodes would cover the coloured edges
    status = results.frames[frame]["CONTACT_STATUS"]
    position = results.frames[frame].positions
    for value, face in ((STICK, MARK), (SLIP, "white")):
        touching = position[status == value]
        axes.scatter(touching[:, 0], touching[:, 1], s=11, facecolor=face, edgecolor=MARK, linewidth=0.9, zorder=5)


def draw_field(
    axes: Axes, results: Result, frame: int, colouring: Colouring, at: Array, bodies: PolyCollection
) -> None:
    """Draws the field in its colours, and a mark where the field is largest; `at` holds the positions of the
    vertices."""
    drawing, field = results.drawing, colouring.field
    values = field.values(results, frame)
    look: dict[str, Any] = {"cmap": COLOURS, "norm": colouring.norm}
    if field.on_outlines(results):
        along = on_lines(results, values)
        there = np.isfinite(along) & (along != 0.0)
        lines = LineCollection(list(at[drawing.outline[there]]), linewidths=3.0, zorder=3, array=along[there], **look)
        axes.add_collection(lines)
    elif not field.of_nodes(results):
        bodies.set(array=values, **look)
    else:
        bodies.set_facecolor("none")
        triangles, (x, y) = drawing.triangles, drawing.with_middles(at).T
        shades = drawing.with_middles(drawing.values(values))
        hidden = ~np.isfinite(shades[triangles]).all(axis=1)
        if not hidden.all():
            mesh = Triangulation(x, y, triangles, hidden)
            axes.tricontourf(mesh, np.nan_to_num(shades), colouring.levels, extend="both", zorder=1.1, **look)
    peak = colouring.peak
    if peak is not None and (peak.results, peak.frame) == (results, frame):
        place = at[peak.place] if field.of_nodes(results) else at[drawing.rings[peak.place]].mean(axis=0)
        # with an edge, to be read on any colour
        drawn: dict[str, Any] = {"zorder": 7, "path_effects": [withStroke(linewidth=2.0, foreground="white")]}
        axes.scatter(place[0], place[1], s=22, marker="o", facecolor="none", edgecolor=ARROW, linewidth=0.9, **drawn)
        axes.annotate(f"{peak.value:.4g}", place, (4, 5), textcoords="offset points", fontsize=7, **drawn)


def mesh_line(axes: Axes, results: Result) -> float:
    """Width of the lines of the mesh in points: at most a thirtieth of an edge; if such lines are too thin, no lines
    are drawn.

    Thicker lines in a fine mesh would hide the colours of the elements.
    """
    left, right = axes.get_xlim()
    figure = cast(Figure, axes.figure)
    across = axes.get_position().width * figure.get_size_inches()[0] * POINTS_PER_INCH
    edge = results.edge_length * across / ((right - left) or 1.0)
    return float(min(MESH_LINE, edge / 30.0)) if edge > 3.0 else 0.0


def status_legend(shown: Sequence[Shown]) -> list[Artist]:
    """Legend entries for the marks that occur."""
    found = {
        int(value)
        for results, frame in shown
        for value in np.unique(results.frames[frame]["CONTACT_STATUS"])
    }
    look: dict[str, Any] = {"marker": "o", "markersize": 3.6, "markeredgecolor": MARK, "linestyle": "none"}
    return [
        Line2D([], [], markerfacecolor=face, label=label, **look)
        for value, face, label in ((STICK, MARK, "stick"), (SLIP, "white", "slip"))
        if value in found
    ]


def limits(shown: Sequence[Shown], arrows: Arrows | None = None) -> tuple[Array, Array]:
    """Lower left and upper right corner of the box that holds the deformable bodies (all surfaces if there are no such
    bodies), with a margin.

    The box includes corners of rigid surfaces that are at most AROUND times the size of the box away.
    """
    bodies = [one.in_cells if one.cells else np.unique(one.rigid) for one, _ in shown]
    positions = [one.frames[frame].positions[nodes] for nodes, (one, frame) in zip(bodies, shown, strict=True)]
    if arrows is not None:
        positions += [arrows.tips(*each) for each in shown]
    low = np.min([place.min(axis=0) for place in positions], axis=0)
    high = np.max([place.max(axis=0) for place in positions], axis=0)
    around = AROUND * float((high - low).max())
    for results, frame in shown:
        corner = results.frames[frame].positions[np.unique(results.rigid)]
        near = ((corner > low - around) & (corner < high + around)).all(axis=1)
        positions.append(corner[near])
    low = np.min([place.min(axis=0, initial=np.inf) for place in positions], axis=0)
    high = np.max([place.max(axis=0, initial=-np.inf) for place in positions], axis=0)
    margin = 0.03 * float((high - low).max()) or 1.0
    return low - margin, high + margin


def draw_overlay(axes: Axes, shown: Sequence[Shown], shades: Sequence[Array]) -> None:
    """Draws frames of one result in one pair of axes, each in its own shade.

    Bodies that hardly move are drawn once, grey.
    """
    results = shown[0][0]
    travel = [np.linalg.norm(results.frames[frame]["U"], axis=1) for _, frame in shown]
    way = np.max(travel, axis=0)
    bodies = range(results.body.max() + 1)
    farthest = np.array([way[results.body == body].max() for body in bodies])
    moving = (farthest > 0.01 * way.max())[results.body]

    drawing = results.drawing

    def draw(frame: int, select: Flags, face: object, edge: object) -> None:
        position = results.frames[frame].positions
        at, seen = drawing.positions(position), drawing.values(select.astype(np.float64)) > 0.5
        cells = [at[ring] for ring in drawing.rings if seen[ring[0]]]
        outline = at[drawing.outline[seen[drawing.outline[:, 0]]]]
        rigid = position[[side for side in results.rigid if select[side[0]]]]
        axes.add_collection(PolyCollection(cells, facecolors=face, linewidths=0))
        axes.add_collection(LineCollection(list(outline), colors=[edge], linewidths=1.1))
        axes.add_collection(LineCollection(list(rigid), colors=[edge], linewidths=1.6))

    if not moving.all():
        draw(shown[0][1], ~moving, BACKGROUND, EDGE)
    for (_, frame), shade in zip(shown, shades):
        draw(frame, moving, [(*shade[:3], 0.10)], shade)
