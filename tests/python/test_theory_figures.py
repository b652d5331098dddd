"""The figures of docs/theory and docs/architecture.md are what their script draws, and pages show each of them."""

import re

import pytest
from conftest import ROOT
from lab import theory_figures


@pytest.mark.parametrize("path", theory_figures.FIGURES)
def test_the_file_is_what_the_script_draws(path: str) -> None:
    drawn = theory_figures.FIGURES[path]().svg()
    assert (ROOT / path).read_text() == drawn, "run scripts/lab/run theory_figures"


def test_every_figure_is_shown() -> None:
    pages = [*(ROOT / "docs/theory").glob("*.md"), ROOT / "docs/architecture.md"]
    shown = {
        (page.parent / link).resolve()
        for page in pages
        for link in re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text())
    }
    assert shown == {ROOT / path for path in theory_figures.FIGURES}
