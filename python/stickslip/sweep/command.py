"""Runs a deck at many values of its parameters, `<name>` in its text, and tabulates the results.

    stickslip sweep arm.inp --vary mu=0:0.5:11 --vary dt=0.01,0.02 -q nodes/TIP/U:2@min -o study
    stickslip sweep arm.inp --points points.csv --scheduler tcp://head:8786 -o study
    stickslip sweep arm.inp --latin-hypercube 50 --vary mu=0:0.5 --vary E=1e3:2e3 -o study

The folder gets table.csv (and table.parquet), plots/ and points/, with a folder for each point. Points that have
already ended are not run again. The exit code is 1 when a point failed.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

from stickslip import command
from stickslip.deck import Deck
from stickslip.errors import Fault, not_installed
from stickslip.sweep.engine import DECK, Settings, sweep, told_on_screen
from stickslip.sweep.points import Point, latin_hypercube, product, ranged, read_points, varied
from stickslip.sweep.table import TABLE


def arguments_of_command_line() -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(
        prog="stickslip sweep",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("deck", type=Path, help="deck with parameters, <name> in its text")
    add(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help="FROM:TO:COUNT or values between commas; several make all combinations",
    )
    add("--points", type=Path, metavar="FILE.csv", help="a line of names, then a line per point")
    add(
        "--latin-hypercube",
        type=command.positive_integer,
        metavar="N",
        help="N points in the ranges NAME=FROM:TO of --vary",
    )
    add("--seed", type=int, default=0, help="of the Latin hypercube (default 0)")
    add(
        "-q",
        "--quantity",
        action="append",
        default=[],
        metavar="HISTORY@WHAT",
        help="number to keep, as nodes/TIP/U:2@min (last, min, max, mean, peak); default: energies",
    )
    add("-o", "--output", type=Path, default=Path("sweep"), help="folder of the study")
    add("--scheduler", metavar="ADDRESS", help="Dask scheduler, tcp://HOST:8786; default: none, runs here")
    add("--workers", type=command.positive_integer, help="runs at a time on this machine")
    add("--threads", type=command.positive_integer, default=1, help="threads of a run (default 1)")
    add("--memory", type=memory, metavar="SIZE", help="bound on the memory of a run, as 2GB")
    add("--frames", type=command.positive_integer, help="frames of each result")
    add("--again", action="store_true", help="run points that have ended before, too")
    add("--colour", metavar="NAME", help="parameter by which curves are coloured (default: the first that varies)")
    add("--no-plots", action="store_true", help="write no pictures")
    return parser.parse_args()


def memory(text: str) -> int:
    """A size in bytes, `2GB` or `512MB`, as a type of argparse."""
    for unit, size in (("KB", 1e3), ("MB", 1e6), ("GB", 1e9), ("TB", 1e12)):
        if text.upper().endswith(unit):
            return int(command.positive(text[: -len(unit)]) * size)
    return command.positive_integer(text)


def points(arguments: argparse.Namespace) -> list[Point]:
    """The points of the study that the options describe."""
    if arguments.points is not None:
        if arguments.vary or arguments.latin_hypercube:
            raise Fault("--points holds all values: it stands without --vary, --latin-hypercube")
        return read_points(arguments.points)
    if not arguments.vary:
        raise Fault("what shall vary? Give --vary NAME=FROM:TO:COUNT or --points FILE.csv")
    names = [text.partition("=")[0].strip() for text in arguments.vary]
    if twice := {name for name in names if names.count(name) > 1}:
        raise Fault(f"--vary names {', '.join(sorted(twice))} twice")
    if arguments.latin_hypercube:
        ranges = dict(map(ranged, arguments.vary))
        return latin_hypercube(ranges, arguments.latin_hypercube, arguments.seed)
    return product(dict(map(varied, arguments.vary)))


def run() -> int:
    """Command line."""
    arguments = arguments_of_command_line()
    options = ("--frames", str(arguments.frames)) if arguments.frames else ()
    settings = Settings(
        arguments.scheduler,
        arguments.threads,
        arguments.memory,
        arguments.workers,
        options,
        arguments.again,
        told_on_screen,
    )
    for path, own in ((arguments.deck, DECK), (arguments.points, TABLE)):
        if path is not None and path.resolve() == (arguments.output / own).resolve():
            raise Fault(f"{path} has the name of a file of the study: choose another folder with -o")
    deck = Deck.read(arguments.deck)
    chosen = points(arguments)
    if arguments.colour is not None and chosen and arguments.colour not in chosen[0]:
        raise Fault(f"--colour {arguments.colour}: the parameters are {', '.join(chosen[0])}")
    if not arguments.no_plots and find_spec("matplotlib") is None:
        raise Fault(f"{not_installed('matplotlib')}, or give --no-plots")
    table = sweep(deck, chosen, arguments.output, arguments.quantity, settings)
    written = table.write(arguments.output)
    if not arguments.no_plots:
        from stickslip.sweep.plots import draw_all

        written += draw_all(table, arguments.output / "plots", arguments.colour)
    print()
    for path in written:
        print(f"wrote {path}")
    for row in table.rows:
        if row["message"]:
            values = ", ".join(f"{name} = {row[name]}" for name in table.parameters)
            print(f"{values}: {row['message']}")
    return 1 if table.failed else 0
