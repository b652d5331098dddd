"""Parameter studies: their points, and clusters of Dask whose workers are killed on the way."""

import csv
import math
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from conftest import COMMAND, ROOT
from decks import CANTILEVERS
from stickslip import Deck, Fault, Result, run
from stickslip.program import binary, settings
from stickslip.sweep import Settings, latin_hypercube, product, read_points, sweep
from stickslip.__main__ import main
from stickslip.sweep.command import memory
from stickslip.sweep.engine import duration
from stickslip.sweep.plots import against, histories
from stickslip.sweep.points import Point, point_name, varied
from stickslip.sweep.quantities import Quantity

psutil = pytest.importorskip("psutil")  # comes with distributed
distributed = pytest.importorskip("distributed")

MU = varied("mu=0:0.5:11")[1]
DT = [0.015, 0.0125, 0.01]
TIP, WORK = "nodes/UPPER_TIP/U:2@min", "energy/friction_dissipation@last"
END = 1.5


@pytest.fixture
def arm() -> Deck:
    """The cantilevers with the parameters mu and dt, up to the first contacts."""
    deck = Deck.read(CANTILEVERS / "A_mu04.inp")
    deck.one("FRICTION").rows = [["<mu>"]]
    deck.one("DYNAMIC").rows = [["<dt>", repr(END)]]
    return deck


@pytest.fixture
def study(arm: Deck, tmp_path: Path) -> Path:
    """A folder of a study in which a fresh deck stands."""
    arm.write(tmp_path / "arm.inp")
    return tmp_path


def runs() -> "list[psutil.Process]":
    """The programs that solve for this process."""
    found = []
    for process in psutil.Process().children(recursive=True):
        try:
            if process.name() == binary().name[:15] and "run" in process.cmdline():
                found.append(process)
        except psutil.Error:
            continue  # it has just ended
    return found


def kill_a_run(told: list[int]) -> Callable[[str], None]:
    """Kills the program in the run of a point, when one point has ended."""

    def tell(text: str) -> None:
        for _ in range(500 * (not told and text.startswith("1 of"))):
            for process in runs():
                process.kill()
                told.append(process.pid)
                return
            time.sleep(0.01)

    return tell


def check_table(folder: Path, table: list[dict[str, str]], points: list[Point]) -> None:
    """All points have ended, in their order, with results that agree with their parameters."""
    assert [{name: float(row[name]) for name in ("mu", "dt")} for row in table] == points
    for row in table:
        assert row["exit_status"] == "0" and row["message"] == "", row
        assert row["result"].startswith(f"points/mu={float(row['mu']):g}_dt={float(row['dt']):g}/")
        with Result(folder / row["result"]) as result:
            assert result.history.time[-1] == pytest.approx(END)
            assert result.history.dt[1] == pytest.approx(float(row["dt"]))
            assert f"mu={float(row['mu'])!r}" in result.run["command"]
            assert float(row[TIP]) == result.quantity("nodes/UPPER_TIP/U:2").min()
            assert float(row[WORK]) == result.history.energy.friction_dissipation[-1]
        assert (float(row[WORK]) > 0.0) == (row["mu"] != "0.0")


def read_table(folder: Path) -> list[dict[str, str]]:
    with (folder / "table.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def ended(folder: Path) -> dict[str, float]:
    """When each point of a study has ended."""
    return {path.parent.name: path.stat().st_mtime_ns for path in folder.glob("points/*/row.json")}


@dataclass(frozen=True)
class Done:
    """A command that has ended."""

    returncode: int
    stdout: str
    stderr: str


Command = Callable[..., Done]


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Command:
    """The command `stickslip sweep`, run in this process."""

    def call(*words: object) -> Done:
        monkeypatch.setattr(sys, "argv", ["stickslip", "sweep", *map(str, words)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Done(int(ended.value.code or 0), *capfd.readouterr())

    return call


@pytest.fixture(scope="module")
def here() -> Iterator[str]:
    """Address of a scheduler in this process, with one worker: it starts faster than processes."""
    look = {"dashboard_address": ":0", "silence_logs": "CRITICAL"}
    with distributed.LocalCluster(1, 1, processes=False, **look) as cluster:
        yield cluster.scheduler_address


def test_a_study_is_whole_though_a_run_is_killed(arm: Deck, tmp_path: Path) -> None:
    """On this machine: the killed point is run again the next time, and once all are there none is."""
    points = product({"mu": MU[:3], "dt": DT[:2]})
    killed: list[int] = []
    settings = Settings(workers=2, options=("--frames", "2"), tell=kill_a_run(killed))
    table = sweep(arm, points, tmp_path, [TIP, WORK], settings)
    assert len(killed) == 1 and table.failed == 1
    assert sorted(table.column("exit_status")) == [-signal.SIGKILL] + 5 * [0]
    texts: list[str] = []
    settings = replace(settings, tell=texts.append)
    table = sweep(arm, points, tmp_path, [TIP, WORK], settings)
    assert texts == ["6 points, 5 have ended before", "1 points, 0 failed"]
    table.write(tmp_path)
    assert table.failed == 0
    assert len(list(tmp_path.glob("points/*"))) == 6
    check_table(tmp_path, read_table(tmp_path), points)
    first = ended(tmp_path)
    assert len(first) == 6
    again = sweep(arm, points, tmp_path, [TIP, WORK], settings)
    assert texts[2:] == ["6 points, 6 have ended before"]
    assert ended(tmp_path) == first and again == table
    # another parameter more: only what is new is run
    more = [*points[:3], {"mu": 0.7, "dt": 0.015}]
    sweep(arm, more, tmp_path, [TIP], settings)
    assert texts[3] == "4 points, 3 have ended before" and len(ended(tmp_path)) == 7


def test_on_this_machine_nothing_listens_and_runs_end_with_the_study(
    arm: Deck, tmp_path: Path
) -> None:
    arm.one("DYNAMIC").rows = [["<dt>", "1000."]]
    seen: list[psutil.Process] = []

    def interrupt(*_: object) -> None:
        seen[:] = runs()
        if len(seen) < 2:
            signal.alarm(1)
            return
        ours = psutil.Process().net_connections()
        assert not [one for one in ours if one.status == psutil.CONN_LISTEN]
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(1)
    try:
        with pytest.raises(KeyboardInterrupt):
            sweep(arm, product({"mu": MU[:3], "dt": DT[:1]}), tmp_path, settings=Settings(workers=2))
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    assert not psutil.wait_procs(seen, timeout=20)[1]


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler and two workers as processes of their own: its address, and the workers."""
    file = tmp_path / "scheduler.json"
    dask = [sys.executable, "-m", "dask"]
    names = ["--scheduler-file", str(file)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    start = [*dask, "scheduler", *names, "--port", "0", "--no-dashboard", "--host", "127.0.0.1"]
    processes = [subprocess.Popen(start, **quiet)]
    work = [*dask, "worker", *names, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    processes += [subprocess.Popen(work, cwd=tmp_path, **quiet) for _ in range(2)]
    end = time.monotonic() + 60.0
    address = None
    while address is None and time.monotonic() < end:
        time.sleep(0.05)
        if file.exists():
            address = re.search(r'"address": "([^"]+)"', file.read_text())
    assert address is not None
    yield address[1], processes[1:]
    for process in processes:
        process.kill()
        process.wait()


def test_a_scheduler_of_its_own_loses_a_worker(
    study: Path, command: Command, cluster: tuple[str, list[subprocess.Popen[bytes]]]
) -> None:
    """The same study by command on two workers, one of which is killed; with table and pictures."""
    address, workers = cluster
    words = ["--vary", "mu=0:0.5:11", "--vary", "dt=0.015,0.0125,0.01", "-q", TIP, "-q", WORK]
    line = [study / "arm.inp", *words, "--frames", 2, "-o", study / "out"]
    line += ["--scheduler", address]
    running = subprocess.Popen(
        [*COMMAND, "sweep", *map(str, line)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert running.stderr is not None
    said = []
    for text in running.stderr:
        said.append(text)
        if text.startswith("3 of"):
            workers[0].send_signal(signal.SIGKILL)
    assert running.wait() == 0, said
    assert workers[0].wait() == -signal.SIGKILL
    assert any(re.fullmatch(r"20 of 33 points, 0 failed, .* left\n", text) for text in said)
    check_table(study / "out", read_table(study / "out"), product({"mu": MU, "dt": DT}))
    pictures = {path.name for path in study.glob("out/plots/*.png")}
    assert {"nodes_UPPER_TIP_U_2.png", "energy_friction_dissipation@last_against_mu.png"} < pictures
    first = ended(study / "out")
    done = command(*line)
    assert done.returncode == 0 and done.stderr == "33 points, 33 have ended before\n"
    assert ended(study / "out") == first
    parquet = pytest.importorskip("pyarrow.parquet").read_table(study / "out" / "table.parquet")
    assert parquet["mu"].to_pylist() == [mu for mu in MU for _ in DT]
    assert parquet[WORK].to_pylist() == [float(row[WORK]) for row in read_table(study / "out")]


def test_a_failing_point_is_a_row_with_its_message(
    study: Path, here: str, command: Command
) -> None:
    (study / "points.csv").write_text("mu, dt\n0.1, 0.015\n-1, 0.015\n0.2, 0.5\n")
    line = [study / "arm.inp", "--points", study / "points.csv", "-q", TIP, "-o", study]
    done = command(*line, "--scheduler", here, "--no-plots")
    assert done.returncode == 1
    good, rejected, coarse = read_table(study)
    assert good["exit_status"] == "0" and good["message"] == ""
    assert rejected["exit_status"] == "2" and "error[" in rejected["message"]
    assert math.isnan(float(rejected[TIP])) and rejected["result"] == ""
    assert "mu = -1.0, dt = 0.015: error[" in done.stdout
    assert coarse["exit_status"] in ("0", "1")
    # too little memory is no property of the point: it is run again when it has enough
    small = [study / "arm.inp", "--vary", "mu=0.3", "--vary", "dt=0.015", "-q", TIP, "-o", study]
    done = command(*small, "--scheduler", here, "--no-plots", "--memory", "20MB")
    assert done.returncode == 1 and read_table(study)[0]["exit_status"] not in ("0", "1", "2")
    done = command(*small, "--scheduler", here, "--no-plots", "--memory", "8GB")
    assert done.returncode == 0 and read_table(study)[0]["exit_status"] == "0"


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ([], "what shall vary?"),
        (["--vary", "mu"], "NAME=VALUES is needed"),
        (["--vary", "mu=0:1"], "FROM:TO:COUNT"),
        (["--vary", "mu=0,1", "--vary", "mu=2"], "--vary names mu twice"),
        (["--vary", "mu=0:1:2"], "there is no parameter dt"),
        (
            ["--vary", "mu=0", "--vary", "dt=0.1", "--vary", "e=1"],
            "the deck has no parameter e",
        ),
        (["--vary", "mu=0:1:2", "--latin-hypercube", "3"], "a Latin hypercube needs FROM:TO"),
        (["--vary", "mu=0", "--vary", "dt=0.1", "-q", "energy/kinetic@least"], "one of last, min"),
        (["--vary", "mu=0,,1", "--vary", "dt=0.1"], "mu: a value is missing"),
        (["--vary", "mu=0,nan", "--vary", "dt=0.1"], "mu: nan is no number"),
        (["--vary", "mu=0", "--vary", "dt=0.1", "-q", "energy/heat"], "no history energy/heat"),
        (["--vary", "mu=0", "--vary", "dt=0.1", "-q", "nodes/UPPER_TIP/U"], "say which component"),
        (["--points", "no.csv"], "No such file"),
        (["--vary", "mu=0", "--vary", "dt=0.1", "--colour", "e"], "the parameters are mu, dt"),
    ],
)
def test_a_wrong_command_is_told_before_anything_runs(
    study: Path, command: Command, words: list[str], text: str
) -> None:
    done = command(study / "arm.inp", *words, "-o", study / "out")
    assert done.returncode == 2 and text in done.stderr, done.stderr
    assert not (study / "out").exists()


def test_deck_and_points_are_not_replaced_by_files_of_the_study(
    study: Path, command: Command
) -> None:
    text = (study / "arm.inp").read_text()
    (study / "deck.inp").write_text(f"** mine\n{text}")
    (study / "table.csv").write_text("mu,dt\n0.1,0.1\n")
    for line in (
        [study / "deck.inp", "--vary", "mu=0.1", "--vary", "dt=0.1"],
        [study / "arm.inp", "--points", study / "table.csv"],
    ):
        done = command(*line, "-o", study)
        assert done.returncode == 2 and "the name of a file of the study" in done.stderr
    assert (study / "deck.inp").read_text().startswith("** mine")
    assert (study / "table.csv").read_text() == "mu,dt\n0.1,0.1\n"


def test_points(tmp_path: Path) -> None:
    assert varied("mu=0:0.5:3") == ("mu", [0.0, 0.25, 0.5])
    assert varied("mesh=a.inc,b.inc") == ("mesh", ["a.inc", "b.inc"])
    assert product({"a": [1.0, 2.0], "b": [3.0]}) == [{"a": 1.0, "b": 3.0}, {"a": 2.0, "b": 3.0}]
    (tmp_path / "p.csv").write_text("mu,name\n0.1,x\n0.2\n")
    with pytest.raises(Fault, match="p.csv:3: as many values"):
        read_points(tmp_path / "p.csv")
    (tmp_path / "p.csv").write_text("mu,name\n0.1,x\n")
    assert read_points(tmp_path / "p.csv") == [{"mu": 0.1, "name": "x"}]
    # a column has numbers, or texts as they stand: 1E1 is no other name for 10.0
    (tmp_path / "p.csv").write_text("mu,name\n1,1E1\n.5d0,x\n")
    assert read_points(tmp_path / "p.csv") == [{"mu": 1.0, "name": "1E1"}, {"mu": 0.5, "name": "x"}]
    assert varied("name=1E1,x") == ("name", ["1E1", "x"])
    for text, fault in (
        ('mu\n"0,3"\n0.3\n', "p.csv:2: mu: 0,3 has a comma"),
        ("mu,mu\n0.1,0.5\n", "p.csv:1: mu is named twice"),
        ("mu,name\n0.1,\n", "p.csv:2: name: a value is missing"),
    ):
        (tmp_path / "p.csv").write_text(text)
        with pytest.raises(Fault, match=fault):
            read_points(tmp_path / "p.csv")
    with pytest.raises(Fault, match="mu: 0,3 has a comma"):
        sweep("none.inp", [{"mu": "0,3"}], tmp_path)
    with pytest.raises(Fault, match="values of e, the first one of mu"):
        sweep("none.inp", [{"mu": 0.3}, {"e": 0.3}], tmp_path)
    with pytest.raises(Fault, match="a column seconds of its own"):
        sweep("none.inp", [{"seconds": 0.3}], tmp_path)
    assert memory("2GB") == 2 * memory("1000MB") == 2_000_000_000
    assert [duration(s) for s in (4.6, 61.0, 7300.0)] == ["5 s", "1 min 1 s", "2 h 1 min"]


def test_a_latin_hypercube_has_one_point_in_each_stripe() -> None:
    points = latin_hypercube({"mu": (0.0, 0.5), "e": (-2.0, 8.0)}, 20, seed=3)
    for name, low, width in (("mu", 0.0, 0.5), ("e", -2.0, 10.0)):
        stripes = [int(20 * (point[name] - low) / width) for point in points]
        assert sorted(stripes) == list(range(20)) != stripes
    assert points == latin_hypercube({"mu": (0.0, 0.5), "e": (-2.0, 8.0)}, 20, seed=3)
    assert points != latin_hypercube({"mu": (0.0, 0.5), "e": (-2.0, 8.0)}, 20, seed=4)


def test_names_without_value_and_values_without_name_are_told_before_the_first_run(
    study: Path, tmp_path: Path
) -> None:
    deck = Deck.read(study / "arm.inp")
    for values, message in (
        ({"mu": 0.1}, "there is no parameter dt"),
        ({"mu": 0.1, "dt": 0.1, "nu": 1.0}, "the deck has no parameter nu"),
    ):
        with pytest.raises(Fault, match=message):
            sweep(deck, [values], tmp_path)
    assert settings({"mu": 1.0 / 3.0, "n": 2, "name": "A"}) == [
        "--set",
        "mu=0.3333333333333333",
        "--set",
        "n=2",
        "--set",
        "name='A'",
    ]


def test_names_of_files_are_parameters(arm: Deck, tmp_path: Path) -> None:
    """Values mix numbers and texts; files are looked for beside the deck, and what is in them counts."""
    deck = tmp_path / "decks" / "arm.inp"
    arm.one("DYNAMIC").rows = [["0.1", "0.2"]]
    text = arm.text().replace("*FRICTION\n<mu>\n", "*INCLUDE, INPUT=<law>\n", 1)
    deck.parent.mkdir()
    deck.write_text(text)
    for name, mu in (("1E1", 0.1), ("hi.inc", 0.9)):
        (deck.parent / name).write_text(f"*FRICTION\n{mu}\n")
    points = product({"law": varied("law=1E1,hi.inc")[1]})
    table = sweep(deck, points, tmp_path / "out", [WORK])
    assert table.failed == 0 and table.column("law") == ["1E1", "hi.inc"]
    table.write(tmp_path)
    for row, mu in zip(table.rows, (0.1, 0.9)):
        with Result(table.folder / row["result"]) as result:
            (contact,) = result.file["model/contacts"].values()
            assert contact["friction"][0] == mu
    texts: list[str] = []
    (deck.parent / "hi.inc").write_text("*FRICTION\n0.8\n")
    sweep(deck, points, tmp_path / "out", [WORK], Settings(tell=texts.append))
    assert texts[0] == "2 points, 1 have ended before"
    with pytest.raises(FileNotFoundError):
        sweep(deck, [{"law": "none.inc"}], tmp_path / "other", [WORK])
    assert not (tmp_path / "other").exists()
    with run(Deck.read(deck), tmp_path / "one", parameters={"law": "hi.inc"}) as result:
        (contact,) = result.file["model/contacts"].values()
        assert contact["friction"][0] == 0.8


def frictions(folder: Path) -> dict[str, float]:
    """The friction of each point of a study, from its result."""
    found = {}
    for path in folder.glob("points/*/*.vtkhdf"):
        with Result(path) as result:
            (contact,) = result.file["model/contacts"].values()
            found[path.parent.name] = float(contact["friction"][0])
    return found


def test_a_value_takes_the_place_of_that_of_the_deck(arm: Deck, tmp_path: Path) -> None:
    """Zero too, and in parameters that are computed from the varied one."""
    arm.one("DYNAMIC").rows = [["0.1", "0.2"]]
    text = arm.text()
    for name, cards, row in (
        ("own", "mu = 0.2\n", "<mu>"),
        ("derived", "mu = 0.2\nm = 2*mu\n", "<m>"),
    ):
        deck = tmp_path / f"{name}.inp"
        deck.write_text(f"*PARAMETER\n{cards}" + text.replace("*FRICTION\n<mu>", f"*FRICTION\n{row}"))
        table = sweep(deck, product({"mu": varied("mu=0,0.4")[1]}), tmp_path / name, [WORK])
        assert table.failed == 0
        times = 2.0 if name == "derived" else 1.0
        assert frictions(tmp_path / name) == {"mu=0": 0.0, "mu=0.4": 0.4 * times}
    # a parameter that stands nowhere in the deck would vary nothing
    deck.write_text("*PARAMETER\nmu = 0.2\n" + text.replace("<mu>", "0.2"))
    with pytest.raises(Fault, match="nothing uses the parameter mu"):
        sweep(deck, [{"mu": 0.0}], tmp_path / "unused", [WORK])


def test_points_have_the_names_of_their_values(arm: Deck, tmp_path: Path) -> None:
    assert point_name({"mu": 0.0, "n": 3, "file": "a/b c.inc"}).startswith("mu=0_n=3_file=a-b-c.inc-")
    assert point_name({"mu": 0.1, "dt": 1.0 / 3.0}) == "mu=0.1_dt=0.3333333333333333"
    names = {point_name({"file": text}) for text in ("a/b", "a-b", "a b", "ä" * 300, "ä" * 301)}
    assert len(names) == 5 and max(map(len, names)) < 120
    assert varied("mu=0:0.3:4")[1] == [0.0, 0.1, 0.2, 0.3]
    arm.one("DYNAMIC").rows = [["<dt>", "0.2"]]
    points = product({"mu": [0.1], "dt": [0.1]})
    sweep(arm, points, tmp_path, [WORK])
    # the folder of mu=0.1 begins like those of mu=0 and mu=0.1_dt=0.15, which leave it alone
    sweep(arm, product({"mu": [0.0, 0.1], "dt": [0.15]}), tmp_path, [WORK])
    assert len(list(tmp_path.glob("points/*"))) == len(ended(tmp_path)) == 3
    # another deck has the same names: its results take the place of the old ones
    arm.one("DYNAMIC").rows = [["<dt>", "0.3"]]
    texts: list[str] = []
    table = sweep(arm, points, tmp_path, [WORK], Settings(tell=texts.append))
    assert texts[0] == "1 points, 0 have ended before"
    with Result(table.folder / table.rows[0]["result"]) as result:
        assert result.history.time[-1] == pytest.approx(0.3)


def test_quantities_are_checked_though_the_first_point_fails(arm: Deck, tmp_path: Path) -> None:
    points = product({"mu": [-1.0, 0.1], "dt": [0.015]})
    with pytest.raises(Fault, match="no history energy/heat"):
        sweep(arm, points, tmp_path, ["energy/heat"])
    assert not ended(tmp_path)


def test_tables_are_small_and_may_be_moved(arm: Deck, tmp_path: Path) -> None:
    """A cell is a number or one line; a study that has been moved has the same pictures."""
    arm.one("DYNAMIC").rows = [["<dt>", "0.2"]]
    points = product({"mu": [-1.0, *MU[:7]], "dt": [0.1, 0.05]})
    table = sweep(arm, points, tmp_path / "study", [WORK])
    assert all("\n" not in str(value) for row in table.rows for value in row.values())
    assert table.failed == 2
    with Result(table.folder / table.rows[2]["result"]) as result:
        assert table.rows[2]["warnings"] == len(result.warnings) > 0
    assert table.rows[0]["message"].startswith("error[")
    text = table.write(tmp_path / "study")[0].read_text()
    (tmp_path / "study").rename(tmp_path / "moved")
    assert str(tmp_path) not in text and len(text) < 150 * len(points)
    moved = replace(table, folder=tmp_path / "moved")
    figure = histories(moved, Quantity.parse(WORK), "dt")
    lines = figure.axes[0].lines
    colours = {line.get_label().partition("dt = ")[2]: line.get_color() for line in lines}
    assert len(lines) == 14 and len(set(map(str, colours.values()))) == 2
    assert figure.axes[1].get_ylabel() == "dt"  # the scale, in the place of a long legend
    number = against(moved, Quantity.parse(WORK), "mu", ["dt"], "dt")
    assert [tuple(line.get_color()) for line in number.axes[0].lines] == [
        tuple(colours[text]) for text in ("0.1", "0.05")
    ]


def test_what_is_taken_of_a_history(study: Path) -> None:
    with run(
        Deck.read(study / "arm.inp"), study, parameters={"mu": 0.1, "dt": 0.1}
    ) as result:
        tip = result.history.nodes["UPPER_TIP"].U[:, :, 1].mean(axis=1)
        for word, value in (("min", tip.min()), ("peak", np.abs(tip).max()), ("last", tip[-1])):
            assert Quantity.parse(f"nodes/UPPER_TIP/U:2@{word}").of(result) == value
        with pytest.raises(Fault, match="say which component"):
            Quantity.parse("nodes/UPPER_TIP/U").of(result)


def examples(language: str) -> list[str]:
    """Blocks of a language in docs/sweeps.md."""
    text = (ROOT / "docs" / "sweeps.md").read_text()
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


@pytest.fixture
def shorter(study: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The deck of docs/sweeps.md, with fewer increments, in the current folder."""
    deck = Deck.read(study / "arm.inp")
    deck.one("DYNAMIC").rows = [["0.1", repr(END)]]
    deck.write(study / "arm.inp")
    monkeypatch.chdir(study)
    return study


def test_the_example_of_optuna(shorter: Path) -> None:
    pytest.importorskip("optuna").logging.set_verbosity(30)
    (code,) = [text for text in examples("python") if "optuna" in text]
    names: dict[str, object] = {}
    exec(code, names)
    assert len(list(shorter.glob("optuna/*.vtkhdf"))) == 10
    assert names["study"].best_value == min(trial.value for trial in names["study"].trials)


def test_the_example_of_snakemake(shorter: Path) -> None:
    pytest.importorskip("snakemake")
    (code,) = examples("snakemake")
    (shorter / "Snakefile").write_text(code)
    line = [sys.executable, "-m", "snakemake", "--cores", "1", "--quiet", "all"]
    done = subprocess.run(line, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    results = sorted(shorter.glob("snakemake/*.vtkhdf"))
    assert [path.stem for path in results] == ["0.0", "0.2", "0.4"]
    with Result(results[1]) as result:
        (contact,) = result.file["model/contacts"].values()
        assert contact["friction"][0] == 0.2


def test_the_commands_of_the_document(shorter: Path, here: str, command: Command) -> None:
    """Every command that needs no cluster of one's own runs as it stands."""
    lines = [line for block in examples("sh") for line in block.splitlines()]
    ours = [line for line in lines if line.startswith("stickslip sweep ") and "ADDRESS" not in line]
    assert len(ours) > 2
    (shorter / "points.csv").write_text("mu\n0.1\n0.3\n")
    for line in ours:
        done = command(*line.replace(":11", ":2").split()[2:], "--scheduler", here)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
