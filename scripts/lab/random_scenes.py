"""Random scenes: bodies that fall, hit each other, are shaken or pushed; a seed gives a deck.

`falling` is the plain kind: rectangles, discs and beams in a rigid box, all settings by default.
`mixed` has more: polygons, hooks, rings, springs and thin strips, round and hollow boxes, a peg,
boxes of elements, shaken or with a pusher, damping, and the settings of *STICKSLIP.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator
from stickslip.arrays import Array
from stickslip.decks import GridMesh, card

from lab import scene_shapes as shapes
from lab.scene_shapes import Shape

POISSON, DENSITY, GRAVITY = 0.3, 1.0, 9.81
FRICTION = (0.0, 0.1, 0.3, 0.6, 1.0)
INCREMENTS = 300
WIDTH = 4.0
"""Of the place for bodies."""
WALL = WIDTH / 2 + 0.3
"""Half the width of the box."""
MATERIALS = ("neo-hooke", "svk", "metal")
YIELD = 0.02
"""Yield stress of metals, by Young's modulus; it doubles up to a plastic strain of 1."""


@dataclass(frozen=True)
class Body:
    """A body in its place, with its motion at the start and its material."""

    shape: Shape
    centre: tuple[float, float]
    velocity: tuple[float, float]
    spin: float
    young: float
    damping: dict[str, float] = field(default_factory=dict)

    @property
    def nodes(self) -> Array:
        """Places of the nodes."""
        return self.shape.nodes + self.centre

    @property
    def velocities(self) -> Array:
        """Velocities of the nodes, those of a rigid motion."""
        x, y = self.shape.nodes.T
        (u, v), w = self.velocity, self.spin
        return np.stack([u - w * y, v + w * x], axis=1)


@dataclass(frozen=True)
class Scene:
    """All that a deck is made of."""

    bodies: list[Body]
    friction: float
    dt: float
    profiles: dict[str, list[tuple[object, ...]]]
    """Rigid profiles by name: the rows of their surfaces."""
    motions: dict[str, tuple[int, float, str]] = field(default_factory=dict)
    """Profiles, or the outside of the walls, that move: direction, way, card of the amplitude."""
    walls: Body | None = None
    """A box of elements, held at its outside."""
    settings: tuple[str, ...] = ()
    increments: int = INCREMENTS

    def deck(self, material: str = "neo-hooke") -> str:
        """The deck with all bodies of one kind of material."""
        meshes = self._meshes()
        bodies = [*self.bodies, *([self.walls] if self.walls else [])]
        references = {name: meshes[-1].next_node + k for k, name in enumerate(self.profiles)}
        kind = "CPS4" if material == "svk" else "CPE4"
        return "".join(
            [
                *(mesh.mesh(kind) for mesh in meshes),
                *(_material(mesh.name, body, material) for mesh, body in zip(meshes, bodies)),
                *(_profile(*item, references[item[0]]) for item in self.profiles.items()),
                card("SURFACE INTERACTION, NAME=DRY"),
                card("FRICTION", (self.friction,)),
                card("CONTACT"),
                card("CONTACT INCLUSIONS, ALL EXTERIOR"),
                card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
                *self._supports(meshes),
                card("INITIAL CONDITIONS, TYPE=VELOCITY", *self._velocities(meshes)),
                card(f"STEP, NLGEOM, INC={self.increments}"),
                card("DYNAMIC, DIRECT", (self.dt, self.increments * self.dt)),
                *([card(", ".join(["STICKSLIP", *self.settings]))] if self.settings else []),
                *self._driven(),
                card("DLOAD", *((mesh.name, "GRAV", GRAVITY, 0.0, -1.0) for mesh in meshes)),
                card("NODE FILE", ("U", "V")),
                card("END STEP"),
            ]
        )

    def _meshes(self) -> list[GridMesh]:
        meshes: list[GridMesh] = []
        named = [(f"B{k}", body) for k, body in enumerate(self.bodies)]
        for name, body in named + ([("WALLS", self.walls)] if self.walls else []):
            first = (meshes[-1].next_node, meshes[-1].next_element) if meshes else (1, 1)
            places = [(_digits(x), _digits(y)) for x, y in body.nodes]
            meshes.append(GridMesh(name, places, body.shape.elements, *first))
        return meshes

    def _velocities(self, meshes: list[GridMesh]) -> list[tuple[object, ...]]:
        return [
            (mesh.first_node + k, direction, _digits(value))
            for mesh, body in zip(meshes, self.bodies)
            for k, velocity in enumerate(body.velocities)
            for direction, value in enumerate(velocity, 1)
        ]

    def _supports(self, meshes: list[GridMesh]) -> list[str]:
        held = [card("BOUNDARY", *((name, 1, 2) for name in self.profiles))]
        if self.walls:
            x, y = self.walls.nodes.T
            outside = np.flatnonzero((np.abs(x) >= np.abs(x).max() - 1e-9) | (y <= y.min() + 1e-9))
            first = meshes[-1].first_node
            held.append(card("NSET, NSET=OUTSIDE", *((first + int(k),) for k in outside)))
            held.append(card("BOUNDARY", ("OUTSIDE", 1, 2)))
        return held if self.profiles else held[1:]

    def _driven(self) -> list[str]:
        cards = []
        for name, (direction, way, amplitude) in self.motions.items():
            cards.append(amplitude)
            row = (name, direction, direction, way)
            cards.append(card(f"BOUNDARY, AMPLITUDE={name}", row))
        return cards


def _digits(value: float) -> float:
    """A number with twelve digits."""
    return float(f"{value:.12g}")


def _material(name: str, body: Body, material: str) -> str:
    """Material and section; the neo-Hookean one has the moduli of the elastic one."""
    young = float(f"{body.young:.6g}")
    if material in ("svk", "metal"):
        law = card("ELASTIC", (young, POISSON))
        if material == "metal":
            law += card("PLASTIC", (YIELD * young, 0.0), (2.0 * YIELD * young, 1.0))
    else:
        bulk = young / (3 * (1 - 2 * POISSON))
        law = card("HYPERELASTIC, NEO HOOKE", (young / (2 * (1 + POISSON)) / 2, 2 / bulk))
    damping = "".join(f", {key}={value!r}" for key, value in body.damping.items())
    return "".join(
        [
            card(f"MATERIAL, NAME={name}"),
            law,
            card("DENSITY", (DENSITY,)),
            card(f"DAMPING{damping}") if damping else "",
            card(f"SOLID SECTION, ELSET={name}, MATERIAL={name}", (1.0,)),
        ]
    )


def _profile(name: str, rows: list[tuple[object, ...]], reference: int) -> str:
    """A rigid profile with its reference node."""
    return "".join(
        [
            card(f"NODE, NSET={name}", (reference, 0.0, -1.0)),
            card(f"SURFACE, NAME={name}, TYPE=SEGMENTS", *rows),
            card(f"RIGID BODY, REF NODE={name}, ANALYTICAL SURFACE={name}"),
        ]
    )


def falling(seed: int) -> Scene:
    """Rectangles, discs and beams fall into a rigid box."""
    rng = np.random.default_rng(seed)
    young, friction = 10 ** rng.uniform(3, 8), float(rng.choice(FRICTION))
    count, columns = int(rng.integers(3, 12)), int(rng.integers(1, 4))

    def shape() -> tuple[Shape, float]:
        kind, n = rng.choice(["rect", "disc", "beam"]), int(rng.integers(2, 7))
        if kind == "disc":
            radius = rng.uniform(0.2, 0.45)
            return shapes.disc(2 * (n // 2) + 2, radius), radius
        if kind == "rect":
            size = tuple(rng.uniform(0.3, 0.7, 2))
            return shapes.rectangle((n, int(rng.integers(2, 6))), size, rng), np.hypot(*size) / 2
        size = rng.uniform(0.6, 1.1), rng.uniform(0.08, 0.16)
        return shapes.rectangle((3 * n, 2), size, rng), np.hypot(*size) / 2

    bodies, top = _stacked(rng, count, columns, young, shape)
    box = _flat_box(max(top + 1.0, 3.0))
    return Scene(bodies, friction, float(rng.choice([0.001, 0.002, 0.005])), {"BOX": box})


def _stacked(
    rng: Generator,
    count: int,
    columns: int,
    young: float,
    shape: Callable[[], tuple[Shape, float]],
    bottom: float = 0.2,
    damping: Callable[[], dict[str, float]] = dict,
) -> tuple[list[Body], float]:
    """Bodies in layers that do not overlap, and the height that they reach."""
    bodies: list[Body] = []
    while len(bodies) < count:
        tallest = 0.0
        for column in range(min(columns, count - len(bodies))):
            body, radius = shape()
            radius = min(radius, 0.62)
            turn = rng.uniform(0, 2 * np.pi) if rng.random() < 0.6 else 0.0
            turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
            x = WIDTH * ((column + 0.5) / columns - 0.5) + rng.uniform(-0.05, 0.05)
            half = max(radius, 0.1)
            bodies.append(
                Body(
                    Shape(body.nodes @ turned.T, body.elements),
                    (x, bottom + half + 0.02),
                    (rng.uniform(-2, 2), rng.uniform(-3, 0.5)),
                    rng.uniform(-4, 4),
                    young * 10 ** rng.uniform(-1, 1),
                    damping(),
                )
            )
            tallest = max(tallest, 2 * half)
        bottom += tallest + 0.05
    return bodies, bottom


def _flat_box(height: float) -> list[tuple[object, ...]]:
    a, h = _digits(WALL), float(f"{height:g}")
    return [("START", -a, h), ("LINE", -a, 0.0), ("LINE", a, 0.0), ("LINE", a, h)]


def _bowl(height: float) -> list[tuple[object, ...]]:
    a, r = WALL, 1.1
    return [
        ("START", -a, height),
        ("LINE", -a, r),
        ("CIRCL", r - a, 0.0, r - a, r),
        ("LINE", a - r, 0.0),
        ("CIRCL", a, r, a - r, r),
        ("LINE", a, height),
    ]


def _funnel(height: float) -> list[tuple[object, ...]]:
    a = WALL
    places = [(-a, height), (-a, 0.9), (0.0, 0.0), (a, 0.9), (a, height)]
    return [("LINE" if k else "START", x, y) for k, (x, y) in enumerate(places)]


def _peg(x: float, y: float, radius: float) -> list[tuple[object, ...]]:
    """A whole circle, clockwise, with the outside on the left."""
    turns = [-2 * np.pi * k / 3 for k in range(4)]
    places = [(_digits(x + radius * np.cos(t)), _digits(y + radius * np.sin(t))) for t in turns]
    places[3] = places[0]
    arcs = [("CIRCL", *place, x, y) for place in places[1:]]
    return [("START", *places[0]), *arcs]


def _walls(height: float, cell: float, young: float) -> Body:
    """A box of one layer of elements."""
    across, up = int(np.ceil(2 * WALL / cell)), int(np.ceil(height / cell))
    size = 2 * WALL / across
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    cells = [(i, -1) for i in range(-1, across + 1)]
    cells += [(i, j) for i in (-1, across) for j in range(up)]
    places = [(square + place) * size - [WALL, 0.0] for place in cells]
    shape = shapes.joined([Shape(place, [(0, 1, 2, 3)]) for place in places])
    return Body(shape, (0.0, 0.0), (0.0, 0.0), 0.0, young)


def mixed(seed: int) -> Scene:
    """Bodies of all kinds in boxes of all kinds, with all settings."""
    rng = np.random.default_rng([seed, 1])
    young, friction = 10 ** rng.uniform(3.5, 8), float(rng.choice(FRICTION))
    count, columns = int(rng.integers(2, 8)), int(rng.integers(1, 4))
    is_damped = rng.random() < 0.4
    dt = float(rng.choice([0.0005, 0.001, 0.002, 0.005]))

    def damping() -> dict[str, float]:
        if not is_damped:
            return {}
        values = {"ALPHA": 10 ** rng.uniform(-1, 1), "BETA": dt * 10 ** rng.uniform(-3, 0.5)}
        return {key: _digits(value) for key, value in values.items() if rng.random() < 0.7}

    def shape() -> tuple[Shape, float]:
        body = _any_shape(rng)
        return body, body.radius

    profiles: dict[str, list[tuple[object, ...]]] = {}
    motions: dict[str, tuple[int, float, str]] = {}
    has_peg = rng.random() < 0.3
    bottom = 1.2 if has_peg else 0.2
    container = str(rng.choice(["box", "bowl", "funnel", "walls"]))
    bottom += 0.8 if container == "funnel" else 0.0
    bodies, top = _stacked(rng, count, columns, young, shape, bottom, damping)
    height = float(f"{max(top + 1.0, 3.0):g}")
    walls = None
    if container == "walls":
        walls = _walls(height, rng.uniform(0.3, 0.8), young * 10 ** rng.uniform(-0.5, 2))
    else:
        make = {"box": _flat_box, "bowl": _bowl, "funnel": _funnel}[container]
        profiles["BOX"] = make(height)
    if has_peg:
        profiles["PEG"] = _peg(_digits(rng.uniform(-1, 1)), bottom - 0.45, 0.4)
    drive = str(rng.choice(["none", "shaken", "pushed"]))
    period = INCREMENTS * dt
    if drive == "shaken":
        name = "OUTSIDE" if walls else "BOX"
        rate, way = 2 * np.pi * rng.uniform(1, 4) / period, rng.uniform(0.05, 0.25)
        row = [(1, _digits(rate), 0.0, 1.0), (-1.0, 0.0)]
        motions[name] = (
            int(rng.integers(1, 3)),
            _digits(way),
            card(f"AMPLITUDE, NAME={name}, DEFINITION=PERIODIC", *row),
        )
    elif drive == "pushed" and container == "box":
        profiles["PUSHER"] = [("START", -_digits(WALL), height), ("LINE", -_digits(WALL), -0.1)]
        rows = [(0.0, 0.0, _digits(0.8 * period), 1.0)]
        motions["PUSHER"] = (
            1,
            _digits(rng.uniform(0.3, 1.2)),
            card("AMPLITUDE, NAME=PUSHER, DEFINITION=SMOOTH STEP", *rows),
        )
    return Scene(bodies, friction, dt, profiles, motions, walls, _settings(rng))


def _any_shape(rng: Generator) -> Shape:
    """A shape of a random kind and size."""
    kinds = ["rectangle", "disc", "polygon", "beam", "thin", "hook", "ring", "spring"]
    kind, n = str(rng.choice(kinds)), int(rng.integers(2, 6))
    if kind == "rectangle":
        return shapes.rectangle((n, int(rng.integers(1, 5))), tuple(rng.uniform(0.3, 0.7, 2)), rng)
    if kind == "disc":
        return shapes.disc(2 * (n // 2) + 2, rng.uniform(0.2, 0.45))
    if kind == "polygon":
        parts = int(rng.integers(1, 4))
        return shapes.polygon(int(rng.integers(3, 8)), parts, rng.uniform(0.25, 0.5), rng)
    if kind == "beam":
        size = rng.uniform(0.6, 1.1), rng.uniform(0.08, 0.16)
        return shapes.rectangle((3 * n, 2), size, rng)
    if kind == "thin":
        size = rng.uniform(0.6, 1.1), rng.uniform(0.015, 0.04)
        return shapes.rectangle((5 * n, 1), size, rng)
    layers = int(rng.integers(1, 3))
    if kind == "hook":
        radius = rng.uniform(0.15, 0.25)
        curve = shapes.arc(radius, rng.uniform(np.pi, 1.7 * np.pi), rng.uniform(0.0, 0.4))
        return shapes.strip(curve, 6 * n, layers, rng.uniform(0.2, 0.5) * radius)
    if kind == "ring":
        radius = rng.uniform(0.2, 0.45)
        curve = shapes.arc(radius, 2 * np.pi, 0.0)
        return shapes.strip(curve, 6 * n, layers, rng.uniform(0.1, 0.4) * radius)
    curve = shapes.wave(rng.uniform(0.6, 1.0), rng.uniform(0.06, 0.12), 2.0)
    return shapes.strip(curve, 32, 1, rng.uniform(0.03, 0.05))


def _settings(rng: Generator) -> tuple[str, ...]:
    """Settings of *STICKSLIP; most scenes have one or none."""

    def chance(setting: str, part: float) -> list[str]:
        return [setting] if rng.random() < part else []

    chosen = chance("SCHEME=SS22", 0.2)
    if not chosen:
        chosen = chance("LANDING=RETURN", 0.2) + chance("CONTACT MASS=REDISTRIBUTED", 0.2)
    chosen += chance("IMPACT TIME=EVENT", 0.15) or chance("IMPACT=NONE", 0.1)
    chosen += chance("LCP=LEMKE", 0.1) + chance("FACTORIZATION=EVERY PASS", 0.1)
    return tuple(chosen + chance("SOLVER=SPRS", 0.1))


KINDS: dict[str, Callable[[int], Scene]] = {"falling": falling, "mixed": mixed}
