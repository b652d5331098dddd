"""Decks that are spoiled at random run, stop or are rejected as documented: a short form of scripts/lab/run spoil."""

import random
import subprocess
import sys
from pathlib import Path

import pytest
from lab import spoil


def test_spoiled_decks(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "lab.spoil", "60", "-o", str(tmp_path)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "spoil: 0 faults" in done.stdout
    assert int(done.stdout.split(" exit 0")[0].split()[-1]) >= 10, "some of them run"


def test_seeds_have_all_that_is_spoiled() -> None:
    texts = "".join(spoil.seeds().values())
    for word in (
        *("GRAV", "BX", "P2", "TRVEC", "*CLOAD", "*DSLOAD", "*EQUATION", "*HYPERELASTIC", "ALPHA="),
        *("BETA=", "MEAN DILATATION", "EQUALLY SPACED", "PERIODIC", "DECAY", "MODULATED", "SMOOTH STEP"),
        *("TYPE=VELOCITY", "TYPE=ACCELERATION", "REDISTRIBUTED", "EVENT", "RETURN", "SS22", "SEGMENTS"),
    ):
        assert word in texts, word


@pytest.mark.parametrize(
    ("code", "err", "fault"),
    [
        (0, "", ""),
        (2, "error[D103]: unknown\n   --> a.inp:2:1\n", ""),
        (2, "error: something is wrong", "rejected without file and line"),
        (4, "error: out of memory: 8 bytes", ""),
        (4, "error: cannot write", "exit 4"),
        (3, "error: unexpected argument", "exit 3"),
        (-6, "memory allocation of 8 bytes failed", "exit -6"),
        (101, "thread 'main' panicked at src/a.rs", "panic"),
    ],
)
def test_faults_are_found(code: int, err: str, fault: str, tmp_path: Path) -> None:
    assert spoil.fault(code, False, "", err, tmp_path / "none").startswith(fault)
    assert bool(fault) == bool(spoil.fault(code, False, "", err, tmp_path / "none"))


def test_the_same_seed_spoils_the_same_way() -> None:
    seeds = {"a": "*NODE\n1, 0., 1.\n2, 1., 0.\n*STEP, INC=3\n*DYNAMIC\n0.1, 1.\n"}
    first, again, other = (spoil.spoiled(seeds, random.Random(seed)) for seed in (3, 3, 4))
    assert first == again != other
