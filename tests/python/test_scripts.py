"""The commands that draw; decks and their generators."""

import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from unittest.mock import patch

import matplotlib.image
import matplotlib.pyplot as plt
import pytest
from compare import differences
from conftest import COMMANDS, ROOT, Job
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
from rescale import Units, rescale
from stickslip import program
from stickslip.deck import Deck


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
    script(COMMANDS / "stickslip-plot-history", result, result, "-o", tmp_path / "history.png")
    assert_picture(tmp_path / "history.png")
    names = ["--x", "nodes/UPPER_TIP/U:2", "--y", "energy/strain", "energy/kinetic"]
    script(COMMANDS / "stickslip-plot-history", result, *names, "-o", tmp_path / "named.png")
    assert_picture(tmp_path / "named.png")


def test_plot_motion_draws_rigid_surfaces(job: Job, tmp_path: Path) -> None:
    path = job(Deck.read(ROOT / "tests/decks/rigid_floor.inp"))
    for option in ("--forces", "--overlay"):
        script(COMMANDS / "stickslip-plot-motion", path, option, "-o", tmp_path / "motion.png")
        assert_picture(tmp_path / "motion.png")


@pytest.mark.parametrize(
    "options",
    [["--field", "speed", "--times", 0, 3], ["--overlay", "--interval", 1.5], ["--forces"]],
    ids=["panels", "overlay", "forces"],
)
def test_plot_motion(result: Path, tmp_path: Path, options: list[object]) -> None:
    script(COMMANDS / "stickslip-plot-motion", result, *options, "-o", tmp_path / "motion.png")
    assert_picture(tmp_path / "motion.png")


def test_an_animation_is_all_that_is_written(job: Job, tmp_path: Path) -> None:
    made = job(shortened(CANTILEVERS / "A_mu04.inp", 40), "--frames", "4")
    result = Path(shutil.copy(made, tmp_path / "JOB.vtkhdf"))
    film = tmp_path / "motion.gif"
    script(COMMANDS / "stickslip-plot-motion", result, "--animation", film)
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
