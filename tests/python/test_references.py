"""docs/references.md has every work that documents and source cite by name and year."""

import re
from calendar import month_name
from pathlib import Path

from conftest import ROOT

CITED = re.compile(r"\b([A-Z][a-zé]+)(?: et al\.| and others)? \(?((?:17|18|19|20)\d\d)\b")
"""The last name before a year, and the year."""

FOLDERS = ("docs", "input", "verification", "src", "crates", "tests/dynamics", "tests/lcp")
GENERATED = {"REPORT.md", "references.md"}


def texts() -> list[Path]:
    """Documents and sources."""
    paths = [
        path
        for folder in FOLDERS
        for path in (ROOT / folder).rglob("*")
        if path.suffix in {".md", ".rs"}
    ]
    return [path for path in paths if path.name not in GENERATED]


def test_every_citation_has_an_entry() -> None:
    entries = (ROOT / "docs/references.md").read_text()
    listed = {
        (name, year)
        for line in entries.splitlines()
        for year in re.findall(r"\b\d{4}\b", line)
        for name in re.findall(r"[A-Z]\w+", line)
    }
    cited = {
        (name, year, path.name)
        for path in texts()
        for name, year in CITED.findall(path.read_text())
    }
    assert len(cited) > 40
    plain = {(name.replace("é", "e"), year) for name, year in listed}
    absent = [
        c
        for c in cited
        if c[0] not in list(month_name) and (c[0].replace("é", "e"), c[1]) not in plain
    ]
    assert sorted(absent) == []
