"""Result of a deck as someone else sees them: moved, turned, mirrored, boosted, in other units.

`Seen` reads all histories and frames of a result; `expected` says what they are after a `Change`;
`deviations` compares them with what a run has given, row by row.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray
from rescale import Units, dimension
from stickslip.arrays import Array, Integers
from stickslip.deck import Deck
from stickslip.result import OPEN

REPORTED_NEARBY = ("CONTACT_STATUS", "GAP", "min_gap")
"""Reported of nodes near a segment; how near depends on ways and passes of the increment."""

LEFT_OUT = re.compile(
    r"history/solver/(?!converged)\w+|history/(certificate/.*|energy/round_off)|history/(impacts|returns|touches)/.*|.*/points/.*|.*/(labels|node|BODY)"
)
"""Work and errors of the solver, and numbers; impacts are compared by themselves."""

AT_REST = 1e-12
"""Speed of approach, relative to the largest speed, that is none."""

POINTS = ("center", "position")
DISPLACEMENTS = ("U",)
VELOCITIES = ("V", "velocity")
VECTORS = (
    "A",
    "CF",
    "CONTACT_FORCE",
    "RF",
    "body_force",
    "contact_force",
    "damped_linear",
    "force",
    "impulse",
    "impulse_sum",
    "linear",
)
STRAINS = ("E", "LE")
TENSORS = (*STRAINS, "S", "S_AT_NODES", "E_AT_NODES", "LE_AT_NODES")
"""Rows xx, yy, xy of histories, xx, yy, zz, xy, yz, xz of fields."""

HANDED = re.compile(r"\w*(tangential\w*|angle|angular|angular_velocity|moment)")
"""Scalars that a mirror turns round."""

OF_CONSISTENT_MASS = ("ELKE", "consistent_angular")
"""What a boost changes by momenta of the consistent mass, which no history has."""

BETWEEN_NODES = ("history/ties", "history/hinges")
"""Groups whose labels are two nodes."""

OF_FORCES = ("history/contact", "history/ties")
"""Groups whose moments are about the origin."""

OF_CONNECTORS = "history/connectors"
"""Forces and lengths along an axis."""

ON_FIRST_BODIES = ("force", "moment", "impulse", "impulse_sum")
"""Of surfaces that touch themselves: sums over pairs of bodies, on that of them whose number is smaller."""

OF_BODIES = re.compile(r"history/bodies/\w+|history/contact/.+/body_\w+")


@dataclass(frozen=True)
class Change:
    """How someone else sees a deck: x' = matrix x + shift + velocity t, in other units."""

    matrix: Array = field(default_factory=lambda: np.eye(2))
    shift: Array = field(default_factory=lambda: np.zeros(2))
    velocity: Array = field(default_factory=lambda: np.zeros(2))
    units: Units = Units()
    nodes: dict[int, int] | None = None
    """New numbers of nodes and elements by the old ones."""
    elements: dict[int, int] | None = None

    @property
    def hand(self) -> float:
        """-1 for a mirror."""
        return float(np.sign(np.linalg.det(self.matrix)))

    @property
    def is_boost(self) -> bool:
        """Whether velocities change by a constant."""
        return bool(self.velocity.any())


class Seen:
    """All numbers of a result file."""

    def __init__(self, path: Path, deck: Deck, was_stopped: bool = False) -> None:
        self.density = max(float(card.rows[0][0]) for card in deck.find("DENSITY"))
        self.stiffness = min(
            [float(card.rows[0][0]) for card in deck.find("ELASTIC")]
            + [6.0 * float(card.rows[0][0]) for card in deck.find("HYPERELASTIC")]
        )
        self.points = sum(
            float(card.rows[0][0]) * len(element.rows)
            for card in deck.find("MASS")
            for element in deck.find("ELEMENT")
            if element.parameters.get("ELSET") == card.parameters["ELSET"]
        )
        """Mass of the points, which no history has."""
        self.data: dict[str, NDArray] = {}
        self.dimensions: dict[str, str] = {}
        with h5py.File(path) as file:
            file.visititems(self._read)
            self.cutbacks = int(file["run"].attrs["cutbacks"])
        self.nodes = len(self.data["model/node_labels"])
        # points of rigid surfaces are the last nodes
        self.rigid = self.nodes - sum(len(card.rows) for card in deck.find("NODE"))
        self.cells = len(self.data["VTKHDF/Types"])
        self.edge = self._shortest_edge()
        # the last increment before a stop may have been cut back
        self.rows = len(self["history/time"]) - was_stopped

    def _read(self, name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and not name.startswith("VTKHDF/Steps/PointData"):
            self.data[name] = item[()]
            if item.dtype.kind == "f":
                self.dimensions[name] = str(item.attrs["dimension"])

    def _shortest_edge(self) -> float:
        """Length of the shortest edge of an element."""
        nodes, offsets = self["VTKHDF/Connectivity"], self["VTKHDF/Offsets"]
        points = self["model/coordinates"]
        cells = [
            nodes[a:b] for a, b in zip(offsets, offsets[1 : len(self["model/element_labels"]) + 1])
        ]
        edges = [points[np.roll(cell, -1)] - points[cell] for cell in cells]
        return min(float(np.linalg.norm(edge, axis=1).min()) for edge in edges)

    def __getitem__(self, name: str) -> NDArray:
        return self.data[name]

    @property
    def mass(self) -> float:
        """Mass of the model."""
        return float(self["model/bodies/mass"].sum()) + self.points

    def names(self) -> list[str]:
        """Histories with a row for each increment, fields of frames."""
        return [
            name
            for name, values in self.data.items()
            if not LEFT_OUT.fullmatch(name)
            and (self._is_field(name) or self._is_history(name, values))
        ]

    def _is_history(self, name: str, values: NDArray) -> bool:
        return name.startswith("history/") and values.shape[:1] == self["history/time"].shape

    def _is_field(self, name: str) -> bool:
        return name.startswith(("VTKHDF/PointData/", "VTKHDF/CellData/"))

    def by_row(self, name: str) -> NDArray:
        """Values with one row for each increment, or each frame."""
        values = self[name]
        if name.startswith("VTKHDF/PointData/"):
            return values.reshape(-1, self.nodes, *values.shape[1:])
        if name.startswith("VTKHDF/CellData/"):
            return values.reshape(-1, self.cells, *values.shape[1:])
        return values

    def times(self, name: str) -> Array:
        """Time of each row."""
        return self["VTKHDF/Steps/Values" if self._is_field(name) else "history/time"]

    def about(self, name: str) -> str:
        """What has the same scale: the dimension; strains are apart from other pure numbers."""
        is_strain = name.rpartition("/")[2] in STRAINS or name.startswith("history/strain")
        return "strain" if is_strain else self.dimensions[name]

    def rows_until(self, name: str, end: float) -> int:
        """Rows up to a time: increments, or frames."""
        return int((self.times(name) <= end * (1.0 + 1e-9)).sum())

    def scales(self, end: float) -> dict[str, float]:
        """Largest values of a dimension up to a time, fields too; 1 for pure numbers."""
        found: dict[str, float] = {}
        for name in self.names():
            if name in self.dimensions:
                values = self.by_row(name)[: self.rows_until(name, end)]
                own = np.abs(values[np.isfinite(values)]).max(initial=0.0)
                about = self.about(name)
                found[about] = max(found.get(about, 0.0), float(own))
        found["1"] = 1.0
        # bodies may not turn at all, momenta and moments may cancel
        length = float(np.ptp(self["model/coordinates"], axis=0).max())
        mass = self.mass
        speed = found.get("length/time", 0.0)
        inertia = mass * found.get("length/time^2", 0.0)
        found["force"] = max(found.get("force", 0.0), inertia)
        # a body that is free of stress has that of round-off of the forces that move it
        stress = self.density * found.get("length/time^2", 0.0) * length
        for about, least in {
            "force/length^2": stress,
            "strain": stress / self.stiffness,
            "1/time": speed / length,
            "mass*length/time": mass * speed,
            "mass*length^2/time": mass * speed * length,
            "force*length": found["force"] * length,
        }.items():
            found[about] = max(found.get(about, 0.0), least)
        return found


@dataclass(frozen=True)
class Order:
    """Places in the new file of what the old one has: nodes, cells, bodies."""

    nodes: Integers
    cells: Integers
    bodies: Integers

    @classmethod
    def between(cls, old: Seen, new: Seen, change: Change) -> "Order":
        """Finds nodes and elements by their numbers; points of rigid surfaces by their order."""
        nodes = _places(
            old["model/node_labels"], new["model/node_labels"], change.nodes, old.rigid, new.rigid
        )
        if change.hand < 0.0:
            for run in _outlines(old):
                nodes[run] = nodes[run][::-1]
        elements = _places(
            old["model/element_labels"], new["model/element_labels"], change.elements, 0, 0
        )
        segments = np.arange(len(elements), old.cells)
        bodies = np.zeros(len(old["model/bodies/mass"]), int)
        of_node = old["model/bodies/node"]
        members = of_node >= 0
        bodies[of_node[members]] = new["model/bodies/node"][nodes[members]]
        return cls(nodes, np.concatenate((elements, segments)), bodies)


def _places(
    old: Integers, new: Integers, renumbered: dict[int, int] | None, tail: int, new_tail: int
) -> Integers:
    """Where the members of `old` are in `new`; the last `tail` ones are the last ones in both."""
    where = {int(label): i for i, label in enumerate(new)}
    labels = old[: len(old) - tail]
    head = [where[renumbered[int(label)] if renumbered else int(label)] for label in labels]
    return np.array([*head, *range(len(new) - new_tail, len(new))], dtype=int)


def _segments(seen: Seen) -> Integers:
    elements = len(seen["model/element_labels"])
    return seen["VTKHDF/Connectivity"][seen["VTKHDF/Offsets"][elements] :].reshape(-1, 2)


def _outlines(seen: Seen) -> list[Integers]:
    """Nodes of each rigid surface in their order."""
    segments = _segments(seen)
    if not len(segments):
        return []
    breaks = np.flatnonzero(segments[1:, 0] != segments[:-1, 1]) + 1
    return [np.append(run[:, 0], run[-1, 1]) for run in np.split(segments, breaks)]


def expected(old: Seen, name: str, change: Change, theta: float) -> NDArray | None:
    """What a history or field is after a change, in the old order; None where that has no formula.

    `theta` is where within an increment the forces act.
    """
    values = old.by_row(name)
    group, _, own = name.rpartition("/")
    if values.dtype.kind != "f":
        return values
    factor = change.units.factor(dimension(old.dimensions[name]))
    time = old.times(name)
    in_time = time.reshape(-1, *[1] * (values.ndim - 1))
    turn = change.matrix
    if own in TENSORS:
        return _turned_tensor(values, turn) * factor
    if group == OF_CONNECTORS:
        return values * factor
    if own in (*POINTS, *DISPLACEMENTS, *VELOCITIES, *VECTORS):
        new = values.copy()
        new[..., :2] = values[..., :2] @ turn.T
        if own in POINTS:
            new += change.shift
        if own in (*POINTS, *DISPLACEMENTS):
            new[..., :2] += change.velocity * in_time
        if own in VELOCITIES:
            new[..., :2] += change.velocity
        if own == "linear":
            new += change.velocity * old.mass
        return new * factor
    if own in OF_CONSISTENT_MASS and change.is_boost:
        return None
    if own == "angular" and change.is_boost and old.points:
        return None  # no history has the centre of all points
    if group.startswith("history/rigid/") and own == "kinetic" and change.is_boost:
        return None  # no history has the mass of the body
    if name == "history/energy/scale" and change.is_boost:
        return None  # the largest energy of any increment is another one
    if own in ("kinetic", "external_work"):
        return _energy(old, name, change) * factor
    if HANDED.fullmatch(own):
        about_origin = _about_origin(old, name, change, theta)
        return (values * change.hand + about_origin) * factor
    return values * factor


def _turned_tensor(values: Array, turn: Array) -> Array:
    in_plane = [0, 1, 3] if values.shape[-1] == 6 else [0, 1, 2]
    xx, yy, xy = np.moveaxis(values[..., in_plane], -1, 0)
    full = np.stack([np.stack([xx, xy], -1), np.stack([xy, yy], -1)], -2)
    full = turn @ full @ turn.T
    new = values.copy()
    new[..., in_plane] = np.stack([full[..., 0, 0], full[..., 1, 1], full[..., 0, 1]], -1)
    return new


def _energy(old: Seen, name: str, change: Change) -> Array:
    """Kinetic energies and external work after a boost.

    T' = T + V.P + M V.V/2, and the work of the forces from outside, W' = W + V.(P - P0).
    """
    velocity, values = change.velocity, old[name]
    masses = old["model/bodies/mass"]
    if name == "history/bodies/kinetic":
        momenta = masses[:, None] * old["history/bodies/velocity"] @ change.matrix.T
        return values + momenta @ velocity + masses * (velocity @ velocity) / 2.0
    momentum = old["history/momentum/linear"] @ change.matrix.T @ velocity
    if name == "history/energy/kinetic":
        return values + momentum + old.mass * (velocity @ velocity) / 2.0
    return values + momentum - momentum[0]


def _about_origin(old: Seen, name: str, change: Change, theta: float) -> Array | float:
    """What a moment about the origin changes by: shift x force, way of the boost x force."""
    group, _, own = name.rpartition("/")
    turn, time = change.matrix, old["history/time"][:, None]
    if own == "moment" and group.startswith(OF_FORCES) or own == "body_moment":
        force = old[f"{group}/{own.replace('moment', 'force')}"] @ turn.T
        acting = time - (1.0 - theta) * old["history/dt"][:, None]
        arm = change.shift + change.velocity * acting
        return _cross(arm if force.ndim == 2 else arm[:, None], force)
    if own == "damped_angular":
        return _cross(change.shift, old["history/momentum/damped_linear"] @ turn.T)
    if own in ("angular", "consistent_angular"):
        mass = old["model/bodies/mass"]
        first = np.einsum("b,ibk->ik", mass, old["history/bodies/center"]) @ turn.T
        momentum = old["history/momentum/linear"] @ turn.T
        shift, velocity = change.shift, change.velocity
        moving = _cross(first, velocity) + mass.sum() * _cross(shift, velocity)
        return moving + _cross(shift + velocity * time, momentum)
    return 0.0


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


@dataclass
class Deviations:
    """Largest deviation of each history in each increment, of each field in each frame."""

    by_name: dict[str, Array] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    """Histories that only one of both has."""


def deviations(old: Seen, new: Seen, change: Change, theta: float, apart: set[int]) -> Deviations:
    """Compares a result with what an old one becomes, relative to the scale of the dimension.

    Decisions that differ deviate by infinity. Reactions of the nodes `apart` are left out.
    """
    found = Deviations()
    order = Order.between(old, new, change)
    scales = _common_scales(old, new, change)
    names = old.names()
    found.missing = sorted(set(names) ^ set(new.names()))
    is_apart = np.isin(old["model/node_labels"], list(apart))
    is_in_other_order = bool((np.diff(order.bodies) < 0).any())
    for name in names:
        if name in found.missing:
            continue
        group, _, own = name.rpartition("/")
        if own in ON_FIRST_BODIES and f"{group}/body_force" in old.data and is_in_other_order:
            continue
        wanted = expected(old, name, change, theta)
        if wanted is None:
            continue
        wanted, actual = _in_order(old, new, name, wanted, order, change)
        rows = _common_rows(old, new, name, change)
        wanted, actual = wanted[:rows], actual[:rows]
        if own == "RF" and apart:
            if name.startswith("history/"):
                continue
            wanted, actual = wanted[:, ~is_apart], actual[:, ~is_apart]
        if own in REPORTED_NEARBY:
            wanted, actual = _nearby(wanted, actual, old.edge * change.units.length)
        if wanted.dtype.kind != "f":
            differs = wanted != actual
            found.by_name[name] = np.where(_flat(differs).any(axis=1), np.inf, 0.0)
            continue
        scale = scales.get(old.about(name), 0.0) or 1.0
        found.by_name[name] = _largest(wanted, actual) / scale
    found.by_name |= _impacts(old, new, change, scales)
    return found


def _common_rows(old: Seen, new: Seen, name: str, change: Change) -> int:
    """The increments that both have finished, the frames up to there."""
    factor = change.units.factor((0, 0, 1))
    end = _common_end(old, new)
    return min(old.rows_until(name, end), new.rows_until(name, end * factor), len(new.times(name)))


def _common_end(old: Seen, new: Seen) -> float:
    """Time of the last increment that both have finished, in the old units."""
    return float(old["history/time"][min(old.rows, new.rows) - 1])


def _common_scales(old: Seen, new: Seen, change: Change) -> dict[str, float]:
    end = _common_end(old, new)
    before = old.scales(end)
    after = new.scales(end * change.units.factor((0, 0, 1)))
    found = {}
    for about, largest in before.items():
        factor = change.units.factor(dimension("1" if about == "strain" else about))
        found[about] = max(largest * factor, after.get(about, 0.0))
    return found


def _in_order(
    old: Seen, new: Seen, name: str, wanted: NDArray, order: Order, change: Change
) -> tuple[NDArray, NDArray]:
    """Both with their columns in the old order."""
    actual = new.by_row(name)
    if name.startswith("VTKHDF/PointData/"):
        return wanted, actual[:, order.nodes]
    if name.startswith("VTKHDF/CellData/"):
        return wanted, actual[:, order.cells]
    if OF_BODIES.fullmatch(name):
        return wanted, actual[:, order.bodies]
    group, _, own = name.rpartition("/")
    labels = f"{group}/labels"
    if labels in old.data and not group.startswith(BETWEEN_NODES):
        is_of_nodes = group.startswith("history/nodes") or group.endswith("nodes")
        map_ = change.nodes if is_of_nodes else change.elements
        return wanted, actual[:, _places(old[labels], new[labels], map_, 0, 0)]
    return wanted, actual


def _nearby(wanted: NDArray, actual: NDArray, near: float) -> tuple[NDArray, NDArray]:
    """States in which none is as good as open; gaps that both report, up to a length."""
    if wanted.dtype.kind != "f":
        return np.maximum(wanted, OPEN), np.maximum(actual, OPEN)
    either = np.isnan(wanted) | np.isnan(actual)
    wanted, actual = (np.where(either, near, np.fmin(x, near)) for x in (wanted, actual))
    return wanted, actual


def _flat(values: NDArray) -> NDArray:
    return values.reshape(len(values), -1)


def _largest(wanted: Array, actual: Array) -> Array:
    """Largest difference in each row; infinite where only one is a number."""
    with np.errstate(invalid="ignore"):
        away = np.abs(wanted - actual)
    away[np.isnan(wanted) & np.isnan(actual)] = 0.0
    away[np.isnan(away)] = np.inf
    return _flat(away).max(axis=1, initial=0.0)


Impacts = list[dict[tuple[int, ...], Array]]
"""Of each increment: place on the segment, approach speed and time of the landings."""


def _impacts(old: Seen, new: Seen, change: Change, scales: dict[str, float]) -> dict[str, Array]:
    """Impacts by increment: the same slave nodes and segments, places, speeds and times."""
    if "history/impacts/increment" not in old.data:
        return {}
    rows = min(old.rows, new.rows)
    size = np.array([1.0, scales["length/time"] or 1.0, scales["time"]])
    away = np.zeros(rows)
    for row, (first, second) in enumerate(
        zip(_listed(old, rows, change), _listed(new, rows, Change()))
    ):
        if first.keys() != second.keys():
            away[row] = np.inf
        elif first:
            away[row] = max(_apart(first[key], second[key], size) for key in first)
    return {"history/impacts": away}


def _apart(one: Array, other: Array, size: Array) -> float:
    """Difference of two landings. Round-off decides when a pair lands that touches and does not approach."""
    away = np.abs(one - other) / size
    is_at_rest = max(abs(one[1]), abs(other[1])) <= AT_REST * size[1]
    return float(away[:2].max() if is_at_rest else away.max())


def _listed(seen: Seen, rows: int, change: Change) -> Impacts:
    """The first landing of each node on each segment in each increment, after a change.

    Points of rigid surfaces have no number of their own.
    """
    names = ("increment", "slave", "segment", "xi", "approach_speed", "time")
    columns = [seen[f"history/impacts/{name}"] for name in names]
    of_deck = {int(label) for label in seen["model/node_labels"][: seen.nodes - seen.rigid]}
    renamed = change.nodes or {label: label for label in of_deck}
    speed, time = (change.units.factor(about) for about in ((1, 0, -1), (0, 0, 1)))
    listed: Impacts = [{} for _ in range(rows)]
    for increment, slave, ends, xi, approach, at in zip(*columns):
        if increment >= rows:
            break
        segment = [renamed.get(int(end), 0) for end in ends]
        if change.hand < 0.0:
            segment, xi = segment[::-1], 1.0 - xi
        landing = np.array([xi, approach * speed, at * time])
        listed[int(increment)].setdefault((renamed.get(int(slave), 0), *segment), landing)
    return listed
