"""Structured meshes of four-node quadrilaterals, written as deck cards."""

from collections.abc import Callable, Sequence


def card(keyword: str, *rows: Sequence[object]) -> str:
    """Text of one card: its keyword line and data lines; floats are written with repr."""
    lines = ["*" + keyword]
    lines += [", ".join(repr(x) if isinstance(x, float) else str(x) for x in row) for row in rows]
    return "\n".join(lines) + "\n"


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
        """`place(i, j)` gives the coordinates of a node, turning counter-clockwise with (i, j)."""
        self.name, self.nx, self.ny, self.place = name, nx, ny, place
        self.first_node, self.first_element = first_node, first_element

    @property
    def next_node(self) -> int:
        """First label behind those of the nodes."""
        return self.first_node + (self.nx + 1) * (self.ny + 1)

    @property
    def next_element(self) -> int:
        """First label behind those of the elements."""
        return self.first_element + self.nx * self.ny

    def node(self, i: int, j: int) -> int:
        """Label of a node."""
        return self.first_node + i + j * (self.nx + 1)

    def element(self, i: int, j: int) -> int:
        """Label of an element."""
        return self.first_element + i + j * self.nx

    def mesh(self, element_type: str) -> str:
        """Cards NODE and ELEMENT; both sets bear the name of the grid."""
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
