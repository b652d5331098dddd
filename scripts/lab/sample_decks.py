"""The decks on which programs are compared: examples, verification cases, some of the tests."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from repository import ROOT
from stickslip.deck import Deck
from stickslip.errors import Fault

sys.path.insert(0, str(ROOT / "verification"))

import runner  # noqa: E402

SMALL = ("drop", "every_card", "rigid_floor", "steps")
"""Decks of tests/decks: supports that move, rigid surfaces, several steps, loads of all kinds."""

QUICK = (
    "tests/decks/drop",
    "tests/decks/every_card",
    "tests/decks/rigid_floor",
    "tests/decks/steps",
    "input/bouncing_rings/rings_mu02",
    "input/buckling_self_contact/column_mu02",
    "input/corner_to_corner/corners_left_mu02",
    "input/corner_to_corner/corners_right_mu02",
    "input/disc_pile/disc_pile",
    "input/fast_bullet/bullet_one",
    "input/rubber_ring/rubber_ring_mu05",
    "input/shapes_in_a_box/shapes_two",
    "input/two_cantilevers/A_mu04",
    "input/two_cantilevers/B_mu04",
    "verification/block_slope/paper_study",
    "verification/block_slope/default_study",
    "verification/contact/bullet_one_event",
    "verification/contact/rings_mu02_event",
    "verification/contact/shapes_two_event",
    "verification/elastic_bar/em_impulse",
    "verification/elastic_bar/ss22_impulse",
    "verification/two_cantilevers/default_A_mu04",
)
"""One of each kind: schemes, impulses, events, friction, corners, self-contact, general contact."""


@dataclass(frozen=True)
class Sample:
    """A deck to run."""

    name: str
    path: Path
    """The deck, or for a run of the verification the deck that is changed."""
    case: runner.Run | None = None

    def write(self, folder: Path) -> Path:
        """Writes the deck, in one file, into a folder."""
        if self.case is None:
            deck = Deck.read(self.path)
        else:
            decks = self.path.parents[len(Path(self.case.deck).parts) - 1]
            deck = self.case.changed_deck(decks, folder / "generated")
        return deck.write(folder / f"{self.path.stem}.inp")


def examples() -> list[Sample]:
    """The decks of input/."""
    return [Sample(_name(path), path) for path in sorted(ROOT.glob("input/*/*.inp"))]


def verification_cases() -> Iterator[Sample]:
    """The cases of verification/ but those that run an example as it is."""
    for folder in runner.all_folders():
        form = runner.read(folder)
        for run in form.runs:
            path = form.decks / run.deck
            if run.changes_deck or path.parent == folder:
                yield Sample(f"verification/{folder.name}/{run.name}", path, run)


def all_samples() -> list[Sample]:
    """Small decks, examples and verification cases."""
    small = [Sample(_name(path), path) for path in _small()]
    return [*small, *examples(), *verification_cases()]


def quick_samples() -> list[Sample]:
    """One of each kind, in the order of QUICK."""
    found = {sample.name: sample for sample in all_samples()}
    return [found[name] for name in QUICK]


def given(paths: list[Path]) -> list[Sample]:
    """Decks that the user names."""
    missing = [path for path in paths if not path.is_file()]
    if missing:
        raise Fault(f"there is no deck {missing[0]}")
    return [Sample(str(path.with_suffix("")), path) for path in paths]


def _small() -> Iterator[Path]:
    for name in SMALL:
        yield ROOT / "tests" / "decks" / f"{name}.inp"


def _name(path: Path) -> str:
    return str(path.relative_to(ROOT).with_suffix(""))
