"""Paths, and the fixture that runs decks once per session."""

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
COMMAND = [sys.executable, "-m", "stickslip"]
"""What the words of a command of the package follow."""

sys.path[:0] = [str(ROOT / "python"), str(ROOT / "scripts"), str(ROOT / "tests")]
# of the scripts that tests start
os.environ["PYTHONPATH"] = os.pathsep.join([str(ROOT / "python"), str(ROOT / "scripts")])

from stickslip import program  # noqa: E402
from stickslip.deck import Deck  # noqa: E402

Job = Callable[..., Path]


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of the tests."""
    help_ = "run the rescaled decks of input/ to their ends, edit a deck of a million nodes"
    parser.addoption("--full", action="store_true", help=help_)


@pytest.fixture(scope="session")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    """`job(deck, *options)` runs a deck and returns the result file; equal calls run once.

    `again=N` asks for a run of its own.
    """
    folder = tmp_path_factory.mktemp("jobs")
    done: dict[tuple[str, ...], Path] = {}

    def run(deck: Deck, *options: str, again: int = 0) -> Path:
        text = deck.text()
        key = (text, *options, str(again))
        if key not in done:
            name = hashlib.sha256(text.encode()).hexdigest()[:12]
            path = deck.write(folder / f"{name}.inp")
            done[key] = program.run(path, folder / str(len(done)), *options).path
        return done[key]

    return run
