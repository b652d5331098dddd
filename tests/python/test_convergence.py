"""Increments, cutbacks, passes and factorisations of runs, counted and compared."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT
from decks import CANTILEVERS, CORNERS, shortened
from lab import convergence
from stickslip import program
from test_compared_programs import compare, faulty_program

LOG = """\
increment 3 of step 1: time 3.000000e-02, dt 1.000e-02
     pass  residual correction  active   stick     LCP  pivots
        1  5.53e-02   1.00e+00      11       0      11       0
cutback  increment 12 at 2.200e-01, dt 2.00e-02 -> 1.00e-02
         the passes did not converge
advice   an increment of half the length may help: this goes on in
         a second line
     pass  residual correction  active   stick     LCP  pivots
        1  5.53e-02   1.00e+00      11       0      11       0
        2  7.93e-05   1.39e-03      11       0      11       0
   1     12 2.300e-01 1.00e-02    5     11     0  1.8e-12   11      0   +1.9e-15
cutback  increment 13 at 2.300e-01, dt 1.00e-02 -> 5.00e-03
         node 2 has gone through the segment from 3 to 4
cutback  increment 13 at 2.300e-01, dt 5.00e-03 -> 2.50e-03
         the passes did not converge
     pass  residual correction  active   stick     LCP  pivots
        1         -          -      11       0      11       0
"""


def test_attempts_that_were_cut_back_are_read_from_the_log() -> None:
    cut = convergence.cut_attempts(LOG.splitlines())
    assert cut == [(12, 2), (13, 0), (13, 1)]


@pytest.fixture(scope="module")
def deck(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Increments with friction, some of which need more passes than they may have."""
    short = shortened(CORNERS / "corners_left_mu02.inp", 40)
    short.set_settings(MAX_PASSES=4)
    return short.write(tmp_path_factory.mktemp("deck") / "corners.inp")


def test_counts_are_those_of_the_results(deck: Path, tmp_path: Path) -> None:
    with program.run(deck, tmp_path) as results:
        rows, cutbacks = len(results.history.time) - 1, int(results.run["cutbacks"])
        passes, most = (
            results.history.solver["passes"].sum(),
            results.history.solver["passes"].max(),
        )
        factorizations = int(results.history.solver["factorizations"].sum())
    assert rows > 40 and cutbacks > 0
    code, text = compare("convergence", program.binary(), deck)
    assert code == 0, text
    numbers = text.splitlines()[1].split()
    assert numbers[:2] == [str(rows), str(cutbacks)]
    assert numbers[2:4] == [f"{passes / rows:.1f}", str(most)]
    assert int(numbers[4]) >= 4 * cutbacks
    assert numbers[5] == str(factorizations)
    assert numbers[7].endswith("/corners")


def test_two_programs_stand_side_by_side(deck: Path, tmp_path: Path) -> None:
    change = "file['history/solver/passes'][7] = 31"
    programs = program.binary(), faulty_program(tmp_path, change)
    code, text = compare("convergence", *programs, deck, "--markdown")
    assert code == 0, text
    head, _, line, total = text.splitlines()
    assert head.startswith("| deck | increments | cutbacks | passes | max |")
    assert re.search(r"/corners \| (\d+) / \1 \| .* \| \d+ / 31 \| ", line), text
    assert total.startswith("| all: 1 decks |")


def test_runs_that_are_cut_short_are_counted_as_far_as_both_go(tmp_path: Path) -> None:
    path = shortened(CANTILEVERS / "A_mu04.inp", 300_000).write(tmp_path / "long.inp")
    code, text = compare("convergence", *[program.binary()] * 2, path, "--limit", 0.5)
    assert code == 0, text
    line = text.splitlines()[1]
    found = re.search(r"^ *(\d+) / (\d+) .*\(to time \S+ of 4500: (OLD|NEW) at the limit\)$", line)
    assert found and found[1] == found[2] and 10 < int(found[1]) < 300_000, text


def test_a_deck_without_results_is_told(deck: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.inp"
    wrong.write_text("*NONSENSE\n")
    code, text = compare("convergence", program.binary(), wrong, deck)
    assert code == 1 and "wrong (failed: exit code 2" in text
    assert "all: 1 decks" in text
    code, text = compare("convergence", deck)
    assert code == 2 and "one program is needed, or two" in text


def test_the_problems_of_the_verification_are_decks_without_faults(tmp_path: Path) -> None:
    generate = ROOT / "verification" / "convergence" / "generate.py"
    subprocess.run([sys.executable, generate, "-o", tmp_path], check=True)
    decks = sorted(tmp_path.glob("*.inp"))
    assert len(decks) == 12
    for deck in decks:
        command = [program.binary(), "check", deck]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        assert done.returncode == 0 and "0 errors, 0 warnings" in done.stdout, deck.name
