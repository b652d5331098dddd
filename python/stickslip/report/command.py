"""Writes the page of a result: one HTML file that works offline (docs/report.md)."""

import argparse
from pathlib import Path

from stickslip.errors import Fault
from stickslip.report.collect import Choice
from stickslip.report.page import page_of
from stickslip.whole import write_text

LARGE = 60e6
"""Pages of more bytes are slow to open and to send: the command says how they become smaller."""


def arguments_of_command_line() -> argparse.Namespace:
    """Options of the command line."""
    parser = argparse.ArgumentParser(prog="stickslip report", description=__doc__)
    parser.add_argument("result", type=Path, help="result file JOB.vtkhdf")
    parser.add_argument("other", type=Path, nargs="?", help="a second result, laid over the first")
    parser.add_argument(
        "-o", "--output", type=Path, help="page to write (default: JOB.html beside the result)"
    )
    parser.add_argument(
        "--frames", type=frames, metavar="N", help="at most N frames, evenly chosen (default: all)"
    )
    parser.add_argument(
        "--fields",
        type=names,
        metavar="NAMES",
        help="fields of the frames, as MISES,V (default: all)",
    )
    return parser.parse_args()


def frames(text: str) -> int:
    """A number of frames, as a type of argparse."""
    if not text.isdigit() or int(text) < 2:
        raise argparse.ArgumentTypeError(f"{text} is no number of frames: give 2 or more")
    return int(text)


def names(text: str) -> tuple[str, ...]:
    """Names between commas, as a type of argparse."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def run() -> None:
    """Writes the page that the command line asks for."""
    arguments = arguments_of_command_line()
    paths = [each for each in (arguments.result, arguments.other) if each is not None]
    output = arguments.output or arguments.result.with_suffix(".html")
    if output.suffix.lower() not in (".html", ".htm"):
        raise Fault(f"{output}: the name of a page ends with .html")
    text = page_of(paths, Choice(arguments.fields, arguments.frames))
    write_text(output, text)
    size = len(text.encode())
    print(f"wrote {output} ({size / 1e6:.2f} MB)")
    if size > LARGE:
        print("note: the page is large; --frames and --fields make it smaller")
