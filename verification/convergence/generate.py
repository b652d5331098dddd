"""Writes the decks with the parameters of their functions: `generate.py [-o FOLDER]`."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "scripts"), str(HERE)]

import elastic_blocks  # noqa: E402
import masonry  # noqa: E402
import stiff_bodies  # noqa: E402
from stickslip.decks import write_to_folder  # noqa: E402

PROBLEMS = {
    "two_blocks": elastic_blocks.two_blocks,
    "block_at_rest": elastic_blocks.block_at_rest,
    "dropped_block": elastic_blocks.dropped_block,
    "compressed_bar": elastic_blocks.compressed_bar,
    "rotating_bar": stiff_bodies.rotating_bar,
    "pendulum": stiff_bodies.pendulum,
    "thrown_block": stiff_bodies.thrown_block,
    "pushed_block": stiff_bodies.pushed_block,
    "stack": masonry.stack,
    "arch": masonry.arch,
    "card_house": masonry.card_house,
    "wall": masonry.shaken_wall,
}


def write(folder: Path, problem: str | None = None, **parameters: float | str) -> None:
    """Writes the deck of a problem, or the decks of all of them, into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in [problem] if problem else PROBLEMS:
        (folder / f"{name}.inp").write_text(PROBLEMS[name](**parameters))


if __name__ == "__main__":
    write_to_folder(__doc__, ROOT / "results" / "verification" / "convergence" / "decks", write)
