"""A laboratory of combinations: small decks of every pair of levels, judged without stored answers."""

import sys

from repository import ROOT

sys.path.insert(0, str(ROOT / "tests"))  # where the oracle of elements is
