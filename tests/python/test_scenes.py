"""Twenty random scenes: no stop, no cutback, no gain of energy, no overlap."""

from pathlib import Path

import numpy as np
import pytest
from lab import random_scenes, scene_shapes
from lab.scenes import GAIN, Trial
from stickslip.arrays import Array
from stickslip.penetration.outlines import LIMIT

INCREMENTS = 100
SCENES = [("falling", seed) for seed in (0, 2, 3, 4, 5, 6, 7, 8, 9, 10)]
SCENES += [("mixed", seed) for seed in (60, 61, 66, 68, 70, 72, 76, 79, 80, 88)]
"""Short ones; among the mixed ones are SS22, EVENT, RETURN, REDISTRIBUTED, LEMKE and a peg."""


@pytest.mark.parametrize(("kind", "seed"), SCENES)
def test_scene(kind: str, seed: int, tmp_path: Path) -> None:
    found = Trial(kind, "neo-hooke", None, 60.0, tmp_path, INCREMENTS).run(seed)
    assert not found.ended
    assert found.increments >= INCREMENTS
    assert found.cutbacks == 0
    assert found.gain < GAIN or not found.is_exact
    assert max(found.depth, found.crossing) < LIMIT


@pytest.mark.parametrize(
    ("family", "material"), [("3", "neo-hooke"), ("4I", "neo-hooke"), ("6", "neo-hooke"), ("8R", "neo-hooke"), ("4H", "metal")]
)
def test_scene_of_other_elements(family: str, material: str, tmp_path: Path) -> None:
    found = Trial("falling", material, None, 60.0, tmp_path, INCREMENTS, family).run(2)
    assert not found.ended
    assert found.cutbacks == 0
    assert found.gain < GAIN
    assert max(found.depth, found.crossing) < LIMIT


def test_corners_that_slide_past_vertices_stay_outside_from_surface_to_surface(tmp_path: Path) -> None:
    """In this scene a corner comes past a convex vertex, behind the line of whose next segment it was."""
    found = Trial("falling", "neo-hooke", None, 60.0, tmp_path, 130, contact="SURFACE TO SURFACE").run(54)
    assert not found.ended
    assert found.cutbacks == 0
    assert found.gain < GAIN
    assert found.depth < 0.1


@pytest.mark.parametrize("kind", random_scenes.KINDS)
def test_scenes_are_bodies_in_their_places(kind: str) -> None:
    decks = set()
    for seed in range(30):
        scene = random_scenes.KINDS[kind](seed)
        decks.add(scene.deck())
        assert scene.deck() == random_scenes.KINDS[kind](seed).deck()
        for body in scene.bodies:
            corners = [body.nodes[list(corners)] for corners in body.shape.elements]
            assert min(map(area, corners)) > 0.0
    assert len(decks) == 30


def area(corners: Array) -> float:
    """Least area between two sides of an element."""
    after, before = np.roll(corners, -1, axis=0) - corners, np.roll(corners, 1, axis=0) - corners
    return float((after[:, 0] * before[:, 1] - after[:, 1] * before[:, 0]).min())


def test_nodes_at_one_place_are_joined() -> None:
    ring = scene_shapes.strip(scene_shapes.arc(1.0, 2 * np.pi, 0.0), 12, 2, 0.1)
    assert (len(ring.nodes), len(ring.elements)) == (36, 24)
    polygon = scene_shapes.polygon(5, 2, 1.0, np.random.default_rng(1))
    assert (len(polygon.nodes), len(polygon.elements)) == (1 + 5 * 6, 20)
