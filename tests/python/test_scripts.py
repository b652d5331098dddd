"""The commands that draw; decks and their generators; the list of public decks."""

import re
import runpy
import shutil
import subprocess
import sys
import urllib.error
from pathlib import Path
from unittest.mock import patch

import matplotlib.image
import matplotlib.pyplot as plt
import pytest
from compare import differences
from conftest import ROOT, Job
from decks import (
    BAR,
    BLOCK,
    BULLET,
    CANTILEVERS,
    COLUMN,
    CORNERS,
    DISCS,
    IMPACT,
    PILE,
    RINGS,
    SHAPES,
    WEDGES,
    shortened,
)
from lab import public_decks
from rescale import Units, rescale
from stickslip import program
from stickslip.deck import Deck


PACKAGE = ROOT / "python" / "stickslip" / "__main__.py"
"""The commands of the package."""


def script(path: Path, *arguments: object) -> None:
    """Runs a Python file as from the command line, in this process; it has to succeed."""
    with patch.object(sys, "argv", [str(path), *map(str, arguments)]):
        with pytest.raises(SystemExit) as ended:
            runpy.run_path(str(path), run_name="__main__")
    plt.close("all")
    assert not ended.value.code


def assert_picture(path: Path) -> None:
    """The picture is there and not blank."""
    pixels = matplotlib.image.imread(path)
    assert min(pixels.shape[:2]) > 200
    assert pixels.std() > 0.01


@pytest.fixture
def result(job: Job) -> Path:
    """A result with contact."""
    return job(shortened(CANTILEVERS / "A_mu04.inp", 300))


def test_plot_history(result: Path, tmp_path: Path) -> None:
    script(PACKAGE, "plot", "history", result, result, "-o", tmp_path / "history.png")
    assert_picture(tmp_path / "history.png")
    names = ["--x", "nodes/UPPER_TIP/U:2", "--y", "energy/strain", "energy/kinetic"]
    script(PACKAGE, "plot", "history", result, *names, "-o", tmp_path / "named.png")
    assert_picture(tmp_path / "named.png")


def test_plot_motion_draws_rigid_surfaces(job: Job, tmp_path: Path) -> None:
    path = job(Deck.read(ROOT / "tests/decks/rigid_floor.inp"))
    for option in ("--forces", "--overlay"):
        script(PACKAGE, "plot", "motion", path, option, "-o", tmp_path / "motion.png")
        assert_picture(tmp_path / "motion.png")


@pytest.mark.parametrize(
    "options",
    [["--field", "speed", "--times", 0, 3], ["--overlay", "--interval", 1.5], ["--forces"]],
    ids=["panels", "overlay", "forces"],
)
def test_plot_motion(result: Path, tmp_path: Path, options: list[object]) -> None:
    script(PACKAGE, "plot", "motion", result, *options, "-o", tmp_path / "motion.png")
    assert_picture(tmp_path / "motion.png")


def test_an_animation_is_all_that_is_written(job: Job, tmp_path: Path) -> None:
    made = job(shortened(CANTILEVERS / "A_mu04.inp", 40), "--frames", "4")
    result = Path(shutil.copy(made, tmp_path / "JOB.vtkhdf"))
    film = tmp_path / "motion.gif"
    script(PACKAGE, "plot", "motion", result, "--animation", film)
    assert film.read_bytes()[:6] == b"GIF89a"
    assert {path.name for path in tmp_path.iterdir()} == {"JOB.vtkhdf", "motion.gif"}


@pytest.mark.parametrize(
    "folder",
    [
        BLOCK,
        CANTILEVERS,
        BAR,
        RINGS,
        PILE,
        COLUMN,
        CORNERS,
        BULLET,
        SHAPES,
        IMPACT,
        DISCS,
        WEDGES,
    ],
    ids=lambda path: path.name,
)
def test_decks_are_what_their_generator_writes(folder: Path, tmp_path: Path) -> None:
    generate = [sys.executable, str(folder / "generate.py"), "-o", str(tmp_path)]
    subprocess.run(generate, check=True)
    written = {path.name: path.read_text() for path in tmp_path.iterdir()}
    committed = {path.name for path in folder.iterdir() if path.suffix in (".inp", ".inc")}
    assert set(written) == committed
    for name, text in written.items():
        assert (folder / name).read_text() == text, name


def test_no_two_decks_write_the_same_files() -> None:
    """A job is named after its deck, and all results go to one folder by default."""
    decks = [path for place in ("input", "verification") for path in ROOT.glob(f"{place}/*/*.inp")]
    places: dict[str, list[str]] = {}
    for path in decks:
        places.setdefault(path.stem.lower(), []).append(str(path.relative_to(ROOT)))
    assert len(decks) > 20
    assert {job: paths for job, paths in places.items() if len(paths) > 1} == {}


def test_a_flattened_deck_is_the_same_deck(job: Job, tmp_path: Path) -> None:
    flat = Deck.read(BAR / "em_impulse.inp")
    assert not flat.find("INCLUDE")
    original = program.run(BAR / "em_impulse.inp", tmp_path).path
    assert differences(original, job(flat)) == []


def test_rescaling_there_and_back_gives_the_same_deck() -> None:
    deck = Deck.read(BLOCK / "block_slope_mu02.inp")
    there = rescale(deck, Units(4.0, 0.5, 8.0))
    assert there.text() != deck.text()
    back = rescale(there, Units(0.25, 2.0, 0.125))
    numbers = [[card.rows for card in deck.cards] for deck in (rescale(deck, Units()), back)]
    assert numbers[0] == numbers[1]


def test_the_list_of_public_decks_has_places_and_judgements() -> None:
    listed = public_decks.read_list()
    assert len(listed) >= 60 and len({one.repository for one in listed}) >= 20
    assert len({one.deck for one in listed}) == len({one.url() for one in listed}) == len(listed)
    for one in listed:
        assert re.fullmatch(r"[0-9a-f]{40}", one.commit) and one.path.endswith(".inp"), one
        assert one.text in ("whole", "mesh", "mesh, head")
        assert one.reason or one.cause == public_decks.NONE, one


def listed_deck(deck: str, cause: str) -> public_decks.Listed:
    place = ("owner/decks", "0" * 40, f"a folder/{deck}")
    return public_decks.Listed(deck, *place, "whole", cause, "")


def test_public_decks_are_judged(tmp_path: Path) -> None:
    """A deck that the program reads and one with a user element, each with a right and a wrong cause."""
    square = (ROOT / "tests/decks/square.inp").read_text()
    user = square.replace("*STEP", "*USER ELEMENT, TYPE=U1\n*STEP")
    (tmp_path / "good.inp").write_text(square)
    (tmp_path / "user.inp").write_text(user)
    found = {
        (name, cause): public_decks.tried(program.binary(), listed_deck(name, cause), tmp_path)
        for name in ("good.inp", "user.inp")
        for cause in ("none", "user code")
    }
    assert {key: one.judgement() for key, one in found.items()} == {
        ("good.inp", "none"): "read",
        ("good.inp", "user code"): "read against the list",
        ("user.inp", "none"): "refused wrongly",
        ("user.inp", "user code"): "refused rightly",
    }
    assert found["good.inp", "none"].run == "runs"
    assert (found["user.inp", "none"].code, found["user.inp", "none"].run) == ("D201", "")
    shown = [("good.inp", "none"), ("user.inp", "user code"), ("user.inp", "none")]
    outcomes = [found[key] for key in shown]
    listed = [one.listed for one in outcomes]
    text = public_decks.report(listed, outcomes, {"far.inp": "no network"})
    assert "3 of 3 listed decks of 1 repositories, 1 not fetched" in text
    assert "physics of 2 decks: 1 of these pass `check`, and 1 of them run" in text
    assert "| none: the program has the physics | 2 | 1 | 0 | 0 | 1 | 0 |" in text
    assert "| user code | 1 | 0 | 0 | 1 | 0 | 0 |" in text
    assert "| owner/decks/a folder/user.inp | D201 \\*USER ELEMENT cannot be used |" in text


def test_public_decks_that_cannot_be_fetched_are_told(tmp_path: Path) -> None:
    listed = [listed_deck("here.inp", "none"), listed_deck("far.inp", "none")]
    (tmp_path / "here.inp").write_text("*HEADING\n")
    asked = []

    def refuse(url: str, timeout: float) -> None:
        assert timeout > 0
        asked.append(url)
        raise urllib.error.URLError("no network")

    with patch("urllib.request.urlopen", refuse):
        failed = public_decks.fetch(listed, tmp_path)
    place = "https://raw.githubusercontent.com/owner/decks/" + "0" * 40
    assert asked == [f"{place}/a%20folder/far.inp"]
    assert list(failed) == ["far.inp"] and "no network" in failed["far.inp"]
    assert [path.name for path in tmp_path.iterdir()] == ["here.inp"]
