"""Comparisons of single models that no array varies: each returns what is wrong, one line each."""

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from pathlib import Path

import numpy as np
from bodies import grid
from repository import ROOT
from stickslip.deck import Deck
from stickslip.report.page import page_of
from stickslip.result import SLIP, Result

from lab.levels import ELSEWHERE, FACTORS, RULES, SIMPLEST
from lab.oracles import Trial
from lab.scene import Scene

PLAIN = {**SIMPLEST, "procedure": "static direct"}


def _work(program: Path, folder: Path, name: str, scene: Scene) -> float:
    """External work of a deck at its end."""
    trial = Trial(scene.choice, program, folder)
    with Result(trial.good(name, scene).result) as result:
        return float(result.history.energy.external_work[-1])


def _near(works: Mapping[str, float], tolerance: float) -> list[str]:
    """What differs from the first of some works."""
    (first, one), *others = works.items()
    return [
        f"{name}: external work {other:.8g}, {first}: {one:.8g}"
        for name, other in others
        if not abs(other - one) <= tolerance * abs(one)
    ]


def rings(program: Path, folder: Path) -> list[str]:
    """A ring of a large radius is a plane body."""
    wrong = []
    for shape, contact in product(
        ("3", "4", "4H", "4I", "4R", "6", "8", "8R", "8H", "8RH"),
        ("node to surface", "surface to surface"),
    ):
        choice = {**PLAIN, "contact": contact, "interaction": "rough", "load": "pressure"}
        plane = Scene({**choice, "family": f"CPE{shape}"}, has_guides=False)
        ring = Scene({**choice, "family": f"CAX{shape}"}, radius=1e5, has_guides=False)
        around = 2.0 * np.pi * (1e5 + 1.57)
        works = {
            f"CPE{shape}, {contact}": _work(program, folder, "plane", plane),
            f"CAX{shape}": _work(program, folder, "ring", ring) / around,
        }
        # one volume ratio of an element: its exponent is 1/2 in the plane, 1/3 in a ring (docs/theory/elements.md, 2.9)
        wrong += _near(works, 1e-2 if shape == "4H" else 1e-3)
    return wrong


def rigid(program: Path, folder: Path) -> list[str]:
    """A rigid base, by a surface or by elements, is one 10 000 times as stiff."""
    wrong = []
    for family, load in product(("CPE4", "CPS8", "CPE6"), ("force", "gravity", "motion")):
        choice = {
            **PLAIN,
            "contact": "node to surface",
            "interaction": "friction",
            "family": family,
            "load": load,
        }
        works = {
            f"stiff, {family}, {load}": _work(
                program, folder, "stiff", Scene(choice, base="stiff")
            ),
            "elements": _work(program, folder, "elements", Scene(choice, base="rigid")),
            "surface": _work(
                program, folder, "surface", Scene({**choice, "contact": "rigid floor"})
            ),
        }
        wrong += _near(works, 2e-3)
    return wrong


def walls(program: Path, folder: Path) -> list[str]:
    """A body in free flight is stopped by a wall, whatever the procedure, the increment and the tolerance."""
    procedures = {
        "default": "*STICKSLIP",
        "tolerance 1e-6": "*STICKSLIP, TOLERANCE=1.E-6",
        "tolerance 1e-12": "*STICKSLIP, TOLERANCE=1.E-12",
        "events": "*STICKSLIP, IMPACT TIME=EVENT",
        "return": "*STICKSLIP, LANDING=RETURN",
        "redistributed": "*STICKSLIP, CONTACT MASS=REDISTRIBUTED",
        "no impulses": "*STICKSLIP, IMPACT=NONE",
        "ss22": "*STICKSLIP, SCHEME=SS22",
        "lemke": "*STICKSLIP, LCP=LEMKE",
    }
    wrong = []
    for (name, settings), dt, way in product(procedures.items(), (0.002, 0.02, 0.07), WALLS):
        if name == "ss22" and dt > 0.002:
            continue  # its increments resolve the waves
        run = Trial({}, program, folder).run("wall", _thrown(settings, dt, way))
        place = f"{name}, dt {dt:g}, {way}"
        if run.code:
            wrong.append(f"{place}: {run.error}")
            continue
        with Result(run.result) as result:
            depth = max(
                -float((frame["U"][:9, 1] + result.coordinates[:9, 1]).min())
                for frame in result.frames
            )
            speed = float(result.history.bodies.velocity[-1, 0, 1])
        if depth > 1e-3 or speed < -0.5:
            wrong.append(f"{place}: depth {depth:.1e}, velocity {speed:.2g} at the end")
    return wrong


WALLS = ("node to surface", "surface to surface", "general", "rigid")


def _thrown(settings: str, dt: float, way: str) -> Deck:
    """A block of nodes 1 to 9 that flies at a wall y = 0, 0.05 below it, by more than its height."""
    deck = Deck.titled("a block flies at a wall")
    block = grid("CPE4", 2, 2, lambda x, y: (0.13 + x, 0.05 + y))
    deck.add_mesh(block)
    sets = ["BODY"]
    deck.surface("BLOCK", "BODY")
    if way == "rigid":
        deck.add("NODE", (900, 0.0, -1.0))
        deck.add("SURFACE, NAME=WALL, TYPE=SEGMENTS", ("START", -2.0, 0.0), ("LINE", 3.0, 0.0))
        deck.add("RIGID BODY, ANALYTICAL SURFACE=WALL, REF NODE=900")
        deck.add("BOUNDARY", (900, 1, 2), (900, 6, 6))
    else:
        wall = grid("CPE4", 3, 1, lambda x, y: (3.0 * x - 1.0, y - 1.0))
        wall.element_sets = {"WALL": np.arange(len(wall.elements))}
        wall.node_sets, wall.sides = {"HELD": np.arange(len(wall.points))}, {}
        deck.add_mesh(wall)
        deck.surface("WALL", "WALL")
        deck.support("HELD")
        sets.append("WALL")
    deck.elastic("M", 1000.0, 0.3, 1.0)
    for name in sets:
        deck.section(name, "M")
    if way == "general":
        deck.general_contact(0.2)
    else:
        deck.contact("BLOCK", "WALL", 0.2)
        if way != "rigid":
            deck.set_formulation(way.upper())
    deck.velocity("BODY", 0.1, -4.0)
    deck.extend(
        f"*STEP, NLGEOM=YES\n{settings}\n*DYNAMIC, DIRECT\n{dt!r}, {max(0.1 // dt, 4) * dt!r}\n*END STEP\n"
    )
    return deck


def sliding(program: Path, folder: Path) -> list[str]:
    """Friction is mu N where a driven block slips, in every formulation."""
    wrong = []
    contacts = [
        one
        for one in FACTORS["contact"]
        if one not in ("none", "interference", "adjusted", "clearance")
    ]
    for contact, family in product(contacts, ("CPE4", "CPE8", "CPS3")):
        choice = {
            **PLAIN,
            "contact": contact,
            "interaction": "friction",
            "family": family,
            "load": "motion",
        }
        run = Trial(choice, program, folder).run(
            "slide", Scene(choice, has_guides=False, motion=(0.1, -0.004))
        )
        if run.code:
            wrong.append(f"{contact}, {family}: {run.error}")
            continue
        with Result(run.result) as result:
            status = result.frames[-1]["CONTACT_STATUS"]
            parts = [
                (np.abs(one.tangential[-1]), one.normal[-1]) for one in result.contact.values()
            ]
        tangential, normal = (sum(each) for each in zip(*parts))
        if not (status == SLIP).any() or not abs(tangential - 0.3 * normal) <= 1e-8 * normal:
            wrong.append(f"{contact}, {family}: friction {tangential:.9g} of {0.3 * normal:.9g}")
    return wrong


def pages(program: Path, folder: Path) -> list[str]:
    """The whole report page is made of a result of every shape."""
    wrong = []
    for family in ("CPE3", "CPE4", "CPE6", "CAX8"):
        choice = {**PLAIN, "contact": "node to surface", "family": family, "output": "histories"}
        run = Trial(choice, program, folder).good("page", Scene(choice))
        if "<html" not in page_of([run.result]):
            wrong.append(f"{family}: no page")
    return wrong


def refusals(program: Path, folder: Path) -> list[str]:
    """The program refuses what a rule says it does, with the error that the rule names."""
    wrong = []
    for rule in RULES:
        if rule.code:
            given = {factor: levels[0] for factor, levels in rule.levels.items()}
            run = Trial({}, program, folder).run("refused", Scene({**PLAIN, **given}))
            if f"error[{rule.code}]" not in run.complaint:
                wrong.append(f"{rule.reason}: not refused with {rule.code}: {run.error}")
    return wrong


def keywords(program: Path, folder: Path) -> list[str]:
    """Every keyword that docs/keywords.md says is read is in a deck of the array, or named as being elsewhere."""
    page = (ROOT / "docs" / "keywords.md").read_text()
    table = page.partition("## Keywords that are read")[2].partition("## Each keyword")[0]
    read = set(re.findall(r"^\| \[`\*([A-Z -]+)`\]", table, re.MULTILINE))
    used = {
        _keyword(line) for text in _texts() for line in text.splitlines() if line.startswith("*")
    }
    missing = [name for name in sorted(read - used) if name not in ELSEWHERE]
    return [f"no level has *{name}" for name in missing]


def _keyword(line: str) -> str:
    return line[1:].partition(",")[0].strip()


def _texts() -> Iterator[str]:
    """A deck with each level."""
    for factor, levels in FACTORS.items():
        for level in levels:
            scene = Scene(
                {**SIMPLEST, "contact": "node to surface", "interaction": "friction", factor: level}
            )
            yield scene.deck() + scene.include


SINGLE: dict[str, Callable[[Path, Path], list[str]]] = {
    "rings": rings,
    "rigid": rigid,
    "walls": walls,
    "sliding": sliding,
    "pages": pages,
    "refusals": refusals,
    "keywords": keywords,
}
"""Comparisons by name."""
