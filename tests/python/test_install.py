"""The wheel: its commands, and a run in an empty environment without a compiler.

The wheel is the newest in target/wheels, which scripts/wheel builds, or that of $STICKSLIP_WHEEL.
"""

import importlib
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import COMMANDS, ROOT
from stickslip.deck import Deck


@pytest.mark.parametrize("path", sorted(COMMANDS.iterdir()), ids=lambda path: path.name)
def test_commands_call_the_package(path: Path) -> None:
    lines = path.read_text().splitlines()
    assert lines[0] == "#!python"  # what installers put in the place of their interpreter
    module = re.fullmatch(r"from (stickslip\.[\w.]+) import main", lines[1])
    assert module and callable(importlib.import_module(module[1]).main)
    # programs that a command starts with Python may import it
    assert lines[2:] == ["", 'if __name__ == "__main__":', "    main()"]
    assert os.access(path, os.X_OK)


def test_versions_agree() -> None:
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["version"]
    for name, pattern in (
        ("CITATION.cff", rf"^version: {re.escape(cargo)}$"),
        ("CHANGELOG.md", rf"^## {re.escape(cargo)}\b"),
        ("python/packaging/conda/recipe.yaml", rf'^  version: "{re.escape(cargo)}"$'),
    ):
        assert re.search(pattern, (ROOT / name).read_text(), flags=re.MULTILINE), name


def wheel() -> Path:
    """The wheel to install; skips the test where there is none."""
    if "STICKSLIP_WHEEL" in os.environ:
        return Path(os.environ["STICKSLIP_WHEEL"])
    built = sorted(
        (ROOT / "target" / "wheels").glob("*.whl"), key=lambda path: path.stat().st_mtime
    )
    if not built:
        pytest.skip("no wheel in target/wheels: scripts/wheel builds one")
    return built[-1]


def test_a_wheel_runs_without_a_compiler(tmp_path: Path) -> None:
    built = wheel()
    place = tmp_path / "empty"
    subprocess.run([sys.executable, "-m", "venv", place], check=True, stdin=subprocess.DEVNULL)
    commands = place / "bin"
    clean = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("STICKSLIP", "PYTHON"))
    }
    with_pictures = f"{built}[plot]"
    install = [commands / "python", "-m", "pip", "install", "--quiet", with_pictures]
    subprocess.run(install, check=True, stdin=subprocess.DEVNULL, env=clean)
    clean["PATH"] = str(commands)  # no compiler, no cargo, no HDF5

    def run(*words: str) -> str:
        done = subprocess.run(
            [commands / words[0], *words[1:]],
            cwd=tmp_path,
            env=clean,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert re.match(r"stickslip \d", run("stickslip", "--version"))
    deck = ROOT / "tests" / "decks" / "rigid_floor.inp"
    run("stickslip", "run", str(deck), "-q")
    study = Deck.read(deck)
    study.one("DYNAMIC").rows[0][1] = "<period>"
    study.write(tmp_path / "study.inp")
    vary = ["--vary", "period=0.01,0.02", "-q", "energy/kinetic@max", "--workers", "2"]
    told = {
        "stickslip-certify": (["-q", "rigid_floor.vtkhdf"], "hold"),
        "stickslip-export": (["rigid_floor.vtkhdf", "--to", "csv"], "wrote rigid_floor.csv"),
        "stickslip-penetration": (["rigid_floor.vtkhdf"], ""),
        "stickslip-plot-along": (["rigid_floor.vtkhdf", "-o", "a.png"], "wrote a.png"),
        "stickslip-plot-history": (["rigid_floor.vtkhdf", "-o", "h.png"], "wrote h.png"),
        "stickslip-plot-motion": (["rigid_floor.vtkhdf", "-o", "m.png"], "wrote m.png"),
        "stickslip-report": (["rigid_floor.vtkhdf"], "wrote"),
        "stickslip-sweep": (["study.inp", *vary], "against_period.png"),
    }
    assert list(told) == [path.name for path in sorted(COMMANDS.iterdir())]
    for name, (words, text) in told.items():
        assert text in run(name, *words), name
    code = "import stickslip; print(stickslip.program.version(), stickslip.program.binary())"
    assert str(commands) in run("python", "-c", code)
