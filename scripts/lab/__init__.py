"""The laboratory: scripts that look for faults of the program, measure it and compare it with others."""

import sys

from repository import ROOT

# where the oracle of elements is, and the bodies of decks
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "python")]
