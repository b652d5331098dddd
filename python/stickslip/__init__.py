"""Decks and results of stickslip in Python: docs/python.md shows how.

>>> result = run(deck, "results")
>>> result.history.energy.kinetic
"""

from stickslip import summary as _summary  # noqa: F401  (results and decks show themselves in notebooks)
from stickslip.deck import Deck
from stickslip.errors import Fault
from stickslip.frame import Frame
from stickslip.history import History
from stickslip.program import DeckRejected, Diagnostic, Progress, RunFailed, RunStopped, check, run
from stickslip.result import Result

__version__ = "0.1.0"

__all__ = [
    "Deck",
    "DeckRejected",
    "Diagnostic",
    "Fault",
    "Frame",
    "History",
    "Progress",
    "Result",
    "RunFailed",
    "RunStopped",
    "check",
    "run",
]
