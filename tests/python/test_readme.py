"""The commands of README.md, run in their order as a new user would."""

import re
import shlex
import subprocess

import pytest
from conftest import ROOT

README = (ROOT / "README.md").read_text()

WHOLE = "scripts/test"
"""The command that runs these tests."""


def commands() -> list[str]:
    """The lines of the shell blocks, those that end with a backslash joined with the next."""
    blocks = re.findall(r"```sh\n(.*?)```", README, flags=re.DOTALL)
    lines = "".join(blocks).replace("\\\n", " ").splitlines()
    return [line.partition("#")[0].strip() for line in lines if line.strip()]


def test_there_are_commands() -> None:
    assert WHOLE in commands() and len(commands()) > 6


def test_every_command_ends_without_an_error() -> None:
    for command in commands():
        if command == WHOLE:
            continue
        done = subprocess.run(shlex.split(command), cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, f"{command}\n{done.stdout[-800:]}{done.stderr[-800:]}"
        if command == commands()[0]:
            warnings = [line for line in done.stdout.splitlines() if line.startswith("warning")]
            assert "done " in done.stdout and not warnings, warnings


@pytest.mark.parametrize("code", re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL))
def test_what_it_says_in_python_works(code: str) -> None:
    exec(code.replace('"results/', f'"{ROOT}/results/'), {})


def test_a_result_that_exists_is_kept_and_said_so() -> None:
    deck = commands()[0].split()[1]
    kept = subprocess.run(["scripts/run", deck], cwd=ROOT, capture_output=True, text=True)
    assert kept.returncode == 4
    assert "--overwrite" in kept.stderr and "-- results:" not in kept.stderr, kept.stderr
