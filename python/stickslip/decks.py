"""Text for decks that are written by programs: cards, and grids of four-node quadrilaterals.

`deck.Deck` reads and changes whole decks, and appends cards with the same `card`.
"""

import argparse
from collections.abc import Callable, Sequence
from math import cos, pi, sin, sqrt
from pathlib import Path


def card(keyword: str, *rows: Sequence[object]) -> str:
    """Text of a card with its keyword line and data lines; floats are written with repr."""
    lines = ["*" + keyword]
    lines += [
        ", ".join(repr(float(x)) if isinstance(x, float) else str(x) for x in row) for row in rows
    ]
    return "\n".join(lines) + "\n"


def material(
    name: str, young: float, poisson: float, density: float, law: str = "", **damping: float
) -> str:
    """Text of a material with `*ELASTIC`, whose `TYPE` is the law; zero damping parameters are left out."""
    kind = f", TYPE={law}" if law else ""
    parameters = "".join(f", {key.upper()}={value!r}" for key, value in damping.items() if value)
    return "".join(
        [
            card(f"MATERIAL, NAME={name}"),
            card(f"ELASTIC{kind}", (young, poisson)),
            card("DENSITY", (density,)),
            card(f"DAMPING{parameters}") if parameters else "",
        ]
    )


def elastic(
    young: float,
    poisson: float,
    density: float,
    *sets: str,
    thickness: float = 1.0,
    **damping: float,
) -> str:
    """Text of a material, and of the sections of element sets made of this material."""
    return "".join(
        [
            material("ELASTIC", young, poisson, density, "", **damping),
            *(
                card(f"SOLID SECTION, ELSET={name}, MATERIAL=ELASTIC", (thickness,))
                for name in sets
            ),
        ]
    )


def dry(friction: float) -> str:
    """Text of the interaction DRY with a coefficient of friction."""
    return card("SURFACE INTERACTION, NAME=DRY") + card("FRICTION", (friction,))


def step(dt: float, increments: int, *cards: str) -> str:
    """Text of a step of equal increments with the cards of the step."""
    head = card(f"STEP, NLGEOM, INC={increments}")
    return "".join([head, card("DYNAMIC, DIRECT", (dt, increments * dt)), *cards, card("END STEP")])


class Grid:
    """nx x ny elements with (nx+1)(ny+1) nodes; i counts along the bottom, j upwards.

    ::

          S3 (top)
        +---+---+   ny      node (i, j) has the label first_node + i + j (nx+1),
     S4 |   |   | S2        element (i, j) the label first_element + i + j nx
        +---+---+
          S1 (bottom) nx
    """

    FACES = {"bottom": "S1", "right": "S2", "top": "S3", "left": "S4"}

    def __init__(
        self,
        name: str,
        nx: int,
        ny: int,
        place: Callable[[int, int], tuple[float, float]],
        first_node: int = 1,
        first_element: int = 1,
    ) -> None:
        """`place(i, j)` gives the coordinates of a node; (i, j) must be a right-handed system."""
        self.name, self.nx, self.ny, self.place = name, nx, ny, place
        self.first_node, self.first_element = first_node, first_element

    @property
    def next_node(self) -> int:
        """First free label behind the labels of the nodes."""
        return self.first_node + (self.nx + 1) * (self.ny + 1)

    @property
    def next_element(self) -> int:
        """First free label behind the labels of the elements."""
        return self.first_element + self.nx * self.ny

    def node(self, i: int, j: int) -> int:
        """Label of a node."""
        return self.first_node + i + j * (self.nx + 1)

    def element(self, i: int, j: int) -> int:
        """Label of an element."""
        return self.first_element + i + j * self.nx

    def mesh(self, element_type: str) -> str:
        """Cards NODE and ELEMENT; the node set and the element set have the name of the grid."""
        nodes = [
            (self.node(i, j), *self.place(i, j))
            for j in range(self.ny + 1)
            for i in range(self.nx + 1)
        ]
        elements = [
            (
                self.element(i, j),
                self.node(i, j),
                self.node(i + 1, j),
                self.node(i + 1, j + 1),
                self.node(i, j + 1),
            )
            for j in range(self.ny)
            for i in range(self.nx)
        ]
        return card(f"NODE, NSET={self.name}", *nodes) + card(
            f"ELEMENT, TYPE={element_type}, ELSET={self.name}", *elements
        )

    def side_nodes(self, name: str, side: str) -> str:
        """Card NSET with the nodes of a side."""
        first, last, step = {
            "bottom": (self.node(0, 0), self.node(self.nx, 0), 1),
            "right": (self.node(self.nx, 0), self.node(self.nx, self.ny), self.nx + 1),
            "top": (self.node(0, self.ny), self.node(self.nx, self.ny), 1),
            "left": (self.node(0, 0), self.node(0, self.ny), self.nx + 1),
        }[side]
        return card(f"NSET, NSET={name}, GENERATE", (first, last, step))

    def side_surface(self, name: str, side: str) -> str:
        """Cards ELSET and SURFACE with the outer faces of a side."""
        right, top = self.nx - 1, self.ny - 1
        first, last, step = {
            "bottom": (self.element(0, 0), self.element(right, 0), 1),
            "right": (self.element(right, 0), self.element(right, top), self.nx),
            "top": (self.element(0, top), self.element(right, top), 1),
            "left": (self.element(0, 0), self.element(0, top), self.nx),
        }[side]
        return card(f"ELSET, ELSET={name}, GENERATE", (first, last, step)) + card(
            f"SURFACE, NAME={name}", (name, self.FACES[side])
        )


class GridMesh:
    """Any quadrilaterals, with nodes and elements by their indices; labels are consecutive.

    This class writes its cards itself, with labels from a first node and element on; `mesh.Mesh` is for decks that are
    made of arrays.
    """

    def __init__(
        self,
        name: str,
        nodes: Sequence[tuple[float, float]],
        elements: Sequence[tuple[int, int, int, int]],
        first_node: int = 1,
        first_element: int = 1,
    ) -> None:
        self.name, self.nodes, self.elements = name, nodes, elements
        self.first_node, self.first_element = first_node, first_element

    @property
    def next_node(self) -> int:
        """First free label behind the labels of the nodes."""
        return self.first_node + len(self.nodes)

    @property
    def next_element(self) -> int:
        """First free label behind the labels of the elements."""
        return self.first_element + len(self.elements)

    def mesh(self, element_type: str) -> str:
        """Cards NODE and ELEMENT; the node set and the element set have the name of the mesh."""
        nodes = [(self.first_node + k, *place) for k, place in enumerate(self.nodes)]
        elements = [
            (self.first_element + k, *(self.first_node + node for node in corners))
            for k, corners in enumerate(self.elements)
        ]
        return card(f"NODE, NSET={self.name}", *nodes) + card(
            f"ELEMENT, TYPE={element_type}, ELSET={self.name}", *elements
        )


def outline(*names: str) -> str:
    """Cards SURFACE with all free sides of element sets; surfaces have the names of the sets."""
    return "".join(card(f"SURFACE, NAME={name}", (name,)) for name in names)


def facing_blocks(elements: int, left: float) -> tuple[Grid, Grid]:
    """Two blocks of 1 x 0.5 with `elements` elements along each: UPPER lies 1e-4 above LOWER, shifted to the right by
    `left`."""
    size = 1.0 / elements
    count = elements, elements // 2
    upper = Grid("UPPER", *count, lambda i, j: (left + i * size, 0.5001 + j * size))
    labels = upper.next_node, upper.next_element
    return upper, Grid("LOWER", *count, lambda i, j: (i * size, j * size), *labels)


def ring(
    name: str,
    centre: tuple[float, float],
    radii: tuple[float, float],
    around: int,
    across: int,
    first_node: int = 1,
    first_element: int = 1,
) -> GridMesh:
    """A ring between two radii; node (k, j) is the k-th node around the ring and the j-th from the inside."""
    nodes = []
    for j in range(across + 1):
        radius = radii[0] + (radii[1] - radii[0]) * j / across
        for k in range(around):
            angle = 2 * pi * k / around
            nodes.append((centre[0] + radius * cos(angle), centre[1] + radius * sin(angle)))
    elements = [
        (
            j * around + k,
            (j + 1) * around + k,
            (j + 1) * around + (k + 1) % around,
            j * around + (k + 1) % around,
        )
        for j in range(across)
        for k in range(around)
    ]
    return GridMesh(name, nodes, elements, first_node, first_element)


def disc(
    name: str,
    centre: tuple[float, float],
    radius: float,
    turn: float,
    side: int,
    rings: int,
    first_node: int = 1,
    first_element: int = 1,
) -> GridMesh:
    """A disc, turned by an angle: a bulging square of side x side elements, with rings around the square.

    The rim of the disc has 4 `side` nodes.
    """
    core = 0.55 * radius
    flat = [(2 * i / side - 1, 2 * j / side - 1) for j in range(side + 1) for i in range(side + 1)]
    nodes = []
    for u, v in flat:
        bulge = 0.5 + 0.5 * sqrt(1 - 0.5 * v * v), 0.5 + 0.5 * sqrt(1 - 0.5 * u * u)
        nodes.append((core * u * bulge[0], core * v * bulge[1]))
    row = side + 1
    rim = [*range(side), *range(side, side * row + side, row)]
    rim += [*range(side * row + side, side * row, -1), *range(side * row, 0, -row)]
    elements = [
        (j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i)
        for j in range(side)
        for i in range(side)
    ]
    inner = rim
    for level in range(1, rings + 1):
        outer = [len(nodes) + k for k in range(len(rim))]
        for k, node in enumerate(rim):
            angle = 2 * pi * k / len(rim) - 0.75 * pi
            start, end = nodes[node], (radius * cos(angle), radius * sin(angle))
            part = level / rings
            nodes.append(tuple(a + (b - a) * part for a, b in zip(start, end)))
        after = {k: (k + 1) % len(rim) for k in range(len(rim))}
        elements += [(inner[k], outer[k], outer[n], inner[n]) for k, n in after.items()]
        inner = outer
    turned = [
        (centre[0] + x * cos(turn) - y * sin(turn), centre[1] + x * sin(turn) + y * cos(turn))
        for x, y in nodes
    ]
    return GridMesh(name, turned, elements, first_node, first_element)


def write_to_folder(about: str | None, folder: Path, write: Callable[[Path], None]) -> None:
    """Command line of a script that writes decks, into `folder` or the folder of the option `-o`."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("-o", "--output", type=Path, default=folder, help="folder of the decks")
    write(parser.parse_args().output)
