"""Writes the deck of a choice of levels: a block on a base, connected at its top, loaded and guided by springs.

The block UPPER stands on LOWER, whose bottom is held. What the connection is made of, a reference node
or a third body CAP, is on top of UPPER. Weak springs guide what is loaded: no body is held by contact
alone, and every static step has an answer. Bodies of revolution stand at a radius of 2.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import cos, pi, radians, sin

import numpy as np
from bodies import Place, grid
from stickslip.decks import card
from stickslip.deck import Deck
from stickslip.mesh import Mesh

from lab.levels import (
    AMPLITUDES,
    DRIVEN,
    FLOORS,
    GENERAL,
    INTERACTIONS,
    MATERIALS,
    OUTPUTS,
    PROCEDURES,
    SLOW,
    STATIC,
    TURNING,
    WITH_CAP,
    WITH_REFERENCE,
    Procedure,
)

GUIDE = 40.0
"""Stiffness of a guiding spring; the block has one of 1000."""

FORCE = 4.0
"""Size of a load on the whole block, whose stress is 0.4 % of its modulus."""

LIFT = {"tie": 1.0, "hinge": 1.2, "springs": 1.4, "springs along axes": 1.4}
"""Height of the third body."""

OVERLAP = 0.002
"""What a pre-tensioned section overlaps by."""

LEFT = 1.07
"""Left end of the block over the base: no node stands over another."""

REFERENCE, SECOND, PIN, BOLT, GROUND, FLOOR = 901, 902, 903, 904, 911, 931
"""Numbers of nodes without element."""

TILT = 30.0
"""Degrees by which a moved instance is turned back into its place."""


@dataclass
class Body:
    """A body of one element family."""

    name: str
    mesh: Mesh
    first_node: int
    first_element: int

    def nodes(
        self, place: Callable[[np.ndarray], np.ndarray] = lambda points: points
    ) -> list[tuple]:
        """Rows of *NODE, numbered from `first_node`."""
        points = place(self.mesh.points)
        return [(self.first_node + k, *map(float, point)) for k, point in enumerate(points)]

    def elements(self) -> list[tuple]:
        """Rows of *ELEMENT."""
        return [
            (self.first_element + k, *(self.first_node + int(node) for node in nodes))
            for k, nodes in enumerate(self.mesh.elements)
        ]

    def nearest(self, x: float, y: float) -> int:
        """Number of the node nearest to a place."""
        return self.first_node + int(np.argmin(np.hypot(*(self.mesh.points - [x, y]).T)))


@dataclass
class Scene:
    """A choice of levels as a deck."""

    choice: Mapping[str, str]
    refined: int = 1
    """Elements of the bodies are divided by this."""
    radius: float = 2.0
    """Inner radius of bodies of revolution."""
    slowed: float = 1.0
    """Durations of dynamic steps are multiplied by this."""
    parts: int = 0
    """Least number of increments of a static or quasi-static step; none where the solver chooses."""
    is_halved: bool = False
    """Whether the only step is two of half its length."""
    zero_for_removed: bool = False
    """Whether loads become zero where the choice removes them."""
    has_guides: bool = True
    """Whether springs guide what is loaded."""
    base: str = ""
    """What the base is made of in place of the material: `stiff`, or `rigid` by its elements."""
    motion: tuple[float, float] = (0.004, -0.004)
    """Displacement of a motion."""
    steps: int = 0
    """Steps that have been written."""
    include: str = ""
    """Text of the file that the deck includes."""
    bodies: list[Body] = field(default_factory=list)
    applied: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """Resultant of the dead loads at the end."""

    def __post_init__(self) -> None:
        self.kind = self.choice["family"]
        self.is_ring = self.kind.startswith("CAX")
        self.x0 = self.radius if self.is_ring else 0.0
        self.connection = self.choice["connection"]
        self.contact = self.choice["contact"]
        self.load = self.choice["load"]
        self.has_base = self.contact not in ("none", *FLOORS)
        self._number = [1, 1]
        gap = {
            "clearance": 0.01,
            "adjusted": 0.01,
            "general adjusted": 0.01,
            "interference": -0.002,
        }.get(self.contact, 0.0)
        if self.has_base:
            self._add("LOWER", 4, 1, lambda x, y: (self.x0 + 3.0 * x, y - 1.0 - gap))
        self._add("UPPER", 2, 2, lambda x, y: (self.x0 + LEFT + x, y))
        if self.connection in WITH_CAP:
            lift = LIFT[self.connection]
            self._add("CAP", 3, 1, lambda x, y: (self.x0 + LEFT + x, lift + 0.4 * y))

    def _add(self, name: str, nx: int, ny: int, place: Place) -> None:
        mesh = grid(self.kind, nx * self.refined, ny * self.refined, place)
        node, element = self._number
        self.bodies.append(Body(name, mesh, node, element))
        self._number = [node + len(mesh.points), element + len(mesh.elements)]

    def body(self, name: str) -> Body:
        """The body of a name."""
        return next(body for body in self.bodies if body.name == name)

    @property
    def top(self) -> Body:
        """The body on top."""
        return self.bodies[-1]

    @property
    def grip(self) -> str:
        """The node or node set that loads act on."""
        if self.connection in WITH_REFERENCE:
            return str(REFERENCE)
        return f"{self.top.name}_TOP_NODES"

    @property
    def top_face(self) -> int:
        """Number of the faces of elements at the top."""
        return next(face for _, face in self.top.mesh.faces("TOP"))

    # The deck.

    def deck(self) -> str:
        """The whole text."""
        written = self.choice["written"]
        mesh, inner = self._mesh(), self._inner()
        if written in ("parts", "moved parts"):
            text = self._assembled(mesh_inner=inner, moved=written == "moved parts")
        else:
            text = mesh + inner
        if written == "include":
            self.include, text = text, "*INCLUDE, INPUT=mesh.inc\n"
        text = (
            "*HEADING\n"
            + ", ".join(self.choice.values())
            + "\n"
            + text
            + self._model()
            + self._steps()
        )
        return _with_parameters(text) if written == "parameters" else text

    def _mesh(self) -> str:
        """Nodes, elements and sections of the bodies, flat."""
        text = ""
        for body in self.bodies:
            text += card(f"NODE, NSET={body.name}_NODES", *body.nodes())
            text += _in_lines(f"ELEMENT, TYPE={self.kind}, ELSET={body.name}", body.elements())
            text += self._section(body.name)
            text += self._sets(body)
        return text

    def _section(self, elements: str) -> str:
        material = "STIFF" if self.base == "stiff" and elements == "LOWER" else "M"
        return card(
            f"SOLID SECTION, ELSET={elements}, MATERIAL={material}",
            *([] if self.is_ring else [(1.0,)]),
        )

    def _sets(self, body: Body, instance: str = "") -> str:
        """Node sets and surfaces of the sides of a body; rows name numbers of its instance."""
        parameter, prefix = (f", INSTANCE={instance}", f"{instance}.") if instance else ("", "")
        start = (body.first_node, body.first_element) if not instance else (1, 1)
        text = ""
        for side, nodes in body.mesh.node_sets.items():
            numbers = [start[0] + int(node) for node in nodes]
            text += _in_rows(f"NSET, NSET={body.name}_{side[1:]}_NODES{parameter}", numbers)
        for side in body.mesh.sides:
            faces = [(f"{prefix}{start[1] + k}", f"S{face}") for k, face in body.mesh.faces(side)]
            text += card(f"SURFACE, NAME={body.name}_{side}", *faces)
        if instance:
            numbers = [start[1] + k for k in range(len(body.mesh.elements))]
            text += _in_rows(f"ELSET, ELSET={body.name}{parameter}", numbers)
        numbers = [start[0] + k for k in range(len(body.mesh.points))]
        text += _in_rows(f"NSET, NSET={body.name}_ALL{parameter}", numbers)
        numbers = [start[1] + k for k, _ in body.mesh.faces("TOP")]
        text += _in_rows(f"ELSET, ELSET={body.name}_HIGHEST{parameter}", numbers)
        upper = [
            k for k, one in enumerate(body.mesh.elements) if body.mesh.points[one, 1].mean() > 0.5
        ]
        if self.contact == "node surface" and body.name == "UPPER":
            text += card("SURFACE, NAME=POINTS, TYPE=NODE", ("UPPER_BOTTOM_NODES",))
        if self.connection == "rigid elements" and body.name == "UPPER":
            text += _in_rows(f"ELSET, ELSET=UPPER_HALF{parameter}", [start[1] + k for k in upper])
        if self.connection == "pre-tension" and body.name == "UPPER":
            faces = self._cut(body, upper)
            rows = [(f"{prefix}{start[1] + k}", f"S{face}") for k, face in faces]
            text += card("SURFACE, NAME=CUT", *rows)
        return text

    def _cut(self, body: Body, upper: list[int]) -> list[tuple[int, int]]:
        """Faces of the upper half of a body on its lower half."""
        found = []
        for k in upper:
            nodes = body.mesh.elements[k]
            corners = list(nodes if len(nodes) < 5 else nodes[: len(nodes) // 2])
            for face, (a, b) in enumerate(zip(corners, [*corners[1:], corners[0]]), 1):
                if np.allclose(body.mesh.points[[a, b], 1], 0.5):
                    found.append((k, face))
        return found

    def _assembled(self, mesh_inner: str, moved: bool) -> str:
        """The bodies as instances of parts, and what stands in the assembly."""
        angle = radians(TILT) if moved else 0.0
        shift = np.array([0.3, -0.2]) if moved else np.zeros(2)
        # x = turn (part + shift), so that part = turn^T x - shift
        turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        text = ""
        for body in self.bodies:
            local = replace(body, first_node=1, first_element=1)
            text += card(f"PART, NAME=P_{body.name}")
            text += card("NODE", *local.nodes(lambda points: points @ turn - shift))
            text += _in_lines(f"ELEMENT, TYPE={self.kind}, ELSET=ALL", local.elements())
            text += self._section("ALL") + card("END PART")
        text += card("ASSEMBLY, NAME=A")
        for body in self.bodies:
            rows = (
                [(*map(float, shift), 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, TILT)] if moved else []
            )
            text += card(f"INSTANCE, NAME=I_{body.name}, PART=P_{body.name}", *rows) + card(
                "END INSTANCE"
            )
        for body in self.bodies:
            text += self._sets(body, f"I_{body.name}")
        return text + mesh_inner + card("END ASSEMBLY")

    def _node(self, body: Body, x: float, y: float) -> str:
        """Number of the node of a body nearest to a place, as the deck names it."""
        number = body.nearest(self.x0 + x, y)
        is_part = self.choice["written"] in ("parts", "moved parts")
        return f"I_{body.name}.{number - body.first_node + 1}" if is_part else str(number)

    def _inner(self) -> str:
        """Nodes without element, springs and rigid profiles: in the assembly where there is one."""
        middle, top = self.x0 + LEFT + 0.5, 1.0
        nodes: list[tuple[object, ...]] = []
        self.references = [
            number
            for number, used in ((REFERENCE, [*WITH_REFERENCE, "hinge"]), (SECOND, ["hinge"]))
            if self.connection in used
        ]
        if self.references:
            nodes.append((REFERENCE, middle, top + (0.3 if self.connection == "disc" else 0.0)))
        if self.connection == "hinge":
            nodes.append((SECOND, middle, top))
        if self.connection == "pre-tension":
            nodes.append((BOLT, middle, 0.5))
        text = self._guides(nodes)
        if self.contact in FLOORS or self.base == "rigid":
            nodes.append((FLOOR, self.x0 + 1.5, -0.5))
        if self.contact in FLOORS:
            text += card(
                "SURFACE, NAME=FLOOR, TYPE=SEGMENTS",
                ("START", self.x0, 0.0),
                ("LINE", self.x0 + 3.0, 0.0),
            )
        if self.connection == "disc":
            rim = [
                (middle + 0.3 * cos(a), top + 0.3 + 0.3 * sin(a))
                for a in np.arange(0.5, -2.5, -0.5) * pi
            ]
            rim[-1] = rim[1]
            centre = (middle, top + 0.3)
            arcs = [("CIRCL", *map(float, point), *centre) for point in rim[2:]]
            text += card("SURFACE, NAME=DISC, TYPE=SEGMENTS", ("START", *map(float, rim[1])), *arcs)
        if self.connection in ("disc", "rigid nodes", "rigid tie nodes", "rigid elements"):
            text += card("ELEMENT, TYPE=MASS, ELSET=EMASS", (981, REFERENCE))
            text += card("ELEMENT, TYPE=ROTARYI, ELSET=EROTARY", (982, REFERENCE))
        return (card("NODE", *nodes) if nodes else "") + text

    def _guides(self, nodes: list[tuple[object, ...]]) -> str:
        """Springs that hold what is loaded weakly, and those of a connection; their grounds join `nodes`."""
        ends: list[tuple[str, float, float, float, float]] = []
        upper, left = self.body("UPPER"), LEFT
        across = not self.is_ring
        if across:
            ends += [(self._node(upper, left, y), left, y, -1.0, 0.0) for y in (0.0, 0.5)]
        ends.append((self._node(upper, left + 1.0, 0.5), left + 1.0, 0.5, 0.0, 1.5))
        if self.connection in WITH_CAP and self.connection != "tie":
            lift = LIFT[self.connection]
            if across:
                ends.append((self._node(self.top, left, lift), left, lift, -1.0, 0.0))
            ends += [
                (self._node(self.top, left + x, lift + 0.4), left + x, lift + 0.4, 0.0, 1.0)
                for x in (0.0, 1.0)
            ]
        if self.connection == "disc":
            ends.append((str(REFERENCE), left + 0.5, 1.3, 0.0, 1.0))
            if across:
                ends.append((str(REFERENCE), left + 0.5, 1.3, 1.0, 0.0))
        ends = ends if self.has_guides else []
        rows = []
        for number, (node, x, y, dx, dy) in enumerate(ends):
            nodes.append((GROUND + number, self.x0 + x + dx, y + dy))
            rows.append((951 + number, node, GROUND + number))
        self.grounds = [GROUND + number for number in range(len(ends))]
        text = card("ELEMENT, TYPE=SPRINGA, ELSET=GUIDES", *rows) if rows else ""
        pairs = [
            (self._node(upper, left + x, 1.0), self._node(self.top, left + z, 1.4))
            for x, z in ((0.0, 0.0), (1.0, 1.0), (0.0, 1.0))
        ]
        if self.connection == "springs":
            text += card(
                "ELEMENT, TYPE=SPRINGA, ELSET=LINKS",
                *((971 + k, *pair) for k, pair in enumerate(pairs)),
            )
            text += card("ELEMENT, TYPE=DASHPOTA, ELSET=DASHPOTS", (975, *pairs[0]))
        if self.connection == "springs along axes":
            text += card(
                "ELEMENT, TYPE=SPRING2, ELSET=LINKS",
                *((971 + k, *pair) for k, pair in enumerate(pairs[:2])),
            )
            text += card("ELEMENT, TYPE=SPRING1, ELSET=GROUNDED", (975, pairs[0][1]))
            text += card("ELEMENT, TYPE=DASHPOT2, ELSET=DASHPOTS", (976, *pairs[1]))
        return text

    # The model.

    def _model(self) -> str:
        """Materials, connections, contact and supports."""
        text = (
            card("MATERIAL, NAME=M") + MATERIALS[self.choice["material"]] + card("DENSITY", (1.0,))
        )
        if self.load == "heat":
            text += card("EXPANSION, ZERO=10.", (1e-4, 0.0), (1.2e-4, 100.0))
        if self.grounds:
            text += card("SPRING, ELSET=GUIDES", (), (GUIDE,))
        if self.base == "stiff":
            text += (
                card("MATERIAL, NAME=STIFF") + card("ELASTIC", (1e7, 0.3)) + card("DENSITY", (1.0,))
            )
        if self.base == "rigid":
            text += card(f"RIGID BODY, ELSET=LOWER, REF NODE={FLOOR}")
        text += self._connection() + self._interactions()
        loaded = "static" if self.choice["sequence"] == "rest" else self.choice["procedure"]
        end = PROCEDURES[loaded].duration * (self.slowed if loaded not in STATIC else 1.0)
        text += AMPLITUDES[self.choice["amplitude"]].format(
            half=end / 2.0, quarter=end / 4.0, end=end, rate=pi / 2.0 / end
        )
        text += self._supports()
        if self.load == "thrown":
            moving = [body.name for body in self.bodies if body.name != "LOWER"]
            sets = [f"{name}_ALL" for name in moving] + [str(node) for node in self.references]
            rows = [
                (name, i, v)
                for name in sets
                for i, v in ((1, 0.2), (2, -0.5))
                if i == 2 or not self.is_ring
            ]
            text += card("INITIAL CONDITIONS, TYPE=VELOCITY", *rows)
        return text

    def _connection(self) -> str:
        """Cards of the connection."""
        ref = f"REF NODE={REFERENCE}"
        middle_mass = card("MASS, ELSET=EMASS", (0.3,)) + card(
            "ROTARY INERTIA, ELSET=EROTARY", ("", "", 0.05)
        )
        match self.connection:
            case "tie":
                return card("TIE, NAME=BOND", ("CAP_BOTTOM", "UPPER_TOP"))
            case "kinematic":
                return card(f"COUPLING, CONSTRAINT NAME=GRIP, {ref}, SURFACE=UPPER_TOP") + card(
                    "KINEMATIC", (1, 2)
                )
            case "distributing":
                return card(f"COUPLING, CONSTRAINT NAME=GRIP, {ref}, SURFACE=UPPER_TOP") + card(
                    "DISTRIBUTING"
                )
            case "kinematic coupling":
                return card(f"KINEMATIC COUPLING, {ref}", ("UPPER_TOP_NODES", 1, 2))
            case "beam":
                return card("MPC", ("BEAM", "UPPER_TOP_NODES", REFERENCE))
            case "pin":
                return card("MPC", ("PIN", "UPPER_TOP_NODES", REFERENCE))
            case "equation":
                terms = (
                    (2,),
                    ("UPPER_TOP_NODES", 1, 1.0, REFERENCE, 1, -1.0),
                    (2,),
                    ("UPPER_TOP_NODES", 2, 1.0, REFERENCE, 2, -1.0),
                )
                return card("EQUATION", *terms)
            case "hinge":
                return (
                    card(f"COUPLING, CONSTRAINT NAME=BELOW, {ref}, SURFACE=UPPER_TOP")
                    + card("KINEMATIC")
                    + card(
                        f"COUPLING, CONSTRAINT NAME=ABOVE, REF NODE={SECOND}, SURFACE=CAP_BOTTOM"
                    )
                    + card("KINEMATIC")
                    + card("MPC", ("PIN", SECOND, REFERENCE))
                )
            case "springs":
                return card("SPRING, ELSET=LINKS", (), (300.0,)) + card(
                    "DASHPOT, ELSET=DASHPOTS", (), (2.0,)
                )
            case "springs along axes":
                # the first local axis is y
                return (
                    card("ORIENTATION, NAME=AXES", (0.0, 1.0, 0.0, -1.0, 0.0, 0.0))
                    + card("SPRING, ELSET=LINKS, ORIENTATION=AXES", (1, 1), (300.0,))
                    + card(
                        "SPRING, ELSET=GROUNDED, NONLINEAR",
                        (1,),
                        (-30.0, -1.0),
                        (0.0, 0.0),
                        (60.0, 1.0),
                    )
                    + card("DASHPOT, ELSET=DASHPOTS", (2, 2), (2.0,))
                )
            case "rigid nodes":
                return card(f"RIGID BODY, NSET=UPPER_TOP_NODES, {ref}") + middle_mass
            case "rigid tie nodes":
                return card(f"RIGID BODY, TIE NSET=UPPER_TOP_NODES, {ref}") + middle_mass
            case "rigid elements":
                return card(f"RIGID BODY, ELSET=UPPER_HALF, {ref}") + middle_mass
            case "pre-tension":
                return card(f"PRE-TENSION SECTION, NODE={BOLT}, SURFACE=CUT")
            case "disc":
                return (
                    card(f"RIGID BODY, ANALYTICAL SURFACE=DISC, {ref}")
                    + middle_mass
                    + self._rolling()
                )
        return ""

    def _rolling(self) -> str:
        """Contact of the disc, which general contact holds where there is one."""
        if self.contact in GENERAL:
            return ""
        friction = card("SURFACE INTERACTION, NAME=ROLLING") + card("FRICTION", (0.2,))
        return friction + card("CONTACT PAIR, INTERACTION=ROLLING", ("DISC", "UPPER_TOP"))

    def _interactions(self) -> str:
        """Contact of block and base."""
        if self.contact == "none":
            return ""
        text = card("SURFACE INTERACTION, NAME=DRY") + INTERACTIONS[self.choice["interaction"]]
        pair = ("UPPER_BOTTOM", "FLOOR" if self.contact in FLOORS else "LOWER_TOP")
        head = "CONTACT PAIR, INTERACTION=DRY"
        match self.contact:
            case "surface to surface" | "rigid floor s2s":
                text += card(f"{head}, TYPE=SURFACE TO SURFACE", pair)
            case "both orders":
                text += card(head, pair, pair[::-1])
            case "both orders s2s":
                text += card(f"{head}, TYPE=SURFACE TO SURFACE", pair, pair[::-1])
            case "node surface":
                text += card(head, ("POINTS", pair[1]))
            case "adjusted":
                text += card(f"{head}, ADJUST=0.05", pair)
            case "clearance":
                text += card(head, pair) + card(
                    "CLEARANCE, SLAVE=UPPER_BOTTOM, MASTER=LOWER_TOP, VALUE=0."
                )
            case (
                "general"
                | "general floor"
                | "general nodes"
                | "general surfaces"
                | "general adjusted"
            ):
                is_adjusted = self.contact == "general adjusted"
                if is_adjusted:
                    text += card("CONTACT INITIALIZATION DATA, NAME=FIT, SEARCH ABOVE=0.02")
                kind = {"general nodes": "NODE", "general surfaces": "SURFACE"}.get(self.contact)
                text += card("CONTACT") + card("CONTACT INCLUSIONS, ALL EXTERIOR")
                text += card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY"))
                text += card(f"CONTACT FORMULATION, TYPE={kind} TO SURFACE") if kind else ""
                if is_adjusted:
                    text += card("CONTACT INITIALIZATION ASSIGNMENT", ("", "", "FIT"))
            case _:
                text += card(head, pair)
        if self.contact in FLOORS:
            text += card(f"RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE={FLOOR}")
        return text

    # The steps.

    def _steps(self) -> str:
        """All steps."""
        procedure = PROCEDURES[self.choice["procedure"]]
        if self.slowed != 1.0 and self.choice["procedure"] not in STATIC:
            procedure = _slowed(procedure, self.slowed)
        if self.parts and self.choice["procedure"] in SLOW:
            procedure = _in_parts(procedure, self.parts)
        first, sequence = self._loads(1.0), self.choice["sequence"]
        if self.choice["contact"] == "interference":
            first += card("CONTACT INTERFERENCE, SHRINK", ("UPPER_BOTTOM", "LOWER_TOP"))
        if self.is_halved:
            half = _halved(procedure)
            is_rate = self.load in ("velocity", "acceleration")
            grows = self.load in ("motion", "rotation") or (
                procedure.duration == 1.0 and not is_rate
            )
            first = self._loads(0.5 if grows and self.choice["amplitude"] == "none" else 1.0)
            return self._step(half, first) + self._step(half, self._loads(1.0))
        if sequence == "rest":
            static = PROCEDURES["static"]
            if self.choice["procedure"] == "redistributed":
                static = replace(static, settings=procedure.settings)
            return self._step(static, first) + self._step(procedure, "")
        if sequence == "released":
            first += card(
                "BOUNDARY",
                (
                    self._node(self.body("UPPER"), LEFT, 0.5 if self.contact == "none" else 0.0),
                    1,
                    1,
                ),
            )
        kept = self._loads(1.0, is_steady=True) if self.load in DRIVEN else ""
        text = self._step(procedure, first)
        pair = (
            "UPPER_BOTTOM" if self.contact != "node surface" else "POINTS",
            "FLOOR" if self.contact in FLOORS else "LOWER_TOP",
        )
        match sequence:
            case "on and off":
                text += self._step(procedure, self._loads(0.0))
            case "hold":
                locked = (
                    card("BOUNDARY, FIXED", (BOLT, 1, 1))
                    if self.connection == "pre-tension"
                    else ""
                )
                text += self._step(procedure, locked)
            case "two loads":
                text += self._step(procedure, self._loads(0.6))
            case "removed":
                text += self._step(
                    procedure, self._loads(0.0) if self.zero_for_removed else self._removed()
                )
            case "released":
                text += self._step(procedure, self._supports("BOUNDARY, OP=NEW") + kept)
            case "contact removed":
                rows = [pair, pair[::-1]] if "both" in self.contact else [pair]
                text += self._step(
                    procedure, card("MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE", *rows)
                )
            case "friction changed":
                text += self._step(
                    procedure, card("CHANGE FRICTION, INTERACTION=DRY") + card("FRICTION", (0.1,))
                )
        return text

    def _step(self, procedure: Procedure, cards: str) -> str:
        output = OUTPUTS[self.choice["output"]].format(
            nodes="UPPER_TOP_NODES",
            elements="UPPER",
            half=procedure.duration / 2.0,
            number=self._count(),
            monitor=self._node(self.body("UPPER"), LEFT, 1.0),
        )
        return "*STEP, NLGEOM=YES\n" + procedure.text + cards + output + "*END STEP\n"

    def _count(self) -> int:
        """Number of the step that is written."""
        self.steps += 1
        return self.steps

    def _supports(self, head: str = "BOUNDARY") -> str:
        """What holds the base, the grounds of springs and rigid bodies."""
        rows: list[tuple[object, ...]] = [(number, 1, 2) for number in self.grounds]
        if self.contact == "none":
            rows.append(("UPPER_BOTTOM_NODES", 1, 2))
        if self.has_base and self.base != "rigid":
            rows.append(("LOWER_BOTTOM_NODES", 1, 2))
        if self.contact in FLOORS or self.base == "rigid":
            rows += [(FLOOR, 1, 2), (FLOOR, 6, 6)]
        if self.connection in [*TURNING, "hinge"] and self.is_ring:
            rows += [(number, held, held) for number in self.references for held in (1, 6)]
        elif self.connection == "disc" and (
            self.choice["procedure"] in SLOW or self.choice["sequence"] == "rest"
        ):
            rows.append((REFERENCE, 6, 6))  # without inertia it would roll away
        if self.connection == "pre-tension" and "NEW" in head:
            rows.append((BOLT, 1, 1, OVERLAP))
        return card(head, *rows)

    def _removed(self) -> str:
        """Takes the load away."""
        if self.load in DRIVEN:
            return self._supports("BOUNDARY, OP=NEW")
        if self.load == "heat":
            return card("TEMPERATURE, OP=NEW") + card("DLOAD, OP=NEW")
        kinds = {"force": "CLOAD", "moment": "CLOAD", "pressure": "DSLOAD", "traction": "DSLOAD"}
        return card(f"{kinds.get(self.load, 'DLOAD')}, OP=NEW")

    def _loads(self, scale: float, is_steady: bool = False) -> str:
        """Cards of the load, a part of its size; a whole one follows the amplitude unless it is steady."""
        follows = self.choice["amplitude"] != "none" and scale == 1.0 and not is_steady
        amplitude = ", AMPLITUDE=A" if follows else ""
        grip, top, down = self.grip, self.top.name, scale * FORCE
        count = len(self.top.mesh.node_sets["NTOP"]) if grip.endswith("NODES") else 1
        sides, elements = f"{top}_TOP", top
        side_force = 0.0 if self.is_ring else 0.25 * down
        ring = self.is_ring
        ends = {
            "force": [(grip, 1, side_force / count), (grip, 2, -down / count)],
            "moment": [(grip, 6, 0.3 * down), (grip, 2, -down)],
        }
        text = (
            card("BOUNDARY", (BOLT, 1, 1, OVERLAP * (1.0 if self.zero_for_removed else scale)))
            if self.connection == "pre-tension"
            else ""
        )
        match self.load:
            case "force" | "moment":
                rows = [row for row in ends[self.load] if row[2] or scale == 0.0]
                if ring and self.load == "moment":
                    rows = [(grip, 2, -down)]
                text += card(f"CLOAD{amplitude}", *rows)
            case "pressure":
                text += card(f"DSLOAD{amplitude}", (sides, "P", down))
            case "traction":
                text += card(
                    f"DSLOAD, FOLLOWER=NO{amplitude}",
                    (sides, "TRVEC", down, *((0.0, -1.0) if ring else (0.28, -0.96))),
                )
            case "face pressure":
                text += card(f"DLOAD{amplitude}", (f"{top}_HIGHEST", f"P{self.top_face}", down))
            case "face traction":
                text += card(
                    f"DLOAD, FOLLOWER=NO{amplitude}",
                    (
                        f"{top}_HIGHEST",
                        f"TRVEC{self.top_face}",
                        down,
                        *((0.0, -1.0) if ring else (0.28, -0.96)),
                    ),
                )
            case "gravity":
                text += card(
                    f"DLOAD{amplitude}",
                    ("", "GRAV", down, *((0.0, -1.0) if ring else (0.28, -0.96))),
                )
            case "heat":
                hot = [("UPPER_ALL", 30.0 * scale), ("UPPER_TOP_NODES", 50.0 * scale)]
                text += card(f"TEMPERATURE{amplitude}", *hot)
                text += card(f"DLOAD{amplitude}", ("", "GRAV", down, 0.0, -1.0))
            case "body force":
                rows = (
                    [(elements, "BZ", -down)]
                    if ring
                    else [(elements, "BX", side_force), (elements, "BY", -down)]
                )
                text += card(f"DLOAD{amplitude}", *rows)
            case "centrifugal":
                axis = (0.0, 0.0, 0.0, 0.0, 1.0, 0.0) if ring else (0.0, 8.0, 0.0, 0.0, 0.0, 1.0)
                text += card(f"DLOAD{amplitude}", ("UPPER", "CENTRIF", (0.25 if ring else 0.5) * scale, *axis))
            case "motion":
                across = (
                    []
                    if ring and self.grip == str(REFERENCE)
                    else [(grip, 1, 1, self.motion[0] * scale)]
                )
                text += card(f"BOUNDARY{amplitude}", *across, (grip, 2, 2, self.motion[1] * scale))
            case "rotation":
                text += card(
                    f"BOUNDARY{amplitude}",
                    *([] if ring else [(grip, 6, 6, 0.01 * scale)]),
                    (grip, 2, 2, -0.004 * scale),
                )
            case "velocity" | "acceleration":
                size = 0.01 * scale if self.load == "velocity" else 0.1 * scale
                across = [] if ring and self.grip == str(REFERENCE) else [(grip, 1, 1, size)]
                text += card(
                    f"BOUNDARY, TYPE={self.load.upper()}{amplitude}", *across, (grip, 2, 2, -size)
                )
        return text


def _slowed(procedure: Procedure, factor: float) -> Procedure:
    """A procedure of another duration, with as many increments."""
    head, row, *rest = procedure.card.split("\n")
    times = [repr(float(text) * factor) for text in row.split(",")]
    return replace(
        procedure,
        card="\n".join([head, ", ".join(times), *rest]),
        duration=procedure.duration * factor,
    )


def _in_parts(procedure: Procedure, parts: int) -> Procedure:
    """A procedure of at least so many increments."""
    head, _, *rest = procedure.card.split("\n")
    largest = procedure.duration / parts
    row = f"{largest!r}, {procedure.duration!r}"
    row += "" if "DIRECT" in head else f", , {largest!r}"
    return replace(procedure, card="\n".join([head, row, *rest]))


def _halved(procedure: Procedure) -> Procedure:
    """A procedure of half the duration, with the same increments."""
    head, row, *rest = procedure.card.split("\n")
    first, end = row.split(",")
    return replace(procedure, card="\n".join([head, f"{first}, {float(end) / 2.0!r}", *rest]))


def _in_rows(head: str, numbers: list[int]) -> str:
    """A set, ten numbers a line."""
    return card(head, *(numbers[k : k + 10] for k in range(0, len(numbers), 10)))


def _in_lines(head: str, rows: list[tuple]) -> str:
    """A card whose rows are short enough for one line each."""
    return card(head, *rows)


def _with_parameters(text: str) -> str:
    """The deck with names in place of its modulus and its density."""
    deck = Deck.parse(text)
    names = {"ELASTIC": "young", "HYPERELASTIC": "constant"}
    used: list[list[str]] = []
    for one in deck.cards:
        if one.keyword in names:
            used.append([f"{names[one.keyword]} = {float(one.rows[0][0])!r}*1"])
            one.rows[0][0] = f"<{names[one.keyword]}>"
        if one.keyword == "DENSITY":
            one.rows[0][0] = "<density>"
    lines = "".join(f"{row[0]}\n" for row in [*used, ["density = 2./2."]])
    heading, rest = deck.cards[0], Deck(deck.cards[1:])
    return heading.text() + "*PARAMETER\n" + lines + rest.text()
