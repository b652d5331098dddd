"""Writes the deck of the case: `write(folder, ...)`."""

from pathlib import Path

from form import load

flat = load(Path(__file__).resolve().parents[1] / "static_contact" / "generate.py")


def write(folder: Path, friction: float, thickness: float = 0.02, degrees: int = 180) -> None:
    """A strip around a cylinder, which pulls a dead load, as in static_contact."""
    flat.BELT = thickness
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "capstan.inp").write_text(flat.capstan(friction, degrees))
