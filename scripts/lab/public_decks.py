"""Checks and runs the public decks that public_decks.tsv lists, and makes a table of what becomes of them by
cause. The list has the place of every deck on GitHub, what of its text was read, and a judgement: the cause
for which the program has to refuse it, or `none` where the program has its physics, with the reason. Decks are
fetched, or read from a folder; they are never committed."""

import argparse
import collections
import csv
import dataclasses
import datetime
import pathlib
import subprocess
import sys
import tempfile
import urllib.error
import urllib.parse
import urllib.request

from lab.corpus import PAGE, SECONDS, bound, check, replace_section

LIST = pathlib.Path(__file__).with_name("public_decks.tsv")
# The cause of decks that the program has to read.
NONE = "none"
# Decks with more bytes are not run: their models are large.
LARGE = 2**20


@dataclasses.dataclass(frozen=True)
class Listed:
    """A deck of the list: its name here, its place, what of its text was read, and the judgement."""

    deck: str
    repository: str
    commit: str
    path: str
    text: str
    cause: str
    reason: str

    def url(self):
        """Address of its text."""
        path = urllib.parse.quote(self.path)
        return f"https://raw.githubusercontent.com/{self.repository}/{self.commit}/{path}"


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What became of a deck: how its check ends, and its run if it was run."""

    listed: Listed
    end: str
    code: str
    message: str
    run: str

    def judgement(self):
        """Whether the end is the right one; a deck that ends without message is a fault."""
        if self.end == "fault":
            return "fault"
        if self.end == "model":
            return "read" if self.listed.cause == NONE else "read against the list"
        return "refused wrongly" if self.listed.cause == NONE else "refused rightly"


def read_list(path=LIST):
    """The decks of a list."""
    with path.open() as lines:
        return [Listed(**row) for row in csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE)]


def fetch(listed, folder):
    """Puts the decks into a folder that lacks them; the reasons by name of those that cannot be fetched."""
    failed = {}
    for one in listed:
        path = folder / one.deck
        if path.exists():
            continue
        try:
            with urllib.request.urlopen(one.url(), timeout=SECONDS) as answer:
                path.write_bytes(answer.read())
        except (urllib.error.URLError, OSError) as error:
            failed[one.deck] = str(error)
    return failed


def run(program, deck):
    """How the run of a model ends within the bounds."""
    if deck.stat().st_size > LARGE:
        return "too large to run here"
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run([program, "run", deck, "-o", folder], capture_output=True,
                                  timeout=SECONDS, preexec_fn=bound, check=False)
        except subprocess.TimeoutExpired:
            return f"no end after {SECONDS} s"
    return "runs" if done.returncode == 0 else f"stops with exit code {done.returncode}"


def tried(program, listed, folder):
    """What becomes of one deck."""
    deck = folder / listed.deck
    (end, code, message), _ = check(program, deck)
    return Outcome(listed, end, code, message, run(program, deck) if end == "model" else "")


def escaped(text):
    """A message in a cell of a table, with its stars and bars."""
    return text.replace("|", "/").replace("*", "\\*")


def report(listed, outcomes, failed):
    """The section of the page."""
    count = collections.Counter((one.listed.cause, one.judgement()) for one in outcomes)
    causes = collections.Counter(one.listed.cause for one in outcomes)
    texts = collections.Counter(one.text for one in listed)
    judged = ["read", "read against the list", "refused rightly", "refused wrongly", "fault"]
    due = [one for one in outcomes if one.listed.cause == NONE]
    passing = sum(one.judgement() == "read" for one in due)
    runs = sum(one.run == "runs" for one in due)
    date = datetime.date.today().isoformat()
    lines = [
        f"`scripts/lab/corpus --public` on {date}: {len(outcomes)} of {len(listed)} listed decks of "
        f"{len({one.repository for one in listed})} repositories, {len(failed)} not fetched. Of the decks of the list "
        f"{texts['whole']} were read whole for the judgement. The program has the physics of {len(due)} decks: "
        f"{passing} of these pass `check`, and {runs} of them run to their end within {SECONDS} s.", "",
        "| cause | decks | " + " | ".join(judged) + " |", "|---|---|" + "---|" * len(judged)]
    for cause, number in sorted(causes.items(), key=lambda row: (row[0] != NONE, -row[1], row[0])):
        name = "none: the program has the physics" if cause == NONE else cause
        cells = " | ".join(str(count[cause, judgement]) for judgement in judged)
        lines.append(f"| {name} | {number} | {cells} |")
    rows = [one for one in outcomes if one.judgement() not in ("read", "refused rightly") or one.run not in ("", "runs")]
    if rows:
        lines += ["", "Decks that do not end as they should, and models that do not run to their end:", "",
                  "| deck | first error, or end of the run | why |", "|---|---|---|"]
    for one in rows:
        end = f"{one.code} {escaped(one.message)}" if one.end != "model" else one.run
        path = f"{one.listed.repository}/{one.listed.path}"
        lines.append(f"| {path} | {end.strip()} | {escaped(one.listed.reason)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, help="holds the decks; those it lacks are fetched")
    parser.add_argument("--list", type=pathlib.Path, default=LIST, help="another list")
    parser.add_argument("--no-fetch", action="store_true", help="only the decks that the folder holds")
    parser.add_argument("--write", action="store_true", help="write docs/reliability.md")
    options = parser.parse_args()
    listed = read_list(options.list)
    options.folder.mkdir(parents=True, exist_ok=True)
    missing = {one.deck: "not in the folder" for one in listed if not (options.folder / one.deck).exists()}
    failed = missing if options.no_fetch else fetch(listed, options.folder)
    for deck, reason in failed.items():
        print(f"not fetched: {deck}: {reason}", file=sys.stderr)
    outcomes = [tried(options.program, one, options.folder) for one in listed if one.deck not in failed]
    if not outcomes:
        sys.exit("no deck was fetched: give a folder that holds them, --decks FOLDER")
    for one in outcomes:
        print(one.listed.deck, one.judgement(), one.code, one.message, one.run, sep="\t")
    text = report(listed, outcomes, failed)
    print(text)
    if options.write:
        replace_section(PAGE, "public decks", text)
    wrong = [one for one in outcomes if one.judgement() in ("fault", "read against the list")]
    for one in wrong:
        print(f"{one.judgement()}: {one.listed.deck}: {one.message}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
