"""The check for nodes inside bodies: known answers."""

import subprocess
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest
from conftest import COMMAND, ROOT, Job
from decks import CANTILEVERS, parse, shortened
from stickslip.bulges import straight
from stickslip.errors import Fault
from stickslip.penetration.intrusion import Overlap, compare, in_obstacle, still_gone
from stickslip.penetration.outlines import Outline, outlines, side
from stickslip.penetration.profiles import Profile
from stickslip.result import Result

Points = list[tuple[float, float]]

UNIT: Points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def overlap(*polygons: Points) -> Overlap:
    """Compares bodies given by their corners, counter-clockwise."""
    bodies, first = [], 0
    for polygon in polygons:
        nodes = np.arange(first, first + len(polygon))
        bodies.append(Outline.of(np.stack([nodes, np.roll(nodes, -1)], axis=1)))
        first += len(polygon)
    return compare(np.array([point for polygon in polygons for point in polygon]), bodies)


def tip(x: float, y: float) -> Points:
    """A triangle with its first corner at a place and the others above."""
    return [(x, y), (x + 0.1, y + 5.0), (x - 0.1, y + 5.0)]


def test_bodies_apart() -> None:
    found = overlap(UNIT, tip(0.5, 1.5))
    assert found == Overlap(None, 0, 0)


@pytest.mark.parametrize("depth", [0.25, 1e-3, 1e-8, 1e-12])
def test_a_node_inside(depth: float) -> None:
    found = overlap(UNIT, tip(0.5, 1.0 - depth))
    assert found.deepest is not None
    assert found.deepest.node == 4
    assert found.deepest.body == 0
    assert found.deepest.edge == (2, 3)
    assert found.depth == pytest.approx(depth, abs=1e-16)
    assert found.inside == (depth > 1e-9)
    assert found.crossings == (2 if depth > 1e-9 else 0)


def test_depth_is_in_lengths_of_the_nearest_edge() -> None:
    flat = [(0.0, 0.0), (10.0, 0.0), (10.0, 1.0), (0.0, 1.0)]
    found = overlap(flat, tip(5.0, 0.9))
    assert found.deepest is not None
    assert found.deepest.distance == pytest.approx(0.1)
    assert found.depth == pytest.approx(0.01)


@pytest.mark.parametrize("x", [0.0, 0.25, 1.0])
def test_a_node_on_the_boundary_is_not_inside(x: float) -> None:
    assert overlap(UNIT, tip(x, 1.0)) == Overlap(None, 0, 0)


def test_sides_are_exact() -> None:
    """A point next to a slanting line, displaced by the smallest steps there are."""
    start, end = np.array([0.1, 0.1]), np.array([12.7, 12.7])
    up, down = np.nextafter(0.7, 1.0), np.nextafter(0.7, 0.0)
    points = np.array([[0.7, 0.7], [0.7, up], [0.7, down], [up, 0.7]])
    assert side(start, end, points).tolist() == [0, 1, -1, -1]


def test_concave_corner() -> None:
    hook = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
    assert overlap(hook, tip(1.5, 1.25)) == Overlap(None, 0, 0)
    corner = [(x + 1.0, y + 1.0) for x, y in UNIT]
    assert overlap(hook, corner) == Overlap(None, 0, 0), "a corner in the corner"
    deeper = [(x - 0.01, y - 0.02) for x, y in corner]
    found = overlap(hook, deeper)
    assert found.deepest is not None
    assert (found.deepest.node, found.deepest.distance) == (6, pytest.approx(np.hypot(0.01, 0.02)))


def test_thin_body() -> None:
    """A node through a thin plate is outside, but edges cross; one in its middle is inside."""
    plate = [(-1.0, 0.0), (1.0, 0.0), (1.0, 1e-6), (-1.0, 1e-6)]
    found = overlap(plate, tip(0.0, -0.1))
    assert (found.deepest, found.crossings) == (None, 4)
    found = overlap(plate, tip(0.0, 0.5e-6))
    assert found.deepest is not None
    assert found.deepest.distance == pytest.approx(0.5e-6)


def test_plates_that_cross_without_a_node_inside() -> None:
    lying = [(-1.0, -0.1), (1.0, -0.1), (1.0, 0.1), (-1.0, 0.1)]
    standing = [(-0.1, -1.0), (0.1, -1.0), (0.1, 1.0), (-0.1, 1.0)]
    found = overlap(lying, standing)
    assert (found.deepest, found.inside, found.crossings) == (None, 0, 4)
    # the long edges cross; each ends 0.9 beyond another, whose length is 2
    assert found.crossing == pytest.approx(0.45)


def test_a_body_around_another() -> None:
    ring = [(3 * x - 1.0, 3 * y - 1.0) for x, y in UNIT]
    edges = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (7, 6), (6, 5), (5, 4), (4, 7)])
    inner = Outline.of(np.array([(8, 9), (9, 10), (10, 11), (11, 8)]))
    quarter = [(0.5 * x + 0.25, 0.5 * y + 0.25) for x, y in UNIT]
    bodies = [Outline.of(edges), inner]
    assert compare(np.array(ring + UNIT + quarter), bodies) == Overlap(None, 0, 0)
    shifted = [(x + 0.5, y) for x, y in quarter]
    found = compare(np.array(ring + UNIT + shifted), bodies)
    assert found.depth == pytest.approx(0.25)
    assert (found.inside, found.crossings) == (2, 2)


def strip(turn: float, pieces: int = 30, width: float = 0.1, pitch: float = 0.0) -> Points:
    """A strip of constant width bent to an arc of radius 1, its end out by `pitch`."""
    angles = [turn * k / pieces for k in range(pieces + 1)]
    rim = [(1.0 + pitch * k / pieces, angle) for k, angle in enumerate(angles)]
    outer = [((r + width) * cos(angle), (r + width) * sin(angle)) for r, angle in rim]
    inner = [(r * cos(angle), r * sin(angle)) for r, angle in rim]
    return outer + inner[::-1]


def test_a_bent_strip_does_not_meet_itself() -> None:
    assert overlap(strip(1.9 * pi)) == Overlap(None, 0, 0)
    assert overlap(strip(2.2 * pi, 67, pitch=0.2)) == Overlap(None, 0, 0)


def test_a_strip_over_itself() -> None:
    """The strip's end lies on its start, which it overlaps by half its width."""
    found = overlap(strip(2.2 * pi, 67, pitch=0.05 * 1.1))
    assert found.deepest is not None
    assert found.deepest.distance == pytest.approx(0.05, abs=1e-3)
    assert found.inside >= 12
    assert found.crossings > 0


def test_all_turns_of_a_body_are_found_alike() -> None:
    """The rays of the test run to the right: turning everything must not matter."""
    for angle in np.arange(0.0, 2 * pi, pi / 12):
        turned = [
            (x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle))
            for x, y in strip(2.2 * pi, 67, pitch=0.05 * 1.1)
        ]
        apart = [
            (x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle))
            for x, y in strip(2.2 * pi, 67, pitch=0.2)
        ]
        assert overlap(turned).inside == overlap(strip(2.2 * pi, 67, pitch=0.05 * 1.1)).inside
        assert overlap(apart).deepest is None


def test_an_outline_that_touches_itself_in_a_node_is_refused(job: Job, tmp_path: Path) -> None:
    square = (ROOT / "tests/decks/square.inp").read_text().partition("*STEP")[0]
    pinched = (
        f"{square}*NODE\n91, 1., 2.\n92, 2., 2.\n93, 2., 1.\n"
        "*ELEMENT, TYPE=CPS4, ELSET=BODY\n91, 3, 93, 92, 91\n"
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n1e-5, 1e-5\n*END STEP\n"
    )
    with Result(job(parse(pinched, tmp_path))) as results:
        with pytest.raises(Fault, match="touch in corners only, at node 3:"):
            outlines(results)


def rigid(chain: Points, *polygons: Points, closed: bool = False) -> Overlap:
    """Compares bodies with a rigid surface, the obstacle on the left of its chain."""
    place, bodies, obstacle = placed(chain, *polygons, closed=closed)
    return compare(place, bodies, [obstacle])


def placed(
    chain: Points, *polygons: Points, closed: bool = False
) -> tuple[np.ndarray, list[Outline], Profile]:
    """Positions, outlines of bodies and the profile behind them."""
    bodies, first = [], 0
    for polygon in polygons:
        nodes = np.arange(first, first + len(polygon))
        bodies.append(Outline.of(np.stack([nodes, np.roll(nodes, -1)], axis=1)))
        first += len(polygon)
    nodes = np.arange(first, first + len(chain))
    ends = nodes[1:] if not closed else np.roll(nodes, -1)
    profile = Profile(nodes[: len(ends)], ends, straight(len(ends)))
    return np.array([point for shape in (*polygons, chain) for point in shape]), bodies, profile


def moved(polygon: Points, x: float, y: float) -> Points:
    """A polygon somewhere else."""
    return [(a + x, b + y) for a, b in polygon]


FLOOR: Points = [(9.0, 0.0), (3.0, 0.0), (-3.0, 0.0)]
"""The obstacle below."""


@pytest.mark.parametrize("depth", [0.25, 1e-3, 1e-8, 1e-12])
def test_a_body_in_a_rigid_floor(depth: float) -> None:
    found = rigid(FLOOR, moved(UNIT, 0.0, -depth))
    assert found.inside == (2 if depth > 1e-9 else 0)
    if depth > 1e-9:
        assert found.deepest is not None
        assert (found.deepest.body, found.deepest.edge) == (None, (5, 6))
        assert found.depth == pytest.approx(depth, rel=1e-6)
        assert found.crossings == 2


@pytest.mark.parametrize("x", [-5.0, -3.0, 0.0, 2.5, 3.0])
def test_a_body_on_a_rigid_floor_is_not_inside(x: float) -> None:
    """Nor over its end, nor by as little as round-off below it."""
    for y in (1e-16, 0.0, -1e-16):
        found = rigid(FLOOR, moved(UNIT, x, y))
        assert (found.inside, found.crossings) == (0, 0)


def test_what_hangs_behind_a_rigid_floor_is_not_inside() -> None:
    """A whole body, and one that grips the floor's end, whose jaw lies on the floor."""
    assert rigid(FLOOR, moved(UNIT, 0.0, -1.5)) == Overlap(None, 0, 0)
    for y in (1e-16, 0.0, -1e-16):
        hook = [(0.0, y), (0.0, 1.0), (-5.0, 1.0), (-5.0, -2.0), (0.0, -2.0), (0.0, -1.0)]
        hook += [(-4.0, -1.0), (-4.0, y)]
        assert rigid(FLOOR, hook[::-1]).inside == 0


def test_the_corner_of_a_punch_in_a_body() -> None:
    """No node of the body is in the obstacle, but the punch's corner is in the body."""
    punch = [(0.3, 5.0), (0.5, 0.75), (0.7, 5.0)]
    found = rigid(punch, UNIT)
    assert found.corner is not None
    assert (found.corner.node, found.corner.body) == (5, 0)
    assert found.depth == found.corner.distance == pytest.approx(0.25)
    assert (found.deepest, found.inside, found.crossings) == (None, 0, 2)


def test_a_node_at_a_corner_of_an_obstacle() -> None:
    """Convex: inside is what is left of both segments; hollow: what is left of one."""
    step = [(5.0, 0.0), (0.0, 0.0), (0.0, -5.0)]  # the obstacle below and right: convex
    assert rigid(step, moved(UNIT, -1.1, -0.5)).inside == 0
    found = rigid(step, moved(UNIT, -0.75, -0.25))
    assert found.inside == 1 and found.corner is not None, "the corner is in the body"
    pit = [(5.0, 0.0), (0.0, 0.0), (0.0, 5.0)]  # the obstacle below and left: hollow
    assert rigid(pit, UNIT).inside == 0
    assert rigid(pit, moved(UNIT, -0.25, -0.25)).inside == 3


def test_closed_rigid_surfaces() -> None:
    square = [(3 * x - 1.0, 3 * y - 1.0) for x, y in UNIT]
    assert rigid(square, UNIT, closed=True).inside == 4, "an obstacle around the body"
    assert rigid(square, moved(UNIT, 5.0, 0.0), closed=True) == Overlap(None, 0, 0)
    assert rigid(square[::-1], UNIT, closed=True) == Overlap(None, 0, 0), "a box"
    assert rigid(square[::-1], moved(UNIT, 1.5, 0.0), closed=True).inside == 2


def test_a_body_that_jumps_through_a_rigid_floor() -> None:
    before, bodies, floor = placed(FLOOR, moved(UNIT, 0.0, 1.0))
    after = placed(FLOOR, moved(UNIT, 0.0, -3.0))[0]
    gone = still_gone(before, after, bodies, [floor], frozenset())
    assert gone == {(0, 0)}
    assert len(in_obstacle(after, bodies[0], floor, True)) == 4
    assert compare(after, bodies, [floor], gone).depth == pytest.approx(3.0)
    # it stays there, is lifted by the floor, which jumps below it, and is not taken for gone
    assert still_gone(after, after, bodies, [floor], gone) == gone
    below = placed(moved(FLOOR, 0.0, -9.0), moved(UNIT, 0.0, -3.0))[0]
    assert still_gone(after, below, bodies, [floor], gone) == set()
    together = placed(moved(FLOOR, 0.0, -9.0), moved(UNIT, 0.0, -8.0))[0]
    assert still_gone(before, together, bodies, [floor], frozenset()) == set()


PUNCH = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*NODE, NSET=REF
9, 0., 5.
*ELEMENT, TYPE=CPE4, ELSET=BODY
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*SOLID SECTION, ELSET=BODY, MATERIAL=M
*SURFACE, NAME=PUNCH, TYPE=SEGMENTS
START, 0.7, 5.
LINE, 0.5, 1.1
LINE, 0.3, 5.
*RIGID BODY, ANALYTICAL SURFACE=PUNCH, REF NODE=REF
*BOUNDARY
ALL, 1, 2
*AMPLITUDE, NAME=DOWN
0., 0., 1., 1.
*STEP, NLGEOM
*DYNAMIC
0.1, 1.
*BOUNDARY, AMPLITUDE=DOWN
REF, 1, 1, 0.
REF, 2, 2, -0.5
*END STEP
"""
"""A punch that no contact keeps out of a block."""


def test_a_punch_without_contact_is_found(job: Job, tmp_path: Path) -> None:
    result = job(parse(PUNCH, tmp_path), "--frames", "10")
    command = [*COMMAND, "penetration", str(result)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    assert "edges cross in 8 of them" in done.stdout
    assert "no node inside; rigid corner" in done.stdout
    assert "at (0.5, 0.6) is 0.4 element sizes (0.4) behind edge" in done.stdout


def test_command_line(job: Job) -> None:
    result = job(shortened(CANTILEVERS / "A_mu04.inp", 40), "--frames", "4")
    command = [*COMMAND, "penetration", str(result), "--all"]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # pairs in contact have a gap that is zero but for round-off
    lines = [line for line in done.stdout.splitlines() if "frame " in line]
    clear = ("no node inside", "; 0 nodes deeper than 1e-09")
    assert len(lines) == 5
    assert all(any(words in line for words in clear) for line in lines), done.stdout
