"""README.md and the pages that guide a new user: their commands, their deck and their figures."""

import os
import re
import shlex
import subprocess

import pytest
from conftest import ROOT
from stickslip.result import Result

README = (ROOT / "README.md").read_text()
PAGES = ("README.md", "docs/start.md", "docs/results.md")
"""Their commands run one after the other: a page uses the results of those before it."""

WHOLE = "scripts/test"
"""The command that runs these tests."""


def blocks(language: str, page: str = "README.md") -> list[str]:
    """The blocks of a language on a page."""
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / page).read_text(), flags=re.DOTALL)


def commands(page: str = "README.md") -> list[str]:
    """The lines of the shell blocks, those that end with a backslash joined with the next."""
    lines = "".join(blocks("sh", page)).replace("\\\n", " ").splitlines()
    return [line.partition("  #")[0].strip() for line in lines if line.strip()]


def words(text: str) -> list[str]:
    """The words of a text without its numbers."""
    return re.sub(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?", "", text).split()


@pytest.fixture(scope="module")
def screens() -> dict[str, str]:
    """What every command of the pages has shown; each ends without an error."""
    shown: dict[str, str] = {}
    for page in PAGES:
        for command in commands(page):
            if command == WHOLE or command in shown:
                continue
            done = subprocess.run(shlex.split(command), cwd=ROOT, capture_output=True, text=True)
            assert done.returncode == 0, f"{page}: {command}\n{done.stdout[-800:]}{done.stderr[-800:]}"
            shown[command] = done.stdout
    return shown


def test_there_are_commands() -> None:
    assert WHOLE in commands() and len(commands()) > 3
    assert all(len(commands(page)) > 3 for page in PAGES)


def test_the_page_is_short() -> None:
    assert len(README.splitlines()) <= 150


def test_the_first_run_ends_as_the_page_says(screens: dict[str, str]) -> None:
    shown = screens[commands()[0]]
    warnings = [line for line in shown.splitlines() if line.startswith("warning")]
    assert "done " in shown and not warnings, warnings
    ending = next(block for block in blocks("text") if block.startswith("checks"))
    assert " ".join(words(ending)) in " ".join(words(shown))


def test_the_screen_is_that_of_the_first_steps(screens: dict[str, str]) -> None:
    shown = " ".join(words(screens[commands("docs/start.md")[0]]))
    parts = [block for block in blocks("text", "docs/start.md") if block.startswith(("title", "step ", "done"))]
    lines = [line for block in parts for line in block.splitlines()]
    assert len(lines) > 15 and [line for line in lines if " ".join(words(line)) not in shown] == []


def test_the_deck_of_the_page_is_the_one_of_the_folder() -> None:
    deck = next(block for block in blocks("text") if block.startswith("*HEADING"))
    assert deck == (ROOT / "docs" / "slide.inp").read_text()


def test_the_block_stops_where_the_page_says(screens: dict[str, str]) -> None:
    assert screens
    (code,) = blocks("python")
    stop, friction, weight = (float(each) for each in re.findall(r"-?0\.\d+(?=[ \]\n])", code.partition("slides: ")[2]))
    with Result(ROOT / "results" / "slide.vtkhdf") as result:
        assert result.quantity("nodes/ALL/U:1")[-1] == pytest.approx(stop, abs=5e-5)
        assert result.contact["FOOT_FLOOR"].force[200] == pytest.approx([friction, weight], abs=5e-5)
    assert f"v²/(2 mu g) = {1 / (2 * 0.3 * 9.81):.3f} m" in README


@pytest.mark.parametrize("page", PAGES)
def test_what_it_says_in_python_works(page: str, screens: dict[str, str]) -> None:
    assert screens
    here = os.getcwd()
    os.chdir(ROOT)
    try:
        for code in blocks("python", page):
            exec(code, {})
    finally:
        os.chdir(here)


def test_a_result_that_exists_is_kept_and_said_so(screens: dict[str, str]) -> None:
    deck = commands()[0].split()[1]
    assert screens
    kept = subprocess.run(["scripts/run", deck], cwd=ROOT, capture_output=True, text=True)
    assert kept.returncode == 4
    assert "--overwrite" in kept.stderr and "-- results:" not in kept.stderr, kept.stderr
