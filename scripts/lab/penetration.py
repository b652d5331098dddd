"""Measures how deep nodes and corners sink in with each kind of contact: the table of docs/contact.md.

    scripts/lab/run penetration               prints the table
    scripts/lab/run penetration --write       puts it into docs/contact.md

Each deck runs with one pair node to surface, with both orders (general and self-contact always have both), and surface to
surface. A figure is the largest `certificate/penetration` of all increments, in lengths of the edge that is entered.
"""

import argparse
import importlib.util
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from stickslip import program
from stickslip.deck import Deck

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "contact.md"
CASE = ROOT / "verification" / "surface_to_surface"
BEGIN, END = "<!-- penetration: begin -->", "<!-- penetration: end -->"

NODES, MEANS = "NODE TO SURFACE", "SURFACE TO SURFACE"

DECKS = {
    "corner_to_corner/corners_left_mu02": "two squares, corner on corner",
    "fast_bullet/bullet_one": "a bullet on a thin plate",
    "bouncing_rings/rings_mu02": "two rings of 60 sides",
    "two_cantilevers/B_mu04": "two cantilevers; the end of one slides below the other",
    "snap_fit/snap_fit_damped": "a hook on a rigid ramp with a sharp edge",
    "rubber_ring/rubber_ring_mu05": "a ring of rubber on a rigid floor, faces turn by 22 degrees",
    "buckling_self_contact/column_mu02": "a column that folds onto itself",
}
"""Decks of input/ and what they are."""

CYLINDERS = {(18.0, 9.0): "twice as fine", (9.0, 18.0): "twice as coarse"}
"""Elements in the half width of Hertz' contact of slave and master (verification/surface_to_surface)."""

ROUND_OFF = 1e-9
"""Penetration that counts as none."""


def variants(name: str) -> dict[str, Deck]:
    """The decks of a name by kind of contact; those that make no sense are left out."""

    def read() -> Deck:
        return Deck.read(ROOT / "input" / f"{name}.inp")

    decks = {"one pair": read(), "both orders": read(), MEANS: read()}
    (card,) = decks["one pair"].find("CONTACT PAIR")
    sides = card.rows[0]
    if len(sides) < 2:
        del decks["one pair"]
    elif any(rigid in ",".join(sides) for rigid in ("FLOOR", "RAMP")):
        del decks["both orders"]
    else:
        card.rows = [sides]
        (other,) = decks["both orders"].find("CONTACT PAIR")
        other.rows = [sides, sides[::-1]]
    for kind, deck in decks.items():
        deck.set_formulation(MEANS if kind == MEANS else NODES)
    return decks


def cylinders(slave: float, master: float, folder: Path) -> dict[str, Deck]:
    """The decks of two cylinders by kind of contact."""
    spec = importlib.util.spec_from_file_location("generate", CASE / "generate.py")
    assert spec and spec.loader
    generate = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generate)
    decks = {}
    for kind, discretisation in (("one pair", NODES), (MEANS, MEANS)):
        generate.write(folder, what="hertz", upper=slave, lower=master, kind=discretisation)
        decks[kind] = Deck.read(folder / "hertz.inp")
    return decks


def measured(decks: dict[str, Deck], folder: Path) -> dict[str, float]:
    """The largest penetration of decks by kind of contact."""
    found = {}
    for kind, deck in decks.items():
        path = deck.write(folder / f"{kind.replace(' ', '_')}.inp")
        with program.run(path, folder, frames=2) as result:
            found[kind] = float(np.nanmax(result.history.certificate.penetration))
    return found


def shown(depth: float | None) -> str:
    """A depth in the table."""
    if depth is None:
        return ""
    return "0" if depth < ROUND_OFF else f"{depth:.2g}"


def row(folder: str, what: str, depths: dict[str, float]) -> str:
    """A line of the table; the folder is that of the decks."""
    cells = [shown(depths.get(kind)) for kind in ("one pair", "both orders", MEANS)]
    return f"| [{Path(folder).name}](../{folder}/README.md): {what} | {' | '.join(cells)} |"


def rows() -> Iterator[str]:
    """The lines of the table."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        for name, what in DECKS.items():
            yield row(f"input/{name.partition('/')[0]}", what, measured(variants(name), folder))
        for counts, what in CYLINDERS.items():
            found = measured(cylinders(*counts, folder), folder)
            yield row("verification/surface_to_surface", f"two cylinders, the slave {what}", found)


def main() -> None:
    """Prints or writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="puts the table into docs/contact.md")
    options = parser.parse_args()
    lines = ["| deck | node to surface, one pair | node to surface, both orders | surface to surface |", "|---|---|---|---|"]
    for line in rows():
        lines.append(line)
        print(line, flush=True)
    if options.write:
        table = "\n".join([BEGIN, *lines, END])
        PAGE.write_text(re.sub(f"{BEGIN}.*{END}", lambda _: table, PAGE.read_text(), flags=re.DOTALL))


if __name__ == "__main__":
    main()
