"""The figures of docs/theory and docs/architecture.md are what their script draws."""

import pytest
from conftest import ROOT
from lab import theory_figures


@pytest.mark.parametrize("path", theory_figures.FIGURES)
def test_the_file_is_what_the_script_draws(path: str) -> None:
    drawn = theory_figures.FIGURES[path]().svg()
    assert (ROOT / path).read_text() == drawn, "run scripts/lab/run theory_figures"
