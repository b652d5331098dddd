"""Results, decks and runs in a notebook, which is executed."""

import html
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest
from conftest import ROOT, Job
from nbclient import NotebookClient
from stickslip import Deck, Fault, Result, summary
from stickslip.report import page
from stickslip.summary import deck_html, result_html

DECK = ROOT / "tests" / "decks" / "square.inp"

CELLS = (
    "import matplotlib.pyplot as plt\nfigure, axes = plt.subplots()\naxes.plot([0, 1], color='#123456', linewidth=5);",
    "import stickslip.plot.motion, stickslip.plot.history\nplt.plot([1, 2]);",
    f"from stickslip import Deck, run\ndeck = Deck.read({str(DECK)!r})\ndeck",
    "result = run(deck, 'results', progress=True, frames=5)\nresult",
    "stickslip.plot.motion.panels([[(result, 5)]], stickslip.plot.motion.Look('S11'))",
    "result.show(400)",
    "plt.figure(); plt.plot([3, 1]); plt.get_backend()",
)


@pytest.fixture(scope="module")
def cells(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """The cells of a notebook that has run."""
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    folder = tmp_path_factory.mktemp("notebook")
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("MPLBACKEND", raising=False)
        NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
    return book.cells


def found(cell: Any, kind: str) -> list[str]:
    """What a cell has put out of a kind."""
    return [each["data"][kind] for each in cell.outputs if kind in each.get("data", {})]


def test_figures_of_the_user_and_of_the_package_are_shown(cells: list[Any]) -> None:
    """Before the import of the package, after it, and after its pictures."""
    for number in (0, 1, 4, 6):
        assert len(found(cells[number], "image/png")) == 1, CELLS[number]
    assert "inline" in found(cells[6], "text/plain")[0]


def test_decks_and_results_show_themselves(cells: list[Any]) -> None:
    (deck,), (*_, result) = found(cells[2], "text/html"), found(cells[3], "text/html")
    assert "image/svg+xml;base64" in deck and "*ELEMENT" in deck and "/tmp" not in deck
    assert "image/png;base64" in result and "<th>model</th>" in result
    assert not [each for cell in cells for each in cell.outputs if each.output_type == "error"]


def test_a_bar_tells_how_far_a_run_is(cells: list[Any]) -> None:
    bars = [text for text in found(cells[3], "text/html") if "<progress" in text]
    assert len(bars) == 1 and 'value="1.0000"' in bars[0] and "0 s left" in bars[0]


def test_the_report_is_inline(cells: list[Any]) -> None:
    (frame,) = found(cells[5], "text/html")
    text = html.unescape(re.fullmatch(r'<iframe srcdoc="([^"]*)" style="[^"]*height:400px[^"]*"></iframe>', frame)[1])
    assert text.startswith("<!doctype html>") and text.rstrip().endswith("</html>")
    assert "window.page = new Page" in text


def test_summaries_where_something_is_missing(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    result = Result(job(Deck.read(DECK), "--frames", "1"))
    with pytest.raises(Fault, match="for notebooks"):
        result.show()
    faulty = Deck.titled("<nothing>")
    faulty.add("MATERIAL, NAME=M")
    assert "error[" in deck_html(faulty) and "<nothing>" not in deck_html(faulty)

    def missing() -> Path:
        raise Fault("the program stickslip is not found")

    monkeypatch.setattr(page, "binary", missing)
    monkeypatch.setattr(summary, "binary", missing)
    assert f"{len(result.coordinates)} nodes" in result_html(result)
    assert "is not found" in deck_html(faulty) and "*MATERIAL" in deck_html(faulty)
