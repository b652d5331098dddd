"""Where the repository of these scripts is."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
