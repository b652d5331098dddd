"""Kills, races, signals and full disks, a few of each."""

import os
import subprocess
import sys

from stickslip import program


def test_torture() -> None:
    command = [sys.executable, "-m", "lab.torture", "--short"]
    environment = {**os.environ, "STICKSLIP": str(program.binary())}
    done = subprocess.run(
        command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    counts = [line.split()[:2] for line in done.stdout.splitlines() if " trials " in line]
    kinds = ["kills", "writes", "races", "signals", "disks", "screens"]
    assert [kind for kind, _ in counts] == kinds
    assert all(int(number) >= 4 for _, number in counts)
    assert "torture: 0 wrong" in done.stdout
