"""Puts the files of `page/` and the data of results together as one HTML file."""

import html
import json
import re
import subprocess
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from stickslip.errors import Fault
from stickslip.program import binary
from stickslip.report.collect import Choice, collect, collect_outline
from stickslip.report.pack import Packed

SCRIPTS = (
    "decode.js",
    "format.js",
    "colours.js",
    "fields.js",
    "raster.js",
    "marks.js",
    "view.js",
    "mouse.js",
    "player.js",
    "charts.js",
    "histories.js",
    "page.js",
)
"""Scripts of the page in the order in which they stand in it."""


def page_of(paths: Sequence[Path], choice: Choice = Choice()) -> str:
    """The page of a result; if two paths are given, the second result is laid over the first."""
    packed = Packed()
    first, *others = paths
    results = [
        collect(first, packed, choice),
        *(collect_outline(each, packed, choice) for each in others),
    ]
    data = {
        "results": results,
        "info": info_of(first),
        "version": results[0]["run"].get("program", ""),
    }
    data["version"] = f"{data['version']} {results[0]['run'].get('version', '')}".strip()
    style = _file("uplot/uPlot.min.css") + _file("page.css")
    licence = "\n".join(f"// {line}".rstrip() for line in _file("uplot/LICENSE").splitlines())
    parts = {
        "title": html.escape(first.stem),
        "style": style,
        "data": json.dumps(data, allow_nan=False).replace("<", "\\u003c"),
        "blobs": "\n".join(
            f'<script type="text/plain" id="blob{i}">{blob}</script>'
            for i, blob in enumerate(packed.blobs)
        ),
        "charts": f"{licence}\n{_file('uplot/uPlot.iife.min.js')}",
        "script": '"use strict";\n' + "\n".join(map(_file, SCRIPTS)),
    }
    pieces = _file("page.html").split("{{")
    text = [pieces[0]]
    for piece in pieces[1:]:
        name, rest = piece.split("}}", 1)
        text += [parts[name], rest]
    return "".join(text)


def _file(name: str) -> str:
    return resources.files(__package__).joinpath("page", name).read_text(encoding="utf-8")


def info_of(path: Path) -> dict[str, Any]:
    """Output of `stickslip info` for a result: lines [name, text], warnings, and missing data."""
    try:
        done = subprocess.run(
            [str(binary()), "info", str(path)], capture_output=True, text=True, check=False
        )
        missing = (
            f"stickslip info failed: {' '.join(done.stderr.split())}" if done.returncode else None
        )
    except Fault:
        missing = (
            "The program stickslip was not found when this page was written:"
            " summary and warnings are missing."
        )
    if missing:
        return {"lines": [], "warnings": [], "missing": missing}
    lines: list[list[str]] = []
    for line in done.stdout.splitlines():
        name, text = line[:9].strip(), re.sub(" {2,}", " · ", line[9:].strip())
        if name:
            lines.append([name, text])
        elif lines:
            lines[-1][1] += (" " if lines[-1][0] == "warning" else "\n") + text
    warnings = [text for name, text in lines if name == "warning"]
    return {
        "lines": [each for each in lines if each[0] != "warning"],
        "warnings": warnings,
        "missing": None,
    }
