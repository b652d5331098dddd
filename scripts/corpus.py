"""Checks every deck of a folder within bounds of time and memory and makes a table of what becomes of
them: models, and messages by the code and the keyword of the first error."""

import argparse
import collections
import datetime
import pathlib
import re
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reliability.md"
SECONDS = 20
MEGABYTES = 1024
# Line of a message: `error[D201]: ...`, and its place two lines below.
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
        f"`scripts/corpus` on {date}: {len(ends)} decks of the package {package}, each within "
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
