"""Compares the processor time of two programs on the examples, in paired runs.

Every deck is run in the order OLD NEW NEW OLD, so that a machine that slowly changes its speed
favours neither; that is a repetition. The figures are ratios NEW/OLD of user and system time. The
exit code is 1 when NEW is slower by more than 3 % over all decks.
"""

import argparse
import tempfile
from dataclasses import dataclass, field
from math import sqrt
from pathlib import Path
from statistics import median, variance

from stickslip.command import finish, positive_integer
from stickslip.errors import Fault

from lab.measured_run import check_program, run
from lab.sample_decks import Sample, examples, given

ALLOWED = 1.03
"""Largest ratio over all decks."""

CONFIDENCE = 1.96
"""Half width of the interval of 95 % confidence in standard errors."""

ORDER = (0, 1, 1, 0)
"""OLD is 0, NEW is 1."""


@dataclass
class Times:
    """Seconds of processor time of a deck: of two runs of each program in every repetition."""

    name: str
    old: list[float] = field(default_factory=list)
    new: list[float] = field(default_factory=list)

    @property
    def ratio(self) -> float:
        """Median over the repetitions."""
        return median(new / old for old, new in zip(self.old, self.new))

    def __str__(self) -> str:
        old, new = (mean(sums) / 2.0 for sums in (self.old, self.new))
        return f"{self.ratio:8.4f} {old:9.3f} {new:9.3f}   {self.name}"


def mean(values: list[float]) -> float:
    """Mean value."""
    return sum(values) / len(values)


def measure(sample: Sample, programs: tuple[Path, Path], repeat: int) -> Times:
    """Runs a deck with both programs."""
    times = Times(sample.name)
    with tempfile.TemporaryDirectory(prefix="paired_cpu_") as name:
        folder = Path(name)
        deck = sample.write(folder)
        for _ in range(repeat):
            sums = [0.0, 0.0]
            for which in ORDER:
                sums[which] += seconds(programs[which], deck, folder / "results")
            times.old.append(sums[0])
            times.new.append(sums[1])
    return times


def seconds(program: Path, deck: Path, output: Path) -> float:
    """Processor time of a run that goes to its end."""
    ended = run(program, deck, output)
    if ended.code != 0:
        raise Fault(f"{program} ends with exit code {ended.code} on {deck.name}: {ended.complaint}")
    return ended.seconds


def overall(decks: list[Times]) -> tuple[float, float]:
    """Ratio of the sums over all decks, and the half width of its interval of 95 % confidence.

        R = sum_d N_d / sum_d O_d
        s^2 = sum_d var(n_d - R o_d) / r / (sum_d O_d)^2

    N_d, O_d are the means of the r repetitions n_d, o_d of deck d; s is the standard error of a
    ratio of sums over strata (Cochran, Sampling Techniques, 3rd ed., section 6.10).
    """
    old = sum(mean(deck.old) for deck in decks)
    ratio = sum(mean(deck.new) for deck in decks) / old
    spread = 0.0
    for deck in decks:
        rests = [new - ratio * old_ for old_, new in zip(deck.old, deck.new)]
        spread += variance(rests) / len(rests)
    return ratio, CONFIDENCE * sqrt(spread) / old


def verdict(ratio: float, half: float) -> str:
    """Whether NEW is slow, in words."""
    allowed = 100.0 * (ALLOWED - 1.0)
    words = "is slower than" if ratio > ALLOWED else "is within"
    surely = "" if abs(ratio - ALLOWED) > half else "; not certain: raise --repeat"
    return f"NEW {words} the {allowed:.0f} % allowed{surely}"


def at_least_two(text: str) -> int:
    """A whole number above 1, as a type of argparse."""
    number = positive_integer(text)
    if number < 2:
        raise argparse.ArgumentTypeError("at least 2 repetitions give a confidence")
    return number


def parse() -> argparse.Namespace:
    """The command line."""
    about = (__doc__ or "").split("\n")[0]
    parser = argparse.ArgumentParser(prog="paired_cpu", description=about)
    parser.add_argument("old", type=Path, metavar="OLD", help="program")
    parser.add_argument("new", type=Path, metavar="NEW", help="program to compare with it")
    parser.add_argument("decks", type=Path, nargs="*", metavar="DECK", help="instead of input/")
    help_ = "repetitions, of two runs of each program (default 3)"
    parser.add_argument("--repeat", type=at_least_two, default=3, metavar="N", help=help_)
    return parser.parse_intermixed_args()


def main() -> int:
    """Measures, prints a line for each deck and the ratio of the sums."""
    arguments = parse()
    programs = check_program(arguments.old), check_program(arguments.new)
    samples = given(arguments.decks) if arguments.decks else examples()
    print(" NEW/OLD   OLD [s]   NEW [s]   deck")
    decks = []
    for sample in samples:
        decks.append(measure(sample, programs, arguments.repeat))
        print(decks[-1], flush=True)
    ratio, half = overall(decks)
    print(f"{ratio:8.4f} +- {half:.4f} (95 %)  ratio of the sums; {verdict(ratio, half)}")
    return 1 if ratio > ALLOWED else 0


if __name__ == "__main__":
    finish(main)
