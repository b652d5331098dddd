"""Commands of the package: `stickslip report ...`, which the program hands over to `python -m stickslip report ...`.

Each command is a function without arguments, which reads the words of the command line from `sys.argv`.
"""

import sys
from collections.abc import Callable
from importlib import import_module

from stickslip import command
from stickslip.errors import Fault

COMMANDS = {
    "certify": "stickslip.certificate.command",
    "export": "stickslip.export",
    "penetration": "stickslip.penetration.intrusion",
    "plot along": "stickslip.plot.along",
    "plot history": "stickslip.plot.history",
    "plot motion": "stickslip.plot.motion",
    "report": "stickslip.report.command",
    "sweep": "stickslip.sweep.command",
}
"""Modules of the commands; the function is `run`."""


def chosen(words: list[str]) -> tuple[str, list[str]]:
    """Splits words into the command that they begin with and the other words."""
    for count in (1, 2):
        name = " ".join(words[:count])
        if name in COMMANDS:
            return name, words[count:]
    raise Fault(f"{' '.join(words[:2]) or 'nothing'} is none of the commands {', '.join(COMMANDS)}")


def run() -> int | None:
    """Runs the command that the command line names."""
    name, words = chosen(sys.argv[1:])
    sys.argv = [f"stickslip {name}", *words]
    begin: Callable[[], int | None] = import_module(COMMANDS[name]).run
    return begin()


def main() -> None:
    """Runs a command; an error that the user can correct is written as one line."""
    sys.argv[0] = "stickslip"
    command.finish(run)


if __name__ == "__main__":
    main()
