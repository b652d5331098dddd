"""Meshes of linear and quadratic triangles and quadrilaterals: from numpy arrays, meshio or Gmsh."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.arrays import Array, Integers
from stickslip.errors import Fault

if TYPE_CHECKING:
    import meshio


FLAT = 1e-9
"""Coordinates z that differ by this part of the mesh's size are the same."""

KINDS = {"triangle": 3, "quad": 4, "triangle6": 6, "quad8": 8}
"""Elements of meshio and their nodes."""

LINES = ("line", "line3")
"""Lines of meshio that sides are made of."""

GMSH = {2: 3, 3: 4, 9: 6, 16: 8}
"""Element types of Gmsh and their nodes: linear and quadratic triangle and quadrilateral."""

GMSH_LINES = {1: 2, 8: 3}
"""Types of lines of Gmsh and their nodes."""


@dataclass
class Mesh:
    """Nodes and elements, numbered by indices from 0, with named sets.

    Elements with clockwise nodes are turned, so that all nodes run counter-clockwise.
    """

    points: Array
    """Coordinates [N, 2]."""
    elements: list[Integers]
    """Node indices of each element: three or four corners, and the nodes between them in quadratic ones."""
    element_sets: dict[str, Integers] = field(default_factory=dict)
    """Element indices by name."""
    node_sets: dict[str, Integers] = field(default_factory=dict)
    """Node indices by name."""
    sides: dict[str, Integers] = field(default_factory=dict)
    """Sides of elements by name: [S, 2] indices of their corners, in any order. They become surfaces."""

    def __init__(
        self,
        points: ArrayLike,
        elements: Sequence[ArrayLike] | NDArray[Any],
        element_sets: Mapping[str, ArrayLike] = {},
        node_sets: Mapping[str, ArrayLike] = {},
        sides: Mapping[str, ArrayLike] = {},
    ) -> None:
        """`elements` is an array [E, k] with k = 3, 4, 6 or 8 nodes, or a list of elements with different numbers of
        nodes."""
        self.points = _plane(np.asarray(points, dtype=np.float64))
        self.elements = [np.asarray(element, dtype=np.int64) for element in elements]
        self.element_sets = {name: _indices(one) for name, one in element_sets.items()}
        self.node_sets = {name: _indices(one) for name, one in node_sets.items()}
        self.sides = {name: _indices(one).reshape(-1, 2) for name, one in sides.items()}
        self._check()
        self.elements = [
            element if _area(self.points[_corners(element)]) > 0.0 else _turned(element)
            for element in self.elements
        ]

    def _check(self) -> None:
        """Raises a Fault for a mesh from which no deck can be made."""
        for index, element in enumerate(self.elements):
            if element.shape not in ((3,), (4,), (6,), (8,)):
                raise Fault(f"element {index} has {element.size} nodes: 3, 4, 6 or 8 are needed")
        count = {"node": len(self.points), "element": len(self.elements)}
        used = np.concatenate([*self.elements, np.empty(0, np.int64)])
        checked = [("node", "the elements", used)]
        checked += [("element", f"the set {name}", one) for name, one in self.element_sets.items()]
        checked += [("node", f"the set {name}", one) for name, one in self.node_sets.items()]
        checked += [("node", f"the sides {name}", one) for name, one in self.sides.items()]
        for kind, what, indices in checked:
            if indices.size and not 0 <= indices.min() <= indices.max() < count[kind]:
                worst = indices.max() if indices.min() >= 0 else indices.min()
                raise Fault(f"{what} have {kind} {worst}: there are 0 to {count[kind] - 1}")

    def faces(self, name: str) -> list[tuple[int, int]]:
        """Element index and number of the side, from 1, for each side of the surface with a given name."""
        if self._owner is None:
            self._owner = {}
            for index, element in enumerate(self.elements):
                corners = _corners(element)
                for side, ends in enumerate(zip(corners, np.roll(corners, -1)), start=1):
                    key = frozenset(map(int, ends))
                    self._owner.setdefault(key, []).append((index, side))
        found = []
        for a, b in self.sides[name]:
            owners = self._owner.get(frozenset((int(a), int(b))), [])
            if len(owners) != 1:
                what = "no element" if not owners else "two elements"
                raise Fault(f"{name}: the side from node {a} to {b} belongs to {what}")
            found += owners
        return found

    _owner: dict[frozenset[int], list[tuple[int, int]]] | None = None

    @classmethod
    def from_meshio(cls, mesh: "meshio.Mesh") -> "Mesh":
        """A mesh made of the triangles and quadrilaterals, linear or quadratic, of a mesh of meshio, with its sets and
        physical groups.

        Sets of lines become sides; the nodes of the lines become node sets. If there are no sets of elements, all
        elements form the set ALL. Nodes that belong to no element are left out.
        """
        blocks = [(block.type, np.asarray(block.data)) for block in mesh.cells]
        groups: dict[str, list[Integers]] = {
            name: [np.asarray(rows, dtype=np.int64) for rows in of_blocks]
            for name, of_blocks in mesh.cell_sets.items()
            if not name.startswith("gmsh:")
        }
        for name, (tag, _) in mesh.field_data.items():
            tags = mesh.cell_data.get("gmsh:physical", [])
            groups.setdefault(name, [np.flatnonzero(rows == tag) for rows in tags])
        elements: list[Integers] = []
        sets: dict[str, list[int]] = {}
        sides: dict[str, list[Integers]] = {}
        between: dict[str, list[Integers]] = {}
        for at, (kind, data) in enumerate(blocks):
            first = len(elements)
            if kind in KINDS:
                elements += list(data)
            elif kind not in (*LINES, "vertex"):
                raise Fault(
                    f"the mesh has elements of the type {kind}: {', '.join(KINDS)} are read"
                )
            for name, rows in groups.items():
                if at < len(rows) and rows[at] is not None and len(rows[at]):
                    if kind in KINDS:
                        sets.setdefault(name, []).extend(first + rows[at])
                    elif kind in LINES:
                        sides.setdefault(name, []).append(data[rows[at]][:, :2])
                        between.setdefault(name, []).append(data[rows[at]].ravel())
        nodes = {name: np.unique(np.concatenate(rows)) for name, rows in between.items()}
        nodes |= {name: np.asarray(rows) for name, rows in mesh.point_sets.items()}
        lines = {name: np.concatenate(rows) for name, rows in sides.items()}
        return cls._of_used(np.asarray(mesh.points), elements, sets, nodes, lines)

    @classmethod
    def from_gmsh(cls, model: Any) -> "Mesh":
        """The mesh of a Gmsh model (`gmsh.model`), with its physical groups by name.

        Groups of surfaces become element sets, groups of curves become sides and node sets, and groups of points become
        node sets. If there is no group of surfaces, all elements form the set ALL; otherwise elements outside all
        groups are left out, as in files of Gmsh.
        """
        tags, coordinates, _ = model.mesh.getNodes()
        index = {int(tag): at for at, tag in enumerate(tags)}
        elements: list[Integers] = []
        sets: dict[str, list[int]] = {}
        sides: dict[str, Integers] = {}
        nodes: dict[str, Integers] = {}
        place: dict[int, int] = {}

        def add(entity: int) -> list[int]:
            """Indices of the elements of a surface."""
            own = []
            for kind, labels, connected in zip(*model.mesh.getElements(2, entity)):
                if int(kind) not in GMSH:
                    name = model.mesh.getElementProperties(kind)[0]
                    raise Fault(f"the mesh has elements of the type {name}, which are not read")
                rows = np.array([index[int(tag)] for tag in connected]).reshape(-1, GMSH[int(kind)])
                for label, row in zip(labels, rows):
                    if int(label) not in place:
                        place[int(label)] = len(elements)
                        elements.append(row)
                    own.append(place[int(label)])
            return own

        for dimension, group in model.getPhysicalGroups():
            name = model.getPhysicalName(dimension, group) or f"GROUP{group}"
            entities = model.getEntitiesForPhysicalGroup(dimension, group)
            if dimension == 2:
                sets[name] = [at for entity in entities for at in add(int(entity))]
                continue
            labels, _ = model.mesh.getNodesForPhysicalGroup(dimension, group)
            nodes[name] = np.array([index[int(tag)] for tag in labels])
            if dimension == 1:
                ends: list[list[int]] = []
                for entity in entities:
                    for kind, _, connected in zip(*model.mesh.getElements(1, int(entity))):
                        lines = np.reshape(connected, (-1, GMSH_LINES[int(kind)]))
                        ends += [[index[int(tag)] for tag in line[:2]] for line in lines]
                sides[name] = np.array(ends, dtype=np.int64).reshape(-1, 2)
        if not sets:
            add(-1)
        return cls._of_used(np.asarray(coordinates).reshape(-1, 3), elements, sets, nodes, sides)

    @classmethod
    def _of_used(
        cls,
        points: Array,
        elements: list[Integers],
        sets: Mapping[str, Sequence[int]],
        nodes: Mapping[str, Integers],
        sides: Mapping[str, Integers],
    ) -> "Mesh":
        """The mesh without nodes that belong to no element."""
        if not elements:
            raise Fault("the mesh has no triangles or quadrilaterals")
        used = np.unique(np.concatenate(elements))
        new = np.full(len(points), -1)
        new[used] = np.arange(len(used))
        kept = {name: new[rows] for name, rows in nodes.items()}
        kept |= {name: new[np.unique(rows)] for name, rows in sides.items() if name not in kept}
        return cls(
            points[used],
            [new[element] for element in elements],
            sets or {"ALL": range(len(elements))},
            {name: rows[rows >= 0] for name, rows in kept.items()},
            {name: new[rows] for name, rows in sides.items()},
        )


def _plane(points: Array) -> Array:
    """Coordinates in the plane; different values of z raise a Fault."""
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise Fault(f"points [N, 2] are needed, not {list(points.shape)}")
    if points.shape[1] == 3 and len(points):
        if np.ptp(points[:, 2]) > FLAT * np.ptp(points[:, :2], axis=0).max():
            raise Fault("the mesh is not plane: its points differ in z")
    return points[:, :2]


def _indices(values: ArrayLike) -> Integers:
    """Indices as integers."""
    given = np.asarray(values if not isinstance(values, range) else list(values))
    if given.size and not np.issubdtype(given.dtype, np.integer):
        raise Fault(f"indices are whole numbers, not {given.dtype}")
    return given.astype(np.int64)


def _corners(element: Integers) -> Integers:
    """The corners of an element; the nodes between corners come after the corners."""
    return element[: len(element) // 2] if len(element) > 4 else element


def _turned(element: Integers) -> Integers:
    """The element with its nodes in the opposite order of rotation."""
    if len(element) <= 4:
        return element[::-1]
    corners, between = np.split(element, 2)
    return np.concatenate([corners[::-1], np.roll(between[::-1], -1)])


def _area(corners: Array) -> float:
    """Area of a polygon, which is positive if its corners run counter-clockwise."""
    x, y = (corners - corners[0]).T
    return float(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))
