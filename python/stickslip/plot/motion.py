"""Draws the motion of results: deformed shapes at chosen times, or an animation.

Each time has its own panel, or, with --overlay, all times of a result share one panel. Several results are arranged
below each other, with the same limits and the same colours. Slave nodes in contact have filled marks if they stick, and
hollow marks if they slide. Without -o the picture is written next to the first result, as JOB_motion.png; --animation
alone writes no picture.
"""

import argparse
import shutil
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from stickslip import command
from stickslip.arrays import Array
from stickslip.errors import Fault
from stickslip.fields import VECTORS, directions, known
from stickslip.plot import style
from stickslip.plot.fields import Colouring, Field, Peak, Shown
from stickslip.plot.page import Legends, Page
from stickslip.plot.shapes import Arrows, draw_overlay, draw_shape, limits, status_legend
from stickslip.result import Result
from stickslip.whole import whole

MOST = 100
"""A page with more panels is refused."""

FILMS = (".mp4", ".m4v", ".mov", ".mkv", ".avi", ".webm")
"""Animations that ffmpeg writes."""

FILM_DPI = 90
"""Pixels per inch of animations."""


Box = tuple[Array, Array]
"""Lower left and upper right corner."""


@dataclass(frozen=True)
class Look:
    """Things that are drawn in addition to the shapes."""

    field: str | None = None
    """Name of the field that colours the bodies (see `stickslip.fields`)."""
    at_nodes: bool = True
    """Whether values of elements are averaged at nodes, within a body and a material."""
    undeformed: bool = False
    """Whether the outlines of the undeformed bodies are drawn."""
    vectors: str | None = None
    """Name of the vector field whose arrows are drawn."""
    ends: tuple[float, float] | None = None
    """Ends of the colour scale."""
    window: Box | None = None
    """Part of the plane that is shown."""


class Scene:
    """Frames that are drawn with common scales."""

    def __init__(self, shown: Sequence[Shown], look: Look) -> None:
        colouring = Colouring.of(Field(look.field, look.at_nodes), shown, look.ends) if look.field else None
        self.colouring = colouring
        self.undeformed = look.undeformed
        self.arrows = Arrows.of(look.vectors, shown) if look.vectors else None
        self.box = look.window or limits(shown, self.arrows)
        marked = colouring is None or not colouring.field.on_outlines(shown[0][0])
        entries = status_legend(shown) if marked else []
        entries += self.arrows.legend() if self.arrows else []
        if colouring:
            self.legends = Legends(entries, colouring.norm, colouring.label, colouring.extend)
        else:
            self.legends = Legends(entries)

    def draw(self, axes: Axes, results: Result, frame: int) -> None:
        """One frame."""
        draw_shape(axes, results, frame, self.colouring, self.undeformed)
        if self.arrows:
            self.arrows.draw(axes, results, frame)


@style.styled
def panels(rows: Sequence[Sequence[Shown]], look: Look, columns: int | None = None) -> Figure:
    """A page with a panel for each frame.

    Panels of a single row are arranged so that they fill the page best, or in `columns`; if there are several rows,
    each row begins a new line of panels.
    """
    shown = [each for row in rows for each in row]
    if len(shown) > MOST:
        raise Fault(f"{len(shown)} panels find no room on a page: {MOST} at most")
    scene = Scene(shown, look)
    columns = columns or (max(map(len, rows)) if len(rows) > 1 else None)
    if columns is None:
        page = Page(len(shown), scene.box, scene.legends, titles(shown))
        columns = page.grid.columns
    else:
        columns = min(columns, max(map(len, rows)))
        lines = sum(-(-len(row) // columns) for row in rows)
        page = Page((lines, columns), scene.box, scene.legends, titles(shown))
    line = 0
    for row in rows:
        places = [(line + i // columns, i % columns) for i in range(len(row))]
        line = places[-1][0] + 1
        for (at, column), (results, frame) in zip(places, row):
            final = line == page.grid.rows and (at + 1, column) not in places
            axes = page.panel(at, column, final)
            scene.draw(axes, results, frame)
            name = f"{results.job},  " if len(rows) > 1 and (at, column) == places[0] else ""
            axes.set_title(f"{name}t = {results.frames[frame].time:.4g}", pad=4)
    return page.figure


def titles(shown: Sequence[Shown]) -> list[str]:
    """Titles of the axes."""
    return directions(2, shown[0][0].is_axisymmetric)


def shades(count: int) -> Array:
    """Colours of times [count, 4]."""
    return colormaps["plasma"](np.linspace(0.0, 0.85, count))


def time_legend(shown: Sequence[Shown]) -> list[Line2D]:
    """The colours of the times."""
    times = [results.frames[frame].time for results, frame in shown]
    colours = shades(len(times))
    return [Line2D([], [], color=c, label=f"t = {t:.4g}") for t, c in zip(times, colours)]


@style.styled
def overlay(rows: Sequence[Sequence[Shown]], window: Box | None = None) -> Figure:
    """A page with a panel for each result, which shows all its frames."""
    legends = Legends(time_legend(max(rows, key=len)))
    box = window or limits([each for row in rows for each in row])
    page = Page(len(rows), box, legends, titles([each for row in rows for each in row]))
    columns = page.grid.columns
    for i, row in enumerate(rows):
        axes = page.panel(i // columns, i % columns, i + columns >= len(rows))
        draw_overlay(axes, row, list(shades(len(row))))
        axes.set_title(row[0][0].job, pad=4)
    return page.figure


def check_film(path: Path) -> None:
    """Raises a Fault if no animation with the given file name can be written."""
    if path.suffix == ".gif":
        return
    if path.suffix not in FILMS:
        raise Fault(f"{path}: an animation is a .gif, or with ffmpeg one of {' '.join(FILMS)}")
    if shutil.which("ffmpeg") is None:
        raise Fault(
            f"{path}: a {path.suffix} needs ffmpeg, which is not installed"
            " (Debian, Ubuntu: apt-get install ffmpeg); a .gif needs nothing"
        )


def write_film(path: Path, pictures: Iterable[Image.Image], frames_per_second: int) -> None:
    """A writer of pictures of one size, as a .gif or through ffmpeg."""
    with whole(path) as draft:
        _write_film(draft, pictures, frames_per_second)


def _write_film(path: Path, pictures: Iterable[Image.Image], frames_per_second: int) -> None:
    """Writes pictures into a file."""
    if path.suffix == ".gif":
        first, *others = pictures
        palette = first.quantize(256)
        others = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in others]
        duration = round(1000 / frames_per_second)
        palette.save(path, save_all=True, append_images=others, duration=duration, loop=0)
        return
    pictures = iter(pictures)
    first = next(pictures)
    width, height = first.size
    command_line = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command_line += ["-s", f"{width}x{height}", "-r", str(frames_per_second), "-i", "-"]
    command_line += ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", str(path)]
    with subprocess.Popen(command_line, stdin=subprocess.PIPE) as process:
        assert process.stdin is not None
        for picture in (first, *pictures):
            process.stdin.write(picture.tobytes())
        process.stdin.close()
    if process.returncode:
        raise Fault(f"ffmpeg ended with code {process.returncode}: no {path.suffix} is written")


def pictures_of(
    page: Page, grid: Sequence[Axes], scene: Scene, rows: Sequence[Sequence[Shown]]
) -> Iterator[Image.Image]:
    """A picture for each row of frames. Axes and legends are drawn only once; the bodies are drawn in each picture."""
    canvas = FigureCanvasAgg(page.figure)
    page.figure.set_dpi(FILM_DPI)
    canvas.draw()
    background = canvas.copy_from_bbox(page.figure.bbox)
    for row in rows:
        canvas.restore_region(background)
        for axes, (results, frame) in zip(grid, row):
            scene.draw(axes, results, frame)
            axes.set_title(f"{results.job},  t = {results.frames[frame].time:.4g}", pad=4)
            drawn = [*axes.collections, *axes.texts]
            for artist in sorted([*drawn, axes.title], key=lambda artist: artist.get_zorder()):
                axes.draw_artist(artist)
            for artist in drawn:
                artist.remove()
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")


@style.styled
def animate(all_results: Sequence[Result], look: Look, path: Path, frames_per_second: int) -> None:
    """Writes an animation of all frames of the first result; other results are shown at the times of these frames."""
    times = all_results[0].frames.times
    rows = [[(each, each.frames.nearest(time).index) for each in all_results] for time in times]
    scene = Scene([each for row in rows for each in row], look)
    page = Page(len(all_results), scene.box, scene.legends, titles(rows[0]))
    columns = page.grid.columns
    places = [divmod(i, columns) for i in range(len(all_results))]
    grid = [page.panel(*place, place[0] == places[-1][0]) for place in places]
    write_film(path, pictures_of(page, grid, scene, rows), frames_per_second)
    print(f"wrote {path}")


PANELS = 6
"""Times that are shown where none are asked for, unless the run has more steps."""


def chosen_times(results: Result, times: list[float] | None, interval: float | None, field: Field | None = None) -> Array:
    """The given times, or multiples of an interval, or times that represent the whole run.

    The representative times are the start, the ends of the steps and the time of the largest value of the field.
    Further times between the representative times are added, up to six times in all.
    """
    if times:
        return np.array(times)
    every = results.frames.times
    first, end = float(every[0]), float(every[-1])
    if interval is None:
        frames = {0, len(every) - 1, *step_ends(results)}
        if field and (peak := Peak.of(field, [(results, frame) for frame in range(len(every))])):
            frames.add(peak.frame)
        while len(frames) < min(PANELS, len(every)):
            away = np.abs(every[:, None] - every[sorted(frames)]).min(axis=1)
            away[list(frames)] = -1.0
            frames.add(int(away.argmax()))
        return every[sorted(frames)]
    count = (end - first) / interval
    if count > MOST:
        raise Fault(f"--interval {interval:g} asks for {count:.0f} panels: {MOST} at most")
    return first + interval * np.arange(int(count + 1e-9) + 1, dtype=np.float64)


def step_ends(results: Result) -> list[int]:
    """Frames at the ends of the steps; for more than ten steps, at the ends of some steps."""
    step, time = results.history["step"], results.history["time"]
    last = np.flatnonzero(np.diff(step, append=step[-1] + 1))
    chosen = last[:: -max(1, -(-len(last) // 10))]
    return [results.frames.nearest(float(t)).index for t in time[chosen]]


def shown_at(results: Result, times: Iterable[float]) -> list[Shown]:
    """Frames nearest to the given times, without duplicates."""
    return [(results, frame) for frame in sorted({results.frames.nearest(t).index for t in times})]


def window(text: str) -> Box:
    """Four numbers X0,X1,Y0,Y1, as a type of argparse."""
    x0, x1, y0, y1 = command.numbers(4)(text)
    if not (x0 < x1 and y0 < y1):
        raise argparse.ArgumentTypeError(f"{text} is empty: give X0,X1,Y0,Y1 with X0 < X1, Y0 < Y1")
    return np.array((x0, y0)), np.array((x1, y1))


def vector(text: str) -> str:
    """Name of a vector field, as a type of argparse."""
    if (name := known(text, VECTORS)) not in VECTORS:
        raise argparse.ArgumentTypeError(f"{text} is no vector: choose from {', '.join(VECTORS)}")
    return name


def arguments_of_command_line() -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(prog="stickslip plot motion", description=__doc__)
    parser.add_argument("result", type=Path, nargs="+", help="result files JOB.vtkhdf")
    parser.add_argument(
        "--times", type=command.finite, nargs="+", help="times to show (nearest frames)"
    )
    parser.add_argument("--interval", type=command.positive, help="show 0, INTERVAL, 2 INTERVAL..")
    parser.add_argument(
        "--field",
        default="MISES",
        metavar="NAME",
        help="what colours the bodies: a field as MISES, S11, PEEQ, U2, CPRESS, or a word as von-mises, speed; none",
    )
    parser.add_argument(
        "--values",
        choices=("nodes", "elements"),
        default="nodes",
        help="of fields of elements: averages at nodes within a body and a material, or means of elements",
    )
    parser.add_argument("--undeformed", action="store_true", help="draw the undeformed outlines")
    parser.add_argument(
        "--range", type=command.numbers(2), metavar="LOW,HIGH", help="ends of the colour scale"
    )
    parser.add_argument(
        "--window", type=window, metavar="X0,X1,Y0,Y1", help="part of the plane to show"
    )
    parser.add_argument("--vectors", type=vector, metavar="NAME", help="draw this vector field as arrows")
    parser.add_argument("--forces", action="store_true", help="the same as --vectors CONTACT_FORCE")
    parser.add_argument("--columns", type=command.positive_integer, help="panels side by side")
    parser.add_argument("--overlay", action="store_true", help="one panel, coloured by time")
    parser.add_argument("-o", "--output", type=Path, help="picture to write")
    parser.add_argument("--dpi", type=command.positive, help="pixels per inch of the picture")
    parser.add_argument("--animation", type=Path, help="animation to write (.gif, .mp4)")
    parser.add_argument(
        "--fps", type=command.positive_integer, default=15, help="frames per second"
    )
    return parser.parse_args()


def run() -> None:
    """Command line."""
    arguments = arguments_of_command_line()
    vectors = arguments.vectors or ("CONTACT_FORCE" if arguments.forces else None)
    field = None if arguments.field == "none" else arguments.field
    at_nodes = arguments.values == "nodes"
    look = Look(field, at_nodes, arguments.undeformed, vectors, arguments.range, arguments.window)
    film = arguments.animation
    if film:
        check_film(film)
    all_results = [Result(path) for path in arguments.result]
    if arguments.output or not film:
        first = all_results[0]
        times = chosen_times(first, arguments.times, arguments.interval, Field(field, at_nodes) if field else None)
        rows = [shown_at(results, times) for results in all_results]
        if arguments.overlay:
            figure = overlay(rows, arguments.window)
        else:
            figure = panels(rows, look, arguments.columns)
        path = arguments.output or first.path.with_name(f"{first.job}_motion.png")
        style.save(figure, path, arguments.dpi)
    if film:
        animate(all_results, look, film, arguments.fps)
