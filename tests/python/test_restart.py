"""Runs that are stopped and killed, and go on."""

import random
from pathlib import Path

import h5py
import pytest
from conftest import ROOT
from lab import restart_equality
from lab.restart_equality import Job


@pytest.mark.parametrize(
    "name",
    [
        "input/two_cantilevers/A_mu04.inp",
        "verification/static/supports.inp",
        "tests/decks/plastic.inp",
    ],
)
def test_stopped_and_killed_runs_end_in_the_same_bits(name: str, tmp_path: Path) -> None:
    deck = restart_equality.shortened(ROOT / name, None, tmp_path)
    assert restart_equality.check(deck, 1, tmp_path, random.Random(3))


def test_a_changed_bit_is_seen(tmp_path: Path) -> None:
    deck = restart_equality.shortened(ROOT / "tests/decks/square.inp", None, tmp_path)
    one, other = Job(deck, tmp_path / "one"), Job(deck, tmp_path / "other")
    one.finish()
    other.finish("--checkpoint", "0")
    assert restart_equality.differences(one, other) == []
    with h5py.File(other.file("vtkhdf"), "r+") as file:
        file["history/energy/kinetic"][3] *= 1.0 + 2.0**-52
        file["history/dt"].attrs["dimension"] = "length"
    other.file("sta").write_text("")
    found = restart_equality.differences(one, other)
    assert found == ["history/dt@dimension", "history/energy/kinetic", "status file"]
