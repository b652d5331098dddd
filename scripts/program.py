"""Runs the program from Python."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

STOPPED = 1
"""Exit code of a run that stopped in the solve: the results up to there are valid."""


class RunFailed(Exception):
    """The program ended with another exit code than expected."""

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code


def binary() -> Path:
    """The program: $STICKSLIP, or the release build."""
    if "STICKSLIP" in os.environ:
        return Path(os.environ["STICKSLIP"])
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    path = target / "release" / "stickslip"
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing: run 'cargo build --release' first")
    return path


def run(deck: Path, output: Path, *options: str, expected: int = 0) -> Path:
    """Runs a deck quietly into a folder, overwriting older results; returns the result file."""
    output.mkdir(parents=True, exist_ok=True)
    command: list[str | Path] = [binary(), "run", deck, "-o", output, "--overwrite", "-q", *options]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != expected:
        words = " ".join(map(str, command))
        message = f"{words}\nexit code {done.returncode}\n{done.stdout}{done.stderr}"
        raise RunFailed(message, done.returncode)
    return output / f"{deck.stem}.vtkhdf"
