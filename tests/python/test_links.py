"""Links between documents lead to files that exist, and to headings that they have."""

import re
from pathlib import Path

from conftest import ROOT

FOLDERS = ("docs", "input", "verification", "scripts", "python", "tests")
LINK = re.compile(r"\]\(([^)\s]+)\)")


def pages() -> list[Path]:
    """All documents of the repository."""
    below = [page for folder in FOLDERS for page in (ROOT / folder).rglob("*.md")]
    return [*ROOT.glob("*.md"), *below]


def lines(page: Path) -> list[str]:
    """The lines of a page outside of fenced blocks, without code."""
    text = re.sub(r"(?ms)^\s*```.*?^\s*```", "", page.read_text())
    return re.sub(r"`[^`\n]*`", "", text).splitlines()


def anchors(page: Path) -> set[str]:
    """The anchors of the headings of a page, as GitHub makes them."""
    text = re.sub(r"(?ms)^\s*```.*?^\s*```", "", page.read_text())
    headings = re.findall(r"(?m)^#+ (.*)$", text)
    plain = [
        re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.strip()).lower() for heading in headings
    ]
    return {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in plain}


def test_links_lead_somewhere() -> None:
    wrong, count = [], 0
    for page in pages():
        for link in (link for line in lines(page) for link in LINK.findall(line)):
            if re.match(r"[a-z]+:", link):
                continue
            count += 1
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            has_anchor = not anchor or target.suffix != ".md" or not target.exists()
            if not target.exists() or not (has_anchor or anchor in anchors(target)):
                wrong.append(f"{page.relative_to(ROOT)}: {link}")
    assert count > 200
    assert wrong == []
