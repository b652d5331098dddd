"""Reads result files `JOB.vtkhdf` (see docs/output.md) with h5py alone."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType

import h5py
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ENERGIES = (
    "kinetic",
    "strain",
    "external_work",
    "normal_contact_work",
    "friction_dissipation",
    "impact_loss",
    "numerical_dissipation",
    "balance",
)

NONE, OPEN, STICK, SLIP = range(4)
"""Values of CONTACT_STATUS."""


@dataclass(frozen=True)
class Contact:
    """Resultants of one contact of the deck; one row per increment."""

    name: str
    force: Array
    moment: Array
    normal: Array
    tangential: Array
    closed: NDArray[np.int64]
    sticking: NDArray[np.int64]
    min_gap: Array
    cone_violation: Array


@dataclass(frozen=True)
class NodeHistory:
    """Motion of a node set: [increments, nodes, 2]."""

    labels: NDArray[np.int64]
    U: Array
    V: Array
    RF: Array


class Results:
    """A result file. Histories have one row per increment, row 0 being the start."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.file = h5py.File(self.path, "r")

    def __enter__(self) -> "Results":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.file.close()

    @property
    def job(self) -> str:
        """Name of the job."""
        return self.path.stem

    # The model.

    @cached_property
    def coordinates(self) -> Array:
        """Reference coordinates [N, 2]."""
        return self.file["model/coordinates"][:]

    @cached_property
    def node_labels(self) -> NDArray[np.int64]:
        """Node numbers of the deck [N]."""
        return self.file["model/node_labels"][:]

    @cached_property
    def cells(self) -> list[NDArray[np.int64]]:
        """Node indices of each element."""
        connectivity = self.file["VTKHDF/Connectivity"][:]
        offsets = self.file["VTKHDF/Offsets"][: len(self.file["model/element_labels"]) + 1]
        return [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])]

    @cached_property
    def rigid(self) -> NDArray[np.int64]:
        """Segments of rigid surfaces, [segments, 2] node indices, obstacle on the left."""
        end = self.file["VTKHDF/Offsets"][len(self.cells)]
        return self.file["VTKHDF/Connectivity"][end:].reshape(-1, 2)

    @cached_property
    def drawn(self) -> NDArray[np.int64]:
        """Nodes of elements and of rigid surfaces."""
        return np.unique(np.concatenate([*self.cells, self.rigid.ravel()]))

    @cached_property
    def boundary(self) -> NDArray[np.int64]:
        """Edges that belong to one element only, [edges, 2] node indices, body on the left."""
        edges = {(int(a), int(b)) for cell in self.cells for a, b in zip(cell, np.roll(cell, -1))}
        return np.array(sorted(edge for edge in edges if edge[::-1] not in edges))

    @cached_property
    def body(self) -> NDArray[np.int64]:
        """Number of the body (connected elements) that each node belongs to [N]."""
        body = np.arange(len(self.coordinates))
        settled = False
        while not settled:
            settled = True
            for cell in self.cells:
                lowest = body[cell].min()
                if (body[cell] != lowest).any():
                    body[cell] = lowest
                    settled = False
        return np.unique(body, return_inverse=True)[1]

    def node_set(self, name: str) -> NDArray[np.int64]:
        """Node indices of a set."""
        return self.file[f"model/node_sets/{name}"][:]

    def element_set(self, name: str) -> NDArray[np.int64]:
        """Element indices of a set."""
        return self.file[f"model/element_sets/{name}"][:]

    # Histories.

    @cached_property
    def time(self) -> Array:
        """Time at the end of each increment."""
        return self.file["history/time"][:]

    @cached_property
    def dt(self) -> Array:
        """Length of each increment; 0 at the start."""
        return self.file["history/dt"][:]

    @cached_property
    def energy(self) -> dict[str, Array]:
        """Energy ledger, by the names in ENERGIES."""
        return {name: self.file[f"history/energy/{name}"][:] for name in ENERGIES}

    @property
    def largest_energy(self) -> float:
        """Largest magnitude of any account of the ledger except the balance."""
        return max(float(np.abs(self.energy[name]).max()) for name in ENERGIES[:-1])

    @cached_property
    def linear_momentum(self) -> Array:
        """Linear momentum [I, 2]."""
        return self.file["history/momentum/linear"][:]

    @cached_property
    def angular_momentum(self) -> Array:
        """Angular momentum about the origin [I]."""
        return self.file["history/momentum/angular"][:]

    @cached_property
    def contacts(self) -> dict[str, Contact]:
        """Contacts by name, `SLAVE_MASTER`."""
        fields = [field for field in Contact.__dataclass_fields__ if field != "name"]
        groups = self.file["history"].get("contact", {})
        return {
            name: Contact(name, *(group[field][:] for field in fields))
            for name, group in groups.items()
        }

    @cached_property
    def solver(self) -> dict[str, NDArray[np.float64]]:
        """Counters of the solver per increment."""
        return {name: data[:] for name, data in self.file["history/solver"].items()}

    @cached_property
    def impacts(self) -> dict[str, NDArray[np.float64]]:
        """Landings: time, increment, slave, segment, xi, approach_speed."""
        return {name: data[:] for name, data in self.file["history/impacts"].items()}

    def nodes(self, name: str) -> NodeHistory:
        """History of a node set."""
        group = self.file[f"history/nodes/{name}"]
        return NodeHistory(*(group[field][:] for field in ("labels", "U", "V", "RF")))

    # Frames.

    @cached_property
    def frame_times(self) -> Array:
        """Times of the frames [F]."""
        return self.file["VTKHDF/Steps/Values"][:]

    def nearest_frame(self, time: float) -> int:
        """Index of the frame nearest to a time."""
        return int(np.abs(self.frame_times - time).argmin())

    def point_field(self, name: str, frame: int) -> NDArray[np.float64]:
        """A field at the nodes in one frame; plane vectors lose their third component."""
        return self._field("PointData", name, len(self.coordinates), frame)

    def cell_field(self, name: str, frame: int) -> NDArray[np.float64]:
        """A field of element means in one frame: S and E as (xx, yy, xy)."""
        count = len(self.cells) + len(self.rigid)
        return self._field("CellData", name, count, frame)[: len(self.cells)]

    def _field(self, kind: str, name: str, count: int, frame: int) -> NDArray[np.float64]:
        data = self.file[f"VTKHDF/{kind}/{name}"][frame * count : (frame + 1) * count]
        return data[:, :2] if kind == "PointData" and data.ndim == 2 else data

    def positions(self, frame: int) -> Array:
        """Current coordinates of the nodes in one frame [N, 2]."""
        return self.coordinates + self.point_field("U", frame)

    # The run.

    @property
    def deck(self) -> str:
        """Full text of the deck."""
        return str(self.file["run"].attrs["deck"])

    @property
    def run(self) -> dict[str, object]:
        """Attributes of the run record."""
        return dict(self.file["run"].attrs)
