"""Command lines of the scripts: an error that the user can correct is written as one line, without a traceback."""

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from stickslip.errors import Fault, not_installed, one_line

FAULT = 2
"""Exit code after a fault; argparse's own."""


def finish(main: Callable[[], int | None]) -> NoReturn:
    """Runs the `main` of a script and exits with its code; after an error, writes one line and exits with FAULT."""
    try:
        code = main() or 0
        sys.stdout.flush()
    except Fault as fault:
        complain(one_line(fault))
        code = FAULT
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package in ("", "stickslip"):
            raise
        complain(str(not_installed(package)))
        code = FAULT
    except BrokenPipeError:
        sys.stderr.close()  # the reader of the output has gone: nobody to tell
        code = FAULT
    except OSError as error:
        text = f"{error.filename}: {error.strerror}" if error.filename else one_line(error)
        complain(text)
        code = FAULT
    except KeyboardInterrupt:
        code = 130
    sys.exit(code)


def complain(text: str) -> None:
    """Writes an error with the name of the command."""
    print(f"{Path(sys.argv[0]).name}: error: {text}", file=sys.stderr)


def finite(text: str) -> float:
    """A finite number, as a type of argparse."""
    number = float(text)
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text} is not finite")
    return number


def positive(text: str) -> float:
    """A finite number above zero, as a type of argparse."""
    number = finite(text)
    if number <= 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


def positive_integer(text: str) -> int:
    """A whole number above zero, as a type of argparse."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


def numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    """`count` finite numbers between commas, as a type of argparse."""

    def parse(text: str) -> tuple[float, ...]:
        values = tuple(finite(part) for part in text.split(","))
        if len(values) != count:
            raise argparse.ArgumentTypeError(f"{text} is not {count} numbers between commas")
        return values

    parse.__name__ = f"{count} numbers"
    return parse
