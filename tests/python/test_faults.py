"""What the user of a script can mend is told in one line."""

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import COMMAND, Job
from decks import CANTILEVERS, shortened
from stickslip import command, program
from stickslip.command import FAULT
from stickslip.errors import Fault
from stickslip.penetration import intrusion as penetration
from stickslip.plot import history as plot_history
from stickslip.plot import motion as plot_motion
from stickslip.result import Result

MAINS = {
    "stickslip plot motion": plot_motion.run,
    "stickslip plot history": plot_history.run,
    "stickslip penetration": penetration.run,
}

Run = Callable[..., tuple[int, str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """`run(script, *arguments)` runs a script's command line: its exit code and its errors."""

    def call(script: str, *arguments: object) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", [script, *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            command.finish(MAINS[script])
        return int(ended.value.code or 0), capsys.readouterr().err

    return call


@pytest.fixture
def result(job: Job, tmp_path: Path) -> Path:
    """A result that may be changed."""
    made = job(shortened(CANTILEVERS / "A_mu04.inp", 40), "--frames", "4")
    return Path(shutil.copy(made, tmp_path / "JOB.vtkhdf"))


def info(path: Path) -> list[str]:
    """What the program tells of a result."""
    words = [program.binary(), "info", path]
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def missing(path: Path) -> str:
    path.unlink()
    return "there is no file"


def folder(path: Path) -> str:
    path.unlink()
    path.mkdir()
    return "a folder"


def text(path: Path) -> str:
    path.write_text("# stickslip status file, format 1\n")
    return "no HDF5 file"


def truncated(path: Path) -> str:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    return "cut short"


def foreign(path: Path) -> str:
    with h5py.File(path, "w") as file:
        file["x"] = [1.0]
    return "no result of stickslip"


def damaged(path: Path) -> str:
    with h5py.File(path, "r+") as file:
        del file["VTKHDF/PointData/U"], file["history/energy/kinetic"]
    return "has no"


@pytest.mark.parametrize("spoil", [missing, folder, text, truncated, foreign, damaged])
@pytest.mark.parametrize("script", MAINS)
def test_a_file_that_cannot_be_read(
    script: str, spoil: Callable[[Path], str], result: Path, run: Run
) -> None:
    words = spoil(result)
    code, errors = run(script, result)
    assert code == FAULT
    assert errors.startswith(f"{script}: error: ") and errors.count("\n") == 1
    assert words in errors and str(result) in errors


@pytest.mark.parametrize("script", ["stickslip plot motion", "stickslip penetration"])
def test_a_file_without_frames(script: str, result: Path, run: Run) -> None:
    with h5py.File(result, "r+") as file:
        file["VTKHDF/Steps/Values"].resize(0, axis=0)
    code, errors = run(script, result)
    assert (code, errors.count("\n")) == (FAULT, 1)
    assert "no frame yet" in errors


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1e200])
@pytest.mark.parametrize("script", ["stickslip plot motion", "stickslip penetration"])
def test_positions_that_are_no_numbers(script: str, value: float, result: Path, run: Run) -> None:
    """A node nowhere is not a node outside of all bodies."""
    with h5py.File(result, "r+") as file:
        file["VTKHDF/PointData/U"][-1] = value
    code, errors = run(script, result)
    assert (code, errors.count("\n")) == (FAULT, 1)
    assert "frame 4 has positions that are no numbers or huge" in errors


@pytest.mark.parametrize("account", ["kinetic", "strain", "normal_contact_work"])
def test_the_largest_energy_drops_no_nan(account: str, result: Path) -> None:
    with h5py.File(result, "r+") as file:
        file[f"history/energy/{account}"][3] = float("nan")
    with Result(result) as results:
        assert np.isnan(results.history.energy.largest)


def test_a_file_without_history(result: Path, run: Run) -> None:
    with h5py.File(result, "r+") as file:
        file["history/energy/kinetic"].resize(0, axis=0)
    assert run("stickslip plot history", result) == (
        FAULT,
        f"stickslip plot history: error: {result} has no history yet\n",
    )


def test_a_running_job_is_looked_at(result: Path) -> None:
    """The file is locked by who writes it, which is not this process for the scripts."""
    with h5py.File(result, "r+") as file:
        file.flush()
        for name in MAINS:
            words = [*COMMAND, *name.split()[1:], str(result)]
            done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True)
            assert (done.returncode, done.stderr) == (0, ""), name


def test_rows_and_frames_that_are_not_complete_are_left_out(result: Path) -> None:
    with h5py.File(result, "r+") as file:
        for name in ("history/time", "VTKHDF/Steps/Values", "VTKHDF/PointData/V"):
            file[name].resize(len(file[name]) + 1, axis=0)
    with Result(result) as results:
        assert (len(results.history.time), len(results.frames)) == (41, 5)
        assert len(results.history.energy["kinetic"]) == len(results.history.dt) == 41


def test_rows_beyond_those_that_the_file_counts_are_left_out(result: Path) -> None:
    """A kill in the middle of a write leaves rows behind the last ones that are counted."""

    def grow(_: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and item.maxshape[:1] == (None,):
            item.resize(2 * len(item) + 7, axis=0)

    with Result(result) as results:
        landings = len(results.history.impacts["time"])
    told = info(result)
    with h5py.File(result, "r+") as file:
        file.visititems(grow)
    with Result(result) as results:
        assert (len(results.history.time), len(results.frames)) == (41, 5)
        assert len(results.history.impacts["time"]) == landings
    assert info(result)[1:] == told[1:]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("film.mp4", "ffmpeg, which is not installed (Debian, Ubuntu: apt-get install ffmpeg)"),
        ("film.mp3", "an animation is a .gif"),
    ],
)
def test_an_animation_that_cannot_be_written(
    name: str, words: str, result: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "")
    code, errors = run("stickslip plot motion", result, "--animation", result.with_name(name))
    assert (code, errors.count("\n")) == (FAULT, 1)
    assert words in errors
    assert [path.name for path in result.parent.iterdir()] == [result.name]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "picture.xyz"), "Format 'xyz' is not supported"),
        (("-o", "/dev/null/picture.png"), "/dev/null"),
        (("--dpi", "1e5"), "lower --dpi"),
        (("--interval", "1e-12"), "100 at most"),
        (("--field", "slip"), "has no field slip; there are A, CONTACT_FORCE"),
    ],
)
def test_a_picture_that_cannot_be_drawn(
    arguments: tuple[str, str], words: str, result: Path, run: Run
) -> None:
    with h5py.File(result, "r+") as file:
        for name in ("PointData/SLIP", "Steps/PointDataOffsets/SLIP"):
            file["VTKHDF"].pop(name, None)
    code, errors = run("stickslip plot motion", result, *arguments)
    assert (code, errors.count("\n")) == (FAULT, 1)
    assert words in errors


def test_a_fault_has_one_line() -> None:
    assert command.one_line(Fault("a\n  b")) == "a b"
