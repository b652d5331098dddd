"""Summaries of results and decks with a small picture, which notebooks show, and the report page in a frame.

Packages with a long import time are imported only when they are needed; matplotlib is used if it is installed.
"""

import base64
import html
import subprocess
import tempfile
from io import BytesIO
from pathlib import Path

from stickslip.deck import Deck
from stickslip.errors import Fault
from stickslip.notebook import Paged, Shown
from stickslip.program import binary
from stickslip.result import Result

STYLE = "max-width:100%;max-height:340px"
"""Of pictures."""


def result_html(result: Result) -> str:
    """Name, picture and summary of a result."""
    from stickslip.report.page import info_of

    info = info_of(result.path)
    lines = info["lines"] or [["model", f"{len(result.coordinates)} nodes, {len(result.cells)} elements"]]
    lines += [["warning", text] for text in info["warnings"]]
    rows = "".join(f"<tr><th>{html.escape(name)}</th><td>{_lines(text)}</td></tr>" for name, text in lines)
    style = "<style scoped>.stickslip th, .stickslip td {text-align:left; vertical-align:top}</style>"
    return f"{style}<b>{html.escape(result.job)}</b><br>{_picture(result)}<table class='stickslip'>{rows}</table>"


def _lines(text: str) -> str:
    return html.escape(text).replace("\n", "<br>")


def _picture(result: Result) -> str:
    """Picture of the end of the step with the largest stress; empty if matplotlib is not installed."""
    try:
        from stickslip.plot.fields import Field, Peak
        from stickslip.plot.motion import Look, panels, step_ends
    except ImportError:
        return ""
    ends = [(result, frame) for frame in step_ends(result)]
    peak = Peak.of(Field("MISES"), ends)
    figure = panels([[(result, peak.frame) if peak else ends[-1]]], Look("MISES"))
    file = BytesIO()
    figure.savefig(file, format="png", dpi=60)
    return _image("png", file.getvalue())


def _image(kind: str, data: bytes) -> str:
    return f'<img alt="picture" style="{STYLE}" src="data:image/{kind};base64,{base64.b64encode(data).decode()}"><br>'


def deck_html(deck: Deck) -> str:
    """Picture of the model of a deck and the messages of the program about the deck; without the program, the number of
    cards."""
    counts: dict[str, int] = {}
    for card in deck.cards:
        counts[card.keyword] = counts.get(card.keyword, 0) + 1
    cards = ", ".join(f"{count} *{keyword}" if count > 1 else f"*{keyword}" for keyword, count in counts.items())
    head = f"<b>deck</b> of {len(deck.cards)} cards: {html.escape(cards)}<br>"
    try:
        program = str(binary())
    except Fault as fault:
        return head + _lines(str(fault))
    with tempfile.TemporaryDirectory() as folder:
        path, picture = deck.write(Path(folder) / "deck.inp"), Path(folder) / "deck.svg"
        command = [program, "check", str(path), "--picture", str(picture)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        image = _image("svg+xml", picture.read_bytes()) if picture.exists() else ""
        told = "\n".join(filter(None, (done.stdout.strip(), done.stderr.strip()))).replace(f"{folder}/", "")
    return f"{head}{image}<pre>{html.escape(told)}</pre>"


def page_html(result: Result, height: int) -> str:
    """The report page of a result in a frame."""
    from stickslip.report.page import page_of

    page = html.escape(page_of([result.path]))
    return f'<iframe srcdoc="{page}" style="width:100%;height:{height}px;border:0"></iframe>'


Shown.summaries |= {Result: result_html, Deck: deck_html}
Paged.pages |= {Result: page_html}
