"""What is installed: the wheel, its commands in an empty environment without a compiler, its files.

The wheel is the newest in target/wheels, which scripts/wheel builds, or that of $STICKSLIP_WHEEL. It is tried with this
Python, or with those that $STICKSLIP_PYTHONS names (scripts/install_matrix).
"""

import importlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
import stickslip
from conftest import COMMAND, ROOT
from licences import linked
from stickslip import program
from stickslip.__main__ import COMMANDS
from stickslip.deck import Deck
from stickslip.errors import EXTRAS

SHARE = ROOT / "python" / "packaging" / "data" / "data" / "share"
PAGE = SHARE / "man" / "man1" / "stickslip.1"
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
PYTHONS = os.environ.get("STICKSLIP_PYTHONS", sys.executable).split(os.pathsep)


def said(*words: str | Path, env: Mapping[str, str] | None = None, cwd: Path | None = None) -> str:
    """What a command that succeeds prints."""
    done = subprocess.run(words, env=env, cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
    return done.stdout


def failed(*words: str | Path, code: int, env: Mapping[str, str]) -> str:
    """The one line that a command which fails says."""
    done = subprocess.run(words, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (code, "", 1), done.stderr
    return done.stderr


def test_the_program_names_each_command_of_the_package() -> None:
    assert all(callable(importlib.import_module(module).run) for module in COMMANDS.values())
    helps = said(program.binary(), "--help") + said(program.binary(), "help", "plot")
    named = set(re.findall(r"^  (\w+)  ", helps, flags=re.MULTILINE))
    assert {name.split()[-1] for name in COMMANDS} < named
    for name in COMMANDS:
        assert f"usage: stickslip {name} " in said(*COMMAND, *name.split(), "--help")


def test_a_program_without_its_package_says_what_to_install(tmp_path: Path) -> None:
    lonely = shutil.copy(program.binary(), tmp_path)
    empty = {"PATH": str(tmp_path)}
    for name, what in (("plot motion", "stickslip[plot]"), ("sweep", "stickslip[sweep]"), ("report", "stickslip")):
        error = failed(lonely, *name.split(), "--help", code=4, env=empty)
        assert error.startswith(f"error: `stickslip {name}` is a command of the Python package")
        assert f'pip install "{what}"' in error
    named = failed(lonely, "report", code=4, env={"STICKSLIP_PYTHON": "/none/python"})
    assert "Python package" in named


def test_the_program_finds_the_package_of_its_checkout(tmp_path: Path) -> None:
    """Wherever it is called: the current folder is none of Python's."""
    (tmp_path / "numpy.py").write_text("raise SystemExit('wrong module')")
    clean = {name: text for name, text in os.environ.items() if not name.startswith(("STICKSLIP", "PYTHON"))}
    clean["STICKSLIP_PYTHON"] = sys.executable
    clean["PYTHONPATH"] = str(ROOT / "python")
    assert "usage: stickslip plot along " in said(
        program.binary(), "plot", "along", "--help", env=clean, cwd=tmp_path
    )
    assert failed(program.binary(), "certify", "none.vtkhdf", code=2, env=clean).startswith("stickslip certify: error: ")


def test_a_package_that_is_not_installed_is_named_with_its_extra() -> None:
    code = "import sys; sys.modules['matplotlib'] = None; from stickslip.__main__ import main; main()"
    words = [sys.executable, "-c", code, "plot", "motion", "none.vtkhdf"]
    assert failed(*words, code=2, env=os.environ) == (
        'stickslip plot motion: error: this needs the package matplotlib: pip install "stickslip[plot]"\n'
    )
    brought = {"PIL": "matplotlib", "dask": "distributed"}
    for package, extra in EXTRAS.items():
        needs = [re.split(r"\W", need)[0] for need in PYPROJECT["optional-dependencies"][extra]]
        assert brought.get(package, package) in needs, package


def test_versions_agree() -> None:
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["version"]
    assert stickslip.__version__ == cargo
    for name, pattern in (
        ("CITATION.cff", rf"^version: {re.escape(cargo)}$"),
        ("CHANGELOG.md", rf"^## {re.escape(cargo)}\b"),
        ("python/packaging/conda/recipe.yaml", rf'^  version: "{re.escape(cargo)}"$'),
    ):
        assert re.search(pattern, (ROOT / name).read_text(), flags=re.MULTILINE), name


def test_the_manual_page_is_that_of_the_program() -> None:
    page = said(program.binary(), "manual")
    assert PAGE.read_text() == page, f"stickslip manual > {PAGE.relative_to(ROOT)} brings it up to date"
    assert all(f'.SS "stickslip {name}"' in page for name in ("run", "check", *COMMANDS))


def test_all_documents_are_linked_into_the_wheel() -> None:
    links = {path.name: path.resolve() for path in (SHARE / "doc" / "stickslip").iterdir()}
    documents = {path.name: path for path in (ROOT / "docs").glob("*.md")}
    assert links == documents, "ln -s ../../../../../../../docs/NAME.md python/packaging/data/data/share/doc/stickslip"


def test_licences_of_all_linked_libraries_are_told() -> None:
    text = (ROOT / "LICENSE-THIRD-PARTY").read_text()
    told = set(re.findall(r"^(\S+ \d\S*): ", text, flags=re.MULTILINE))
    here = {f"{package['name']} {package['version']}" for package in linked("--offline")}
    assert here <= told, f"scripts/venv scripts/licences.py brings {sorted(here - told)}"
    lock = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    assert told <= {f"{package['name']} {package['version']}" for package in lock}
    for words in ("GNU LESSER GENERAL PUBLIC LICENSE", "HDF5 (Hierarchical Data Format 5)", "Jean-loup Gailly"):
        assert words in text


COMPLETE = """source "$1"
COMP_WORDS=(stickslip "$2"); COMP_CWORD=1
"$(complete -p stickslip | sed 's/.*-F \\([^ ]*\\) .*/\\1/')" stickslip "$2" stickslip
echo "${COMPREPLY[@]}"
"""
"""What bash completes a beginning to."""


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_bash_completes_commands(tmp_path: Path) -> None:
    env = {"PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    (tmp_path / "stickslip").symlink_to(program.binary())
    stub = SHARE / "bash-completion" / "completions" / "stickslip"
    for beginning, words in (("pl", "plot"), ("c", "check certify completion")):
        assert said("bash", "-c", COMPLETE, "bash", stub, beginning, env=env).split() == words.split()


@pytest.fixture(scope="module")
def wheel() -> Path:
    """The wheel to install; skips the test where there is none."""
    if "STICKSLIP_WHEEL" in os.environ:
        return Path(os.environ["STICKSLIP_WHEEL"])
    built = sorted((ROOT / "target" / "wheels").glob("*.whl"), key=lambda path: path.stat().st_mtime)
    if not built:
        pytest.skip("no wheel in target/wheels: scripts/wheel builds one")
    return built[-1]


def test_the_wheel_has_its_files(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = [name.partition("/")[2] for name in archive.namelist()]
        (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        text = archive.read(metadata).decode()
    shared = [f"data/share/{path.relative_to(SHARE)}" for path in SHARE.rglob("*") if path.is_file()]
    licences = [f"licenses/{name}" for name in PYPROJECT["license-files"]]
    for name in (*shared, *licences, "scripts/stickslip", "__main__.py"):
        assert name in names, name
    assert [name for name in names if name.startswith("scripts/")] == ["scripts/stickslip"]
    for line in ("License-Expression: MIT OR Apache-2.0", "Classifier: ", "Provides-Extra: plot"):
        assert f"\n{line}" in text, line


@pytest.fixture(params=PYTHONS)
def environment(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[..., None]:
    """An empty environment: installs into it."""
    place = tmp_path / "empty"
    said(request.param, "-m", "venv", place)
    clean = {name: text for name, text in os.environ.items() if not name.startswith(("STICKSLIP", "PYTHON"))}

    def install(what: str) -> None:
        said(place / "bin" / "python", "-m", "pip", "install", "--quiet", what, env=clean)

    return install


def test_a_wheel_runs_without_a_compiler(wheel: Path, environment: Callable[..., None], tmp_path: Path) -> None:
    place = tmp_path / "empty"
    commands = place / "bin"
    clean = {name: text for name, text in os.environ.items() if not name.startswith(("STICKSLIP", "PYTHON"))}
    clean["PATH"] = str(commands)  # no compiler, no cargo, no HDF5

    def run(*words: str) -> str:
        return said(commands / words[0], *words[1:], env=clean, cwd=tmp_path)

    # the wheel alone: what needs no more works, all else says what to install
    environment(str(wheel))
    assert re.match(r"stickslip \d", run("stickslip", "--version"))
    deck = ROOT / "tests" / "decks" / "rigid_floor.inp"
    run("stickslip", "run", str(deck), "-q")
    assert "hold" in run("stickslip", "certify", "-q", "rigid_floor.vtkhdf")
    run("stickslip", "penetration", "rigid_floor.vtkhdf")
    assert "wrote rigid_floor.html" in run("stickslip", "report", "rigid_floor.vtkhdf")
    assert run("stickslip", "export", "rigid_floor.vtkhdf", "--to", "csv") == "wrote rigid_floor.csv\n"
    result = str(tmp_path / "rigid_floor.vtkhdf")
    for words, extra in (
        (("plot", "motion", result), "plot"),
        (("plot", "history", result), "plot"),
        (("plot", "along", result), "plot"),
        (("sweep", str(deck), "--vary", "mu=0,1"), "plot"),
        (("export", result, "--to", "vtu"), "convert"),
    ):
        error = failed(commands / "stickslip", *words, code=2, env=clean)
        assert f'pip install "stickslip[{extra}]"' in error, error
    share = place / "share"
    assert (share / "man" / "man1" / "stickslip.1").read_text() == PAGE.read_text()
    assert (share / "doc" / "stickslip" / "messages.md").read_text() == (ROOT / "docs" / "messages.md").read_text()
    assert (share / "bash-completion" / "completions" / "stickslip").is_file()
    code = "import stickslip; print(stickslip.__version__, stickslip.program.version(), stickslip.program.binary())"
    told = run("python", "-c", code)
    assert told.startswith(f"{stickslip.__version__} stickslip ") and str(commands) in told
    # with pictures
    environment(f"{wheel}[plot]")
    study = Deck.read(deck)
    study.one("DYNAMIC").rows[0][1] = "<period>"
    study.write(tmp_path / "study.inp")
    vary = ["--vary", "period=0.01,0.02", "-q", "energy/kinetic@max", "--workers", "2"]
    for name in ("motion", "history", "along"):
        assert "wrote a.png" in run("stickslip", "plot", name, "rigid_floor.vtkhdf", "-o", "a.png")
    assert "against_period.png" in run("stickslip", "sweep", "study.inp", *vary)
