"""Runs random scenes (random_scenes.py) and tabulates what happened in them.

Of each scene: increments, cutbacks, the largest gain of energy, the deepest node inside a body, the
deepest crossing of edges of bodies, the deepest corner of a rigid profile in a body, processor time,
and the message if the run has stopped. The gain is the largest rise of kinetic and strain energy
above their least value before, without external work, beside the largest account of the ledger.
SS22 does not promise that energy never rises: its gain is told, and not judged. Depths are those of
stickslip penetration in the frames. Contact keeps nodes out of bodies and profiles; it does not keep the
corners of profiles out of the edges of bodies.

The exit code is 1 when a run has stopped or gained energy.
"""

import argparse
import re
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from stickslip import Deck, command
from stickslip.penetration import intrusion as penetration
from stickslip.program import STOPPED, binary
from stickslip.result import Result

from lab.measured_run import run
from lab.random_scenes import INCREMENTS, KINDS, MATERIALS

GAIN = 1e-10
"""Gain of energy, relative to the largest account, that is not round-off."""
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")


@dataclass(frozen=True)
class Outcome:
    """What happened in a scene."""

    seed: int
    settings: str
    ended: str
    """Empty, or the message of a run that has stopped."""
    increments: int = 0
    cutbacks: int = 0
    gain: float = 0.0
    is_exact: bool = True
    """Whether the scheme promises that there is no gain."""
    depth: float = 0.0
    """Of the deepest node, in lengths of the edge; the others likewise."""
    crossing: float = 0.0
    corner: float = 0.0
    seconds: float = 0.0

    @property
    def is_good(self) -> bool:
        """Whether it went to its end, and without gain."""
        return not self.ended and (self.gain <= GAIN or not self.is_exact)

    def line(self) -> str:
        """A row of the table."""
        return (
            f"{self.seed:>6} {self.increments:>6} {self.cutbacks:>5} {self.gain:>9.1e}"
            f" {self.depth:>9.1e} {self.crossing:>9.1e} {self.corner:>9.1e} {self.seconds:>7.1f}"
            f"  {'; '.join(filter(None, [self.ended, self.settings]))}"
        )


HEADER = (
    f"{'seed':>6} {'incr':>6} {'cuts':>5} {'gain':>9} {'nodes':>9} {'edges':>9} {'rigid':>9}"
    f" {'s':>7}"
)


@dataclass(frozen=True)
class Trial:
    """How scenes are run."""

    kind: str
    material: str
    settings: tuple[str, ...] | None
    """In place of those of the scenes."""
    limit: float
    """Seconds of processor time for one scene."""
    folder: Path
    increments: int = INCREMENTS
    elements: str = "4"
    """What follows CPE or CPS in the type of the elements."""
    contact: str = "NODE TO SURFACE"
    """Discretisation of contact."""

    def deck(self, seed: int) -> tuple[str, tuple[str, ...]]:
        """The deck of a scene and its settings."""
        scene = KINDS[self.kind](seed)
        settings = scene.settings if self.settings is None else self.settings
        scene = replace(scene, settings=settings, increments=self.increments)
        text = with_elements(scene.deck(self.material), self.elements)
        return with_formulation(text, self.contact), settings

    def run(self, seed: int) -> Outcome:
        """Runs a scene."""
        text, settings = self.deck(seed)
        deck = self.folder / f"{self.kind}_{seed}.inp"
        deck.write_text(text)
        ran = run(binary(), deck, self.folder, self.limit)
        ended = _message((self.folder / f"{deck.stem}.err").read_text()) if ran.code else ""
        if ran.was_stopped:
            ended = f"not done in {self.limit:g} s"
        elif ran.code not in (0, STOPPED):
            return Outcome(seed, "; ".join(settings), f"exit code {ran.code}: {ended}")
        with Result(ran.result) as results:
            overlaps = penetration.follow(results)
            return Outcome(
                seed,
                "; ".join(settings),
                ended,
                len(results.history.time) - 1,
                int(results.run["cutbacks"]),
                gain(results),
                "SCHEME=SS22" not in settings,
                max(overlap.deepest.depth if overlap.deepest else 0.0 for overlap in overlaps),
                max(overlap.crossing for overlap in overlaps),
                max(overlap.corner.depth if overlap.corner else 0.0 for overlap in overlaps),
                ran.seconds,
            )


def with_formulation(text: str, formulation: str) -> str:
    """A deck of general contact with another discretisation."""
    inclusions = "*CONTACT INCLUSIONS, ALL EXTERIOR\n"
    return text.replace(inclusions, f"{inclusions}*CONTACT FORMULATION, TYPE={formulation}\n")


def with_elements(text: str, family: str) -> str:
    """A deck of quadrilaterals of four nodes with elements of another family, as 8R; triangles are halves of them."""
    if family == "4":
        return text
    deck = Deck.parse(text)
    places = {int(row[0]): np.array(row[1:3], float) for card in deck.find("NODE") for row in card.rows}
    (motion,) = deck.find("INITIAL CONDITIONS")
    speeds = {(int(row[0]), row[1]): float(row[2]) for row in motion.rows}
    between: dict[tuple[int, int], int] = {}
    number = 0

    def middle(a: int, b: int) -> str:
        """The node between two corners, made where it is missing."""
        return str(between.setdefault((min(a, b), max(a, b)), max(places) + 1 + len(between)))

    for card in deck.find("ELEMENT"):
        kind = card.parameters["TYPE"][:3]
        card.head = card.head.replace(f"{kind}4", f"{kind}{family}")
        rows = []
        for row in card.rows:
            corners = [int(node) for node in row[1:]]
            own = [corners] if family[0] in "48" else [corners[:3], [*corners[2:], corners[0]]]
            for one in own:
                number += 1
                after = [*one[1:], one[0]]
                more = [middle(a, b) for a, b in zip(one, after)] if family[0] in "68" else []
                rows.append([str(number), *map(str, one), *more])
        card.rows = rows
    for (a, b), node in between.items():
        place = (places[a] + places[b]) / 2.0
        deck.find("NODE")[0].rows.append([str(node), *map(repr, place.tolist())])
        for way in "12":
            ends = [speeds.get((end, way)) for end in (a, b)]
            if None not in ends:
                motion.rows.append([str(node), way, repr(sum(ends) / 2.0)])
    return deck.text()


def gain(results: Result) -> float:
    """Rise of kinetic and strain energy without external work, beside the largest account."""
    energy = results.history.energy
    total = energy["kinetic"] + energy["strain"] - energy["external_work"]
    rise = float((total - np.minimum.accumulate(total)).max())
    return rise / (results.history.energy.largest or 1.0)


def _message(text: str) -> str:
    """What a run says of its end: the line after `stopped`, or the first one."""
    lines = [line.strip() for line in ESCAPE.sub("", text).splitlines()] or [""]
    stops = [k for k, line in enumerate(lines) if line.startswith("stopped")]
    return lines[min(stops[0] + 1, len(lines) - 1)] if stops else lines[0]


def outcomes(trial: Trial, seeds: range, jobs: int) -> Iterator[Outcome]:
    """Those of all seeds, in their order."""
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(trial.run, seeds)


def summary(found: list[Outcome]) -> str:
    """A line about all scenes."""
    increments = sum(outcome.increments for outcome in found)
    cutbacks = sum(outcome.cutbacks for outcome in found)
    exact = [outcome.gain for outcome in found if outcome.is_exact]
    return (
        f"{len(found)} scenes: {sum(bool(outcome.ended) for outcome in found)} stops,"
        f" {cutbacks} cutbacks in {increments} increments,"
        f" gain {max(exact, default=0.0):.1e},"
        f" nodes {max((outcome.depth for outcome in found), default=0.0):.1e},"
        f" edges {max((outcome.crossing for outcome in found), default=0.0):.1e},"
        f" {sum(outcome.seconds for outcome in found):.0f} s"
    )


def seeds(text: str) -> range:
    """`A:B`, from A to B - 1, or one seed, as a type of argparse."""
    first, colon, last = text.partition(":")
    found = range(int(first), int(last) if colon else int(first) + 1)
    if not found or found[0] < 0:
        raise argparse.ArgumentTypeError(f"{text} has no seeds")
    return found


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kind", choices=KINDS, default="mixed", help="kind of scenes")
    parser.add_argument("--seeds", type=seeds, default=range(100), metavar="A:B")
    parser.add_argument("--material", choices=MATERIALS, default=MATERIALS[0])
    parser.add_argument(
        "--elements",
        default="4",
        choices=["3", "4", "4H", "4I", "4R", "6", "8", "8R"],
        help="family of the elements, as in CPE8R",
    )
    parser.add_argument(
        "--contact",
        default="NODE TO SURFACE",
        choices=["NODE TO SURFACE", "SURFACE TO SURFACE"],
        help="discretisation of contact",
    )
    parser.add_argument(
        "--settings", action="append", help="of *STICKSLIP for all scenes in place of their own"
    )
    parser.add_argument("--jobs", type=command.positive_integer, default=1, help="runs at a time")
    parser.add_argument(
        "--time", type=command.positive, default=120.0, help="processor seconds for one scene"
    )
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keeps decks and results")
    parser.add_argument("--deck", type=int, metavar="SEED", help="prints a deck and runs nothing")
    arguments = parser.parse_args()
    settings = None if arguments.settings is None else tuple(filter(None, arguments.settings))
    with tempfile.TemporaryDirectory() as own:
        folder = arguments.keep or Path(own)
        folder.mkdir(parents=True, exist_ok=True)
        trial = Trial(arguments.kind, arguments.material, settings, arguments.time, folder)
        trial = replace(trial, elements=arguments.elements, contact=arguments.contact)
        if arguments.deck is not None:
            print(trial.deck(arguments.deck)[0], end="")
            return 0
        print(HEADER)
        found = []
        for outcome in outcomes(trial, arguments.seeds, arguments.jobs):
            print(outcome.line(), flush=True)
            found.append(outcome)
    print(summary(found))
    return 0 if all(outcome.is_good for outcome in found) else 1


if __name__ == "__main__":
    command.finish(main)
