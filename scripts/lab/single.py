"""Comparisons of single models that no array varies."""

from collections.abc import Callable
from pathlib import Path

SINGLE: dict[str, Callable[[Path, Path], list[str]]] = {}
"""Comparisons by name: each returns what is wrong."""
