"""What is asked of every deck, without stored answers; one function for each question, in a table.

An oracle returns what is wrong, or None; it raises `Untold` where it has nothing to say of a deck.
"""

import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray
from oracle.checks import broken
from rescale import Units, Unscalable, rescale
from stickslip.arrays import Array, Flags
from stickslip.deck import Deck
from stickslip.report.collect import Choice, collect_outline
from stickslip.report.pack import Packed
from stickslip.result import Result

from lab import changed_decks as changed
from lab.changed_decks import Unchangeable
from lab.expected_results import Change, Seen, deviations
from lab.invariance import rotation
from lab.levels import INELASTIC, INTERACTIONS, PROCEDURES, SLOW, STATIC
from lab.restart_equality import contents
from lab.scene import BOLT, FORCE, Scene

SAME = 1e-8
"""Largest deviation of another form, relative to the largest value of its dimension."""

NOISE = 1e-13
"""Random numbers added to coordinates, relative to the size of the model."""

GROWN = 0.01 * SAME
"""Deviation through this noise from which on a history has no one answer."""

BOOKS = 1e-9
"""Largest difference of sums that must agree, as a part of the larger one."""

ROUND_OFF = 1e-12
"""Work of a contact that is round-off, as a part of the largest energy."""

IMPACTS = "history/impacts"
"""Landings of single pairs, as deviations name them."""

CONTACTS = "history/contact/"
"""Group of the histories of contacts."""

OF_CONTACTS = ("CONTACT_STATUS", "FRICTION_COEFFICIENT", "SLIP")
"""Fields of contacts that decisions make."""

OF_WORK = ("friction_dissipation", "numerical_dissipation", "FRICTION_WORK", "FRICTION_HEAT", "WEAR")
"""Sums of friction work: where an increment ends without force, that of pairs that slide to no force, but not of open ones."""

ON_SLAVE = ("force", "moment", "impulse", "impulse_sum")
"""What acts on the slave surface of a contact."""

LIMIT = 60.0
"""Seconds that a run may take."""

UNITS = Units(length=0.3048, mass=7.0, time=1.1)
POWERS = Units(length=0.25, mass=8.0, time=2.0)


class Untold(Exception):
    """An oracle has nothing to say of a deck; says why."""


@dataclass
class Ended:
    """A run that has ended."""

    code: int
    complaint: str
    result: Path

    @property
    def error(self) -> str:
        """First error, numbers left out, so that the same errors are counted together."""
        found = re.search(
            r"^(?:error(?:\[\w+\])?:|stopped).*(?:\n\s+(?!-->).*)?", self.complaint, re.MULTILINE
        )
        return " ".join(found[0].split()) if found else f"exit code {self.code}"


@dataclass
class Trial:
    """A deck in a folder, and its runs."""

    choice: Mapping[str, str]
    program: Path
    folder: Path
    runs: dict[str, Ended] = field(default_factory=dict)

    @cached_property
    def scene(self) -> Scene:
        """What the deck is written from."""
        return Scene(self.choice)

    @cached_property
    def base(self) -> Ended:
        """The deck as it is."""
        return self.run("base", self.scene)

    @cached_property
    def result(self) -> Result:
        """Its result."""
        return Result(self.base.result)

    @cached_property
    def flat(self) -> Deck:
        """The deck as `flatten` writes it."""
        self.base  # noqa: B018 - writes the deck
        deck = self.folder / "base" / "deck.inp"
        done = subprocess.run([self.program, "flatten", deck], capture_output=True, text=True)
        if done.returncode:
            raise ValueError(f"flatten: {Ended(done.returncode, done.stderr, deck).error}")
        return Deck.parse(done.stdout)

    @cached_property
    def seen(self) -> Seen:
        """The result of the flat deck."""
        return self.see("flat", self.flat)

    def run(self, name: str, deck: Scene | Deck, *options: str) -> Ended:
        """Writes and runs a deck."""
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        text = deck.deck() if isinstance(deck, Scene) else deck.text()
        (folder / "deck.inp").write_text(text)
        if isinstance(deck, Scene) and deck.include:
            (folder / "mesh.inc").write_text(deck.include)
        return self.start(name, *options)

    def start(self, name: str, *options: str) -> Ended:
        """Runs the deck of a folder."""
        folder = self.folder / name
        command = [self.program, "run", "deck.inp", "-q", "--overwrite", "--threads", "1", *options]
        try:
            done = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, timeout=LIMIT
            )
            ended = Ended(done.returncode, done.stderr, folder / "deck.vtkhdf")
        except subprocess.TimeoutExpired:
            ended = Ended(-1, f"stopped after {LIMIT:g} s", folder / "deck.vtkhdf")
        self.runs[name] = ended
        return ended

    def good(self, name: str, deck: Scene | Deck, *options: str) -> Ended:
        """A run that must reach its end, as the first one has."""
        ended = self.run(name, deck, *options)
        if ended.code:
            raise ValueError(f"{name}: {ended.error}")
        return ended

    def see(self, name: str, deck: Deck) -> Seen:
        """The result of a run of a flat deck."""
        return Seen(self.good(name, deck).result, deck)

    def is_one(self, factor: str, *levels: str) -> bool:
        """Whether the level of a factor is one of these."""
        return self.choice[factor] in levels


# Other forms of the same deck.


def _compared(trial: Trial, deck: Deck, change: Change, tolerance: float = SAME) -> str | None:
    """Runs another form of the flat deck and compares."""
    return _same(trial, trial.seen, trial.see("form", deck), change, tolerance)


def _same(trial: Trial, old: Seen, new: Seen, change: Change, tolerance: float) -> str | None:
    """The history or field that deviates most; what noise changes is left out from there on."""
    new_nodes = {int(n) for n in new["model/node_labels"]} - {
        int(n) for n in old["model/node_labels"]
    }
    apart = _tied(trial, new_nodes)
    found = deviations(old, new, change, 0.5, apart)
    if found.missing:
        return f"only in one result: {', '.join(found.missing[:3])}"
    compared = {
        name: np.where(_has_answer(old, name)[: len(away)], away, 0.0)
        for name, away in found.by_name.items()
    }
    beyond = {name: away for name, away in compared.items() if (away > tolerance).any()}
    if not beyond:
        return None
    noisy = _noisy(trial)
    grown = deviations(trial.seen, noisy, Change(), 0.5, set()).by_name
    small = max(GROWN, 1e-2 * tolerance)
    # other increments have other rows
    last = int((np.maximum.accumulate(grown["history/time"]) <= small).sum()) - 1
    end = float(trial.seen["history/time"][max(last, 0)])
    other = _other_contact(trial.seen, grown, small)
    worst, where = 0.0, ""
    for name, away in beyond.items():
        noise = np.maximum.accumulate(grown.get(name, np.zeros(len(away))))
        rows = min(len(away), int((noise <= small).sum()))
        if name != IMPACTS:
            rows = min(rows, trial.seen.rows_until(name, end))
        else:
            rows = min(rows, last + 1)
        if _is_of_contacts(name):
            rows = min(rows, int((trial.seen.times(name) < other).sum()))
        largest = float(away[:rows].max(initial=0.0))
        if largest > max(worst, tolerance):
            row = int(np.flatnonzero(away[:rows] > tolerance)[0])
            worst, where = largest, f"{name} differs by {largest:.1e} from row {row} on"
    return where or None


def _is_of_contacts(name: str) -> bool:
    return name == IMPACTS or name.startswith(CONTACTS) or name.rpartition("/")[2] in OF_CONTACTS


def _other_contact(
    seen: Seen, grown: Mapping[str, Array], small: float
) -> float:
    """When noise first changes a contact.

    Which pairs are closed, stick or collide is not compared from there on.
    """
    times = [
        seen.times(name)[: len(away)][(away > small) & _has_answer(seen, name)[: len(away)]]
        for name, away in grown.items()
        if _is_of_contacts(name)
    ]
    return min((float(each[0]) for each in times if len(each)), default=np.inf)


def _has_answer(seen: Seen, name: str) -> Flags:
    """Rows of a history or field that have one answer.

    Where a surface touches itself, the order of its faces decides which side is slave, and forces on bodies alone have a sign.
    Where all contact forces are round-off, it decides which pairs are closed.
    """
    if name == IMPACTS:
        return np.ones(seen.rows, np.bool_)
    values = seen.by_row(name)
    group, _, own = name.rpartition("/")
    is_field = name.startswith("VTKHDF/")
    if group == f"{CONTACTS}ALL_EXTERIOR" and own in ON_SLAVE:
        return np.zeros(len(values), np.bool_)
    if is_field and own in (*OF_CONTACTS, *OF_WORK):
        size = np.abs(seen.by_row("VTKHDF/PointData/CONTACT_FORCE")).reshape(len(values), -1).max(axis=1)
    elif not is_field and (own in OF_WORK or _is_decision(group, own, values)):
        names = [each for each in seen.data if each.startswith(CONTACTS) and each.endswith("/force")]
        if group.startswith(CONTACTS):
            names = [f"{group}/force"]
        forces = [np.abs(seen[each]).max(axis=1) for each in names]
        size = np.max(forces, axis=0) if forces else np.ones(len(values))
    else:
        return np.ones(len(values), np.bool_)
    return size > SAME * size.max()


def _is_decision(group: str, own: str, values: NDArray[Any]) -> bool:
    """Whether a history of a contact counts pairs, or is of closed ones."""
    return group.startswith(CONTACTS) and (values.dtype.kind != "f" or own == "friction_coefficient")


def _noisy(trial: Trial) -> Seen:
    """The result of the flat deck with noise; where that does not end, the deck is on an edge."""
    deck = changed.noisy(trial.flat, NOISE * changed.size(trial.flat))
    if trial.run("noise", deck).code:
        raise Untold("noise stops the run")
    return trial.see("noise", deck)


def _tied(trial: Trial, new_nodes: set[int]) -> set[int]:
    """Nodes whose supports others have taken over in the other form."""
    if not new_nodes:
        return set()
    text = (trial.folder / "form" / "deck.inp").read_text()
    rows = [row for card in Deck.parse(text).find("EQUATION") for row in card.rows if len(row) > 1]
    return {int(label) for row in rows for label in row[::3]}


def _changed(
    trial: Trial, deck: Callable[[], Deck], change: Change, tolerance: float = SAME
) -> str | None:
    try:
        return _compared(trial, deck(), change, tolerance)
    except (Unchangeable, Unscalable) as refused:
        raise Untold(str(refused)) from None


def moved(trial: Trial) -> str | None:
    """Elsewhere: bodies of revolution along their axis."""
    shift = np.array([0.0 if trial.scene.is_ring else 2.1, -2.7])
    return _changed(trial, lambda: changed.moved(trial.flat, shift), Change(shift=shift))


def turned(trial: Trial) -> str | None:
    """Turned by 0.3 rad; bodies of revolution are mirrored along their axis."""
    matrix = np.diag([1.0, -1.0]) if trial.scene.is_ring else rotation(0.3)
    return _changed(trial, lambda: changed.turned(trial.flat, matrix), Change(matrix=matrix))


def mirrored(trial: Trial) -> str | None:
    """Mirrored; bodies of revolution along their axis."""
    matrix = np.diag([1.0, -1.0] if trial.scene.is_ring else [-1.0, 1.0])
    return _changed(trial, lambda: changed.turned(trial.flat, matrix), Change(matrix=matrix))


def renumbered(trial: Trial) -> str | None:
    """Nodes and elements have other numbers."""
    new, *maps = changed.renumbered(trial.flat)
    nodes, elements = ({int(a): int(b) for a, b in each.items()} for each in maps)
    return _changed(trial, lambda: new, Change(nodes=nodes, elements=elements))


def reordered(trial: Trial) -> str | None:
    """Nodes, elements and faces stand in another order."""
    return _changed(trial, lambda: changed.reordered(trial.flat), Change())


def exchanged(trial: Trial) -> str | None:
    """Slave and master of contacts of two passes change places."""
    return _changed(trial, lambda: changed.exchanged(trial.flat), Change())


def units(trial: Trial) -> str | None:
    """Other units of length, mass and time, no powers of two."""
    return _changed(trial, lambda: rescale(trial.flat, UNITS), Change(units=UNITS))


def powers_of_two(trial: Trial) -> str | None:
    """Other units by powers of two: the same bits."""
    return _changed(trial, lambda: rescale(trial.flat, POWERS), Change(units=POWERS), 0.0)


def solved_otherwise(trial: Trial) -> str | None:
    """Another way to the same solution."""
    deck = Deck.parse(trial.flat.text())
    for card in deck.find("STICKSLIP"):
        card.head = card.head.replace("FACTORIZATION=KEEP", "FACTORIZATION=EVERY PASS").replace(
            "SOLVER=FAER", "SOLVER=SPRS"
        )
    return _compared(trial, deck, Change())


def flattened(trial: Trial) -> str | None:
    """`flatten` writes every model that is read, and the same one."""
    return _alike(trial, trial.base.result, trial.good("flat", trial.flat).result)


def otherwise_written(trial: Trial) -> str | None:
    """Parts, moved instances, includes and parameters make the model of the flat deck."""
    plain = Scene({**trial.choice, "written": "flat"})
    return _alike(trial, trial.good("plain", plain).result, trial.base.result)


def _alike(trial: Trial, one: Path, other: Path) -> str | None:
    """Compares two results of the same model; numbers of nodes may differ, their order does not."""
    decks = [Deck.read(path.with_suffix(".inp")) for path in (one, other)]
    a, b = (_seen_alone(path, deck) for path, deck in zip((one, other), decks))
    if missing := sorted(a.keys() ^ b.keys()):
        return f"only in one result: {', '.join(missing[:3])}"
    scales: dict[str, float] = {}
    for name, values in a.items():
        about = name if name.endswith("U") else name.rpartition("/")[0]
        scales[about] = max(scales.get(about, 0.0), float(np.nanmax(np.abs(values), initial=0.0)))
    for name in sorted(a):
        if a[name].shape != b[name].shape:
            return f"{name} has another shape"
        scale = scales[name if name.endswith("U") else name.rpartition("/")[0]]
        away = float(np.nanmax(np.abs(a[name] - b[name]), initial=0.0))
        if away > 1e-6 * scale:
            return f"{name} differs by {away / scale:.1e}"
    return None


def _seen_alone(path: Path, deck: Deck) -> dict[str, Array]:
    """Displacements, reactions, contact forces and energies of a result."""
    found: dict[str, Array] = {}
    with h5py.File(path) as file:
        for name in ("U", "RF", "CONTACT_FORCE"):
            found[f"VTKHDF/PointData/{name}"] = file[f"VTKHDF/PointData/{name}"][()]
        for name in ("kinetic", "strain", "external_work", "friction_dissipation"):
            found[f"history/energy/{name}"] = file[f"history/energy/{name}"][()]
    return found


def threads(trial: Trial) -> str | None:
    """Two threads: the same bits."""
    trial.run("two", Scene(trial.choice), "--threads", "2")
    shutil.rmtree(trial.folder / "two")
    ended = _with_threads(trial, "two", "2")
    return _bits(trial.base.result, ended.result)


def _with_threads(trial: Trial, name: str, count: str) -> Ended:
    folder = trial.folder / name
    shutil.copytree(
        trial.folder / "base",
        folder,
        ignore=shutil.ignore_patterns("deck.vtkhdf", "*.sta", "*.log"),
    )
    command = [trial.program, "run", "deck.inp", "-q", "--threads", count]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=LIMIT)
    if done.returncode:
        raise ValueError(f"{name}: {Ended(done.returncode, done.stderr, folder).error}")
    return Ended(0, "", folder / "deck.vtkhdf")


def _bits(one: Path, other: Path) -> str | None:
    a, b = contents(one), contents(other)
    differing = sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
    return f"not the same bits: {', '.join(differing[:3])}" if differing else None


def resumed(trial: Trial) -> str | None:
    """Stopped by a signal and gone on with: the same bits."""
    folder = trial.folder / "stopped"
    shutil.copytree(
        trial.folder / "base",
        folder,
        ignore=shutil.ignore_patterns("deck.vtkhdf", "*.sta", "*.log"),
    )
    command = [trial.program, "run", "deck.inp", "-q", "--threads", "1"]
    process = subprocess.Popen(
        command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    status, end = folder / "deck.sta", time.monotonic() + LIMIT
    while process.poll() is None and time.monotonic() < end:
        if status.exists() or (folder / "deck.vtkhdf.part").exists():
            process.send_signal(signal.SIGINT)
            break
        time.sleep(0.0005)
    process.wait(LIMIT)
    if not (folder / "deck.restart").exists():
        raise Untold("the run ends before the signal")
    done = subprocess.run(
        [*command, "--resume"], cwd=folder, capture_output=True, text=True, timeout=LIMIT
    )
    if done.returncode:
        return f"resume: {Ended(done.returncode, done.stderr, folder).error}"
    return _bits(trial.base.result, folder / "deck.vtkhdf")


def restarted(trial: Trial) -> str | None:
    """The second step as a job of its own, *RESTART, READ: the same rows."""
    deck = Deck.read(trial.folder / "base" / "deck.inp")
    steps = [k for k, card in enumerate(deck.cards) if card.keyword == "STEP"]
    text = Deck(deck.cards[: steps[1]]).text()
    first = Deck.parse(
        text.replace("*STEP, NLGEOM=YES\n", "*STEP, NLGEOM=YES\n*RESTART, WRITE, FREQUENCY=1000\n")
    )
    trial.good("first", first)
    rest = Deck.parse("*RESTART, READ\n" + Deck(deck.cards[steps[1] :]).text())
    ended = trial.good("rest", rest, "--oldjob", str(trial.folder / "first" / "deck"))
    with h5py.File(trial.base.result) as whole, h5py.File(ended.result) as part:
        for name in (
            "history/time",
            "history/energy/strain",
            "history/energy/kinetic",
            "history/energy/external_work",
        ):
            a, b = whole[name][()], part[name][()]
            if len(b) < 2 or not np.array_equal(a[len(a) - len(b) + 1 :], b[1:]):
                return f"{name} is not the end of that of the whole run"
        nodes = len(whole["model/node_labels"])
        a, b = (file["VTKHDF/PointData/U"][-nodes:] for file in (whole, part))
        return None if np.array_equal(a, b) else "U differs at the end"


# The same physics otherwise.


def finer_family(trial: Trial) -> str | None:
    """Another family stores the same energy on a finer mesh, within the error of the mesh."""
    own, other = (
        trial.good(name, Scene({**trial.choice, "family": kind}, refined=2)).result
        for name, kind in (("fine", trial.scene.kind), ("other", trial.scene.kind[:3] + "8"))
    )
    # linear triangles lock in bending
    return _near_energies(own, other, 0.6 if "3" in trial.scene.kind else 0.35)


SHORT = 50
"""Increments in which metals and friction follow their path."""


def slowly(trial: Trial) -> str | None:
    """A slow motion ends where the static step does, both in increments whose error is small."""
    static = trial.good("static", Scene(trial.choice, parts=SHORT)).result
    slow = Scene({**trial.choice, "procedure": "quasi-static"}, slowed=20.0, parts=SHORT)
    return _near_energies(static, trial.good("slow", slow).result, 0.02)


def _near_energies(one: Path, other: Path, tolerance: float) -> str | None:
    with Result(one) as first, Result(other) as second:
        a, b = (float(result.read("history/energy/strain")[-1]) for result in (first, second))
    scale = max(abs(a), abs(b))
    is_near = abs(a - b) <= tolerance * scale or scale < 1e-12
    return None if is_near else f"strain energy {a:.4g} against {b:.4g}"


def halves(trial: Trial) -> str | None:
    """One step is two of half its length."""
    other = trial.good("halves", Scene(trial.choice, is_halved=True)).result
    return _ends_alike(trial, other)


def removed_as_zero(trial: Trial) -> str | None:
    """A load that is removed is a load of zero."""
    other = trial.good("zero", Scene(trial.choice, zero_for_removed=True)).result
    return _ends_alike(trial, other)


def _ends_alike(trial: Trial, other: Path) -> str | None:
    with Result(other) as result:
        a, b = trial.result.frames[-1]["U"], result.frames[-1]["U"]
        scale = max(
            np.abs(trial.result.frames[-1]["U"]).max(), _largest_motion(trial.result), 1e-12
        )
    away = float(np.abs(a - b).max() / scale)
    return None if away < 1e-6 else f"U differs by {away:.1e} at the end"


def _largest_motion(result: Result) -> float:
    """Largest displacement of any frame."""
    return float(np.abs(result.read("VTKHDF/PointData/U")).max())


# What every deck must show.


def runs(trial: Trial) -> str | None:
    """The run reaches its end."""
    return None if trial.base.code == 0 else trial.base.error


def checked(trial: Trial) -> str | None:
    """`check` says of the deck what `run` says."""
    deck = trial.folder / "base" / "deck.inp"
    done = subprocess.run([trial.program, "check", deck], capture_output=True, text=True)
    is_refused = trial.base.code == 2
    if (done.returncode == 2) != is_refused:
        return f"check ends with {done.returncode}, run with {trial.base.code}"
    if "Traceback" in done.stderr or done.returncode not in (0, 2):
        return f"check ends with {done.returncode}"
    return None


def certificate(trial: Trial) -> str | None:
    """All checks of the certificate and of the oracle of elements hold."""
    found = broken(trial.result)
    return f"fails: {', '.join(sorted(found))}" if found else None


def own_checks(trial: Trial) -> str | None:
    """All checks of the run itself hold."""
    group = trial.result.file["history/certificate"]
    for name, item in group.items():
        if (
            "bound" in item.attrs
            and item.ndim == 1
            and (np.nan_to_num(item[()]) > item.attrs["bound"]).any()
        ):
            return f"{name} {np.nanmax(item[()]):.1e} above {float(item.attrs['bound']):.1e}"
    return None


def pandas_(trial: Trial) -> str | None:
    """All histories are a table of pandas."""
    table = trial.result.to_dataframe()
    return None if len(table) == trial.result.rows else f"{len(table)} of {trial.result.rows} rows"


def xarray_(trial: Trial) -> str | None:
    """All histories are a set of xarray."""
    trial.result.to_xarray("U")
    return None


def pyvista_(trial: Trial) -> str | None:
    """PyVista reads the mesh."""
    import pyvista  # takes a second, which most decks need not

    mesh = pyvista.read(trial.base.result)
    points = len(trial.result.coordinates)
    return None if mesh.n_points == points else f"{mesh.n_points} of {points} points"


def report(trial: Trial) -> str | None:
    """Surfaces of the report page run along sides of `Result.outlines`."""
    page = collect_outline(trial.base.result, Packed(), Choice())
    # the nodes of an outline are counted among those that are drawn
    boundary, rigid = trial.result.boundary, trial.result.rigid
    drawn = np.unique(np.concatenate([boundary.ravel(), rigid.ravel()]))
    sides = {tuple(sorted(edge)) for edge in np.searchsorted(drawn, boundary).tolist()}
    for surface in page["surfaces"]:
        ways = zip(surface["nodes"][:-1], surface["nodes"][1:])
        if any(tuple(sorted(way)) not in sides for way in ways):
            return f"surface {surface['name']} runs along no sides of Result.outlines"
    return None


def h5py_(trial: Trial) -> str | None:
    """Every dataset has its dimension, and the package reads all rows."""
    with h5py.File(trial.base.result, locking=False) as file:
        bad: list[str] = []

        def visit(name: str, item: object) -> None:
            if (
                isinstance(item, h5py.Dataset)
                and item.dtype.kind == "f"
                and not {"dimension", "description"} <= set(item.attrs)
            ):
                bad.append(name)

        file.visititems(visit)
        rows = trial.result.rows
        short = len(file["history/time"]) != rows
    return (
        f"{bad[0]} has no dimension" if bad else f"{rows} rows are read of more" if short else None
    )


def reactions(trial: Trial) -> str | None:
    """In a static end reactions are the loads."""
    last = "static" if trial.is_one("sequence", "rest") else trial.choice["procedure"]
    loads = {"force", "gravity", "traction", "face traction", "body force"}
    if last not in STATIC or trial.is_one("sequence", "rest") or trial.choice["load"] not in loads:
        raise Untold("loads are known of static forces")
    if trial.is_one("connection", "springs along axes"):
        raise Untold("springs to the ground have no reaction")
    if trial.is_one("sequence", "on and off", "two loads", "removed") or trial.scene.is_ring:
        raise Untold("loads are known of one force")
    result = trial.result
    # the force of a section that is closed pulls both of its sides
    has_support = result.node_labels != BOLT
    reaction = result.frames[-1]["RF"][has_support].sum(axis=0)[:2]
    mass = result.read("model/bodies/mass").sum()
    # a body with rigid elements has the point mass of their reference node
    if trial.is_one("connection", "rigid nodes", "rigid tie nodes", "disc"):
        mass += 0.3
    full = FORCE * (1.0 if not trial.is_one("amplitude", "decaying") else 1.0 - np.exp(-4.0))
    applied = {
        "force": full * np.array([0.25, -1.0]),
        "gravity": full * mass * np.array([0.28, -0.96]),
        "traction": full * np.array([0.28, -0.96]),
        "face traction": full * np.array([0.28, -0.96]),
        "body force": full * np.array([0.25, -1.0]) * _area(result, trial.scene.top.name),
    }[trial.choice["load"]]
    away = float(np.abs(reaction + applied).max() / np.abs(applied).max())
    return None if away < 1e-6 else f"reactions {reaction} against loads {applied}"


def _area(result: Result, elements: str) -> float:
    """Area of elements before the first step, moved nodes at their places."""
    x, y = result.coordinates.T[:2]
    outlines = [result.outlines[e] for e in result.element_set(elements)]
    return sum(
        0.5 * float((x[line] * np.roll(y[line], -1) - np.roll(x[line], -1) * y[line]).sum())
        for line in outlines
    )


def action(trial: Trial) -> str | None:
    """Every contact force has its reaction: contact forces of all nodes sum up to none."""
    for frame in trial.result.frames:
        force = frame["CONTACT_FORCE"][:, :2]
        total, size = np.abs(force.sum(axis=0)), np.abs(force).sum()
        if trial.scene.is_ring:
            total = total[1:]
        if size > 0.0 and total.max() > 1e-8 * size:
            return f"sum {total.max() / size:.1e} of the forces"
    return None


def friction(trial: Trial) -> str | None:
    """Friction is not above mu N, and not below where all slips."""
    largest = {
        "friction": 0.3,
        "wear": 0.3,
        "heat": 0.3,
        "wear and heat": 0.3,
        "table": 0.3,
        "decay": 0.4,
        "frictionless": 0.0,
    }
    if trial.choice["interaction"] not in largest or trial.is_one("contact", "none"):
        raise Untold("no coefficient")
    limit = largest[trial.choice["interaction"]]
    for name, contact in trial.result.contact.items():
        if "DISC" in name:
            continue
        if "DISC" not in name and trial.is_one("connection", "disc") and "EXTERIOR" in name:
            continue
        over = np.abs(contact.tangential) - limit * contact.normal
        if (over > 1e-8 * max(contact.normal.max(), 1e-300)).any():
            return f"{name}: {over.max() / contact.normal.max():.1e} N above"
    return None


def sums(trial: Trial) -> str | None:
    """Friction work, wear and heat of the nodes sum up to the ledger."""
    frame = trial.result.frames[-1]
    total = float(trial.result.read("history/energy/friction_dissipation")[-1])
    interaction = INTERACTIONS[trial.choice["interaction"]]
    if "HEAT" not in interaction or trial.is_one("contact", "none"):
        raise Untold("no heat is asked for")
    if trial.is_one("connection", "disc"):
        raise Untold("another contact has friction of its own")
    part = 0.9 * 0.5 if "0.9" in interaction else 0.5
    heat = float(np.nansum(frame["FRICTION_HEAT"]))
    both = trial.scene.contact.startswith(("both", "general"))
    allowed = [part * total, part / 0.5 * total] if both else [part * total]
    scale = max(total, 1e-12)
    away = min(abs(heat - one) for one in allowed) / scale
    if both and min(allowed) - 1e-9 * scale <= heat <= max(allowed) + 1e-9 * scale:
        return None
    return (
        None
        if away < BOOKS
        else f"heat {heat:.6g}, part {heat / scale:.4f} of the ledger's {total:.6g}"
    )


def wear(trial: Trial) -> str | None:
    """Wear is friction work times k/(hardness mu), or k/hardness, at every node."""
    interaction = INTERACTIONS[trial.choice["interaction"]]
    if "WEAR" not in interaction or trial.is_one("contact", "none"):
        raise Untold("no wear is asked for")
    if trial.is_one("sequence", "friction changed"):
        raise Untold("the coefficient changes")
    frame = trial.result.frames[-1]
    work, depth = np.nan_to_num(frame["FRICTION_WORK"]), np.nan_to_num(frame["WEAR"])
    factor = 1e-5 if "DEPENDENT" in interaction else 1e-5 / 0.3
    away = np.abs(depth - factor * work).max(initial=0.0)
    scale = factor * np.abs(work).max(initial=0.0)
    noise = factor * ROUND_OFF * trial.result.history.energy.largest
    return (
        None
        if away <= 1e-7 * scale + noise
        else f"wear off by {away / max(scale, 1e-300):.1e} of the largest"
    )


def mass(trial: Trial) -> str | None:
    """Bodies have the mass of their area, or of their rings."""
    if trial.is_one("contact", "general adjusted"):
        raise Untold("nodes of both bodies are moved")
    scene, ring = trial.scene, trial.scene.is_ring
    sizes = {"LOWER": (0.0, 3.0, 1.0), "UPPER": (1.07, 1.0, 1.0), "CAP": (1.07, 1.0, 0.4)}
    expected = 0.0
    for body in scene.bodies:
        left, width, height = sizes[body.name]
        around = 2.0 * np.pi * (scene.x0 + left + width / 2.0) if ring else 1.0
        if body.name == "UPPER" and trial.is_one("contact", "adjusted", "clearance"):
            height += 0.01  # its bottom has been moved onto the base
        expected += width * height * around
    found = float(trial.result.read("model/bodies/mass").sum())
    if trial.is_one("connection", "rigid elements"):
        raise Untold("masses of rigid elements are counted with their bodies")
    return (
        None if abs(found - expected) < 1e-9 * expected else f"mass {found:.9g} of {expected:.9g}"
    )


def returns(trial: Trial) -> str | None:
    """A load on and off returns to zero."""
    if not trial.is_one("sequence", "on and off", "removed") or not trial.is_one(
        "procedure", *SLOW
    ):
        raise Untold("a static load goes on and off")
    if not trial.is_one("interaction", "frictionless") or trial.is_one("material", *INELASTIC):
        raise Untold("friction and metals remember")
    if trial.is_one(
        "contact", "interference", "adjusted", "clearance", "general adjusted"
    ) or trial.is_one("connection", "disc", "pre-tension"):
        raise Untold("what is not the load stays")
    if trial.is_one("load", "velocity", "acceleration"):
        raise Untold("velocities leave displacements")
    last = np.abs(trial.result.frames[-1]["U"]).max()
    largest = _largest_motion(trial.result)
    tolerance = 1e-7 if trial.is_one("procedure", *STATIC) else 0.02
    return None if last <= tolerance * largest else f"U ends at {last / largest:.1e} of its largest"


def holds(trial: Trial) -> str | None:
    """A step that changes nothing changes nothing."""
    if not trial.is_one("sequence", "hold") or not trial.is_one("procedure", *STATIC):
        raise Untold("a static step holds")
    if trial.is_one("connection", "springs", "springs along axes") and trial.is_one(
        "procedure", "quasi-static"
    ):
        raise Untold("dashpots move on")
    return _still(trial, 1e-6)


def rests(trial: Trial) -> str | None:
    """Static, then dynamic without anything new: at rest."""
    if not trial.is_one("sequence", "rest"):
        raise Untold("no static step before a dynamic one")
    if not trial.is_one("amplitude", "none", "tabular", "total time", "smooth", "equal"):
        raise Untold("the amplitude goes on")
    if PROCEDURES[trial.choice["procedure"]].duration != 1.0 and not trial.is_one(
        "amplitude", "none", "total time"
    ):
        raise Untold("the amplitude begins anew")
    return _still(trial, 1e-6)


def _still(trial: Trial, tolerance: float) -> str | None:
    """Whether nothing moves in the last step."""
    result = trial.result
    step = result.history.step
    start = float(result.history.time[step == 1][-1])
    frames = [frame["U"] for frame in result.frames if frame.time >= start * (1.0 - 1e-9)]
    way = max(float(np.abs(u - frames[0]).max()) for u in frames)
    largest = _largest_motion(result)
    return None if way <= tolerance * largest else f"U moves by {way / largest:.1e} of its largest"


def balance(trial: Trial) -> str | None:
    """The energy balance is round-off."""
    energy = trial.result.history.energy
    off = float(np.abs(energy.balance).max() / max(energy.largest, 1e-300))
    return None if off < 1e-8 else f"balance {off:.1e}"


FORMS: dict[str, Callable[[Trial], str | None]] = {
    "moved": moved,
    "turned": turned,
    "mirrored": mirrored,
    "renumbered": renumbered,
    "reordered": reordered,
    "exchanged": exchanged,
    "units": units,
    "powers of two": powers_of_two,
    "solved otherwise": solved_otherwise,
    "flattened": flattened,
    "otherwise written": otherwise_written,
    "threads": threads,
    "resumed": resumed,
    "restarted": restarted,
    "finer family": finer_family,
    "slowly": slowly,
    "halves": halves,
    "removed as zero": removed_as_zero,
}
"""Oracles that run the deck in another form; the level of the factor `form` chooses one."""

ALWAYS: dict[str, Callable[[Trial], str | None]] = {
    "check": checked,
    "certificate": certificate,
    "own checks": own_checks,
    "balance": balance,
    "reactions": reactions,
    "action": action,
    "friction": friction,
    "sums": sums,
    "wear": wear,
    "mass": mass,
    "returns": returns,
    "holds": holds,
    "rests": rests,
}
"""Oracles of every deck that runs."""

READERS: dict[str, Callable[[Trial], str | None]] = {
    "h5py": h5py_,
    "pandas": pandas_,
    "xarray": xarray_,
    "PyVista": pyvista_,
    "report": report,
}
"""What opens the result; the level of the factor `reader` chooses one."""
