"""The grammar of decks, the extension of VS Code and the problem matcher of editors."""

import json
import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT
from lab import grammar
from stickslip import program

Rules = list[dict[str, Any]]

DECKS = sorted([*ROOT.glob("tests/decks/*.inp"), *ROOT.glob("input/*/*.inp")])
FAULTY = {"cycle", "faulty_include", "keyword_in_rows", "missing_include"}


def rules() -> tuple[Rules, re.Pattern[str], re.Pattern[str], re.Pattern[str]]:
    """Rules of keywords, and the patterns of those that are not read, left out silently, and unknown."""
    parts = json.loads(grammar.GRAMMAR.read_text())["repository"]
    names = ("unread", "silent", "unknown")
    unread, silent, unknown = (re.compile(parts[name]["match"]) for name in names)
    return parts["keywords"]["patterns"], unread, silent, unknown


def scopes(line: str, found: Rules) -> list[tuple[str, str]]:
    """Pieces of a keyword line with their scopes, as an editor finds them."""
    for rule in found:
        head = re.match(rule["begin"], line)
        if not head:
            continue
        pieces = [(name["name"], head[int(k)]) for k, name in rule["beginCaptures"].items()]
        at = head.end()
        while at < len(line):
            hits = [(re.compile(one["match"]).search(line, at), one) for one in rule["patterns"]]
            hits = [(hit, one) for hit, one in hits if hit and hit.end() > hit.start()]
            if not hits:
                break
            hit, one = min(hits, key=lambda each: each[0].start())
            if "name" in one:
                pieces.append((one["name"], hit[0]))
            for k, name in one.get("captures", {}).items():
                if hit[int(k)]:
                    pieces.append((name["name"], hit[int(k)]))
            at = hit.end()
        return [(name.removesuffix(".stickslip"), text.strip()) for name, text in pieces]
    return []


def test_the_grammar_is_up_to_date() -> None:
    assert grammar.GRAMMAR.read_text() == grammar.text(), "run scripts/lab/run grammar"


def test_pieces_of_lines() -> None:
    found, unread, silent, unknown = rules()
    assert scopes("*Solid section, elset=A, MATERIAL=B", found) == [
        ("keyword.control", "*Solid section"),
        ("variable.parameter", "elset"),
        ("keyword.operator", "="),
        ("string.unquoted", "A"),
        ("variable.parameter", "MATERIAL"),
        ("keyword.operator", "="),
        ("string.unquoted", "B"),
    ]
    assert ("constant.language", "ENERGY-MOMENTUM") in scopes(
        "*STICKSLIP, SCHEME=ENERGY-MOMENTUM", found
    )
    assert ("invalid.deprecated", "FOO=1") in scopes("*NODE, FOO=1, NSET=A", found)
    assert ("string.unquoted", "A") in scopes("*NODE, FOO=1, NSET=A", found)
    assert not scopes("*NODES", found) and not scopes("*BONDARY", found)
    assert unread.match("*TRANSFORM, TYPE=C") and not unread.match("*NODE")
    assert silent.match("*Preprint, echo=NO") and unknown.match("*BONDARY")


@pytest.mark.parametrize("path", DECKS, ids=lambda path: path.stem)
def test_decks_have_no_invalid_piece(path: Path) -> None:
    if path.stem in FAULTY:
        pytest.skip("a deck with errors")
    found, unread, silent, _ = rules()
    lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    heads = [line for line in lines if re.match(r"\s*\*(?!\*)", line)]
    assert heads
    for line in heads:
        pieces = scopes(line, found)
        assert pieces or unread.match(line) or silent.match(line), line
        marked = [text for name, text in pieces if name.startswith("invalid")]
        assert not marked, line


def test_the_problem_matcher_reads_messages(tmp_path: Path) -> None:
    task = json.loads((ROOT / "docs" / "editor" / "problem-matcher.json").read_text())["tasks"][0]
    head, place = (re.compile(one["regexp"]) for one in task["problemMatcher"]["pattern"])
    deck = tmp_path / "bad.inp"
    deck.write_text("*NODE\n1, 0., 0.\n*BONDARY\n1, 1\n")
    command = [str(program.binary()), *task["args"][:-1], str(deck)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    lines = (done.stdout + done.stderr).splitlines()
    found = [
        (one[1], one[2], two[1], two[2], two[3])
        for first, second in zip(lines, lines[1:])
        if (one := head.match(first)) and (two := place.match(second))
    ]
    assert ("error", "D103", str(deck), "3", "1") in found


@pytest.mark.skipif(shutil.which("npm") is None, reason="npm is not there")
def test_the_extension_is_built(tmp_path: Path) -> None:
    source, folder = ROOT / "docs" / "editor", tmp_path / "editor"
    shutil.copytree(source, folder, ignore=shutil.ignore_patterns("node_modules", "dist", "*.vsix"))
    for words in (["ci", "--no-audit", "--no-fund"], ["run", "package"]):
        done = subprocess.run(
            ["npm", *words],
            cwd=folder / "vscode",
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=900,
        )
        assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(folder / "vscode" / "stickslip.vsix") as package:
        names = set(package.namelist())
        manifest = json.loads(package.read("extension/package.json"))
        [colours] = manifest["contributes"]["grammars"]
        inside = f"extension/{colours['path'].removeprefix('./')}"
        assert package.read(inside).decode() == grammar.GRAMMAR.read_text()
        assert b"lsp" in package.read(f"extension/{manifest['main'].removeprefix('./')}")
    assert "extension/language-configuration.json" in names
