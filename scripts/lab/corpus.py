"""Checks every deck of a folder within bounds of time and memory and makes a table of what becomes of
them: models, and messages by the code and the keyword of the first error. Models are run, and their
displacements compared with the results of CalculiX beside the deck."""

import argparse
import collections
import datetime
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from repository import ROOT
from stickslip.deck import Deck
from stickslip.result import Result

PAGE = ROOT / "docs" / "reliability.md"
SECONDS = 20
MEGABYTES = 1024
# Loads of the second comparison, beside those of the deck.
SMALL = 1e-4
# Line of a message: `error[D201]: ...`, and its place two lines below.
# Heading of a table of displacements in a result of CalculiX.
TABLE = re.compile(r"^ displacements \(vx,vy,vz\) for set \S+ and time +(\S+)$")
ERROR = re.compile(r"^error\[(D\d+)\]: (.*)$", re.MULTILINE)
PLACE = re.compile(r"^ *--> .+:(\d+):\d+$", re.MULTILINE)


def bound():
    size = MEGABYTES * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (size, size))


def check(program, deck, arguments=()):
    """How the check of a deck ends: ("model", "", "") or ("error", code, message); everything else
    is a fault of the program. Also its wall time in seconds."""
    start = time.monotonic()
    try:
        done = subprocess.run([program, "check", deck, *arguments], capture_output=True,
                              timeout=SECONDS, preexec_fn=bound, check=False)
    except subprocess.TimeoutExpired:
        return ("fault", "", f"no end after {SECONDS} s"), SECONDS
    seconds = time.monotonic() - start
    messages = done.stderr.decode(errors="replace")
    if done.returncode == 0:
        return ("model", "", ""), seconds
    first = ERROR.search(messages)
    if done.returncode == 2 and first and PLACE.search(messages, first.end()):
        return ("error", first[1], first[2]), seconds
    return ("fault", "", f"exit {done.returncode}: {messages[-300:]}"), seconds


def reason(code, message):
    """The message without the names and numbers of one deck."""
    keyword = re.search(r"\*[A-Z][A-Z ]*[A-Z]", message)
    if code in ("D201", "D103") and keyword:
        return f"`{keyword[0]}`"
    element = re.match(r"element type (\S+) cannot be used", message)
    if element:
        return f"element type `{element[1].upper()}`"
    message = message.split(":")[0]
    return re.sub(r"-?\b\d[\d.eE+-]*", "n", message)


def table(found):
    rows = collections.Counter((code, reason(code, message)) for _, code, message in found)
    lines = ["| decks | code | first error |", "|---|---|---|"]
    ordered = sorted(rows.items(), key=lambda row: (-row[1], row[0]))
    for (code, text), count in ordered:
        lines.append(f"| {count} | {code} | {text.replace('|', '/')} |")
    return lines


def displacements(path):
    """Tables of a result of CalculiX: time, and displacements by node number."""
    tables = []
    for line in path.read_text().splitlines():
        heading = TABLE.match(line)
        fields = line.split()
        if heading:
            tables.append((float(heading[1]), {}))
        elif tables and len(fields) == 4 and fields[0].isdigit():
            tables[-1][1][int(fields[0])] = [float(value) for value in fields[1:3]]
        elif fields:
            tables.append((0.0, {}))
    return [table for table in tables if table[1]]


def scaled(deck, folder):
    """A deck whose loads and prescribed motions are SMALL times those of another."""
    read = Deck.read(deck)
    for keyword, field in (("CLOAD", 2), ("DLOAD", 2), ("BOUNDARY", 3)):
        for card in read.find(keyword):
            for row in card.rows:
                if len(row) > field:
                    row[field] = repr(float(row[field]) * SMALL)
    path = folder / f"{deck.stem}_small.inp"
    path.write_text(read.text())
    return path


def difference(program, deck, tables, scale):
    """Increments of a model that CalculiX has solved too, and the largest difference of its
    displacements, divided by `scale`, as a part of the largest one; or how it ends."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run([program, "run", deck, "-o", folder], capture_output=True,
                                  timeout=SECONDS, preexec_fn=bound, check=False)
        except subprocess.TimeoutExpired:
            return "", f"no end after {SECONDS} s"
        if done.returncode:
            return "", f"exit {done.returncode}"
        largest = worst = 0.0
        with Result(f"{folder}/{deck.stem}.vtkhdf") as result:
            increments = len(result.history.time) - 1
            index = {int(label): k for k, label in enumerate(result.read("model/node_labels"))}
            for when, nodes in tables:
                moved = result.frame(when)["U"] / scale
                own = np.array([moved[index[node], :2] for node in nodes])
                other = np.array([*nodes.values()])
                largest = max(largest, np.abs(other).max())
                worst = max(worst, np.abs(own - other).max())
    return str(increments), f"{worst / largest:.1e}" if tables else "no displacements printed"


def compared(program, decks):
    """Lines about the models, each beside the result of CalculiX."""
    lines = ["", "The table compares the models, run unchanged, with CalculiX: the largest difference of the "
             "displacements, divided by the largest displacement. CalculiX assumes small displacements; the last column "
             f"has loads of {SMALL:g} times these.", "",
             "| deck | increments | difference | small loads |", "|---|---|---|---|"]
    for deck in decks:
        reference = deck.with_suffix(".dat.ref")
        tables = displacements(reference) if reference.exists() else []
        increments, whole = difference(program, deck, tables, 1.0)
        with tempfile.TemporaryDirectory() as folder:
            small = scaled(deck, pathlib.Path(folder))
            lines.append(f"| {deck.stem} | {increments} | {whole} | "
                         f"{difference(program, small, tables, SMALL)[1] if tables else ''} |")
    return lines if decks else []


def report(package, results, lenient):
    """The section of the page."""
    ends = [end for end, _ in results]
    kinds = collections.Counter(end[0] for end in ends)
    slowest = max(seconds for _, seconds in results)
    errors = [end for end in ends if end[0] == "error"]
    faults = "none" if not kinds["fault"] else str(kinds["fault"])
    date = datetime.date.today().isoformat()
    more = sum(end[0] == "model" for end, _ in lenient)
    return "\n".join([
        f"`scripts/lab/corpus` on {date}: {len(ends)} decks of the package {package}, each within "
        f"{SECONDS} s and {MEGABYTES} MB. {kinds['model']} read as models ({more} with `--lenient`), "
        f"{kinds['error']} end with a message that names file and line, {faults} otherwise; the "
        f"slowest took {slowest:.2f} s.", "", *table(errors)])


def replace_section(page, name, text):
    """Puts text between the marks of a section of a page."""
    begin, end = f"<!-- {name} -->\n", f"\n<!-- end of {name} -->"
    before, rest = page.read_text().split(begin)
    after = rest.split(end)[1]
    page.write_text(before + begin + text + end + after)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="holds the package and its content")
    parser.add_argument("--write", action="store_true", help="write docs/reliability.md")
    options = parser.parse_args()
    package = next(options.folder.glob("*.deb")).stem
    decks = sorted(options.folder.glob("usr/**/*.inp"))
    results = [check(options.program, deck) for deck in decks]
    lenient = [check(options.program, deck, ["--lenient"]) for deck in decks]
    text = report(" ".join(package.split("_")[:2]), results, lenient)
    models = [deck for deck, (end, _) in zip(decks, results) if end[0] == "model"]
    text = "\n".join([text, *compared(options.program, models)])
    print(text)
    faults = [(deck, end) for runs in (results, lenient) for deck, (end, _) in zip(decks, runs)
              if end[0] == "fault"]
    for deck, end in faults:
        print(f"fault: {deck}: {end[2]}", file=sys.stderr)
    if options.write:
        replace_section(PAGE, "corpus", text)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
