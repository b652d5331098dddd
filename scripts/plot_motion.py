"""Draws the motion of a result: deformed shapes at chosen times, and an animation.

Each time has a panel of its own, or, with --overlay, all shapes stand in one. Slave nodes in
contact are marked: filled where they stick, hollow where they slide. Without -o the picture goes
next to the result, as JOB_motion.png.
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import style
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure, SubFigure
from results import SLIP, STICK, Array, Results


def magnitude(name: str, results: Results, frame: int) -> Array:
    """Element means of the magnitude of a vector at the nodes."""
    length = np.linalg.norm(results.point_field(name, frame), axis=1)
    return np.array([length[cell].mean() for cell in results.cells])


def von_mises(results: Results, frame: int) -> Array:
    """Von Mises stress of the stresses in the plane."""
    xx, yy, xy = results.cell_field("S", frame).T
    return np.sqrt(xx**2 - xx * yy + yy**2 + 3 * xy**2)


def mean_stress(results: Results, frame: int) -> Array:
    """Mean of the two normal stresses in the plane."""
    return results.cell_field("S", frame)[:, :2].mean(axis=1)


FIELDS: dict[str, tuple[str, Callable[[Results, int], Array]]] = {
    "von-mises": ("von Mises stress (in the plane)", von_mises),
    "mean-stress": ("mean stress (in the plane)", mean_stress),
    "speed": ("speed", partial(magnitude, "V")),
    "displacement": ("displacement", partial(magnitude, "U")),
    "contact-force": ("contact force on a node (mean)", partial(magnitude, "CONTACT_FORCE")),
}
"""Fields that colour the elements: label, values per element."""

BACKGROUND, EDGE = "#eef1f4", "#40464d"


@dataclass(frozen=True)
class Colouring:
    """A field with its colour scale, the same for all frames; or plain bodies."""

    field: str | None
    norm: Normalize

    @classmethod
    def of(cls, results: Results, field: str | None, frames: list[int]) -> "Colouring":
        """Scale that covers the field in all given frames."""
        if field is None:
            return cls(None, Normalize())
        values = np.concatenate([FIELDS[field][1](results, frame) for frame in frames])
        low = min(0.0, float(values.min()))
        return cls(field, Normalize(low, float(values.max()) or 1.0))

    def bar(self, figure: Figure | SubFigure, axes: Axes | list[Axes]) -> None:
        """Adds the colour bar."""
        if self.field is not None:
            figure.colorbar(
                ScalarMappable(self.norm, "viridis"),
                ax=axes,
                label=FIELDS[self.field][0],
                shrink=0.8,
                pad=0.01,
            )


def draw_shape(axes: Axes, results: Results, frame: int, colouring: Colouring) -> None:
    """The deformed mesh in one frame, its outline and the nodes in contact."""
    position = results.positions(frame)
    bodies = PolyCollection([position[cell] for cell in results.cells], linewidths=0.25)
    bodies.set_edgecolor("#ffffff80" if colouring.field else "#b8c0c8")
    if colouring.field is None:
        bodies.set_facecolor(BACKGROUND)
    else:
        bodies.set(array=FIELDS[colouring.field][1](results, frame), cmap="viridis")
        bodies.set_norm(colouring.norm)
    axes.add_collection(bodies)
    axes.add_collection(LineCollection(position[results.boundary], colors=EDGE, linewidths=0.8))
    axes.add_collection(LineCollection(position[results.rigid], colors=EDGE, linewidths=1.6))
    status = results.point_field("CONTACT_STATUS", frame)
    for value, face in ((STICK, "#d1495b"), (SLIP, "white")):
        at = position[status == value]
        axes.scatter(*at.T, s=11, facecolor=face, edgecolor="#d1495b", linewidth=0.9, zorder=5)


def draw_forces(axes: Axes, results: Results, frame: int, per_length: float) -> None:
    """Contact forces on the nodes as arrows; `per_length` is the force of an arrow of length 1."""
    force = results.point_field("CONTACT_FORCE", frame)
    loaded = np.linalg.norm(force, axis=1) > 0.0
    axes.quiver(
        *results.positions(frame)[loaded].T,
        *force[loaded].T,
        angles="xy",
        scale_units="xy",
        scale=per_length,
        width=0.003,
        color="#d1495b",
        zorder=4,
    )


def force_scale(results: Results, frames: list[int]) -> float:
    """Force per length that makes the largest arrow a tenth of the picture."""
    largest = max(
        float(np.linalg.norm(results.point_field("CONTACT_FORCE", f), axis=1).max()) for f in frames
    )
    extent = float(np.ptp(results.coordinates[results.drawn], axis=0).max())
    return max(largest, 1e-300) / (0.1 * extent)


def frame_axes(axes: Axes, results: Results, frames: list[int]) -> None:
    """Limits that hold all given frames, equal scales."""
    positions = [results.positions(frame)[results.drawn] for frame in frames]
    low = np.min([p.min(axis=0) for p in positions], axis=0)
    high = np.max([p.max(axis=0) for p in positions], axis=0)
    margin = 0.03 * (high - low).max()
    axes.set(
        xlim=(low[0] - margin, high[0] + margin),
        ylim=(low[1] - margin, high[1] + margin),
        aspect="equal",
    )


def status_legend(axes: Axes) -> None:
    """What the marks mean."""
    for face, label in (("#d1495b", "stick"), ("white", "slip")):
        axes.scatter([], [], s=11, facecolor=face, edgecolor="#d1495b", linewidth=0.9, label=label)
    axes.legend(loc="best", handletextpad=0.1)


def height_over_width(results: Results) -> float:
    """Proportions of a panel that holds all frames of a result."""
    figure, axes = plt.subplots()
    frame_axes(axes, results, list(range(len(results.frame_times))))
    ratio = float(np.diff(axes.get_ylim())[0] / np.diff(axes.get_xlim())[0])
    plt.close(figure)
    return ratio


def draw_panels(
    figure: Figure | SubFigure,
    results: Results,
    frames: list[int],
    field: str | None,
    columns: int,
    forces: bool = False,
) -> None:
    """Fills a figure with one panel per frame, in reading order."""
    grid = figure.subplots(
        -(-len(frames) // columns), columns, sharex=True, sharey=True, squeeze=False
    )
    colouring = Colouring.of(results, field, frames)
    scale = force_scale(results, frames)
    for axes, frame in zip(grid.flat, frames):
        draw_shape(axes, results, frame, colouring)
        if forces:
            draw_forces(axes, results, frame, scale)
        frame_axes(axes, results, list(range(len(results.frame_times))))
        axes.set_title(f"t = {results.frame_times[frame]:.4g}")
    for axes in grid.flat[len(frames) :]:
        axes.set_visible(False)
    status_legend(grid[0, 0])
    colouring.bar(figure, list(grid.flat))


def panels(
    results: Results,
    frames: list[int],
    field: str | None,
    forces: bool,
    columns: int | None = None,
) -> Figure:
    """A figure with one panel per frame."""
    columns = columns or {4: 2, 7: 4, 8: 4}.get(len(frames), min(len(frames), 3))
    rows = -(-len(frames) // columns)
    height = 4.2 * height_over_width(results) + 0.45
    figure = plt.figure(figsize=(4.2 * columns + 1, height * rows))
    draw_panels(figure, results, frames, field, columns, forces)
    return figure


def draw_overlay(axes: Axes, results: Results, frames: list[int]) -> None:
    """All shapes in one axes, coloured by time; bodies that hardly move are drawn once, grey."""
    shades = plt.get_cmap("plasma")(np.linspace(0.0, 0.85, len(frames)))
    travel = np.max([np.linalg.norm(results.point_field("U", f), axis=1) for f in frames], axis=0)
    bodies = range(results.body.max() + 1)
    farthest = np.array([travel[results.body == body].max() for body in bodies])
    moving = (farthest > 0.01 * travel.max())[results.body]

    def draw(frame: int, select: np.ndarray, face: object, edge: object) -> None:
        position = results.positions(frame)
        cells = [position[cell] for cell in results.cells if select[cell[0]]]
        outline = position[[side for side in results.boundary if select[side[0]]]]
        axes.add_collection(PolyCollection(cells, facecolors=face, linewidths=0))
        rigid = position[[side for side in results.rigid if select[side[0]]]]
        axes.add_collection(LineCollection(outline, colors=[edge], linewidths=1.1))
        axes.add_collection(LineCollection(rigid, colors=[edge], linewidths=1.6))

    if not moving.all():
        draw(frames[0], ~moving, BACKGROUND, EDGE)
    for frame, shade in zip(frames, shades):
        draw(frame, moving, [(*shade[:3], 0.10)], shade)
        axes.plot([], [], color=shade, label=f"t = {results.frame_times[frame]:.4g}")
    axes.legend(loc="best", fontsize=7)
    frame_axes(axes, results, frames)


def overlay(results: Results, frames: list[int]) -> Figure:
    """A figure with all shapes in one axes."""
    figure, axes = plt.subplots(figsize=(9, 6))
    draw_overlay(axes, results, frames)
    axes.set_title(results.job)
    return figure


def animate(
    results: Results, field: str | None, forces: bool, path: Path, frames_per_second: int
) -> None:
    """Writes an animation of all frames."""
    frames = list(range(len(results.frame_times)))
    colouring = Colouring.of(results, field, frames)
    scale = force_scale(results, frames)
    figure, axes = plt.subplots(figsize=(8, 5.5), dpi=90)
    frame_axes(axes, results, frames)
    colouring.bar(figure, axes)
    limits = axes.get_xlim(), axes.get_ylim()

    def draw(frame: int) -> None:
        axes.clear()
        draw_shape(axes, results, frame, colouring)
        if forces:
            draw_forces(axes, results, frame, scale)
        axes.set(xlim=limits[0], ylim=limits[1], aspect="equal")
        axes.set_title(f"{results.job}   t = {results.frame_times[frame]:.4g}", loc="left")

    film = FuncAnimation(figure, draw, frames, init_func=lambda: None)
    film.save(path, writer=PillowWriter(fps=frames_per_second), dpi=90)
    plt.close(figure)
    print(f"wrote {path}")


def chosen_frames(results: Results, times: list[float] | None, interval: float | None) -> list[int]:
    """Frames nearest to the given times, each once; six of the whole run when none are given."""
    end = float(results.frame_times[-1])
    if interval:
        times = list(np.arange(0.0, end + 0.5 * interval, interval))
    elif not times:
        times = list(np.linspace(0.0, end, 6))
    return sorted({results.nearest_frame(time) for time in times})


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, help="result file JOB.vtkhdf")
    parser.add_argument("--times", type=float, nargs="+", help="times to show (nearest frames)")
    parser.add_argument("--interval", type=float, help="show 0, INTERVAL, 2 INTERVAL, ...")
    parser.add_argument("--field", choices=[*FIELDS, "none"], default="von-mises")
    parser.add_argument("--columns", type=int, help="panels side by side")
    parser.add_argument("--overlay", action="store_true", help="one panel, coloured by time")
    parser.add_argument("--forces", action="store_true", help="draw contact forces as arrows")
    parser.add_argument("-o", "--output", type=Path, help="picture to write")
    parser.add_argument("--dpi", type=float, help="pixels per inch of the picture")
    parser.add_argument("--animation", type=Path, help="animation to write (.gif)")
    parser.add_argument("--fps", type=int, default=15, help="frames per second")
    arguments = parser.parse_args()
    field = None if arguments.field == "none" else arguments.field
    with Results(arguments.result) as results:
        frames = chosen_frames(results, arguments.times, arguments.interval)
        if arguments.overlay:
            figure = overlay(results, frames)
        else:
            figure = panels(results, frames, field, arguments.forces, arguments.columns)
        path = arguments.output or arguments.result.with_name(f"{results.job}_motion.png")
        style.save(figure, path, arguments.dpi)
        if arguments.animation:
            animate(results, field, arguments.forces, arguments.animation, arguments.fps)


if __name__ == "__main__":
    main()
