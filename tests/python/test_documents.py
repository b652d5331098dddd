"""All documents: links lead somewhere, pictures are small and used, pages are reached from the index."""

import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

LISTED = subprocess.run(
    ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
    cwd=ROOT,
    capture_output=True,
    text=True,
    check=True,
).stdout
PAGES = [
    path
    for path in (ROOT / name for name in sorted(set(LISTED.splitlines())))
    if path.exists() and not path.is_symlink()
]

LINK = re.compile(r'!?\[[^\]\[]*\]\(([^()\s]+)\)|<img src="([^"]+)"')

LARGEST = 2_000_000
"""Bytes that the pictures of the guide may have together."""


def without_code(text: str) -> str:
    """The text without blocks and spans of code."""
    return re.sub(r"`[^`\n]*`", "``", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE))


def anchors(path: Path) -> set[str]:
    """The anchors of the headings of a page, as GitHub makes them."""
    blocks = re.sub(r"^```.*?^```", "", path.read_text(), flags=re.DOTALL | re.MULTILINE)
    found: set[str] = set()
    for heading in re.findall(r"^#+ +(.*?) *$", blocks, flags=re.MULTILINE):
        shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("\\", "").lower()
        anchor = re.sub(r"[^\w\- ]", "", shown).replace(" ", "-")
        times = sum(1 for known in found if re.fullmatch(rf"{re.escape(anchor)}(-\d+)?", known))
        found.add(f"{anchor}-{times}" if times else anchor)
    return found


def links(page: Path) -> list[str]:
    """Targets of the links of a page, those to the web left out."""
    found = [link or picture for link, picture in LINK.findall(without_code(page.read_text()))]
    return [to for to in found if not re.match(r"[a-z]+:", to)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    wrong = []
    for link in links(page):
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        if not target.exists():
            wrong.append(link)
        elif anchor and (target.suffix != ".md" or anchor not in anchors(target)):
            wrong.append(link)
    assert wrong == []


def test_every_page_is_reached_from_the_index() -> None:
    """In one step or several."""
    reached: set[Path] = set()
    waiting = [ROOT / "docs" / "README.md"]
    while waiting:
        page = waiting.pop()
        if page not in reached and page in PAGES:
            reached.add(page)
            waiting += [(page.parent / link.partition("#")[0]).resolve() for link in links(page)]
    assert [page for page in PAGES if (ROOT / "docs") in page.parents and page not in reached] == []


def test_pictures_are_small_and_used() -> None:
    shown = {(page.parent / link).resolve() for page in PAGES for link in links(page) if link.endswith((".png", ".svg"))}
    own = [*ROOT.glob("docs/**/*.png"), *ROOT.glob("docs/**/*.svg"), *ROOT.glob("input/*/*.png")]
    assert set(own) - shown == set()
    assert len(own) >= 20
    assert sum(picture.stat().st_size for picture in own) < LARGEST


def test_the_gallery_shows_every_example_and_its_cards() -> None:
    text = (ROOT / "input" / "README.md").read_text()
    rows = re.findall(r'^\| <img src="(\w+)/\w+\.png".*?\| \[(\w+)\]\((\w+)/README\.md\) \|.*\| (.*) \|$', text, flags=re.MULTILINE)
    assert sorted(name for _, name, _, _ in rows) == sorted(path.name for path in (ROOT / "input").iterdir() if path.is_dir())
    for picture, name, folder, cards in rows:
        assert picture == name == folder
        decks = [path.read_text().upper() for path in (ROOT / "input" / name).glob("*.in[pc]")]
        for card in re.findall(r"`\*([A-Z ]+)[,`]", cards):
            assert any(f"*{card}" in deck for deck in decks), (name, card)
