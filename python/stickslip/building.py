"""Cards of a deck from numbers and names: meshes, materials, contacts, rigid bodies, springs, steps, loads.

Every method appends cards. What cannot be is told as a `Fault`; the program checks the rest (`stickslip.check`).
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Literal, Self

from stickslip.cards import Card
from stickslip.decks import material
from stickslip.errors import Fault
from stickslip.mesh import Mesh

Number = float | str
"""A number, or the parameter of a deck that stands for it, `<mu>`."""

Plane = Literal["strain", "stress", "axisymmetric"]

FORMULATIONS = {
    "": "",
    "reduced": "R",
    "incompatible": "I",
    "hybrid": "H",
    "reduced hybrid": "RH",
}
"""Ends of the types of elements by their words."""

SHAPES = {"": (3, 4, 6, 8), "R": (4, 8), "I": (4,), "H": (4, 8), "RH": (8,)}
"""Numbers of nodes of the elements that exist with an end."""

ROUGH = "rough"
"""Friction of contacts that never slip."""

MATERIAL_CARDS = ("DENSITY", "DAMPING", "PLASTIC")
"""Last cards of materials."""

Discretisation = Literal["", "node to surface", "surface to surface"]


class Building(ABC):
    """What appends cards to a deck."""

    cards: list[Card]

    @abstractmethod
    def add(self, head: str, *rows: Sequence[object]) -> Self:
        """Appends a card: its keyword line without the star, and its data lines."""

    @abstractmethod
    def extend(self, text: str) -> Self:
        """Appends the cards of a text."""

    @abstractmethod
    def find(self, keyword: str) -> list[Card]:
        """All cards with this keyword."""

    # Meshes and sections.

    def add_mesh(self, mesh: Mesh, plane: Plane = "strain", formulation: str = "") -> int:
        """Appends the mesh: nodes, elements, sets, and its sides as surfaces.

        In bodies of revolution x is the radius and y goes along the axis. `formulation` is a word of FORMULATIONS; elements
        of a shape that has no such type get the plain one, triangles for example. The nodes of an element set are a node
        set of the same name. Returns the number of its first node: index i of the mesh has that number plus i. A second
        mesh goes on with the numbers of the first.
        """
        ends = element_types(plane, formulation)
        node, element = self._next_number("NODE"), self._next_number("ELEMENT")
        self.add("NODE", *((node + at, *map(float, place)) for at, place in enumerate(mesh.points)))
        for count, kind in ends.items():
            rows = [(element + at, *(node + nodes)) for at, nodes in enumerate(mesh.elements) if len(nodes) == count]
            if rows:
                self.add(f"ELEMENT, TYPE={kind}", *rows)
        for name, members in mesh.node_sets.items():
            self.add(f"NSET, NSET={name}", *_in_lines(node + members))
        for name, members in mesh.element_sets.items():
            self.add(f"ELSET, ELSET={name}", *_in_lines(element + members))
            if name not in mesh.node_sets:
                self.add(f"NSET, NSET={name}, ELSET={name}")
        for name in mesh.sides:
            faces = [(element + at, f"S{side}") for at, side in mesh.faces(name)]
            self.add(f"SURFACE, NAME={name}", *faces)
        return node

    def _next_number(self, keyword: str) -> int:
        """The first free number of nodes or elements."""
        numbers = (int(row[0]) for card in self.find(keyword) for row in card.rows)
        return max(numbers, default=0) + 1

    def surface(self, name: str, *sets: str) -> Self:
        """A surface of all free sides of element sets."""
        return self.add(f"SURFACE, NAME={name}", *((one,) for one in sets))

    def node(self, name: str, x: float, y: float) -> int:
        """A node of its own, such as the reference node of a rigid body, and a set of its name; returns its number."""
        number = self._next_number("NODE")
        self.add(f"NODE, NSET={name}", (number, float(x), float(y)))
        return number

    def section(self, elements: str, material: str, thickness: float | None = 1.0) -> Self:
        """Gives a set of elements its material and thickness; None in bodies of revolution, which have none."""
        rows = [] if thickness is None else [(thickness,)]
        return self.add(f"SOLID SECTION, ELSET={elements}, MATERIAL={material}", *rows)

    # Materials.

    def elastic(self, name: str, young: float, poisson: float, density: float, **damping: float) -> Self:
        """A St. Venant-Kirchhoff material, for strains below some 20 %; damping as `alpha`, `beta`."""
        return self.extend(material(name, young, poisson, density, "", **damping))

    def hencky(self, name: str, young: float, poisson: float, density: float, **damping: float) -> Self:
        """Hencky's material, for large strains: Kirchhoff stress over logarithmic strain; damping as `alpha`, `beta`."""
        return self.extend(material(name, young, poisson, density, "HENCKY", **damping))

    def plastic(
        self,
        name: str,
        young: float,
        poisson: float,
        yield_stresses: Sequence[tuple[float, float]],
        density: float,
        kinematic: bool = False,
        **damping: float,
    ) -> Self:
        """A metal: pairs of yield stress and plastic strain, the first at 0; `kinematic` hardening has two."""
        if not yield_stresses or yield_stresses[0][1] != 0.0:
            raise Fault(f"{name}: the first yield stress is that of the plastic strain 0")
        head = "PLASTIC, HARDENING=KINEMATIC" if kinematic else "PLASTIC"
        return self.elastic(name, young, poisson, density, **damping).add(head, *yield_stresses)

    def neo_hooke(self, name: str, c10: float, d1: float, density: float) -> Self:
        """A neo-Hookean material, for large strains."""
        return self.hyperelastic(name, "NEO HOOKE", (c10, d1), density)

    def mooney_rivlin(self, name: str, c10: float, c01: float, d1: float, density: float) -> Self:
        """A material of Mooney and Rivlin."""
        return self.hyperelastic(name, "MOONEY-RIVLIN", (c10, c01, d1), density)

    def yeoh(self, name: str, c: Sequence[float], d: Sequence[float], density: float) -> Self:
        """A material of Yeoh: C10, C20, C30 and D1, D2, D3."""
        if len(c) != 3 or len(d) != 3:
            raise Fault(f"{name}: YEOH has three C and three D")
        return self.hyperelastic(name, "YEOH", (*c, *d), density)

    def ogden(self, name: str, terms: Sequence[tuple[float, float]], d: Sequence[float], density: float) -> Self:
        """A material of Ogden: mu and alpha of each of its one to three terms, and as many D."""
        if not 1 <= len(terms) <= 3 or len(d) != len(terms):
            raise Fault(f"{name}: OGDEN has one to three terms and as many D")
        return self.hyperelastic(name, f"OGDEN, N={len(terms)}", (*(x for term in terms for x in term), *d), density)

    def hyperelastic(self, name: str, law: str, constants: Sequence[float], density: float) -> Self:
        """A material for large strains with the constants of its law in their order."""
        rows = [constants[at : at + 8] for at in range(0, len(constants), 8)]
        self.add(f"MATERIAL, NAME={name}").add(f"HYPERELASTIC, {law}", *rows)
        return self.add("DENSITY", (density,))

    def expansion(self, coefficient: Number | Sequence[tuple[float, float]], zero: float = 0.0) -> Self:
        """Thermal expansion of the material before it: a coefficient, or pairs of coefficient and temperature; `zero` is the
        temperature that the coefficient counts from."""
        if not self.cards or self.cards[-1].keyword not in MATERIAL_CARDS:
            raise Fault("expansion stands right behind the material that expands")
        rows = [(coefficient,)] if isinstance(coefficient, (float, int, str)) else coefficient
        return self.add(f"EXPANSION, ZERO={zero!r}", *rows)

    # Contact.

    def contact(self, slave: str, master: str, friction: Number = 0.0, discretisation: Discretisation = "") -> Self:
        """Contact of two surfaces; the friction may be a parameter, `<mu>`, or ROUGH."""
        kind = f", TYPE={discretisation.upper()}" if discretisation else ""
        return self.add(f"CONTACT PAIR, INTERACTION={self._interaction(friction)}{kind}", (slave, master))

    def general_contact(self, friction: Number = 0.0, discretisation: Discretisation = "") -> Self:
        """Contact of everything with everything."""
        name = self._interaction(friction)
        self.add("CONTACT").add("CONTACT INCLUSIONS, ALL EXTERIOR")
        if discretisation:
            self.add(f"CONTACT FORMULATION, TYPE={discretisation.upper()}")
        return self.add("CONTACT PROPERTY ASSIGNMENT", ("", "", name))

    def tie(self, slave: str, master: str) -> Self:
        """Ties two surfaces as if they were parts of one body."""
        return self.add(f"TIE, NAME=TIE{len(self.find('TIE')) + 1}", (slave, master))

    def _interaction(self, friction: Number) -> str:
        """A new interaction; returns its name."""
        name = f"INTERACTION{len(self.find('SURFACE INTERACTION')) + 1}"
        rows = [] if friction == ROUGH else [(friction,)]
        self.add(f"SURFACE INTERACTION, NAME={name}").add("FRICTION" if rows else "FRICTION, ROUGH", *rows)
        return name

    # Rigid bodies, springs, dashpots.

    def rigid_line(self, name: str, points: Iterable[tuple[float, float]], reference: str) -> Self:
        """A rigid surface along points, the obstacle on the left of the way, moved by its reference node (`node`)."""
        first, *others = points
        if not others:
            raise Fault(f"{name}: a line has two points or more")
        rows = [("START", *map(float, first)), *(("LINE", *map(float, point)) for point in others)]
        self.add(f"SURFACE, NAME={name}, TYPE=SEGMENTS", *rows)
        return self.add(f"RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE={reference}")

    def rigid_body(self, elements: str, reference: str) -> Self:
        """Elements that do not deform and have mass, with their reference node (`node`)."""
        return self.add(f"RIGID BODY, ELSET={elements}, REF NODE={reference}")

    def point_mass(self, node: int, mass: float) -> Self:
        """A mass at a node of a rigid body."""
        return self._connect("MASS", "MASS", (node,), mass)

    def hinge(self, first: int, second: int) -> Self:
        """A hinge between nodes at one place: of two rigid bodies, or of bodies that ride on reference nodes."""
        if first == second:
            raise Fault(f"a hinge has two nodes, not node {first} twice")
        return self.add("MPC", ("PIN", first, second))

    def coupling(self, name: str, surface: str, reference: str, distributing: bool = False) -> Self:
        """The nodes of a surface ride on a reference node (`node`) as a rigid body, which turns and takes moments.

        `distributing`: its displacement is the mean of theirs, and forces on it go to them in equal parts.
        """
        head = f"COUPLING, CONSTRAINT NAME={name}, REF NODE={reference}, SURFACE={surface}"
        return self.add(head).add("DISTRIBUTING" if distributing else "KINEMATIC")

    def pre_tension(self, surface: str, node: str, normal: tuple[float, float] | None = None) -> Self:
        """Cuts a body, such as a bolt, along faces between its elements, for its preload.

        In steps direction 1 of the node (`node`) is the overlap of the sides: `load` is the force of the bolt, tension being
        positive, and `support` prescribes the overlap. `normal` is that of the section, if not the mean one of the faces.
        """
        if normal == (0.0, 0.0):
            raise Fault(f"{surface}: the normal of the section has no length")
        rows = [] if normal is None else [(*map(float, normal), 0.0)]
        return self.add(f"PRE-TENSION SECTION, NODE={node}, SURFACE={surface}", *rows)

    def equation(self, *terms: tuple[int | str, int, float]) -> Self:
        """A linear equation a1 u1 + a2 u2 + ... = 0: of each term the node or node set, the direction and the factor.

        The first term follows from the others. Sets give an equation for every node.
        """
        if len(terms) < 2:
            raise Fault("an equation has two terms or more")
        for node, direction, factor in terms:
            if direction not in (1, 2):
                raise Fault(f"node {node}: direction {direction} is not 1 or 2")
            if factor == 0.0:
                raise Fault(f"node {node}: the factor of a term is not 0")
        lines = [terms[at : at + 4] for at in range(0, len(terms), 4)]
        return self.add("EQUATION", (len(terms),), *([x for term in line for x in term] for line in lines))

    def spring(self, first: int, second: int, law: Number | Sequence[tuple[float, float]]) -> Self:
        """A spring between two nodes, by their numbers, along their line.

        `law` is its stiffness, or pairs of force and elongation, which increases; beyond them the force stays.
        """
        return self._connect("SPRINGA", "SPRING", (first, second), law)

    def dashpot(self, first: int, second: int, law: Number | Sequence[tuple[float, float]]) -> Self:
        """A dashpot between two nodes, by their numbers, along their line.

        `law` is its coefficient, or pairs of force and rate of the elongation, which increases.
        """
        return self._connect("DASHPOTA", "DASHPOT", (first, second), law)

    def _connect(
        self, kind: str, keyword: str, nodes: tuple[int, ...], law: Number | Sequence[tuple[float, float]]
    ) -> Self:
        """An element of its own set between nodes, with its constant or its table."""
        number = self._next_number("ELEMENT")
        name = f"{keyword}{number}"
        head = f"{keyword}, ELSET={name}"
        if isinstance(law, (int, float, str)):
            rows: Sequence[Sequence[object]] = [(law,)]
        else:
            head, rows = f"{head}, NONLINEAR", _table(name, law)
        self.add(f"ELEMENT, TYPE={kind}, ELSET={name}", (number, *nodes))
        return self.add(head, *rows)

    # Steps, supports, loads, output.

    def amplitude(self, name: str, points: Iterable[tuple[float, float]]) -> Self:
        """A course over the time of the step: pairs of time and factor."""
        return self.add(f"AMPLITUDE, NAME={name}", *points)

    @contextmanager
    def step(self, dt: Number, duration: Number, automatic: bool = False, **settings: object) -> Iterator[Self]:
        """A dynamic step of equal increments, or of such that follow their error; what is added within belongs to it.

        `settings` are those of *STICKSLIP: `scheme="SS22"`, `impact_time="EVENT"`.
        """
        with self._step("DYNAMIC", dt, duration, automatic, settings):
            yield self

    @contextmanager
    def static_step(
        self, dt: Number = 1.0, duration: Number = 1.0, automatic: bool = True, **settings: object
    ) -> Iterator[Self]:
        """A static step whose increments follow their passes, or of equal increments; what is added within belongs to it."""
        with self._step("STATIC", dt, duration, automatic, settings):
            yield self

    @contextmanager
    def _step(
        self, procedure: str, dt: Number, duration: Number, automatic: bool, settings: Mapping[str, object]
    ) -> Iterator[None]:
        """A step of a procedure."""
        self.add("STEP, NLGEOM")
        if settings:
            text = "".join(f", {key.replace('_', ' ')}={value}" for key, value in settings.items())
            self.add("STICKSLIP" + text.upper())
        self.add(procedure if automatic else f"{procedure}, DIRECT", (dt, duration))
        yield
        self.add("END STEP")

    def velocity(self, nodes: str, x: float, y: float) -> Self:
        """Initial velocity of a node set; one of `add_mesh` may be that of an element set."""
        return self.add("INITIAL CONDITIONS, TYPE=VELOCITY", (nodes, 1, x), (nodes, 2, y))

    def initial_temperature(self, nodes: str, value: Number) -> Self:
        """Temperature of a node set at the start, at which it is free of stress; without any it is 0."""
        return self.add("INITIAL CONDITIONS, TYPE=TEMPERATURE", (nodes, value))

    def temperature(self, nodes: str, value: Number, amplitude: str = "") -> Self:
        """Temperature of a node set, in a step."""
        return self.add(_with_amplitude("TEMPERATURE", amplitude), (nodes, value))

    def support(self, nodes: str, *directions: int, value: Number = 0.0, amplitude: str = "") -> Self:
        """Holds a node set in directions (1, 2; both when none is given; 6 turns a rigid body) or, in a step, moves it."""
        rows = [(nodes, one, one, value) for one in directions or (1, 2)]
        return self.add(_with_amplitude("BOUNDARY", amplitude), *rows)

    def load(self, nodes: str, x: Number = 0.0, y: Number = 0.0, amplitude: str = "") -> Self:
        """A force on each node of a set, in a step."""
        rows = ((nodes, i, f) for i, f in ((1, x), (2, y)) if f != 0.0)
        return self.add(_with_amplitude("CLOAD", amplitude), *rows)

    def gravity(self, elements: str, size: Number, x: float = 0.0, y: float = -1.0) -> Self:
        """An acceleration on an element set, in a step; (x, y) is its direction."""
        return self.add("DLOAD", (elements, "GRAV", size, x, y))

    def pressure(self, surface: str, size: Number, amplitude: str = "") -> Self:
        """A pressure on a surface, in a step; positive presses on the body."""
        return self.add(_with_amplitude("DSLOAD", amplitude), (surface, "P", size))

    def history(self, nodes: str) -> Self:
        """Asks for the history of a node set, in a step."""
        return self.add(f"NODE PRINT, NSET={nodes}", ("U", "V", "RF"))


def element_types(plane: Plane, formulation: str = "") -> dict[int, str]:
    """Types of elements by their numbers of nodes; a Fault where a formulation does not exist in the plane."""
    starts = {"strain": "CPE", "stress": "CPS", "axisymmetric": "CAX"}
    if plane not in starts:
        raise Fault(f"{plane} is no plane: choose from {', '.join(starts)}")
    if formulation not in FORMULATIONS:
        raise Fault(f"{formulation} is no formulation: choose from {', '.join(filter(None, FORMULATIONS))}")
    end = FORMULATIONS[formulation]
    if plane == "stress" and "H" in end:
        raise Fault("in plane stress no element is hybrid: the thickness takes up the volume")
    return {count: f"{starts[plane]}{count}{end if count in SHAPES[end] else ''}" for count in SHAPES[""]}


def _with_amplitude(head: str, amplitude: str) -> str:
    return f"{head}, AMPLITUDE={amplitude}" if amplitude else head


def _table(name: str, law: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """The rows of a table whose second column increases."""
    rows = [(float(force), float(along)) for force, along in law]
    if len(rows) < 2 or any(a >= b for (_, a), (_, b) in zip(rows, rows[1:])):
        raise Fault(f"the table of {name} has two rows or more, and its second column increases")
    return rows


def _in_lines(numbers: Iterable[int]) -> list[list[int]]:
    """Numbers as data lines of eight."""
    flat = [int(number) for number in numbers]
    return [flat[at : at + 8] for at in range(0, len(flat), 8)]
