"""Figures of README.md and of the guide: those that a case of verification/ measures stand in its report."""

import re
from pathlib import Path

import pytest
from conftest import ROOT
from lab import penetration

REPORT = (ROOT / "verification" / "REPORT.md").read_text()

FIGURES = [
    ("README.md", "lose {:.0%} of its energy by default", "bouncing_disc/plastic", "energy lost in ten bounces / start, plastic"),
    (
        "README.md",
        "up to {:.0%} where coarse faces bend",
        "contact/pile_STS",
        "deepest node in a body / element size, surface to surface",
    ),
    (
        "docs/contact.md",
        "pile of discs with 20 sides: {:.0%} of a segment",
        "contact/pile_STS",
        "deepest node in a body / element size, surface to surface",
    ),
    (
        "docs/contact.md",
        "| 9 on 12.6 elements | {:.1%}, 0.7% |",
        "surface_to_surface/hertz_9_12_STS",
        "largest deviation of the pressure of the slave from a smooth curve / peak",
    ),
    (
        "docs/contact.md",
        "| 9 on 12.6 elements | 0.3%, {:.1%} |",
        "surface_to_surface/hertz_9_12_STS",
        "largest deviation of the pressure of the master from a smooth curve / peak",
    ),
    ("docs/choosing.md", "| default | {:.1f} | 237.5 |", "metal_bar/plastic_40", "rebound in m/s"),
    ("docs/choosing.md", "| `LANDING=RETURN` | {:.1f} | 237.9 | 7% |", "metal_bar/return_40", "rebound in m/s"),
    ("docs/choosing.md", "LANDING=RETURN` | {:.1f} | 239.6 |", "metal_bar/both_40", "rebound in m/s"),
    ("docs/choosing.md", "| 221.5 | {:.1f} | 13% |", "metal_bar/plastic_40", "energy after the impact in J, plastic landing"),
    ("docs/choosing.md", "| 221.6 | {:.1f} | 7% |", "metal_bar/return_40", "energy after the impact in J, plastic landing"),
    ("docs/choosing.md", "| 221.6 | 237.9 | {:.0%} |", "bouncing_disc/return", "energy lost in ten bounces / start, return"),
    ("docs/choosing.md", "a foot of {:.1f} in radius", "taylor_bar/reduced_4", "radius of the foot in mm"),
]
"""Pages, how a figure stands there, the run and the quantity that it is."""

ERRORS = [
    ("docs/choosing.md", "leave an error of {:.4%}", "thick_cylinder/q8_8", "displacement of the bore / pressure, quadratic"),
    ("docs/contact.md", "the peak pressure is {:.1%} low", "hertz_cylinder/n8_a1", "peak pressure, a/R = 0.02"),
    ("docs/choosing.md", "16 linear ones {:.2%}", "thick_cylinder/q4_16", "displacement of the bore / pressure"),
]
"""The same of errors against the reference."""

BOUNDS = [
    ("README.md", "by less than 1e-17 m in 400 increments", 1e-17, "sliding_block/stick", "motion of the block that sticks"),
    (
        "README.md",
        "by less than 1e-13 of its start in 200 increments",
        1e-13,
        "free_flight",
        "change of kinetic, strain and dissipated energy / start",
    ),
    (
        "README.md",
        "less than 1e-11 of it with two options",
        1e-11,
        "bouncing_disc/both",
        "energy lost in ten bounces / start, redistributed mass and return",
    ),
]
"""Pages, how a bound of round-off stands there, the bound, the run and the quantity that it holds down."""


def both(run: str, quantity: str) -> tuple[str, float]:
    """The reference, if any, and what the program computed, in the report."""
    rows = re.findall(r"^\| (\S+) \| (.*?)(?: \(worst of \d+\))? \| (\S*) \| (\S+) \|", REPORT, flags=re.MULTILINE)
    (found,) = [(wanted, float(number)) for case, name, wanted, number in rows if case.startswith(run) and name == quantity]
    return found


def value(run: str, quantity: str) -> float:
    """What the program computed, in the report."""
    return both(run, quantity)[1]


def plain(text: str) -> str:
    """A text with its line breaks as blanks, and exponents without zeros."""
    return re.sub(r"e([-+])0+", r"e\1", " ".join(text.split())).replace(" %", "%")


@pytest.mark.parametrize(("page", "form", "run", "quantity"), FIGURES)
def test_a_figure_is_that_of_the_report(page: str, form: str, run: str, quantity: str) -> None:
    assert plain(form.format(value(run, quantity))) in plain((ROOT / page).read_text())


@pytest.mark.parametrize(("page", "form", "run", "quantity"), ERRORS)
def test_an_error_is_that_of_the_report(page: str, form: str, run: str, quantity: str) -> None:
    wanted, found = both(run, quantity)
    assert plain(form.format(abs(found / float(wanted) - 1.0))) in plain((ROOT / page).read_text())


@pytest.mark.parametrize(("page", "words", "bound", "run", "quantity"), BOUNDS)
def test_a_bound_holds_in_the_report(page: str, words: str, bound: float, run: str, quantity: str) -> None:
    assert plain(words) in plain((ROOT / page).read_text())
    assert abs(value(run, quantity)) < bound


def test_the_counts_of_the_verification() -> None:
    counts = re.search(r"(\d+) cases, (\d+) runs, (\d+) checks, (\d+) failed", REPORT)
    assert counts
    cases, runs, checks, failed = counts.groups()
    readme = plain((ROOT / "README.md").read_text())
    assert f"{cases} cases, {runs} runs and {checks} checks" in readme and f"{failed} checks fail" in readme


@pytest.mark.parametrize("name", ["corner_to_corner/corners_left_mu02", "two_cantilevers/B_mu04", "rubber_ring/rubber_ring_mu05"])
def test_the_table_of_penetration_is_measured(name: str, tmp_path: Path) -> None:
    depths = penetration.measured(penetration.variants(name), tmp_path)
    row = penetration.row(f"input/{name.partition('/')[0]}", penetration.DECKS[name], depths)
    assert row in penetration.PAGE.read_text()
