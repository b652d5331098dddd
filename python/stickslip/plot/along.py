"""Draws a field at the nodes along a line, at some times: the contact pressure along a surface.

The nodes belong to a node set (--nset), or else are all slave nodes. The curve joins the nodes along the outlines of
the bodies. If the nodes form several lines, each line has axes of its own; lines on which the field is zero at all
shown times are left out. The abscissa is the length along the line in the undeformed mesh, or, with --against, the
current x or y (r or z in bodies of revolution). Without -o the picture is written next to the result, as JOB_along.png.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure

from stickslip import command
from stickslip.arrays import Array, Integers
from stickslip.errors import Fault
from stickslip.plot import style
from stickslip.plot.fields import Field
from stickslip.plot.motion import chosen_times, shown_at
from stickslip.result import Result

MOST = 8
"""More lines of nodes than this are refused: they would find no room."""


def chains(results: Result, nodes: Integers) -> list[Integers]:
    """The given nodes as lines along the outlines, with the body on the left; closed lines end where they begin."""
    chosen = np.isin(results.boundary, nodes).all(axis=1)
    following = {int(a): int(b) for a, b in results.boundary[chosen]}
    starts = [a for a in following if a not in set(following.values())]
    found = []
    while following:
        node = starts.pop(0) if starts else next(iter(following))
        line = [node]
        while line[-1] in following:
            line.append(following.pop(line[-1]))
        found.append(np.array(line))
    return found


def abscissa(results: Result, line: Integers, frame: int, against: str) -> Array:
    """Length along the line in the undeformed mesh, or the current x or y (r or z in bodies of revolution)."""
    if against != "length":
        return results.frames[frame].positions[line, "xyrz".index(against) % 2]
    steps = np.linalg.norm(np.diff(results.coordinates[line], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


@style.styled
def draw(
    results: Result, lines: list[Integers], frames: Sequence[int], name: str, against: str
) -> Figure:
    """A figure with axes for each line and a curve for each frame."""
    size = (8.0, 0.8 + 2.6 * len(lines))
    figure, axes = style.subplots(len(lines), 1, size, squeeze=False, sharey=True)
    shown = Field(name)
    for at, line in zip(axes[:, 0], lines):
        first, last = results.node_labels[line[[0, -1]]]
        ring = f"whole outline from node {first}"
        at.set_title(ring if first == last else f"nodes {first} to {last}", loc="left")
        for frame, colour in zip(frames, style.colours(len(frames))):
            across = abscissa(results, line, frame, against)
            values = shown.values(results, frame)[line]
            time = results.frames[frame].time
            at.plot(across, values, ".-", ms=4, color=colour, label=f"t = {time:.4g}")
        at.set_ylabel(fill(results.frames.part(name).label, 32))
    axes[0, 0].legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    axes[-1, 0].set_xlabel("length along the line" if against == "length" else against)
    figure.suptitle(results.job)
    return figure


def run() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        prog="stickslip plot along",
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result", type=Path, help="result file JOB.vtkhdf")
    parser.add_argument("--field", default="CPRESS", help="a field as CPRESS, S11, U2; of elements at nodes")
    parser.add_argument("--nset", help="node set whose nodes are taken")
    parser.add_argument("--times", type=command.finite, nargs="+", help="times (nearest frames)")
    parser.add_argument("--interval", type=command.positive, help="0, INTERVAL, 2 INTERVAL...")
    parser.add_argument("--against", choices=("length", "x", "y", "r", "z"), default="length")
    parser.add_argument("-o", "--output", type=Path, help="picture to write")
    parser.add_argument("--dpi", type=command.positive, help="pixels per inch of the picture")
    arguments = parser.parse_args()
    results = Result(arguments.result)
    if arguments.nset:
        nodes = results.node_set(arguments.nset)
    else:
        nodes = np.flatnonzero(np.isfinite(results.frames[0]["SLIP"]))
    lines = chains(results, nodes)
    wanted = Field(arguments.field)
    times = chosen_times(results, arguments.times, arguments.interval, wanted)
    frames = [frame for _, frame in shown_at(results, times)]
    if not lines:
        what = f"nodes of {arguments.nset}" if arguments.nset else "slave nodes"
        raise Fault(f"{results.path}: no edge of an outline joins two {what}")
    shown = [wanted.values(results, frame) for frame in frames]
    lines = [line for line in lines if any(np.nan_to_num(v[line]).any() for v in shown)] or lines
    if len(lines) > MOST:
        raise Fault(f"the nodes make {len(lines)} lines, {MOST} at most are drawn: give --nset")
    figure = draw(results, lines, frames, arguments.field, arguments.against)
    path = arguments.output or results.path.with_name(f"{results.job}_along.png")
    style.save(figure, path, arguments.dpi)
