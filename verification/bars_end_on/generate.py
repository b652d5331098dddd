"""Writes the deck of the case: `write(folder, ...)`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from meshes import prints, rectangle  # noqa: E402  (first: it finds the modules of python/)
from stickslip.decks import card, dry, elastic, step  # noqa: E402


GAP = 0.003


def write(folder: Path, lengths: str, n: int, settings: str = "") -> None:
    """Bars in a row, `n` elements in the length 5 of the first, which moves with the speed 0.03."""
    size, start, blocks = 5.0 / n, 0.0, []
    for k, length in enumerate(map(float, lengths.split())):
        cells = round(length / size)
        blocks.append(
            rectangle(f"BAR{k + 1}", "CPE4", (cells, 1), (length, 0.5), (start, 0.0), blocks[-1] if blocks else None)
        )
        start += length + GAP
    names = range(1, len(blocks) + 1)
    count = round(0.2 / (size / 30) + 2.6 * n * (len(blocks) - 1))
    cards = [
        card("HEADING", ("bars end on",)),
        *(block.cards() for block in blocks),
        *(block.surface(f"TAIL{k}", "left") + block.surface(f"NOSE{k}", "right") for k, block in zip(names, blocks)),
        elastic(900.0, 0.0, 1.0, *(block.name for block in blocks)),
        dry(0.0),
        card("CONTACT PAIR, INTERACTION=DRY", *((f"NOSE{k}", f"TAIL{k + 1}") for k in names[:-1])),
        card("INITIAL CONDITIONS, TYPE=VELOCITY", ("BAR1", 1, 0.03)),
        step(size / 30, count, card(f"STICKSLIP, {settings}") if settings else ""),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bars.inp").write_text("".join(cards))
