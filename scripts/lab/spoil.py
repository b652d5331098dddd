"""Runs valid decks that are spoiled at random: numbers, fields, names, parameters and cards.

Every run has a few increments and bounds of time and memory. A fault is: a panic, an end by a signal, an exit
code that docs/output.md does not name, a rejected deck without file and line, a stopped run that does not
say where, results that are not finite, a run that does not heed SIGTERM. The decks of faults are kept.
"""

import argparse
import collections
import math
import os
import random
import re
import resource
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from repository import ROOT
from stickslip import command
from stickslip.deck import FREE_TEXT, Card, Deck, fields
from stickslip.errors import Fault
from stickslip.program import binary

LARGEST = 8_000
"""Characters of the largest deck that is a seed."""

INCREMENTS = 6
"""Most increments of a step of a seed."""

SECONDS = 20.0
"""Longest time before a run is asked to end; it may be long without a fault."""

TO_HEED = 20.0
"""Longest time in which a run heeds SIGTERM."""

MEGABYTES = 2048
"""Most memory of a run."""

FOLDERS = ("tests/decks", "input", "verification")

NUMBERS = (
    "0", "-0.", "1", "-1", "0.5", "1e-3", "1e3", "-1e3", "1e16", "1e-16", "1e300", "-1e300", "1e-300",
    "1e-320", "1e400", "nan", "inf", "-inf", "1.", ".", "1e", "1d3", "2147483648", "18446744073709551616",
    "-1", "0x10", "1,", "1 2",
)  # fmt: skip
"""What takes the place of a field."""

FACTORS = (1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.0, 1.0, 1.01, 1.1, 2.0, 10.0, 1e3, 1e6, 1e12)
"""What a measured number is multiplied by."""

CODES = (0, 1, 2, 4)
"""Exit codes of a run that nothing has asked to end; 4 only for want of memory."""

PLACE = re.compile(r"^ *--> .+:\d+:\d+$", re.MULTILINE)
ERROR = re.compile(r"^error\[D\d+\]: ", re.MULTILINE)
STOPPED = re.compile(r"increment|impulse|at time|step \d+")
WITHOUT_PLACE = ("cannot stand in the result file",)
"""Errors of a deck that the program finds when it makes the result file."""

OF_PAIRS = (
    "GAP", "CONTACT_PRESSURE", "SLIP", "FRICTION_COEFFICIENT", "FRICTION_WORK", "WEAR", "FRICTION_HEAT",
)  # fmt: skip
"""Fields that are NaN at nodes without a pair."""

Mutation = Callable[[list[Card], random.Random], None]


def seeds() -> dict[str, str]:
    """Texts of valid decks of few elements, in one file each and with a few increments."""
    found = {}
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.inp")):
            try:
                deck = Deck.read(path)
            except (Fault, OSError):
                continue  # a test of what happens to such decks
            shorten(deck)
            text = deck.text()
            if len(text) <= LARGEST and deck.find("STEP"):
                found[str(path.relative_to(ROOT))] = text
    return found


def shorten(deck: Deck) -> None:
    """Cuts the steps of a deck to a few increments."""
    for card in [*deck.find("DYNAMIC"), *deck.find("STATIC")]:
        try:
            dt, period = (float(field) for field in card.rows[0][:2])
        except (ValueError, IndexError):
            continue
        card.rows[0][1] = repr(min(period, INCREMENTS * dt))


def cards_of(text: str) -> list[Card]:
    """The cards of a text; rows as fields."""
    cards: list[Card] = []
    for line in text.splitlines():
        if line.startswith("*"):
            cards.append(Card(command_of(line), line))
        elif cards:
            row = [line] if cards[-1].keyword in FREE_TEXT else fields(line)
            cards[-1].rows.append(row)
    return cards


def command_of(line: str) -> str:
    """The keyword of a line, in capitals without blanks."""
    return "".join(fields(line)[0][1:].split()).upper()


def row_of(cards: list[Card], rng: random.Random) -> list[str] | None:
    """A data line. Cards are drawn first, so that those with many lines, nodes and elements, do not
    take all."""
    with_rows = [card for card in cards if card.rows]
    return rng.choice(rng.choice(with_rows).rows) if with_rows else None


def scale(cards: list[Card], rng: random.Random) -> None:
    """A measured number times a power of ten, or with the other sign."""
    at = {id(card): measured(card) for card in cards}
    others = [card for card in cards if at[id(card)]]
    if not others:
        return
    # a node far off spoils the shape of its elements, and nothing else is seen of the deck
    weights = [0.2 if card.keyword == "NODE" else 1.0 for card in others]
    row, place = rng.choice(at[id(rng.choices(others, weights)[0])])
    factor = rng.choice(FACTORS) if rng.random() < 0.9 else -1.0
    row[place] = repr(float(row[place]) * factor)


def measured(card: Card) -> list[tuple[list[str], int]]:
    """The fields of a card that hold measured numbers: rows, and places in them."""
    return [(row, i) for row in card.rows for i, field in enumerate(row) if is_measured(field)]


def is_measured(field: str) -> bool:
    """Whether a field holds a number that is not whole."""
    try:
        return math.isfinite(float(field)) and not field.lstrip("+-").isdigit()
    except ValueError:
        return False


def spoil_number(cards: list[Card], rng: random.Random) -> None:
    """Another number in a field, or the number times a power of ten."""
    row = row_of(cards, rng)
    if not row:
        return
    at = rng.randrange(len(row))
    try:
        value = float(row[at])
    except ValueError:
        value = math.nan
    if math.isfinite(value) and rng.random() < 0.5:
        factor = rng.choice((-1.0, 1.0)) * 10.0 ** rng.choice((-12, -6, -3, -1, 0, 1, 3, 6, 12))
        row[at] = repr(value * factor)
    else:
        row[at] = rng.choice(NUMBERS)


def spoil_fields(cards: list[Card], rng: random.Random) -> None:
    """A field too many, too few, or in another place."""
    row = row_of(cards, rng)
    if not row:
        return
    i, j = rng.randrange(len(row)), rng.randrange(len(row))
    kind = rng.randrange(4)
    if kind == 0:
        del row[i]
    elif kind == 1:
        row.insert(i, row[j])
    elif kind == 2:
        row[i], row[j] = row[j], row[i]
    else:
        row[i] = ""


def spoil_name(cards: list[Card], rng: random.Random) -> None:
    """One word of the deck in the place of another: a name, a number of a node, a kind of load."""
    row, other = row_of(cards, rng), row_of(cards, rng)
    if row and other:
        row[rng.randrange(len(row))] = rng.choice(other)


def spoil_rows(cards: list[Card], rng: random.Random) -> None:
    """A data line twice, gone, or under another card."""
    with_rows = [card for card in cards if card.rows]
    if not with_rows:
        return
    card, other = rng.choice(with_rows), rng.choice(with_rows)
    at = rng.randrange(len(card.rows))
    kind = rng.randrange(3)
    if kind == 0:
        card.rows.insert(at, list(card.rows[at]))
    elif kind == 1:
        del card.rows[at]
    else:
        other.rows.append(card.rows.pop(at))


def spoil_parameters(cards: list[Card], rng: random.Random) -> None:
    """A parameter gone, twice, of another card, or with another value."""
    parts = {id(card): fields(card.head) for card in cards}
    with_parameters = [card for card in cards if len(parts[id(card)]) > 1]
    if not with_parameters:
        return
    card, other = rng.choice(with_parameters), rng.choice(with_parameters)
    own, more = parts[id(card)], parts[id(other)]
    at, taken = rng.randrange(1, len(own)), rng.choice(more[1:])
    kind = rng.randrange(4)
    if kind == 0:
        del own[at]
    elif kind == 1:
        own.append(taken)
    elif kind == 2:
        name = own[at].partition("=")[0]
        own[at] = f"{name}={taken.partition('=')[2] or rng.choice(NUMBERS)}"
    else:
        own[at] = f"{own[at].partition('=')[0]}={rng.choice(NUMBERS)}"
    card.head = ", ".join(own)


def spoil_cards(cards: list[Card], rng: random.Random) -> None:
    """A card gone, twice, or in another place."""
    at, to = rng.randrange(len(cards)), rng.randrange(len(cards))
    kind = rng.randrange(3)
    if kind == 0 and len(cards) > 1:
        del cards[at]
    elif kind == 1:
        card = cards[at]
        cards.insert(to, Card(card.keyword, card.head, [list(row) for row in card.rows]))
    else:
        cards.insert(to, cards.pop(at))


MUTATIONS: tuple[tuple[Mutation, int], ...] = (
    (scale, 30),
    (spoil_number, 6),
    (spoil_fields, 2),
    (spoil_name, 3),
    (spoil_rows, 2),
    (spoil_parameters, 3),
    (spoil_cards, 4),
)
"""What spoils a deck, and how often."""


def spoiled(all_seeds: dict[str, str], rng: random.Random) -> str:
    """A spoiled deck: one to four faults, sometimes with a card of another deck."""
    names = sorted(all_seeds)
    cards = cards_of(all_seeds[rng.choice(names)])
    if rng.random() < 0.15:
        other = rng.choice(cards_of(all_seeds[rng.choice(names)]))
        cards.insert(rng.randrange(len(cards)), other)
    mutations, weights = zip(*MUTATIONS)
    for mutation in rng.choices(mutations, weights, k=rng.choice((1, 1, 1, 2, 2, 3))):
        mutation(cards, rng)
    return "".join(card.text() for card in cards)


@dataclass
class Outcome:
    """How a run ended."""

    what: str
    """`exit 0`, `stopped by SIGTERM` and the like."""
    fault: str = ""
    seconds: float = 0.0


def bound() -> None:
    """Bounds of the memory of a run."""
    size = MEGABYTES * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
    os.nice(5)


def run(path: Path, folder: Path) -> Outcome:
    """Runs a deck and looks at what it leaves."""
    words = [str(binary()), "run", str(path), "-o", str(folder), "--overwrite", "--threads", "1"]
    start = time.monotonic()
    with subprocess.Popen(
        words,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=bound,
    ) as process:
        asked = False
        try:
            out, err = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            asked = True
            process.send_signal(signal.SIGTERM)
            try:
                out, err = process.communicate(timeout=TO_HEED)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                return Outcome("hangs", "SIGTERM is not heeded", time.monotonic() - start)
        code = process.returncode
    seconds = time.monotonic() - start
    texts = [text.decode(errors="replace") for text in (out, err)]
    what = "asked to end" if asked else f"exit {code}"
    return Outcome(what, fault(code, asked, *texts, folder / f"{path.stem}.vtkhdf"), seconds)


def fault(code: int, asked: bool, out: str, err: str, result: Path) -> str:
    """What is wrong with the end of a run; empty if nothing is."""
    if "panicked" in err or "RUST_BACKTRACE" in err:
        return f"panic: {err[:400]}"
    if asked:
        return "" if code in (0, 1, 128 + signal.SIGTERM) else f"exit {code} after SIGTERM"
    if code not in CODES:
        return f"exit {code}: {err[-400:]}"
    if code == 2 and not names_the_place(err):
        return f"rejected without file and line: {err[-400:]}"
    if code == 4 and "memory" not in err:
        return f"exit 4: {err[-400:]}"
    if code == 1 and not STOPPED.search(out + err):
        return f"stopped without a place: {out[-400:]}"
    if code in (0, 1) and result.exists():
        return not_finite(result)
    return ""


def names_the_place(err: str) -> bool:
    """Whether an error names file and line."""
    if any(text in err for text in WITHOUT_PLACE):
        return True
    error = ERROR.search(err)
    return error is not None and PLACE.search(err, error.end()) is not None


def not_finite(result: Path) -> str:
    """Datasets of a result that hold what is not finite and should not."""
    bad: list[str] = []

    def look(name: str, data: object) -> None:
        if not isinstance(data, h5py.Dataset) or data.dtype.kind != "f":
            return
        if name.rpartition("/")[2] in OF_PAIRS:
            return
        if not np.isfinite(data[()]).all():
            bad.append(name)

    with h5py.File(result) as file:
        for group in ("history/energy", "history/momentum", "history/nodes", "VTKHDF/PointData"):
            if group in file:
                prefix = group
                file[group].visititems(lambda name, data: look(f"{prefix}/{name}", data))
    return f"not finite: {', '.join(bad)}" if bad else ""


def main() -> int:
    """Runs the decks; 0 if there is no fault."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("number", type=command.positive_integer, nargs="?", default=300)
    parser.add_argument("--first", type=int, default=0, help="number of the first deck")
    parser.add_argument("--seed", type=int, default=1, help="of the random faults")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "results" / "spoiled",
                        help="folder for the decks of faults")  # fmt: skip
    args = parser.parse_args()
    all_seeds = seeds()
    ends: collections.Counter[str] = collections.Counter()
    faults: list[str] = []
    slowest = (0.0, "")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = folder / "deck.inp"
        for number in range(args.first, args.first + args.number):
            text = spoiled(all_seeds, random.Random(f"{args.seed}/{number}"))
            deck.write_text(text)
            outcome = run(deck, folder)
            ends[outcome.what] += 1
            slowest = max(slowest, (outcome.seconds, str(number)))
            if outcome.fault:
                args.output.mkdir(parents=True, exist_ok=True)
                (args.output / f"spoiled_{args.seed}_{number}.inp").write_text(text)
                faults.append(outcome.fault)
                print(f"{number}: {outcome.fault}", flush=True)
    seen = ", ".join(f"{count} {what}" for what, count in sorted(ends.items()))
    print(f"{args.number} decks spoiled from {len(all_seeds)}: {seen}")
    print(f"slowest {slowest[0]:.1f} s (deck {slowest[1]})")
    print(f"spoil: {len(faults)} faults")
    return int(bool(faults))


if __name__ == "__main__":
    command.finish(main)
