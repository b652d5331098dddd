"""Faults put into the program one at a time, which the short part of the laboratory must find.

Each is one text of the source replaced by another. The program is built from a copy of the last commit
in `target/mutations`; the first build takes as long as any first build, the others some minutes less.
"""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from repository import ROOT
from stickslip.errors import Fault

TARGET = ROOT / "target" / "mutations"
"""Folder of the builds."""

Found = set[tuple[str, str]]
"""Decks and the oracles that they fail."""


@dataclass(frozen=True)
class Mutation:
    """A fault of the program."""

    name: str
    file: str
    right: str
    """Text that stands once in the file."""
    wrong: str

    def apply(self, root: Path) -> None:
        """Puts the fault into a copy of the source."""
        path = root / self.file
        path.write_text(self.put_into(path.read_text()))

    def put_into(self, text: str) -> str:
        """The text of the file with the fault."""
        if text.count(self.right) != 1:
            raise Fault(f"{self.file} has not one place like this: {self.right}")
        return text.replace(self.right, self.wrong)


MUTATIONS = [
    Mutation(
        "a weight of a mean is left out",
        "crates/dynamics/src/contact/surface_to_surface.rs",
        "map(|q| q.weight * q.gaps(at)[0])",
        "map(|q| q.gaps(at)[0])",
    ),
    Mutation(
        "a coupling turns the other way",
        "crates/dynamics/src/dynamics/step/turning.rs",
        "d[2 * node + i] = of_pole[i] + c * j[i]",
        "d[2 * node + i] = of_pole[i] - c * j[i]",
    ),
    Mutation(
        "flatten leaves the largest shear stress out",
        "crates/decks/src/flat_deck/model.rs",
        'parameters.push(set("TAUMAX", number(friction.shear_limit)));',
        "",
    ),
]


def find_all(judge: Callable[[Path], Found]) -> int:
    """Builds the program with each fault; the number of those that nothing finds."""
    missed = 0
    with tempfile.TemporaryDirectory(prefix="mutations_") as folder:
        known = judge(_built(Path(folder), None))
        for mutation in MUTATIONS:
            new = judge(_built(Path(folder), mutation)) - known
            missed += not new
            oracles = sorted({oracle for _, oracle in new})
            decks = len({deck for deck, _ in new})
            print(
                f"{mutation.name}: {decks} decks fail {', '.join(oracles) or 'nothing'}", flush=True
            )
    return missed


def _built(folder: Path, mutation: Mutation | None) -> Path:
    """The program with a fault, or without one."""
    source = folder / "source"
    shutil.rmtree(source, ignore_errors=True)
    subprocess.run(["git", "clone", "--quiet", "--shared", ROOT, source], check=True)
    if mutation:
        mutation.apply(source)
    environment = {**os.environ, "CARGO_TARGET_DIR": str(TARGET)}
    command = ["cargo", "build", "--release", "--locked", "--quiet"]
    subprocess.run(command, cwd=source, env=environment, check=True)
    program = folder / "stickslip"
    shutil.copy2(TARGET / "release" / "stickslip", program)
    return program
