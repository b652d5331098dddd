"""Draws sentences at random from all that a reader meets, to be graded, and counts the grades.

    scripts/lab/run sentences --seed 7 --number 200 -o sentences.txt
    scripts/lab/run sentences --count sentences.txt

A line of the file is `- PLACE | SENTENCE`. The grader reads the sentence alone, without its paragraph, and writes a
grade for the dash: A clear at once, B at the second reading, C not clear. Of a table each row is a sentence, its cells
behind the heads of their columns. `[formula]` stands for the formula that ends a sentence.

Groups are drawn by their shares: the guide (README.md and docs/), the reference (keywords, messages, result file),
READMEs of examples, cases and scripts, doc comments of the source, and `--help`. Within a group all sentences are alike.
The list of books and papers (docs/references.md) has none.
"""

import argparse
import ast
import os
import random
import re
import subprocess
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

REFERENCE = ("docs/keywords.md", "docs/messages.md", "docs/output.md")
BOOKS = "docs/references.md"
COMMANDS = ("run", "check", "explain", "flatten", "info", "lsp", "lcp")
SHARES = {"guide": 0.45, "reference": 0.15, "readme": 0.2, "comment": 0.15, "help": 0.05}
ABBREVIATIONS = ("eq.", "St.", "Fig.", "No.", "cf.", "e.g.", "i.e.", "J.", "H.", "B.", "M.")

Sentences = list[tuple[str, str]]
"""Places (file and line) and sentences."""


def sentences(text: str) -> Iterator[str]:
    """The sentences of a paragraph; shorter ones than three words are labels."""
    whole = ""
    for part in re.split(r"(?<=[.!?])\s+", " ".join(text.split())):
        whole = f"{whole} {part}".strip()
        if not whole.endswith(ABBREVIATIONS):
            if len(whole.split()) > 2:
                yield whole
            whole = ""
    if len(whole.split()) > 2:
        yield whole


def of_markdown(path: str, text: str) -> Sentences:
    """Sentences of paragraphs and lists, rows of tables, and what the program says in blocks of messages."""
    found: Sentences = []
    paragraph: list[str] = []
    heads: list[str] = []
    start, in_block = 0, False

    def close(end: str = "") -> None:
        joined = re.sub(r"^(\* |\d+\. |> )", "", " ".join(paragraph))
        if joined and not joined.endswith((".", "!", "?", ":")):
            joined += end
        found.extend((f"{path}:{start}", one) for one in sentences(joined))
        paragraph.clear()

    for number, line in enumerate(text.splitlines(), 1):
        stripped = line.strip()
        if stripped.startswith("```"):
            close(" [formula]")
            in_block = not in_block
            continue
        if line.startswith("    ") and not paragraph:
            continue
        if in_block:
            said = re.match(r"(?:(?:error|warning|note)\[D\d+\]: |= help: )(.*)", stripped)
            if said:
                found.extend((f"{path}:{number}", one) for one in sentences(said[1]))
            continue
        if re.match(r"\* |\d+\. |\|.*\|$|#|<!--|!\[", stripped) or not stripped:
            close()
        is_row = re.match(r"\|.*\|$", stripped)
        if not is_row:
            heads = []
        elif not re.match(r"\|[-| :]*-[-| :]*$", stripped):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", stripped)[1:-1]]
            if not heads:
                heads = cells
            elif sum(len(re.findall(r"[A-Za-z]{3,}", cell)) for cell in cells) > 4:
                said = [f"{head}: {cell}" if head else cell for head, cell in zip(heads, cells)]
                found.append((f"{path}:{number}", " | ".join(said)))
        if stripped and not is_row and not re.match(r"#|<!--|!\[", stripped):
            start = start if paragraph else number
            paragraph.append(stripped)
    close()
    return found


def of_rust(path: str, text: str) -> Sentences:
    """Sentences of the doc comments."""
    found: Sentences = []
    lines: list[str] = []
    for number, line in enumerate([*text.splitlines(), ""], 1):
        doc = re.match(r"\s*//[/!] ?(.*)", line)
        if doc:
            lines.append(doc[1])
        elif lines:
            at = f"{path}:{number - len(lines)}"
            found.extend((at, one) for _, one in of_markdown(path, "\n".join(lines)))
            lines.clear()
    return found


def of_python(path: str, text: str) -> Sentences:
    """Sentences of the docstrings."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    found: Sentences = []
    for node in ast.walk(ast.parse(text)):
        doc = ast.get_docstring(node) if isinstance(node, kinds) else None
        if doc:
            at = f"{path}:{getattr(node, 'lineno', 1)}"
            found.extend((at, one) for _, one in of_markdown(path, doc))
    return found


def of_help(program: str) -> Sentences:
    """Sentences of `--help` of the program and of its commands."""
    found: Sentences = []
    for command in ((), *((name,) for name in COMMANDS)):
        text = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True).stdout
        blocks = re.split(r"\n\s*\n|\n(?=\s+-)|\n(?=  [a-z]+  )|  +(?=[A-Z])", text)
        at = " ".join(["--help", *command])
        found.extend((at, one) for block in blocks for one in sentences(block))
    return found


def groups(program: str) -> dict[str, Sentences]:
    """All sentences by group."""
    found: dict[str, Sentences] = {group: [] for group in SHARES}
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for path in tracked.splitlines():
        if (ROOT / path).is_symlink():
            continue
        text = (ROOT / path).read_text() if path.endswith((".md", ".rs", ".py")) else ""
        if path in REFERENCE:
            found["reference"] += of_markdown(path, text)
        elif path == "README.md" or path.startswith("docs/") and path.endswith(".md") and path != BOOKS:
            found["guide"] += of_markdown(path, text)
        elif path.endswith("README.md"):
            found["readme"] += of_markdown(path, text)
        elif path.startswith(("src/", "crates/")) and path.endswith(".rs"):
            found["comment"] += of_rust(path, text)
        elif path.startswith("python/") and path.endswith(".py"):
            found["comment"] += of_python(path, text)
    found["help"] = of_help(program)
    return found


def drawn(seed: int, number: int, pages: re.Pattern[str], program: str) -> Sentences:
    """The sentences to grade, of places that match a pattern; groups without any give their share to the others."""
    chosen = {
        group: [one for one in all_of if pages.search(one[0])] for group, all_of in groups(program).items()
    }
    chosen = {group: all_of for group, all_of in chosen.items() if all_of}
    share = sum(SHARES[group] for group in chosen)
    dice = random.Random(seed)
    found: Sentences = []
    for group, all_of in chosen.items():
        count = min(len(all_of), round(number * SHARES[group] / share))
        found += sorted(dice.sample(all_of, count))
    return found


def count(text: str) -> str:
    """The grades of a file, by page, as lines."""
    grades: dict[str, Counter[str]] = {}
    for line in text.splitlines():
        graded = re.match(r"([ABC-]) (.*?)(?::\d+)? \| ", line)
        if graded:
            page = graded[2]
            if page.startswith(("src/", "crates/", "python/")):
                page = "doc comments"
            elif page.count("/") > 1:
                page = page.partition("/")[0]
            for name in (page, "all"):
                grades.setdefault(name, Counter())[graded[1]] += 1
    lines = []
    for page, found in grades.items():
        total = found.total()
        figures = "  ".join(f"{grade} {found[grade]:3d}" for grade in "ABC-" if found[grade])
        lines.append(f"{page:28s} {total:4d}   {100 * found['A'] / total:3.0f} % clear at once   {figures}")
    return "\n".join(sorted(lines, key=lambda line: line.startswith("all ")))


def main() -> None:
    """Draws or counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1, help="of the drawing; a new one gives another sample")
    parser.add_argument("--number", type=int, default=200, help="how many sentences")
    parser.add_argument("--pages", default="", help="regular expression of the places to draw from")
    parser.add_argument("--count", type=Path, metavar="FILE", help="counts the grades of this file")
    parser.add_argument("-o", "--output", type=Path, help="the file to write; without it the screen")
    parser.add_argument("--program", default=os.environ.get("STICKSLIP", str(ROOT / "target/release/stickslip")))
    options = parser.parse_args()
    if options.count:
        print(count(options.count.read_text()))
        return
    sample = drawn(options.seed, options.number, re.compile(options.pages), options.program)
    text = "".join(f"- {place} | {sentence}\n" for place, sentence in sample)
    if options.output:
        options.output.write_text(text)
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
