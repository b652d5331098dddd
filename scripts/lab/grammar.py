"""Writes docs/editor/stickslip.tmLanguage.json, the TextMate grammar of decks, from the keyword table.

The table is that of the reader: scripts/dimensions.json for keywords that are read, with their
parameters and values, and docs/keywords.md for those that are not. Both are written by the program.
"""

import json
import re
from typing import Any

from repository import ROOT

GRAMMAR = ROOT / "docs" / "editor" / "stickslip.tmLanguage.json"

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?"
END = r"(?=\s*(?:,|$))"


def spelled(name: str) -> str:
    """A regular expression of a name, in which blanks may stand anywhere between words."""
    return r"\s*".join(map(re.escape, name.split()))


def any_of(names: list[str]) -> str:
    """Any of these names, longer ones first."""
    return "|".join(spelled(name) for name in sorted(names, key=lambda name: (-len(name), name)))


def unread() -> tuple[list[str], list[str]]:
    """Keywords that stop with an error or are left out with a warning, and those left out silently."""
    page = (ROOT / "docs" / "keywords.md").read_text()
    rest = page[page.index("## Keywords that stop with an error") :]
    parts = rest.split("## Keywords that are left out without a warning")
    found = [re.findall(r"^\| `\*([^`]+)` \|", part, flags=re.MULTILINE) for part in parts]
    return found[0], found[1]


def keyword(name: str, entry: dict[str, Any]) -> dict[str, Any]:
    """The rule of a keyword line: its parameters, those it does not have, and their values."""
    patterns: list[dict[str, Any]] = []
    for parameter, values in entry.get("parameters", {}).items():
        own = rf"(?i)(?<=,)\s*({spelled(parameter)})\s*"
        if values:
            patterns.append(
                {
                    "match": rf"{own}(=)\s*({any_of(values)}){END}",
                    "captures": {
                        "1": {"name": "variable.parameter.stickslip"},
                        "2": {"name": "keyword.operator.stickslip"},
                        "3": {"name": "constant.language.stickslip"},
                    },
                }
            )
        patterns.append(
            {
                "match": rf"{own}(?:(=)\s*(\"[^\"]*\"|[^,]*[^,\s])?)?{END}",
                "captures": {
                    "1": {"name": "variable.parameter.stickslip"},
                    "2": {"name": "keyword.operator.stickslip"},
                    "3": {"name": "string.unquoted.stickslip"},
                },
            }
        )
    patterns.append({"match": r"(?<=,)\s*[^,]*[^,\s]", "name": "invalid.deprecated.stickslip"})
    rule = {
        "begin": rf"(?i)^\s*(\*\s*{spelled(name)}){END}",
        "beginCaptures": {"1": {"name": "keyword.control.stickslip"}},
        "end": r"(?<![,\s])\s*$|^(?=\s*\*)",
        "patterns": patterns,
    }
    if entry.get("text"):
        return {
            "begin": rf"(?i)^\s*(\*\s*{spelled(name)}){END}(.*)$",
            "beginCaptures": {
                "1": {"name": "keyword.control.stickslip"},
                "2": {"name": "variable.parameter.stickslip"},
            },
            "end": r"^(?=\s*\*(?!\*))",
            "patterns": [
                {"include": "#comment"},
                {"match": r".+", "name": "string.unquoted.stickslip"},
            ],
        }
    return rule


def grammar() -> dict[str, Any]:
    """The whole grammar."""
    table = json.loads((ROOT / "scripts" / "dimensions.json").read_text())
    told, silent = unread()
    read = {name: entry for name, entry in table.items() if name not in (*told, *silent)}
    return {
        "name": "stickslip",
        "scopeName": "source.stickslip",
        "fileTypes": ["inp"],
        "patterns": [
            {"include": "#comment"},
            {"include": "#keywords"},
            {"include": "#unread"},
            {"include": "#silent"},
            {"include": "#unknown"},
            {"include": "#data"},
        ],
        "repository": {
            "comment": {"match": r"^\s*\*\*.*$", "name": "comment.line.stickslip"},
            "keywords": {"patterns": [keyword(name, entry) for name, entry in read.items()]},
            "unread": {
                "match": rf"(?i)^\s*\*\s*(?:{any_of(told)}){END}.*$",
                "name": "invalid.deprecated.stickslip",
            },
            "silent": {
                "match": rf"(?i)^\s*\*\s*(?:{any_of(silent)}){END}.*$",
                "name": "comment.line.stickslip",
            },
            "unknown": {"match": r"^\s*\*.*$", "name": "invalid.illegal.stickslip"},
            "data": {
                "patterns": [
                    {"match": r"\"[^\"]*\"", "name": "string.quoted.double.stickslip"},
                    {"match": r"<[^<>]*>", "name": "variable.other.stickslip"},
                    {"match": rf"(?<![\w.-]){NUMBER}{END}", "name": "constant.numeric.stickslip"},
                    {"match": r"[^,\s\"][^,\"]*", "name": "entity.name.stickslip"},
                ]
            },
        },
    }


def text() -> str:
    """The grammar as it stands in the file."""
    return json.dumps(grammar(), indent=1) + "\n"


if __name__ == "__main__":
    GRAMMAR.write_text(text())
