"""Histories of a result, with one row per increment; row 0 is the start (docs/output.md, /history).

A group reads a dataset when the dataset is accessed, `group.name` or `group["name"]`, up to the last complete row.
Every result has the names that the classes annotate; a result may have more.
"""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from stickslip.arrays import Array, Integers
from stickslip.errors import Missing
from stickslip.result_file import ResultFile


class Group(Mapping[str, Any]):
    """Histories and groups of histories by name."""

    _groups: ClassVar[dict[str, type["Group"]]] = {}
    """Classes of the groups in it."""
    _others: ClassVar[type["Group"] | None] = None
    """Class of groups that it does not name."""

    def __init__(self, result: ResultFile, path: str) -> None:
        self._result = result
        self._path = path

    @property
    def name(self) -> str:
        """Last part of the path of the group in the file, such as `SLAVE_MASTER` for a contact."""
        return self._path.rpartition("/")[2]

    @property
    def _stored(self) -> Mapping[str, Any]:
        """The group in the file; an empty group if the result lacks the group."""
        return self._result.item(self._path) if self._result.has(self._path) else {}

    def __getitem__(self, name: str) -> Any:
        path = f"{self._path}/{name}"
        if not self._result.has(path):
            there = ", ".join(self) or "nothing"
            raise Missing(f"{self._result.path}: {self._path} has no {name}; there is {there}")
        if isinstance(self._result.item(path), h5py.Group):
            return self._groups.get(name, self._others or Group)(self._result, path)
        return self._result.complete_rows(path)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except Missing as error:
            raise AttributeError(str(error)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._stored)

    def __len__(self) -> int:
        return len(self._stored)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

    def __repr__(self) -> str:
        return f"<{self._path} of {self._result.path}: {', '.join(self) or 'empty'}>"


Each = TypeVar("Each", bound=Group)


class Named(Group, Generic[Each]):
    """Groups by the names of the deck."""

    if TYPE_CHECKING:

        def __getitem__(self, name: str) -> Each: ...


class Energy(Group):
    """Energy ledger [I]. All energies except the first two (kinetic and strain energy) are sums since the start."""

    kinetic: Array
    strain: Array
    external_work: Array
    thermal_work: Array
    """Work of the temperature; older files have none."""
    normal_contact_work: Array
    friction_dissipation: Array
    impact_loss: Array
    landing_return: Array
    release_loss: Array
    damping: Array
    material_dissipation: Array
    numerical_dissipation: Array
    balance: Array
    """What is left over: the residual of the increments."""
    scale: Array
    """Largest energy or work so far."""
    round_off: Array
    """Work that the round-off of the forces may have done in static steps."""

    @property
    def largest(self) -> float:
        """Largest magnitude of the energies, without the balance, and of the works that cancel in these energies; NaN
        if one value is NaN."""
        names = [name for name in (*ENERGIES, "scale") if name != "balance" and name in self]
        return float(np.max([np.abs(self[name]).max() for name in names]))

    @property
    def noise(self) -> float:
        """Largest energy that counts as round-off in the balance."""
        return float(np.max(self["round_off"])) if "round_off" in self else 0.0


ENERGIES = tuple(name for name in Energy.__annotations__ if name not in ("scale", "round_off"))
"""Accounts of the energy ledger."""


class Momentum(Group):
    """Momentum of all bodies."""

    linear: Array
    """[I, 2]"""
    angular: Array
    """About the origin [I]."""


class Bodies(Group):
    """Motion of the bodies (B)."""

    center: Array
    """Centre of mass [I, B, 2]."""
    velocity: Array
    """[I, B, 2]"""
    angular_velocity: Array
    """[I, B]"""
    kinetic: Array
    strain: Array
    contact_force: Array
    """Force of all contacts on the body [I, B, 2]."""
    contact_moment: Array
    """Its moment about the centre of mass [I, B]."""


class Contact(Group):
    """Resultants of one contact of the deck."""

    force: Array
    """Force on the slave surface [I, 2]."""
    moment: Array
    """Its moment about the origin [I]."""
    normal: Array
    """Sum of the normal forces of the pairs [I]."""
    tangential: Array
    closed: Integers
    """Pairs with a normal force [I]."""
    sticking: Integers
    min_gap: Array
    """Smallest gap [I]; NaN without any pair."""
    friction_coefficient: Array
    """Mean coefficient of friction of the closed pairs by their normal force [I]; NaN without any."""
    cone_violation: Array
    impulse_cone_violation: Array
    normal_work: Array
    friction_dissipation: Array
    impulse: Array
    """Impulse on the slave surface in the increment [I, 2]."""
    impulse_sum: Array
    """The same since the start."""
    normal_impulse_sum: Array
    tangential_impulse_sum: Array


class Contacts(Named[Contact]):
    """Contacts by name, `SLAVE_MASTER`."""

    _others = Contact


class NodeSet(Group):
    """Motion of the k nodes of a set."""

    labels: Integers
    """Node numbers [k]."""
    U: Array
    """Displacement [I, k, 2]."""
    V: Array
    """Velocity [I, k, 2]."""
    RF: Array
    """Support reaction [I, k, 2]."""
    sum: Group
    mean: Group


class NodeSets(Named[NodeSet]):
    """Node sets of the deck's history requests."""

    _others = NodeSet


class ElementSet(Group):
    """Means over the k elements of a set, and values of the elements."""

    labels: Integers
    """Element numbers [k]."""
    S: Array
    """Cauchy stress xx yy xy [I, k, 3]."""
    MISES: Array
    """Von Mises stress [I, k]."""
    SP1: Array
    """Smallest principal stress [I, k]."""
    SP2: Array
    """Middle principal stress [I, k]."""
    SP3: Array
    """Largest principal stress [I, k]."""
    PRESS: Array
    """Pressure [I, k]."""
    E33: Array
    """Green-Lagrange strain around the axis [I, k]; of bodies of revolution."""
    PEEQ: Array
    """Accumulated plastic strain [I, k]; where a material has `*PLASTIC`."""
    E: Array
    """Green-Lagrange strain xx yy xy [I, k, 3]."""
    sum: Group


class ElementSets(Named[ElementSet]):
    """Element sets of the deck's history requests."""

    _others = ElementSet


class Rigid(Group):
    """Motion of the reference node of a rigid surface, and the reaction at this node."""

    position: Array
    U: Array
    V: Array
    force: Array
    """Reaction [I, 2]: the force that holds the surface against all its contacts."""
    moment: Array


class RigidSurfaces(Named[Rigid]):
    """Rigid surfaces with a reference node."""

    _others = Rigid


class Solver(Group):
    """Counters of the solver [I]."""

    passes: Integers
    pivots: Integers
    factorizations: Integers
    converged: NDArray[np.uint8]


class Certificate(Group):
    """Checks that the run has made in every increment [I]; the attribute `bound` of a dataset is its bound."""

    residual: Array
    """Force residual of the last pass, part of the largest force."""
    balance: Array
    """Energy balance, part of the largest energy."""


class Impacts(Group):
    """Landings; each has one row."""

    time: Array
    increment: Integers
    slave: Integers
    segment: Integers
    xi: Array
    approach_speed: Array


class History(Group):
    """All histories of a result."""

    time: Array
    """Time at the end of each increment [I]."""
    dt: Array
    """Length of each increment [I]; 0 at the start."""
    step: Integers
    """Number of the step [I], from 1."""
    energy: Energy
    momentum: Momentum
    bodies: Bodies
    contact: Contacts
    nodes: NodeSets
    elements: ElementSets
    rigid: RigidSurfaces
    solver: Solver
    certificate: Certificate
    impacts: Impacts

    _groups = {
        "energy": Energy,
        "momentum": Momentum,
        "bodies": Bodies,
        "contact": Contacts,
        "nodes": NodeSets,
        "elements": ElementSets,
        "rigid": RigidSurfaces,
        "solver": Solver,
        "certificate": Certificate,
        "impacts": Impacts,
    }

    def __getitem__(self, name: str) -> Any:
        """A dataset or group by its path; a group that a result may lack is empty if it is missing."""
        if name in self._groups and name not in self._stored:
            return self._groups[name](self._result, f"{self._path}/{name}")
        return super().__getitem__(name)
