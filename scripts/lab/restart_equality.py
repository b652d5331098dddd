"""Stops and kills runs at random times, goes on with `--resume`, and compares the results.

They must be the same bits as those of a run that was never stopped: all datasets and attributes
outside /run, and the status file (docs/restart.md).

    scripts/lab/run restart_equality                   five stops and five kills of five decks
    scripts/lab/run restart_equality --count 1 DECK    once each, of this deck
"""

import argparse
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from repository import ROOT
from stickslip.program import binary

PERIODS = {
    "input/two_cantilevers/A_mu04.inp": None,
    "input/disc_pile/disc_pile.inp": 0.3,
    "tests/decks/beam_lands_with_events.inp": None,
    "input/bouncing_discs/discs_redistributed.inp": 1.0,
    "input/rubber_ring/rubber_ring_mu05.inp": None,
}
"""Decks with the time at which their step shall end, if it is not that of the deck."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)

CHECKPOINTS = "0.02"
"""Seconds between two checkpoints."""

THREADS = ("1", "2")

LINE = re.compile(r"(?im)^(\*DYNAMIC[^\n]*\n[^,\n]*,)[^,\n]*")


@dataclass(frozen=True)
class Job:
    """A deck, and where the results of its runs are."""

    deck: Path
    folder: Path

    def start(self, *options: str) -> subprocess.Popen[bytes]:
        """Starts the program."""
        command = [binary(), "run", self.deck, "-q", "-o", self.folder, *options]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def finish(self, *options: str) -> float:
        """Runs the program to its end; returns the seconds that it takes."""
        begin = time.perf_counter()
        process = self.start(*options)
        _, message = process.communicate()
        if process.returncode != 0:
            what = f"{self.deck.name} {' '.join(options)}: exit code {process.returncode}"
            sys.exit(f"{what}\n{message.decode()}")
        return time.perf_counter() - begin

    def file(self, extension: str) -> Path:
        """A file of the results."""
        return self.folder / f"{self.deck.stem}.{extension}"


def contents(path: Path) -> dict[str, object]:
    """All datasets and attributes outside /run: bytes, by their names."""
    found: dict[str, object] = {}

    def visit(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if name.split("/")[0] == "run":
            return
        for key, value in item.attrs.items():
            is_array = isinstance(value, np.generic | np.ndarray)
            found[f"{name}@{key}"] = value.tobytes() if is_array else value
        if isinstance(item, h5py.Dataset):
            found[name] = (item.shape, item.dtype.str, item[()].tobytes())

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


def differences(one: Job, other: Job) -> list[str]:
    """Names of what is not the same bits."""
    a, b = contents(one.file("vtkhdf")), contents(other.file("vtkhdf"))
    differing = sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
    if one.file("sta").read_bytes() != other.file("sta").read_bytes():
        differing.append("status file")
    return differing


TOO_LATE = "too late"


def stopped(job: Job, after: float, how: signal.Signals) -> str:
    """Stops a run after some seconds and goes on to its end, with another number of threads.

    Returns why that was no stop.
    """
    shutil.rmtree(job.folder, ignore_errors=True)
    process = job.start("--checkpoint", CHECKPOINTS, "--threads", THREADS[0])
    time.sleep(after)
    process.send_signal(how)
    process.communicate()
    if process.returncode == 0:
        return TOO_LATE
    if not job.file("restart").exists():
        return "before the first checkpoint"
    job.finish("--resume", "--threads", THREADS[1])
    return ""


def check(deck: Path, count: int, scratch: Path, chance: random.Random) -> bool:
    """Compares `count` stops and `count` kills of a deck with its whole run."""
    whole, other = Job(deck, scratch / "whole"), Job(deck, scratch / "other")
    seconds = whole.finish()
    ways = [(chance.choice(SIGNALS), "stop") for _ in range(count)]
    ways += [(signal.SIGKILL, "kill")] * count
    is_same = True
    for how, word in ways:
        reason = "once"
        while reason:
            after = chance.uniform(0.05, 0.95) * seconds
            reason = stopped(other, after, how)
            if reason:
                # the machine may have been busier, or less busy, when the whole run was measured
                seconds *= 0.8 if reason == TOO_LATE else 1.1
        found = differences(whole, other)
        is_same &= not found
        text = "same bits" if not found else f"{len(found)} differences: {', '.join(found[:5])}"
        when = f"{word} after {after:6.2f} of {seconds:.2f} s by {how.name:8}"
        print(f"{deck.name:28} {when} {text}", flush=True)
    return is_same


def shortened(deck: Path, period: float | None, scratch: Path) -> Path:
    """A copy of a deck, and of what it includes, that ends at another time."""
    folder = scratch / "deck"
    shutil.copytree(deck.parent, folder, ignore=shutil.ignore_patterns("*.png", "*.py"))
    copy = folder / deck.name
    if period is not None:
        copy.write_text(LINE.sub(rf"\g<1> {period}", copy.read_text()))
    return copy


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    help_ = "decks (default: five of the repository)"
    parser.add_argument("decks", nargs="*", type=Path, metavar="DECK", help=help_)
    parser.add_argument("--count", type=int, default=5, help="stops and kills of each (default 5)")
    parser.add_argument("--seed", type=int, default=0, help="of the random times (default 0)")
    arguments = parser.parse_args()
    # a job in the background of a script starts with SIGINT ignored, and so would its programs
    signal.signal(signal.SIGINT, signal.default_int_handler)
    of_repository = {ROOT / name: end for name, end in PERIODS.items()}
    decks = dict.fromkeys(arguments.decks) or of_repository
    chance = random.Random(arguments.seed)
    is_same = True
    for deck, period in decks.items():
        with tempfile.TemporaryDirectory() as scratch:
            copy = shortened(deck, period, Path(scratch))
            is_same &= check(copy, arguments.count, Path(scratch), chance)
    sys.exit(0 if is_same else 1)


if __name__ == "__main__":
    main()
