"""Cards of a deck from numbers and names: meshes, materials, contacts, rigid bodies, springs, steps, loads.

Every method appends cards. Impossible arguments raise a `Fault`; everything else is checked by the program
(`stickslip.check`).
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
    """Base class of objects that append cards to a deck."""

    cards: list[Card]

    @abstractmethod
    def add(self, head: str, *rows: Sequence[object]) -> Self:
        """Appends a card, given by its keyword line without the star and its data lines."""

    @abstractmethod
    def extend(self, text: str) -> Self:
        """Appends the cards of a text."""

    @abstractmethod
    def find(self, keyword: str) -> list[Card]:
        """All cards with a given keyword."""

    # Meshes and sections.

    def add_mesh(self, mesh: Mesh, plane: Plane = "strain", formulation: str = "") -> int:
        """Appends the mesh: nodes, elements, sets, and its sides as surfaces.

        In bodies of revolution x is the radius and y goes along the axis. `formulation` is a word of FORMULATIONS;
        elements of a shape without such a type, for example triangles, get their type without a formulation. The nodes
        of an element set become a node set of the same name. Returns the number of its first node; the node with index
        i of the mesh has this number plus i. A second mesh continues the numbers of the first mesh.
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
        """Appends a surface of all free sides of element sets."""
        return self.add(f"SURFACE, NAME={name}", *((one,) for one in sets))

    def node(self, name: str, x: float, y: float) -> int:
        """Appends a single node, such as the reference node of a rigid body, and a node set with its name; returns its
        number."""
        number = self._next_number("NODE")
        self.add(f"NODE, NSET={name}", (number, float(x), float(y)))
        return number

    def section(self, elements: str, material: str, thickness: float | None = 1.0) -> Self:
        """Gives a set of elements its material and thickness (None in bodies of revolution, which have no
        thickness)."""
        rows = [] if thickness is None else [(thickness,)]
        return self.add(f"SOLID SECTION, ELSET={elements}, MATERIAL={material}", *rows)

    # Materials.

    def elastic(self, name: str, young: float, poisson: float, density: float, **damping: float) -> Self:
        """Appends a St. Venant-Kirchhoff material, for strains below about 20 %, with the damping `alpha` and
        `beta`."""
        return self.extend(material(name, young, poisson, density, "", **damping))

    def hencky(self, name: str, young: float, poisson: float, density: float, **damping: float) -> Self:
        """Appends Hencky's material, for large strains: Kirchhoff stress proportional to logarithmic strain; the
        damping has the factors `alpha` and `beta`."""
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
        """Appends a metal with pairs of yield stress and plastic strain, the first pair at plastic strain 0; with
        `kinematic` hardening there are two pairs."""
        if not yield_stresses or yield_stresses[0][1] != 0.0:
            raise Fault(f"{name}: the first yield stress is that of the plastic strain 0")
        head = "PLASTIC, HARDENING=KINEMATIC" if kinematic else "PLASTIC"
        return self.elastic(name, young, poisson, density, **damping).add(head, *yield_stresses)

    def neo_hooke(self, name: str, c10: float, d1: float, density: float) -> Self:
        """Appends a neo-Hookean material, for large strains."""
        return self.hyperelastic(name, "NEO HOOKE", (c10, d1), density)

    def mooney_rivlin(self, name: str, c10: float, c01: float, d1: float, density: float) -> Self:
        """Appends a Mooney-Rivlin material."""
        return self.hyperelastic(name, "MOONEY-RIVLIN", (c10, c01, d1), density)

    def yeoh(self, name: str, c: Sequence[float], d: Sequence[float], density: float) -> Self:
        """Appends a Yeoh material with C10, C20, C30 and D1, D2, D3."""
        if len(c) != 3 or len(d) != 3:
            raise Fault(f"{name}: YEOH has three C and three D")
        return self.hyperelastic(name, "YEOH", (*c, *d), density)

    def ogden(self, name: str, terms: Sequence[tuple[float, float]], d: Sequence[float], density: float) -> Self:
        """Appends an Ogden material with mu and alpha of each of its one to three terms, and as many D."""
        if not 1 <= len(terms) <= 3 or len(d) != len(terms):
            raise Fault(f"{name}: OGDEN has one to three terms and as many D")
        return self.hyperelastic(name, f"OGDEN, N={len(terms)}", (*(x for term in terms for x in term), *d), density)

    def hyperelastic(self, name: str, law: str, constants: Sequence[float], density: float) -> Self:
        """Appends a material for large strains with the constants of its law in their order."""
        rows = [constants[at : at + 8] for at in range(0, len(constants), 8)]
        self.add(f"MATERIAL, NAME={name}").add(f"HYPERELASTIC, {law}", *rows)
        return self.add("DENSITY", (density,))

    def expansion(self, coefficient: Number | Sequence[tuple[float, float]], zero: float = 0.0) -> Self:
        """Appends the thermal expansion of the last material: a coefficient, or pairs of coefficient and temperature;
        `zero` is the reference temperature of the coefficient."""
        if not self.cards or self.cards[-1].keyword not in MATERIAL_CARDS:
            raise Fault("expansion stands right behind the material that expands")
        rows = [(coefficient,)] if isinstance(coefficient, (float, int, str)) else coefficient
        return self.add(f"EXPANSION, ZERO={zero!r}", *rows)

    # Contact.

    def contact(self, slave: str, master: str, friction: Number = 0.0, discretisation: Discretisation = "") -> Self:
        """Appends contact of two surfaces; the friction may be a number, a parameter `<mu>`, or ROUGH."""
        kind = f", TYPE={discretisation.upper()}" if discretisation else ""
        return self.add(f"CONTACT PAIR, INTERACTION={self._interaction(friction)}{kind}", (slave, master))

    def general_contact(self, friction: Number = 0.0, discretisation: Discretisation = "") -> Self:
        """Appends general contact: every exterior face may touch every other exterior face."""
        name = self._interaction(friction)
        self.add("CONTACT").add("CONTACT INCLUSIONS, ALL EXTERIOR")
        if discretisation:
            self.add(f"CONTACT FORMULATION, TYPE={discretisation.upper()}")
        return self.add("CONTACT PROPERTY ASSIGNMENT", ("", "", name))

    def tie(self, slave: str, master: str) -> Self:
        """Appends a tie, which joins two surfaces as if these were parts of one body."""
        return self.add(f"TIE, NAME=TIE{len(self.find('TIE')) + 1}", (slave, master))

    def _interaction(self, friction: Number) -> str:
        """Appends a new interaction; returns its name."""
        name = f"INTERACTION{len(self.find('SURFACE INTERACTION')) + 1}"
        rows = [] if friction == ROUGH else [(friction,)]
        self.add(f"SURFACE INTERACTION, NAME={name}").add("FRICTION" if rows else "FRICTION, ROUGH", *rows)
        return name

    # Rigid bodies, springs, dashpots.

    def rigid_line(self, name: str, points: Iterable[tuple[float, float]], reference: str) -> Self:
        """Appends a rigid surface along points, with the obstacle on its left, which moves with its reference node (see
        `node`)."""
        first, *others = points
        if not others:
            raise Fault(f"{name}: a line has two points or more")
        rows = [("START", *map(float, first)), *(("LINE", *map(float, point)) for point in others)]
        self.add(f"SURFACE, NAME={name}, TYPE=SEGMENTS", *rows)
        return self.add(f"RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE={reference}")

    def rigid_body(self, elements: str, reference: str) -> Self:
        """Appends a rigid body of elements, which have mass, with its reference node (see `node`)."""
        return self.add(f"RIGID BODY, ELSET={elements}, REF NODE={reference}")

    def point_mass(self, node: int, mass: float) -> Self:
        """Appends a mass at a node of a rigid body."""
        return self._connect("MASS", "MASS", (node,), mass)

    def hinge(self, first: int, second: int) -> Self:
        """Appends a hinge between two nodes at one place, of two rigid bodies or of nodes that move with reference
        nodes."""
        if first == second:
            raise Fault(f"a hinge has two nodes, not node {first} twice")
        return self.add("MPC", ("PIN", first, second))

    def coupling(self, name: str, surface: str, reference: str, distributing: bool = False) -> Self:
        """Couples the nodes of a surface to a reference node (see `node`): they move with the reference node as a rigid
        body, which turns and can carry moments.

        With `distributing`, the displacement of the reference node is the mean displacement of the surface nodes, and
        forces on the reference node are distributed to these nodes in equal parts.
        """
        head = f"COUPLING, CONSTRAINT NAME={name}, REF NODE={reference}, SURFACE={surface}"
        return self.add(head).add("DISTRIBUTING" if distributing else "KINEMATIC")

    def pre_tension(self, surface: str, node: str, normal: tuple[float, float] | None = None) -> Self:
        """Cuts a body, such as a bolt, along faces between its elements, for its preload.

        In steps, direction 1 of the node (see `node`) is the overlap of the two sides of the cut. There `load` gives
        the force of the bolt (tension is positive), and `support` prescribes the overlap. `normal` is the normal of the
        section; the default is the mean normal of the faces.
        """
        if normal == (0.0, 0.0):
            raise Fault(f"{surface}: the normal of the section has no length")
        rows = [] if normal is None else [(*map(float, normal), 0.0)]
        return self.add(f"PRE-TENSION SECTION, NODE={node}, SURFACE={surface}", *rows)

    def equation(self, *terms: tuple[int | str, int, float]) -> Self:
        """Appends a linear equation: a sum of terms is zero. Each term is given by its node or node set, direction and
        factor.

        The displacement of the first term follows from the displacements of the other terms. Node sets give an equation
        for every node.
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
        """Appends a spring between two nodes, given by their numbers, along the line between these nodes.

        `law` is the stiffness of the spring, or pairs of force and elongation with increasing elongation; beyond the
        pairs the force is constant.
        """
        return self._connect("SPRINGA", "SPRING", (first, second), law)

    def dashpot(self, first: int, second: int, law: Number | Sequence[tuple[float, float]]) -> Self:
        """Appends a dashpot between two nodes, given by their numbers, along the line between these nodes.

        `law` is the coefficient of the dashpot, or pairs of force and rate of elongation with increasing rate.
        """
        return self._connect("DASHPOTA", "DASHPOT", (first, second), law)

    def _connect(
        self, kind: str, keyword: str, nodes: tuple[int, ...], law: Number | Sequence[tuple[float, float]]
    ) -> Self:
        """Appends an element between nodes, in a set of its own, with its constant or its table."""
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
        """Appends an amplitude over the time of a step: pairs of time and factor."""
        return self.add(f"AMPLITUDE, NAME={name}", *points)

    @contextmanager
    def step(self, dt: Number, duration: Number, automatic: bool = False, **settings: object) -> Iterator[Self]:
        """Begins a dynamic step of equal increments, or of automatic increments that follow their truncation error;
        cards that are added inside the `with` block belong to the step.

        `settings` are parameters of *STICKSLIP: `scheme="SS22"`, `impact_time="EVENT"`.
        """
        with self._step("DYNAMIC", dt, duration, automatic, settings):
            yield self

    @contextmanager
    def static_step(
        self, dt: Number = 1.0, duration: Number = 1.0, automatic: bool = True, **settings: object
    ) -> Iterator[Self]:
        """Begins a static step whose increments follow their number of passes, or a static step of equal increments;
        cards that are added inside the `with` block belong to the step."""
        with self._step("STATIC", dt, duration, automatic, settings):
            yield self

    @contextmanager
    def _step(
        self, procedure: str, dt: Number, duration: Number, automatic: bool, settings: Mapping[str, object]
    ) -> Iterator[None]:
        """Begins a step of a procedure."""
        self.add("STEP, NLGEOM")
        if settings:
            text = "".join(f", {key.replace('_', ' ')}={value}" for key, value in settings.items())
            self.add("STICKSLIP" + text.upper())
        self.add(procedure if automatic else f"{procedure}, DIRECT", (dt, duration))
        yield
        self.add("END STEP")

    def velocity(self, nodes: str, x: float, y: float) -> Self:
        """Appends the initial velocity of a node set, which `add_mesh` also makes of each element set."""
        return self.add("INITIAL CONDITIONS, TYPE=VELOCITY", (nodes, 1, x), (nodes, 2, y))

    def initial_temperature(self, nodes: str, value: Number) -> Self:
        """Appends the initial temperature of a node set, at which the nodes are free of thermal stress; the default is
        0."""
        return self.add("INITIAL CONDITIONS, TYPE=TEMPERATURE", (nodes, value))

    def temperature(self, nodes: str, value: Number, amplitude: str = "") -> Self:
        """Appends the temperature of a node set, in a step."""
        return self.add(_with_amplitude("TEMPERATURE", amplitude), (nodes, value))

    def support(self, nodes: str, *directions: int, value: Number = 0.0, amplitude: str = "") -> Self:
        """Holds a node set in directions 1 or 2 (the default is both directions) or 6, the angle of a rigid body; in a
        step the support may also move the set."""
        rows = [(nodes, one, one, value) for one in directions or (1, 2)]
        return self.add(_with_amplitude("BOUNDARY", amplitude), *rows)

    def load(self, nodes: str, x: Number = 0.0, y: Number = 0.0, amplitude: str = "") -> Self:
        """Appends a force on each node of a set, in a step."""
        rows = ((nodes, i, f) for i, f in ((1, x), (2, y)) if f != 0.0)
        return self.add(_with_amplitude("CLOAD", amplitude), *rows)

    def gravity(self, elements: str, size: Number, x: float = 0.0, y: float = -1.0) -> Self:
        """Appends an acceleration of an element set, in a step; (x, y) is its direction."""
        return self.add("DLOAD", (elements, "GRAV", size, x, y))

    def pressure(self, surface: str, size: Number, amplitude: str = "") -> Self:
        """Appends a pressure on a surface, in a step; a positive pressure presses on the body."""
        return self.add(_with_amplitude("DSLOAD", amplitude), (surface, "P", size))

    def history(self, nodes: str) -> Self:
        """Asks for the history of a node set, in a step."""
        return self.add(f"NODE PRINT, NSET={nodes}", ("U", "V", "RF"))


def element_types(plane: Plane, formulation: str = "") -> dict[int, str]:
    """Types of elements by their number of nodes; a formulation that does not exist in the given plane raises a
    Fault."""
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
    """The rows of a table; its second column must increase."""
    rows = [(float(force), float(along)) for force, along in law]
    if len(rows) < 2 or any(a >= b for (_, a), (_, b) in zip(rows, rows[1:])):
        raise Fault(f"the table of {name} has two rows or more, and its second column increases")
    return rows


def _in_lines(numbers: Iterable[int]) -> list[list[int]]:
    """Splits numbers into data lines of eight."""
    flat = [int(number) for number in numbers]
    return [flat[at : at + 8] for at in range(0, len(flat), 8)]
