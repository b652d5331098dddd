"""Two programs compared: results and processor time."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from decks import CANTILEVERS, CORNERS, shortened
from stickslip import program
from stickslip.deck import Card

FAULTY = """\
#!{python}
import os, subprocess, sys
from pathlib import Path
import h5py

code = subprocess.run([{binary!r}, *sys.argv[1:]]).returncode
deck, output = Path(sys.argv[2]), Path(sys.argv[sys.argv.index("-o") + 1])
result = output / (deck.stem + ".vtkhdf")
with h5py.File(result, "r+") as file:
{change}
sys.exit(code)
"""

FLIP = """\
data = file[{name!r}]
values = data[()]
bits = values.view("u1").reshape(*values.shape, values.dtype.itemsize)
bits[({row}, *[0] * values.ndim)] ^= 1
data[...] = values"""
"""Alters the last bit of a number."""


def compare(script: str, *arguments: object) -> tuple[int, str]:
    """Runs a script that compares programs; its exit code and output."""
    command = [sys.executable, "-m", f"lab.{script}", *map(str, arguments)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def faulty_program(folder: Path, change: str) -> Path:
    """A program that runs the real one and then changes its result file."""
    path = folder / "faulty"
    indented = "\n".join(f"    {line}" for line in change.splitlines())
    text = FAULTY.format(python=sys.executable, binary=str(program.binary()), change=indented)
    path.write_text(text)
    path.chmod(0o755)
    return path


@pytest.fixture(scope="module")
def deck(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some increments with friction, with impacts."""
    folder = tmp_path_factory.mktemp("deck")
    return shortened(CORNERS / "corners_left_mu02.inp", 40).write(folder / "corners.inp")


def test_a_program_is_the_same_as_itself(deck: Path) -> None:
    code, text = compare("same_histories", program.binary(), program.binary(), deck)
    assert code == 0, text
    assert re.search(r"^same .*/corners   40 increments, \d+ frames, \d{3} datasets$", text, re.M)
    assert "1 decks: 1 same, 0 different, 0 failed; 0 shortened" in text


@pytest.mark.parametrize(
    ("name", "row"),
    [
        ("history/energy/kinetic", 17),
        ("history/solver/pivots", 3),
        ("history/impacts/xi", 0),
        ("VTKHDF/PointData/GAP", 5),
        ("VTKHDF/CellData/S", -1),
        ("model/coordinates", 2),
    ],
)
def test_one_bit_is_found(deck: Path, tmp_path: Path, name: str, row: int) -> None:
    faulty = faulty_program(tmp_path, FLIP.format(name=name, row=row))
    code, text = compare("same_histories", program.binary(), faulty, deck)
    assert code == 1
    assert "1 difference; OLD / NEW:" in text
    place = rf"{row}\b" if row >= 0 else r"\d+"
    assert re.search(rf"  {name}\[{place}.*\]: \S+ / \S+", text), text


def test_a_not_a_number_is_told_from_a_number_and_from_another(deck: Path, tmp_path: Path) -> None:
    change = "file['history/contact/LOWER_UPPER/min_gap'][7] = float('nan')"
    name = "history/contact/LOWER_UPPER/min_gap"
    for tolerance in ([], ["--tolerance", 1.0]):
        faulty = faulty_program(tmp_path, change)
        code, text = compare("same_histories", program.binary(), faulty, deck, *tolerance)
        assert code == 1 and re.search(rf"{name}\[7\]: \S+ / nan", text), text


def test_a_tolerance_is_a_part_of_the_largest_value(deck: Path, tmp_path: Path) -> None:
    change = """\
data = file["history/energy/kinetic"]
data[11] += 1e-10 * abs(data[()]).max()"""
    faulty = faulty_program(tmp_path, change)
    programs = program.binary(), faulty
    code, text = compare("same_histories", *programs, deck, "--tolerance", 1e-9)
    assert code == 0, text
    assert re.search(r"largest relative difference 1\.00e-10 in history/energy/kinetic", text), text
    code, text = compare("same_histories", *programs, deck, "--tolerance", 1e-11)
    assert code == 1 and "history/energy/kinetic[11]: " in text
    # rows up to the tenth of forty
    code, text = compare("same_histories", *programs, deck, "--until", 0.25)
    assert code == 0 and "10 increments" in text, text


def test_datasets_of_one_program_are_listed(deck: Path, tmp_path: Path) -> None:
    new = faulty_program(tmp_path, "file['history/energy/heat'] = file['history/time'][()]")
    code, text = compare("same_histories", program.binary(), new, deck)
    assert code == 1 and "only in NEW: history/energy/heat" in text
    code, text = compare("same_histories", program.binary(), new, deck, "--allow-new")
    assert code == 0 and "only in NEW: history/energy/heat" in text
    code, text = compare("same_histories", new, program.binary(), deck, "--allow-new")
    assert code == 1 and "only in OLD: history/energy/heat" in text


def test_a_status_line_is_compared(deck: Path, tmp_path: Path) -> None:
    change = """\
status = result.with_suffix(".sta")
lines = status.read_text().splitlines()
lines[9] = lines[9].replace("e-0", "e-1", 1)
status.write_text("\\n".join(lines) + "\\n")"""
    faulty = faulty_program(tmp_path, change)
    code, text = compare("same_histories", program.binary(), faulty, deck)
    assert code == 1 and "corners.sta, line 10: " in text


def test_long_runs_are_compared_as_far_as_they_go(tmp_path: Path) -> None:
    deck = shortened(CANTILEVERS / "A_mu04.inp", 12_000)
    path = deck.write(tmp_path / "long.inp")
    code, text = compare("same_histories", *[program.binary()] * 2, path, "--limit", 0.5)
    assert code == 0, text
    found = re.search(r"SHORTENED to time (\S+) of 180 \(\d+ %\), (\d+) increments", text)
    assert found and 10 < int(found[2]) < 12_000, text
    faulty = faulty_program(tmp_path, FLIP.format(name="history/energy/strain", row=4))
    code, text = compare("same_histories", program.binary(), faulty, path, "--limit", 0.5)
    assert code == 1 and "history/energy/strain[4]: " in text


def test_a_run_that_ends_early_is_found(deck: Path, tmp_path: Path) -> None:
    path = tmp_path / "early"
    text = f'#!/bin/sh\nsed -i "s/, 0.2$/, 0.1/" "$2"\nexec {program.binary()} "$@"\n'
    short = shortened(CORNERS / "corners_left_mu02.inp", 40)
    short.one("DYNAMIC").rows = [["0.005", "0.2"]]
    same = short.write(tmp_path / "corners.inp")
    path.write_text(text)
    path.chmod(0o755)
    code, text = compare("same_histories", program.binary(), path, same)
    assert code == 1 and "NEW ends after 20 increments" in text, text


def test_a_deck_that_is_refused_is_no_agreement(deck: Path, tmp_path: Path) -> None:
    wrong = shortened(CORNERS / "corners_left_mu02.inp", 40)
    wrong.cards.append(Card("NONSENSE", "*NONSENSE"))
    path = wrong.write(tmp_path / "wrong.inp")
    code, text = compare("same_histories", *[program.binary()] * 2, path)
    assert code == 1 and "OLD ends with exit code" in text
    assert "1 failed" in text


def test_what_is_not_there_is_told_in_one_line(deck: Path, tmp_path: Path) -> None:
    for script in ("same_histories", "paired_cpu"):
        code, text = compare(script, tmp_path / "none", program.binary(), deck)
        assert code == 2 and len(text.splitlines()) == 1 and "there is no program" in text
        code, text = compare(script, *[program.binary()] * 2, tmp_path / "none.inp")
        assert code == 2 and len(text.splitlines()) == 1 and "there is no deck" in text


def test_processor_times_of_a_program_and_of_a_slower_one(tmp_path: Path) -> None:
    deck = shortened(CANTILEVERS / "A_mu04.inp", 150).write(tmp_path / "short.inp")
    slow = tmp_path / "slow"
    slow.write_text(f'#!/bin/sh\n{program.binary()} "$@" && exec {program.binary()} "$@"\n')
    slow.chmod(0o755)
    code, text = compare("paired_cpu", program.binary(), slow, deck, "--repeat", 2)
    ratio = re.search(r"^ *(\S+) \+- (\S+) \(95 %\)  ratio of the sums; NEW is slower", text, re.M)
    assert code == 1 and ratio, text
    assert 1.5 < float(ratio[1]) < 2.6
    code, text = compare("paired_cpu", slow, program.binary(), deck, "--repeat", 2)
    assert code == 0 and "NEW is within the 3 % allowed" in text, text
