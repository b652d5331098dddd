"""The check for nodes inside bodies: known answers."""

import subprocess
import sys
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import penetration
import pytest
from conftest import ROOT, Job
from decks import CANTILEVERS, shortened
from penetration import Outline, Overlap, compare, side

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
    assert overlap(lying, standing) == Overlap(None, 0, 4)


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


def test_an_outline_that_touches_itself_in_a_node_is_refused() -> None:
    with pytest.raises(ValueError, match="touches itself"):
        Outline.of(np.array([(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)]))


def test_command_line(job: Job) -> None:
    result = job(shortened(CANTILEVERS / "A_mu04.inp", 40), "--frames", "4")
    command = [sys.executable, str(ROOT / "scripts" / "penetration.py"), str(result), "--all"]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("no node inside") == 5
    assert Path(penetration.__file__) == ROOT / "scripts" / "penetration.py"
