"""Values of elements at nodes, recovered from the means over elements by averaging within a body and a material.

The value at a corner comes from a plane, which is fitted with weights 1/distance^4 to the means at the centres of the
elements at the corner and of their neighbours. Inside a body the recovered value is almost the plain mean; at the
surface it is a linear extrapolation. A linear field is recovered exactly at every node. A node between two corners has
the mean of the values at the corners.
"""

from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array, Integers

FARTHEST = 8.0
"""A plane is not extended farther than so many times the spread of the centres in a direction: they are on a line there."""


def around_element(cell: Integers) -> Integers:
    """The nodes of an element in their order around it; a node between two corners stands between these corners."""
    return np.reshape(cell, (2, -1)).T.ravel() if len(cell) > 4 else cell


@dataclass(frozen=True)
class Recovery:
    """Places are pairs of a node and a material of the elements at the node: the first N places are the nodes, further
    places belong to nodes of several materials."""

    twins: Integers
    """Nodes of the places behind the first N [P - N]."""
    cells: list[Integers]
    """Places of the nodes of each element, as in `Result.cells`."""
    place: Integers
    """Place, element and weight of every part of a value at a corner [W]."""
    element: Integers
    weight: Array
    middles: Integers
    """Places between corners with the places of these [M, 3]: corner, middle, corner."""
    alone: Integers
    """Nodes all of whose elements have one material."""
    places: int
    """Their number P."""

    @classmethod
    def of(cls, coordinates: Array, elements: list[Integers], materials: Integers) -> "Recovery":
        """The recovery on an undeformed mesh, with the numbers of the materials of the elements [E]."""
        nodes = len(coordinates)
        cells, twins = _places(elements, materials, nodes)
        places = nodes + len(twins)
        at = coordinates[np.concatenate([np.arange(nodes), twins])]
        corners = [cell if len(cell) <= 4 else cell[: len(cell) // 2] for cell in cells]
        centres = np.array([at[one].mean(axis=0) for one in corners]).reshape(-1, 2)
        place, element, weight = _weights(corners, centres, at)
        middles = {
            int(m): (int(a), int(m), int(b))
            for cell, ends in zip(cells, corners)
            for a, m, b in zip(ends, cell[len(ends) :], np.roll(ends, -1))
        }
        split = np.zeros(nodes, dtype=bool)
        split[twins] = True
        alone = np.flatnonzero(~split)
        return cls(twins, cells, place, element, weight, np.reshape([*middles.values()], (-1, 3)).astype(int), alone, places)

    def __call__(self, values: Array) -> Array:
        """Values of elements [E] or [E, k] at the places [P] or [P, k]; NaN at nodes without elements.

        If no element has a negative value, no place has a negative value.
        """
        columns = values.reshape(len(values), int(np.prod(values.shape[1:]))).T
        found = np.full((self.places, len(columns)), np.nan)
        there = np.unique(self.place)
        for k, column in enumerate(columns):
            sums = np.bincount(self.place, self.weight * column[self.element], self.places)
            found[there, k] = sums[there]
            if (column >= 0.0).all():
                found[there, k] = np.maximum(found[there, k], 0.0)
        first, between, second = self.middles.T
        found[between] = 0.5 * (found[first] + found[second])
        return found.reshape(self.places, *values.shape[1:])


def _places(cells: list[Integers], materials: Integers, nodes: int) -> tuple[list[Integers], Integers]:
    """Places of the nodes of each element, and nodes of the places beyond the first N."""
    found: dict[tuple[int, int], int] = {}
    first: set[int] = set()
    twins: list[int] = []
    numbered = []
    for cell, material in zip(cells, materials.tolist()):
        for node in cell.tolist():
            if (node, material) in found:
                continue
            if node in first:
                found[node, material] = nodes + len(twins)
                twins.append(node)
            else:
                found[node, material] = node
                first.add(node)
        numbered.append(np.array([found[node, material] for node in cell.tolist()]))
    return numbered, np.array(twins, dtype=np.int64)


def _weights(corners: list[Integers], centres: Array, at: Array) -> tuple[Integers, Integers, Array]:
    """Place, element and weight of every term in the values at corners."""
    around: dict[int, list[int]] = {}
    for number, ends in enumerate(corners):
        for end in ends.tolist():
            around.setdefault(end, []).append(number)
    near = [{other for end in ends.tolist() for other in around[end]} for ends in corners]
    pairs = [(end, sorted({other for one in of for other in near[one]})) for end, of in around.items()]
    place = np.repeat(np.array([p for p, _ in pairs], np.int64), [len(of) for _, of in pairs])
    element = np.array([one for _, of in pairs for one in of], np.int64)
    if len(place) == 0:
        return place, element, np.empty(0)
    size = len(at)

    def total(values: Array) -> Array:
        return np.stack([np.bincount(place, column, size) for column in values.T], axis=1)

    way = centres[element] - at[place]
    share = (way**2).sum(axis=1) ** -2
    share /= np.bincount(place, share, size)[place]
    middle = total(share[:, None] * way)
    off = way - middle[place]
    spread = total(share[:, None] * np.stack([off[:, 0] ** 2, off[:, 0] * off[:, 1], off[:, 1] ** 2], axis=1))
    sizes, axes = np.linalg.eigh(spread[:, [0, 1, 1, 2]].reshape(-1, 2, 2))
    # the middle in the axes of the spread, and the slope of the plane along each that is wide enough
    along = np.einsum("pij,pi->pj", axes, middle)
    wide = sizes * FARTHEST**2 > along**2
    slope = np.where(wide & (sizes > 0.0), along / np.where(sizes > 0.0, sizes, 1.0), 0.0)
    vector = np.einsum("pij,pj->pi", axes, slope)
    return place, element, share * (1.0 - (vector[place] * off).sum(axis=1))
