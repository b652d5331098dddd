"""Meshes of one block for the cases: triangles or quadrilaterals, linear or quadratic, of any shape."""

import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from stickslip.decks import card  # noqa: E402

Place = Callable[[int, int], tuple[float, float]]

SIDES = ("bottom", "right", "top", "left")


class Block:
    """nx x ny cells of a lattice that is twice as fine: linear elements take every other point.

    ::

          top
        +--o--+--o--+   2 ny       cell (k, l): corners at (2 k, 2 l), (2 k + 2, 2 l), ...
        o     o     o              triangles: each cell cut from its first corner to its third
        +--o--+--o--+   0
        0    bottom  2 nx
    """

    def __init__(self, name: str, kind: str, nx: int, ny: int, place: Place, after: "Block | None" = None) -> None:
        """`kind` is the type of the elements, `place(i, j)` gives the coordinates of a point of the lattice."""
        self.name, self.kind, self.nx, self.ny, self.place = name, kind, nx, ny, place
        self.first_node = after.next_node if after else 1
        self.first_element = after.next_element if after else 1
        nodes = int(kind.rstrip("RIH")[-1])
        self.cut, self.quadratic = nodes in (3, 6), nodes in (6, 8)

    @property
    def next_node(self) -> int:
        """First label behind those of the nodes."""
        return self.first_node + (2 * self.nx + 1) * (2 * self.ny + 1)

    @property
    def next_element(self) -> int:
        """First label behind those of the elements."""
        return self.first_element + (1 + self.cut) * self.nx * self.ny

    def node(self, i: int, j: int) -> int:
        """Label of a point of the lattice."""
        return self.first_node + i + j * (2 * self.nx + 1)

    def _elements(self) -> Iterable[list[int]]:
        for row in range(self.ny):
            for column in range(self.nx):
                a = (2 * column, 2 * row)
                b, c, d = (a[0] + 2, a[1]), (a[0] + 2, a[1] + 2), (a[0], a[1] + 2)
                for corners in ([a, b, c], [a, c, d]) if self.cut else ([a, b, c, d],):
                    around = zip(corners, corners[1:] + corners[:1])
                    middles = [((p[0] + q[0]) // 2, (p[1] + q[1]) // 2) for p, q in around]
                    yield [self.node(*point) for point in corners + (middles if self.quadratic else [])]

    def cards(self) -> str:
        """Cards NODE and ELEMENT; both sets bear the name of the block."""
        elements = list(self._elements())
        used = {node for element in elements for node in element}
        lattice = [(i, j) for j in range(2 * self.ny + 1) for i in range(2 * self.nx + 1)]
        nodes = [(self.node(i, j), *map(float, self.place(i, j))) for i, j in lattice if self.node(i, j) in used]
        return card(f"NODE, NSET={self.name}", *nodes) + card(
            f"ELEMENT, TYPE={self.kind}, ELSET={self.name}",
            *((self.first_element + k, *element) for k, element in enumerate(elements)),
        )

    def on(self, side: str) -> list[int]:
        """Labels of the nodes of a side."""
        step = 1 if self.quadratic else 2
        along = range(0, 2 * (self.nx if side in ("bottom", "top") else self.ny) + 1, step)
        fixed = {"bottom": 0, "top": 2 * self.ny, "left": 0, "right": 2 * self.nx}[side]
        return [self.node(k, fixed) if side in ("bottom", "top") else self.node(fixed, k) for k in along]

    def nset(self, name: str, side: str) -> str:
        """Card NSET with the nodes of a side."""
        return card(f"NSET, NSET={name}", *((node,) for node in self.on(side)))

    def surface(self, name: str, side: str) -> str:
        """Cards ELSET and SURFACE with the outer faces of a side."""
        per = 1 + self.cut
        column = range(self.nx) if side in ("bottom", "top") else [0 if side == "left" else self.nx - 1]
        row = range(self.ny) if side in ("left", "right") else [0 if side == "bottom" else self.ny - 1]
        late = self.cut and side in ("top", "left")
        labels = [self.first_element + per * (k + r * self.nx) + late for r in row for k in column]
        faces = dict(zip(SIDES, ("S1", "S2", "S2", "S3") if self.cut else ("S1", "S2", "S3", "S4")))
        return card(f"ELSET, ELSET={name}", *((label,) for label in labels)) + card(
            f"SURFACE, NAME={name}", (name, faces[side])
        )


def rectangle(
    name: str, kind: str, cells: tuple[int, int], size: tuple[float, float], corner: tuple[float, float] = (0.0, 0.0),
    after: Block | None = None,
) -> Block:
    """A rectangle of so many cells, its lower left corner at `corner`."""
    (nx, ny), (width, height), (x, y) = cells, size, corner
    return Block(name, kind, nx, ny, lambda i, j: (x + width * i / (2 * nx), y + height * j / (2 * ny)), after)


def graded(size: float, even: float, end: float, growth: float = 1.35) -> list[float]:
    """Places from 0 to `end`: of equal distance up to `even`, then farther and farther apart."""
    places = [k * size for k in range(round(even / size) + 1)]
    steps, reach = [], 0.0
    while reach < end - places[-1]:
        steps.append(size * growth ** (len(steps) + 1))
        reach += steps[-1]
    stretch = (end - places[-1]) / reach if reach else 1.0
    for step in steps:
        places.append(places[-1] + step * stretch)
    return places


def mapped(
    name: str, kind: str, xs: Sequence[float], ys: Sequence[float],
    shape: Callable[[float, float], tuple[float, float]] = lambda x, y: (x, y), after: Block | None = None,
) -> Block:
    """Cells between the lines x and y, mapped by `shape`, which the nodes between corners follow too."""

    def between(lines: Sequence[float], k: int) -> float:
        return lines[k // 2] if k % 2 == 0 else (lines[k // 2] + lines[k // 2 + 1]) / 2

    return Block(name, kind, len(xs) - 1, len(ys) - 1, lambda i, j: shape(between(xs, i), between(ys, j)), after)


def plane(name: str, start: tuple[float, float], end: tuple[float, float], reference: str = "REFERENCE") -> str:
    """A rigid line with the obstacle on the right of the way from start to end, and its reference node."""
    return "".join(
        [
            card(f"NODE, NSET={reference}", (100_000, *start)),
            card(f"SURFACE, NAME={name}, TYPE=SEGMENTS", ("START", *start), ("LINE", *end)),
            card(f"RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE={reference}"),
        ]
    )


def ride(block: Block, side: str, head: str, *directions: int) -> str:
    """The nodes of a side move in these directions as the first of them does, which is the set `head`."""
    first, *others = block.on(side)
    return "".join(
        [
            card(f"NSET, NSET={head}", (first,)),
            card(f"NSET, NSET={head}_OTHERS", *((node,) for node in others)),
            *(
                card("EQUATION", (2,), (f"{head}_OTHERS", direction, 1.0, head, direction, -1.0))
                for direction in directions
            ),
        ]
    )


def follower(surface: str, pressure: float) -> str:
    """A pressure, which follows the surface."""
    return card("DSLOAD", (surface, "P", pressure))


def write_deck(folder: Path, name: str, cards: Iterable[str]) -> None:
    """Writes a deck into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text("".join(cards))


def static(*cards: str, dt: float = 1.0, direct: bool = False) -> str:
    """A static step of the duration 1."""
    keyword = "STATIC, DIRECT" if direct else "STATIC"
    return "".join([card("STEP, NLGEOM"), card(keyword, (dt, 1.0)), *cards, card("END STEP")])


def dead(surface: str, traction: float, x: float, y: float) -> str:
    """A traction that keeps its direction."""
    return card("DSLOAD, FOLLOWER=NO", (surface, "TRVEC", traction, x, y))


def prints(*sets: str) -> str:
    """Histories of node sets."""
    return "".join(card(f"NODE PRINT, NSET={name}", ("U, V, RF",)) for name in sets)
