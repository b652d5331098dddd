"""Shapes of the bodies of random scenes: nodes around the origin and quadrilaterals."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from stickslip.arrays import Array

Corners = tuple[int, int, int, int]
Curve = Callable[[Array], Array]
"""Points [n, 2] of a line at the parts of its length between 0 and 1."""

SAME = 1e-9
"""Nodes nearer than this, in sizes of the shape, are one."""


@dataclass(frozen=True)
class Shape:
    """Nodes [n, 2] and elements, both counter-clockwise."""

    nodes: Array
    elements: list[Corners]

    @property
    def radius(self) -> float:
        """Of the circle around the origin that holds the shape."""
        return float(np.hypot(*self.nodes.T).max())


def rectangle(
    count: tuple[int, int], size: tuple[float, float], rng: Generator, jitter: float = 0.15
) -> Shape:
    """Elements along and across; inner nodes are off the lattice by up to `jitter` elements."""
    (nx, ny), (width, height) = count, size
    place = [(i / nx - 0.5, j / ny - 0.5) for j in range(ny + 1) for i in range(nx + 1)]
    inner = [0 < i < nx and 0 < j < ny for j in range(ny + 1) for i in range(nx + 1)]
    nodes = np.array(place) * [width, height]
    shift = rng.uniform(-jitter, jitter, (sum(inner), 2))
    nodes[np.array(inner)] += shift * [width / nx, height / ny]
    return Shape(nodes, _lattice(nx, ny))


def _lattice(nx: int, ny: int) -> list[Corners]:
    row = nx + 1
    corners = (0, 1, row + 1, row)
    return [tuple(j * row + i + corner for corner in corners) for j in range(ny) for i in range(nx)]


def disc(side: int, radius: float) -> Shape:
    """A disc of side x side elements: a square whose sides have been bent."""
    flat = rectangle((side, side), (2.0, 2.0), np.random.default_rng(0), 0.0)
    out = np.abs(flat.nodes).max(axis=1)
    distance = np.hypot(*flat.nodes.T)
    bent = np.where(distance > 0, out / np.where(distance > 0, distance, 1), 1)
    weight = 0.35 + 0.65 * out**2
    return Shape(flat.nodes * (bent * weight + 1 - weight)[:, None] * radius, flat.elements)


def polygon(corners: int, parts: int, radius: float, rng: Generator) -> Shape:
    """A polygon with corners in random directions and distances, not always convex."""
    turns = (np.arange(corners) + rng.uniform(-0.2, 0.2, corners)) * 2 * np.pi / corners
    far = radius * rng.uniform(0.75, 1.0, corners)
    rim = np.stack([far * np.cos(turns), far * np.sin(turns)], axis=1)
    middle = (rim + np.roll(rim, -1, axis=0)) / 2
    centre = rim.mean(axis=0)
    patches = [
        np.array([centre, middle[k - 1], rim[k], middle[k]]) - centre for k in range(corners)
    ]
    return joined([_patch(patch, parts) for patch in patches])


def _patch(corners: Array, parts: int) -> Shape:
    """parts x parts elements between four corners."""
    s = np.linspace(0.0, 1.0, parts + 1)
    v, u = (x.ravel()[:, None] for x in np.meshgrid(s, s, indexing="ij"))
    weights = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]
    nodes = sum(weight * corner for weight, corner in zip(weights, corners))
    return Shape(nodes, _lattice(parts, parts))


def strip(curve: Curve, along: int, layers: int, thickness: float) -> Shape:
    """A thin body around a line, closed where the line is."""
    part = np.linspace(0.0, 1.0, along + 1)
    small = 1e-6
    way = curve(np.minimum(part + small, 1.0)) - curve(np.maximum(part - small, 0.0))
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]
    line = curve(part)
    if np.allclose(line[0], line[-1]):
        across[-1] = across[0]
    levels = thickness * (np.arange(layers + 1) / layers - 0.5)
    nodes = np.concatenate([line + level * across for level in levels])
    shape = joined([Shape(nodes, _lattice(along, layers))])
    return Shape(shape.nodes - shape.nodes.mean(axis=0), shape.elements)


def arc(radius: float, angle: float, leg: float) -> Curve:
    """A part of a circle with a straight piece behind it: a hook; 2 pi is a ring."""

    def points(part: Array) -> Array:
        way = part * (radius * angle + leg)
        turn = np.minimum(way / radius, angle)
        rest = np.maximum(way - radius * angle, 0.0)
        x = radius * np.cos(turn) - rest * np.sin(turn)
        y = radius * np.sin(turn) + rest * np.cos(turn)
        return np.stack([x, y], axis=1)

    return points


def wave(length: float, height: float, waves: float) -> Curve:
    """A meander: a spring whose windings can touch."""

    def points(part: Array) -> Array:
        return np.stack([length * part, height * np.sin(2 * np.pi * waves * part)], axis=1)

    return points


def joined(shapes: Sequence[Shape]) -> Shape:
    """Shapes as one; nodes at the same place are one node."""
    nodes = np.concatenate([shape.nodes for shape in shapes])
    size = np.ptp(nodes, axis=0).max()
    index: dict[tuple[int, int], int] = {}
    number, kept = [], []
    for node, key in zip(nodes, np.round(nodes / (size * SAME)).astype(np.int64)):
        key = (int(key[0]), int(key[1]))
        if key not in index:
            index[key] = len(kept)
            kept.append(node)
        number.append(index[key])
    elements, first = [], 0
    for shape in shapes:
        elements += [tuple(number[first + k] for k in corners) for corners in shape.elements]
        first += len(shape.nodes)
    return Shape(np.array(kept), elements)
