"""Loads that are put on and taken off: a part of scripts/lab/run loads_on_off."""

from conftest import ROOT
from test_scripts import script


def test_loads_that_go_back_to_zero_leave_nothing() -> None:
    """Every element, procedure, load, length of increments and joint at least once."""
    script(ROOT / "scripts/lab/loads_on_off.py", "--every", 58, "--certify")


def test_loads_that_are_small_are_taken_off_too() -> None:
    """What they leave is measured beside them."""
    script(ROOT / "scripts/lab/loads_on_off.py", "--procedure", "static", "--scale", 1e-9, "--every", 29)
