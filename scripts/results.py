"""Reads result files `JOB.vtkhdf` (see docs/output.md) with h5py alone.

The file of a running or killed job is read up to the rows and frames that are complete. What cannot be
read is told as a `Fault`.
"""

from collections.abc import Iterable, Iterator, Sized
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType

import h5py
import numpy as np
from command import Fault, one_line
from numpy.typing import NDArray

Array = NDArray[np.float64]

ENERGIES = (
    "kinetic",
    "strain",
    "external_work",
    "normal_contact_work",
    "friction_dissipation",
    "impact_loss",
    "landing_return",
    "release_loss",
    "damping",
    "material_dissipation",
    "numerical_dissipation",
    "balance",
)

NONE, OPEN, STICK, SLIP = range(4)
"""Values of CONTACT_STATUS."""

LARGEST = 1e150
"""Largest position whose square is a number."""

EVENTS = ("impacts/", "returns/", "touches/")
"""Groups of the history with one row per event."""


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
        self.file = _open(self.path)
        missing = [name for name in ("VTKHDF", "model", "history", "run") if name not in self.file]
        if missing:
            self.file.close()
            raise Fault(f"{self.path} is no result of stickslip: it has no group /{missing[0]}")

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

    def read(self, name: str) -> NDArray[np.float64]:
        """A whole dataset by its path in the file."""
        with self._reading(name):
            return self.file[name][()]

    @contextmanager
    def _reading(self, name: str) -> Iterator[None]:
        """Tells what goes wrong while `name` is read: a file can be damaged or being written."""
        try:
            yield
        except KeyError:
            raise Fault(f"{self.path} has no {name}") from None
        except (OSError, RuntimeError, ValueError, TypeError) as error:
            raise Fault(f"{self.path}: {name} cannot be read: {one_line(error)}") from None

    # The model.

    @cached_property
    def coordinates(self) -> Array:
        """Reference coordinates [N, 2]."""
        return self.read("model/coordinates")

    @cached_property
    def node_labels(self) -> NDArray[np.int64]:
        """Node numbers of the deck [N]."""
        return self.read("model/node_labels")

    @cached_property
    def cells(self) -> list[NDArray[np.int64]]:
        """Node indices of each element."""
        connectivity = self.read("VTKHDF/Connectivity")
        offsets = self.read("VTKHDF/Offsets")[: len(self.read("model/element_labels")) + 1]
        return [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])]

    @cached_property
    def rigid(self) -> NDArray[np.int64]:
        """Segments of rigid surfaces, [segments, 2] node indices, obstacle on the left."""
        end = self.read("VTKHDF/Offsets")[len(self.cells)]
        return self.read("VTKHDF/Connectivity")[end:].reshape(-1, 2)

    @cached_property
    def drawn(self) -> NDArray[np.int64]:
        """Nodes of elements and of rigid surfaces."""
        return np.unique(np.concatenate([*self.cells, self.rigid.ravel()]))

    @cached_property
    def in_cells(self) -> NDArray[np.int64]:
        """Nodes of elements."""
        return np.unique(np.concatenate(self.cells))

    @cached_property
    def edge_length(self) -> float:
        """Median length of the edges of the undeformed mesh."""
        way = [self.coordinates[cell] - self.coordinates[np.roll(cell, -1)] for cell in self.cells]
        return float(np.median(np.linalg.norm(np.concatenate(way), axis=1)))

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
        return self.read(f"model/node_sets/{name}")

    def element_set(self, name: str) -> NDArray[np.int64]:
        """Element indices of a set."""
        return self.read(f"model/element_sets/{name}")

    # Histories.

    @cached_property
    def histories(self) -> dict[str, h5py.Dataset]:
        """All histories by their paths below /history, such as `energy/kinetic`.

        Events, numbers of the deck and volumes are none: they have other rows.
        """
        found: dict[str, h5py.Dataset] = {}

        def visit(name: str, item: object) -> None:
            last = name.rpartition("/")[2]
            other = name.startswith(EVENTS) or last in ("labels", "node", "EVOL")
            if isinstance(item, h5py.Dataset) and item.ndim > 0 and not other:
                found[name] = item

        with self._reading("history"):
            self.file["history"].visititems(visit)
        return found

    @cached_property
    def rows(self) -> int:
        """Complete rows of all histories."""
        rows = self._complete("history", self.histories.values())
        if rows == 0:
            raise Fault(f"{self.path} has no history yet")
        return rows

    def _complete(self, group: str, datasets: Iterable[Sized]) -> int:
        """Complete rows of the datasets of a group; files of older programs do not say it."""
        rows = min(map(len, datasets), default=0)
        return min(rows, int(self.file[group].attrs.get("rows", rows)))

    def history(self, name: str) -> Array:
        """A history by its path below /history."""
        return self.read(f"history/{name}")[: self.rows]

    @cached_property
    def time(self) -> Array:
        """Time at the end of each increment."""
        return self.history("time")

    @cached_property
    def dt(self) -> Array:
        """Length of each increment; 0 at the start."""
        return self.history("dt")

    @cached_property
    def energy(self) -> dict[str, Array]:
        """Energy ledger, by the names in ENERGIES."""
        return {name: self.history(f"energy/{name}") for name in ENERGIES}

    @property
    def largest_energy(self) -> float:
        """Largest magnitude of any account of the ledger except the balance; NaN if one is NaN."""
        return float(np.max([np.abs(self.energy[name]).max() for name in ENERGIES[:-1]]))

    @cached_property
    def linear_momentum(self) -> Array:
        """Linear momentum [I, 2]."""
        return self.history("momentum/linear")

    @cached_property
    def angular_momentum(self) -> Array:
        """Angular momentum about the origin [I]."""
        return self.history("momentum/angular")

    @cached_property
    def contacts(self) -> dict[str, Contact]:
        """Contacts by name, `SLAVE_MASTER`."""
        fields = [field for field in Contact.__dataclass_fields__ if field != "name"]
        groups = self.file["history"].get("contact", {})
        return {
            name: Contact(name, *(self.history(f"contact/{name}/{field}") for field in fields))
            for name in groups
        }

    @cached_property
    def solver(self) -> dict[str, NDArray[np.float64]]:
        """Counters of the solver per increment."""
        return {name: self.history(f"solver/{name}") for name in self.file["history/solver"]}

    @cached_property
    def impacts(self) -> dict[str, NDArray[np.float64]]:
        """Landings: time, increment, slave, segment, xi, approach_speed."""
        names = self.file["history/impacts"]
        found = {name: self.read(f"history/impacts/{name}") for name in names}
        rows = self._complete("history/impacts", found.values())
        return {name: data[:rows] for name, data in found.items()}

    def nodes(self, name: str) -> NodeHistory:
        """History of a node set."""
        labels = self.read(f"history/nodes/{name}/labels")
        motion = (self.history(f"nodes/{name}/{field}") for field in ("U", "V", "RF"))
        return NodeHistory(labels, *motion)

    # Frames.

    @cached_property
    def frame_times(self) -> Array:
        """Times of the frames [F]."""
        with self._reading("frames"):
            steps = self.file["VTKHDF/Steps"]
            frames = min(int(steps.attrs["NSteps"]), len(steps["Values"]))
            for kind, count in self._sizes.items():
                for name, data in self.file[f"VTKHDF/{kind}"].items():
                    ends = self._offsets(kind, name) + count
                    frames = min(frames, int((ends <= len(data)).sum()))
        if frames == 0:
            raise Fault(f"{self.path} has no frame yet")
        return self.read("VTKHDF/Steps/Values")[:frames]

    @cached_property
    def _sizes(self) -> dict[str, int]:
        """Rows of a frame in the nodal and in the element fields."""
        return {
            "PointData": len(self.coordinates),
            "CellData": len(self.cells) + len(self.rigid),
        }

    def nearest_frame(self, time: float) -> int:
        """Index of the frame nearest to a time."""
        return int(np.abs(self.frame_times - time).argmin())

    def _offsets(self, kind: str, name: str) -> NDArray[np.int64]:
        """First row of each frame in a field; fields that do not change are there once."""
        return self.read(f"VTKHDF/Steps/{kind}Offsets/{name}")

    def has_field(self, name: str) -> bool:
        """Whether the frames have a field, at the nodes or of the elements."""
        return any(f"VTKHDF/{kind}/{name}" in self.file for kind in self._sizes)

    def point_field(self, name: str, frame: int) -> NDArray[np.float64]:
        """A field at the nodes in one frame; plane vectors lose their third component."""
        data = self._field("PointData", name, frame)
        return data[:, :2] if data.ndim == 2 else data

    def cell_field(self, name: str, frame: int) -> NDArray[np.float64]:
        """A field of element means in one frame: S and E as (xx, yy, xy)."""
        return self._field("CellData", name, frame)[: len(self.cells)]

    def _field(self, kind: str, name: str, frame: int) -> NDArray[np.float64]:
        if name not in self.file[f"VTKHDF/{kind}"]:
            there = ", ".join(self.file[f"VTKHDF/{kind}"])
            raise Fault(f"{self.path} has no field {name}; there are {there}")
        first = int(self._offsets(kind, name)[frame])
        with self._reading(name):
            return self.file[f"VTKHDF/{kind}/{name}"][first : first + self._sizes[kind]]

    def positions(self, frame: int) -> Array:
        """Current coordinates of the nodes in one frame [N, 2]; a Fault when areas overflow."""
        positions = self.coordinates + self.point_field("U", frame)
        if not (np.abs(positions) < LARGEST).all():
            raise Fault(f"{self.path}: frame {frame} has positions that are no numbers or huge")
        return positions

    # The run.

    @property
    def deck(self) -> str:
        """Full text of the deck."""
        return str(self.file["run"].attrs["deck"])

    @property
    def run(self) -> dict[str, object]:
        """Attributes of the run record."""
        return dict(self.file["run"].attrs)


def _open(path: Path) -> h5py.File:
    """Opens a file that may be being written: without a lock."""
    if not path.exists():
        raise Fault(f"there is no file {path}")
    if not path.is_file():
        kind = "a folder" if path.is_dir() else "no regular file"
        raise Fault(f"{path} is {kind}: a result JOB.vtkhdf is needed")
    with path.open("rb"):
        pass  # a file that may not be read is told by the system
    if not h5py.is_hdf5(path):
        raise Fault(f"{path} is no HDF5 file: results are named JOB.vtkhdf")
    try:
        return h5py.File(path, "r", locking=False)
    except OSError as error:
        text = one_line(error)
        reason = "it is cut short" if "truncated" in text else text
        raise Fault(f"{path} cannot be opened: {reason}") from None
