"""Static steps: bodies held by contact, equations, general contact, self-contact, an arch."""

from math import cos, hypot, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from stickslip import program
from stickslip.decks import Grid, card, disc, dry, elastic, outline
from stickslip.program import RunStopped
from stickslip.result import Result

YOUNG = 1e4


def static(*cards: str, dt: float = 1.0, direct: bool = True) -> str:
    """A static step of the duration 1."""
    keyword = "STATIC, DIRECT" if direct else "STATIC"
    return "".join([card("STEP, NLGEOM"), card(keyword, (dt, 1.0)), *cards, card("END STEP")])


def solve(tmp_path: Path, *cards: str) -> Result:
    """The result of a deck of these cards; its ledger is closed."""
    deck = tmp_path / "deck.inp"
    deck.write_text("".join(cards))
    result = program.run(deck, tmp_path, "--threads", "1")
    energy = result.history.energy
    assert np.abs(energy.balance).max() < 1e-9 * energy.largest
    return result


def block(
    name: str, size: tuple[int, int], lengths: tuple[float, float], *before: Grid, **at: float
) -> Grid:
    """A rectangle with its lower left corner at (x, y), labelled after the last grid `before`."""
    (nx, ny), (lx, ly) = size, lengths
    x, y = at.get("x", 0.0), at.get("y", 0.0)
    labels = (before[-1].next_node, before[-1].next_element) if before else (1, 1)
    return Grid(name, nx, ny, lambda i, j: (x + lx * i / nx, y + ly * j / ny), *labels)


def profile(name: str, *places: tuple[float, float]) -> str:
    """A fixed rigid profile; the obstacle is on the right of the way."""
    rows = [("START" if k == 0 else "LINE", x, y) for k, (x, y) in enumerate(places)]
    return "".join(
        [
            card("NODE, NSET=REFERENCE", (90_000, 0.0, -1.0)),
            card(f"SURFACE, NAME={name}, TYPE=SEGMENTS", *rows),
            card(f"RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE=REFERENCE"),
            card("BOUNDARY", ("REFERENCE", 1, 2)),
        ]
    )


def out_of_balance(result: Result, load: tuple[float, float]) -> float:
    """Force and moment of contact and of a load at the centre of a body, beside the load."""
    contacts = result.contact.values()
    force = sum(contact.force[-1] for contact in contacts) + np.array(load)
    x, y = result.history.bodies.center[-1, 0]
    moment = sum(contact.moment[-1] for contact in contacts) + x * load[1] - y * load[0]
    return max(hypot(*force), abs(moment)) / hypot(*load)


def ladder(friction: float) -> str:
    """A bar of length 2 leans at 60 degrees on a wall; floor and wall are one rigid profile."""
    turn, length, thickness = radians(60.0), 2.0, 0.1

    def place(i: int, j: int) -> tuple[float, float]:
        along, up = length * i / 16, thickness * j / 2
        x, y = (along - length) * cos(turn), along * sin(turn)
        return x - up * sin(turn), y + up * cos(turn)

    bar = Grid("BAR", 16, 2, place)
    return "".join(
        [
            bar.mesh("CPE4"),
            bar.side_surface("FACE", "bottom"),
            elastic(1e7, 0.3, 1.0, "BAR"),
            profile("CORNER", (-3.0, 0.0), (0.0, 0.0), (0.0, 3.0)),
            dry(friction),
            card("CONTACT PAIR, INTERACTION=DRY", ("FACE", "CORNER")),
            static(card("DLOAD", ("BAR", "GRAV", 1.0, 0.0, -1.0))),
        ]
    )


def least_friction() -> float:
    """Of the ladder: mu N1 = N2, N1 + mu N2 = W, and no moment about the foot."""
    turn, length, thickness = radians(60.0), 2.0, 0.1
    arm = length / 2 * cos(turn) - thickness / 2 * sin(turn)
    low, high = 0.0, 1.0
    for _ in range(60):
        mu = 0.5 * (low + high)
        wall = mu / (1 + mu**2)
        held = wall * length * (sin(turn) + mu * cos(turn))
        low, high = (mu, high) if held < arm else (low, mu)
    return low


def test_a_ladder_stands_where_friction_of_floor_and_wall_holds_it(tmp_path: Path) -> None:
    result = solve(tmp_path, ladder(1.002 * least_friction()))
    assert out_of_balance(result, (0.0, -0.2)) < 1e-9
    stands = solve(tmp_path, ladder(1.0))
    assert out_of_balance(stands, (0.0, -0.2)) < 1e-9
    with pytest.raises(RunStopped, match="not in equilibrium"):
        solve(tmp_path, ladder(0.998 * least_friction()))


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_box_in_a_groove(tmp_path: Path, friction: float) -> None:
    """A square on its corner in a groove of 90 degrees; the flanks share its weight."""
    turn = radians(45.0)

    def place(i: int, j: int) -> tuple[float, float]:
        return (i - j) / 4 * cos(turn), (i + j) / 4 * sin(turn)

    box = Grid("BOX", 4, 4, place)
    result = solve(
        tmp_path,
        box.mesh("CPE4"),
        card("SURFACE, NAME=SKIN", ("BOX",)),
        elastic(YOUNG, 0.3, 1.0, "BOX"),
        profile("GROOVE", (-3.0, 3.0), (0.0, 0.0), (3.0, 3.0)),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "GROOVE")),
        static(card("DLOAD", ("BOX", "GRAV", 1.0, 0.0, -1.0))),
    )
    assert out_of_balance(result, (0.0, -1.0)) < 1e-9
    if friction == 0.0:
        (contact,) = result.contact.values()
        assert abs(contact.normal[-1] - sqrt(2.0)) < 1e-6


def test_a_disc_in_a_groove_is_held_by_friction(tmp_path: Path) -> None:
    """The friction of two flanks is indeterminate: any answer is in equilibrium and in the cone."""
    body = disc("DISC", (0.0, sqrt(2.0)), 1.0, 0.0, 4, 3)
    result = solve(
        tmp_path,
        body.mesh("CPE4"),
        card("SURFACE, NAME=SKIN", ("DISC",)),
        elastic(YOUNG, 0.3, 1.0, "DISC"),
        profile("GROOVE", (-3.0, 3.0), (0.0, 0.0), (3.0, 3.0)),
        dry(0.3),
        card("CONTACT PAIR, INTERACTION=DRY", ("SKIN", "GROOVE")),
        static(card("DLOAD", ("DISC", "GRAV", 1.0, 0.0, -1.0))),
    )
    weight = -float(sum(contact.force[-1] for contact in result.contact.values())[1])
    assert abs(-weight - pi) < 0.1
    assert out_of_balance(result, (0.0, weight)) < 1e-9
    (contact,) = result.contact.values()
    assert contact.cone_violation.max() < 1e-9


def test_equations_carry_force_between_bodies(tmp_path: Path) -> None:
    """A lever of ratio 2 joins two bars: half the force and twice the way of what it pulls."""
    left = block("LEFT", (4, 1), (4.0, 1.0))
    right = block("RIGHT", (4, 1), (4.0, 1.0), left, x=10.0)
    result = solve(
        tmp_path,
        left.mesh("CPS4"),
        right.mesh("CPS4"),
        *(grid.side_nodes(f"{grid.name}_END", "right") for grid in (left, right)),
        *(grid.side_nodes(f"{grid.name}_HELD", "left") for grid in (left, right)),
        elastic(YOUNG, 0.0, 1.0, "LEFT", "RIGHT"),
        card("EQUATION", (2,), ("RIGHT_END", 1, 1.0, "LEFT_END", 1, -2.0)),
        card("BOUNDARY", ("LEFT_HELD", 1, 2), ("RIGHT_HELD", 1, 2)),
        static(
            card("CLOAD", ("LEFT_END", 1, 5.0)),
            *(card(f"NODE PRINT, NSET={name}_HELD", ("RF",)) for name in ("LEFT", "RIGHT")),
            *(card(f"NODE PRINT, NSET={name}_END", ("U",)) for name in ("LEFT", "RIGHT")),
        ),
    )
    nodes = result.history.nodes
    ways = [nodes[f"{name}_END"].U[-1, :, 0] for name in ("LEFT", "RIGHT")]
    assert np.abs(ways[1] - 2 * ways[0]).max() < 1e-14
    pulls = [-nodes[f"{name}_HELD"].RF[-1, :, 0].sum() for name in ("LEFT", "RIGHT")]
    # in equilibrium at the lever: 10 = F_left + 2 F_right
    assert abs(pulls[0] + 2 * pulls[1] - 10.0) < 1e-9


def blocks_on_floor(contacts: str) -> list[str]:
    """Three blocks on each other and on a rigid floor, under their weight and a push."""
    low = block("LOW", (8, 4), (2.0, 1.0))
    middle = block("MIDDLE", (6, 3), (1.5, 0.75), low, x=0.2, y=1.0)
    top = block("TOP", (4, 2), (1.0, 0.5), middle, x=0.45, y=1.75)
    grids = (low, middle, top)
    names = [grid.name for grid in grids]
    return [
        *(grid.mesh("CPE4") for grid in grids),
        *(grid.side_surface(f"{grid.name}_SOLE", "bottom") for grid in grids),
        *(grid.side_surface(f"{grid.name}_ROOF", "top") for grid in grids),
        elastic(YOUNG, 0.3, 1.0, *names),
        profile("FLOOR", (-1.0, 0.0), (4.0, 0.0)),
        dry(0.4),
        contacts,
        static(card("DLOAD", ("", "GRAV", 10.0, 0.1, -1.0)), dt=0.5),
    ]


def test_general_contact_finds_what_pairs_find(tmp_path: Path) -> None:
    pairs = [("LOW_SOLE", "FLOOR"), ("MIDDLE_SOLE", "LOW_ROOF"), ("TOP_SOLE", "MIDDLE_ROOF")]
    general = "".join(
        [
            card("CONTACT"),
            card("CONTACT INCLUSIONS, ALL EXTERIOR"),
            card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
        ]
    )
    found = []
    for contacts in (card("CONTACT PAIR, INTERACTION=DRY", *pairs), general):
        result = solve(tmp_path, *blocks_on_floor(contacts))
        weight = 10.0 * (2.0 + 1.125 + 0.5)
        force = result.history.rigid["FLOOR"].force[-1]
        norm = sqrt(1.01)
        assert abs(abs(force[1]) * norm / weight - 1) < 1e-9
        assert abs(abs(force[0]) * norm / (0.1 * weight) - 1) < 1e-9
        found.append(result.history.bodies.center[-1].copy())
    # nodes of both sides are slaves in general contact, which is a little stiffer
    assert np.abs(found[0] - found[1]).max() < 1e-4


def test_every_body_of_a_stack_gets_soft_pins(tmp_path: Path) -> None:
    """Three blocks on an elastic floor: none has all of the nearest pairs, and no increment is cut."""
    floor = block("FLOOR", (16, 3), (4.0, 0.75), x=-1.0, y=-0.75)
    low = block("LOW", (8, 4), (2.0, 1.0), floor)
    middle = block("MIDDLE", (6, 3), (1.5, 0.75), low, x=0.2, y=1.0)
    top = block("TOP", (4, 2), (1.0, 0.5), middle, x=0.45, y=1.75)
    grids = (floor, low, middle, top)
    pairs = [("LOW_SOLE", "FLOOR_ROOF"), ("MIDDLE_SOLE", "LOW_ROOF"), ("TOP_SOLE", "MIDDLE_ROOF")]
    result = solve(
        tmp_path,
        *(grid.mesh("CPE4") for grid in grids),
        *(grid.side_surface(f"{grid.name}_SOLE", "bottom") for grid in grids),
        *(grid.side_surface(f"{grid.name}_ROOF", "top") for grid in grids),
        floor.side_nodes("BASE", "bottom"),
        elastic(YOUNG, 0.3, 1.0, *(grid.name for grid in grids)),
        dry(0.4),
        card("CONTACT PAIR, INTERACTION=DRY", *pairs),
        card("BOUNDARY", ("BASE", 1, 2)),
        static(card("DLOAD", ("", "GRAV", 10.0, 0.1, -1.0)), dt=0.5),
    )
    passes = result.history.solver["passes"][1:]
    assert len(passes) == 2
    assert passes.max() <= 5


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_hairpin_closes_onto_itself(tmp_path: Path, friction: float) -> None:
    """Self-contact: the ends of a strip that is bent to a U are pressed together."""
    straight, half = 24, 12

    def place(i: int, j: int) -> tuple[float, float]:
        radius = 0.4 + 0.05 * j
        if i < straight:
            return 4.0 * (1 - i / straight), -radius
        if i > straight + half:
            return 4.0 * (i - straight - half) / straight, radius
        turn = pi * (i - straight) / half
        return -radius * sin(turn), -radius * cos(turn)

    count = 2 * straight + half
    pin = Grid("PIN", count, 2, place)
    result = solve(
        tmp_path,
        pin.mesh("CPE4"),
        pin.side_surface("INSIDE", "bottom"),
        card("NSET, NSET=BEND", (pin.node(count // 2, 2), pin.node(count // 2, 0))),
        card("NSET, NSET=UPPER", (pin.node(count, 2),)),
        card("NSET, NSET=LOWER", (pin.node(0, 2),)),
        elastic(YOUNG, 0.3, 1.0, "PIN"),
        dry(friction),
        card("CONTACT PAIR, INTERACTION=DRY", ("INSIDE",)),
        card("BOUNDARY", ("BEND", 1, 2)),
        static(
            card("CLOAD", ("UPPER", 2, -6.0), ("LOWER", 2, 6.0)),
            card("NODE PRINT, NSET=UPPER", ("U",)),
            card("NODE PRINT, NSET=LOWER", ("U",)),
            dt=0.02,
            direct=False,
        ),
    )
    (contact,) = result.contact.values()
    assert contact.normal[-1] > 1.0
    ways = [result.history.nodes[name].U[-1, 0] for name in ("UPPER", "LOWER")]
    assert ways[0][1] < -0.3
    # it stays symmetric
    assert abs(ways[0][1] + ways[1][1]) < 1e-6
    assert np.nanmin(contact.min_gap) > -1e-9


def test_a_dead_load_beyond_the_limit_of_an_arch_is_refused(tmp_path: Path) -> None:
    """The run of half of a shallow arch stops at the largest load and does not snap through."""
    span, rise, depth, count = 10.0, 0.4, 0.2, 100

    def place(i: int, j: int) -> tuple[float, float]:
        x = span / 2 * i / count
        return x, rise / 2 * (1 - cos(2 * pi * x / span)) + depth * (j - 1) / 2

    arch = Grid("ARCH", count, 2, place)
    cards = [
        arch.mesh("CPS4"),
        arch.side_nodes("HELD", "left"),
        arch.side_nodes("CROWN", "right"),
        elastic(1e3, 0.0, 1.0, "ARCH"),
        card("BOUNDARY", ("HELD", 1, 2), ("CROWN", 1, 1)),
        static(card("CLOAD", ("CROWN", 2, -0.02)), dt=0.1, direct=False),
    ]
    with pytest.raises(RunStopped) as stop:
        solve(tmp_path, *cards)
    load = 0.12 * stop.value.result.history.time[-1]
    assert 0.9 < load / 0.0841 < 1.02


@pytest.mark.parametrize("way", [1e-6, 0.3])
def test_a_part_may_be_moved_before_it_touches_anything(tmp_path: Path, way: float) -> None:
    """A body without any load is moved: round-off of its forces is all the work that there is."""
    part = block("PART", (1, 1), (1.0, 1.0), x=0.1, y=0.3)
    deck = tmp_path / "deck.inp"
    deck.write_text(
        "".join(
            [
                part.mesh("CPE4"),
                part.side_nodes("HELD", "left"),
                elastic(1e3, 0.3, 1.0, "PART"),
                card("BOUNDARY", ("HELD", 2, 2)),
                static(card("BOUNDARY", ("HELD", 1, 1, way)), dt=0.1),
            ]
        )
    )
    result = program.run(deck, tmp_path, "--threads", "1")
    moved = result.frame(result.history.time[-1])["U"]
    assert np.abs(moved[:, :2] - [way, 0.0]).max() < 1e-12


ROUND_GENERAL = card("CONTACT") + card("CONTACT INCLUSIONS, ALL EXTERIOR") + card(
    "CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")
)


def of_pair(kind: str) -> str:
    """A pair of the skins of a disc and its floor."""
    pair = card(f"CONTACT PAIR, INTERACTION=DRY, TYPE={kind}", ("ROUND", "FLOOR"))
    return outline("ROUND", "FLOOR") + pair


@pytest.mark.parametrize("young", [1e4, 1e7])
@pytest.mark.parametrize("mu", [0.0, 0.5])
@pytest.mark.parametrize(
    "contact", [of_pair("NODE TO SURFACE"), of_pair("SURFACE TO SURFACE"), ROUND_GENERAL]
)
def test_a_disc_on_a_vertex_tips_over_once(
    contact: str, mu: float, young: float, tmp_path: Path
) -> None:
    sides, radius = 16, 0.5
    floor = block("FLOOR", (20, 2), (2.0, 0.2), x=-1.0, y=-0.2)
    labels = floor.next_node, floor.next_element
    middle = (0.01, radius + 1e-3)
    round_body = disc("ROUND", middle, radius, 0.0, sides // 4, 2, *labels)
    steps = [static(card("DLOAD", ("ROUND", "GRAV", 10.0, 0.0, -1.0)), dt=0.2), static(dt=0.2)]
    deck = tmp_path / "deck.inp"
    cards = [
        floor.mesh("CPE4"),
        round_body.mesh("CPE4"),
        floor.side_nodes("BASE", "bottom"),
        elastic(young, 0.3, 1.0, "FLOOR", "ROUND"),
        dry(mu),
        contact,
        card("BOUNDARY", ("BASE", 1, 2)),
        *steps,
    ]
    deck.write_text("".join(cards))
    result = program.run(deck, tmp_path, "--threads", "1")
    energy = result.history.energy
    assert (np.abs(energy.balance) <= 1e-8 * energy.scale).all()
    nodes = result.node_labels >= floor.next_node
    travel = np.array([np.nanmean(frame["U"][nodes, 0]) for frame in result.frames])
    face = 2.0 * radius * sin(pi / sides)
    assert np.abs(travel).max() < face
    # half a face, then it stays
    assert np.ptp(travel[1:]) < 0.1 * face
