"""Result files `JOB.vtkhdf` (see docs/output.md), read with h5py alone; the path of a dataset in the file gives its
data.

The file of a running or killed job is read up to the rows that are complete. Data that cannot be read raises a `Fault`.
"""

from collections.abc import Iterable, Iterator, Sized
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import h5py
import numpy as np
from numpy.typing import NDArray

from stickslip.arrays import Array, Integers
from stickslip.drawing import Drawing
from stickslip.errors import Fault, one_line
from stickslip.nodal import Recovery, around_element

EVENTS = ("impacts", "returns", "touches")
"""Groups of the history with one row per event."""


class ResultFile:
    """A result file as stored: datasets by their paths, the model, and the number of complete rows."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.file = _open(self.path)
        missing = [name for name in ("VTKHDF", "model", "history", "run") if name not in self.file]
        if missing:
            self.file.close()
            raise Fault(f"{self.path} is no result of stickslip: it has no group /{missing[0]}")
        self._found: dict[str, h5py.Dataset | h5py.Group] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.file.close()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({str(self.path)!r})"

    @property
    def job(self) -> str:
        """Name of the job."""
        return self.path.stem

    def read(self, name: str, start: int | None = None, end: int | None = None) -> NDArray[Any]:
        """A dataset, or rows of a dataset, by its path in the file."""
        data = self.item(name)
        with self.reading(name):
            return data[()] if start is None and end is None else data[start:end]

    def item(self, name: str) -> Any:
        """A dataset or a group by its path in the file; the object is kept, because finding an object takes longer than
        reading it."""
        with self.reading(name):
            if name not in self._found:
                self._found[name] = self.file[name]
            return self._found[name]

    def has(self, name: str) -> bool:
        """Whether the file has a dataset or a group with a given path."""
        with self.reading(name):
            return name in self._found or name in self.file

    @contextmanager
    def reading(self, name: str) -> Iterator[None]:
        """Turns errors while `name` is read into Faults: a file can be damaged, or still being written."""
        if not self.file:
            raise Fault(f"{self.path} is closed: read {name} before")
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
    def node_labels(self) -> Integers:
        """Node numbers of the deck [N]."""
        return self.read("model/node_labels")

    @cached_property
    def element_labels(self) -> Integers:
        """Element numbers of the deck [E]."""
        return self.read("model/element_labels")

    @cached_property
    def cells(self) -> list[Integers]:
        """Node indices of each element."""
        connectivity = self.read("VTKHDF/Connectivity")
        offsets = self.read("VTKHDF/Offsets")[: len(self.element_labels) + 1]
        return [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])]

    @cached_property
    def outlines(self) -> list[Integers]:
        """Node indices in order around each element; a node between two corners stands between these corners."""
        return list(map(around_element, self.cells))

    @cached_property
    def recovery(self) -> Recovery:
        """The recovery of values at nodes from values of elements."""
        return Recovery.of(self.coordinates, self.cells, self.read("model/element_materials"))

    @cached_property
    def drawing(self) -> Drawing:
        """The mesh for drawing, with curved sides of quadratic elements."""
        return Drawing.of(self.recovery, self.boundary)

    @cached_property
    def rigid(self) -> Integers:
        """Segments of rigid surfaces, [segments, 2] node indices, with the obstacle on their left."""
        end = self.read("VTKHDF/Offsets")[len(self.cells)]
        return self.read("VTKHDF/Connectivity")[end:].reshape(-1, 2)

    @cached_property
    def drawn(self) -> Integers:
        """Nodes of elements and of rigid surfaces."""
        return np.unique(np.concatenate([*self.cells, self.rigid.ravel()]))

    @cached_property
    def in_cells(self) -> Integers:
        """Nodes of elements."""
        return np.unique(np.concatenate([*self.cells, np.empty(0, np.int64)]))

    @cached_property
    def is_axisymmetric(self) -> bool:
        """Whether the elements are bodies of revolution, which have no thickness."""
        return bool(np.isnan(self.read("model/thickness")).any())

    @cached_property
    def middles(self) -> dict[int, tuple[int, int]]:
        """For each node between two corners of a side, these two corners."""
        found: dict[int, tuple[int, int]] = {}
        for cell in self.cells:
            if len(cell) > 4:
                corners, between = np.reshape(cell, (2, -1)).tolist()
                found.update(zip(between, zip(corners, [*corners[1:], corners[0]])))
        return found

    @cached_property
    def edge_length(self) -> float:
        """Median distance of the nodes that follow each other around elements of the undeformed mesh."""
        pairs = [(self.coordinates[one], np.roll(one, -1)) for one in self.outlines]
        way = [place - self.coordinates[after] for place, after in pairs]
        return float(np.median(np.linalg.norm(np.concatenate(way), axis=1))) if way else np.inf

    @cached_property
    def boundary(self) -> Integers:
        """Straight lines between nodes that belong to one element only, [edges, 2] node indices, with the body on the
        left."""
        pairs = (zip(one, np.roll(one, -1)) for one in self.outlines)
        edges = {(int(a), int(b)) for one in pairs for a, b in one}
        single = sorted(edge for edge in edges if edge[::-1] not in edges)
        return np.array(single, np.int64).reshape(-1, 2)

    @cached_property
    def body(self) -> Integers:
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

    def node_set(self, name: str) -> Integers:
        """Node indices of a set."""
        return self.read(f"model/node_sets/{name}")

    def element_set(self, name: str) -> Integers:
        """Element indices of a set."""
        return self.read(f"model/element_sets/{name}")

    # Rows.

    @cached_property
    def histories(self) -> dict[str, h5py.Dataset]:
        """All datasets with one row per increment, by their paths below /history."""
        found: dict[str, h5py.Dataset] = {}

        def visit(name: str, item: object) -> None:
            if not isinstance(item, h5py.Dataset) or name.partition("/")[0] in EVENTS:
                return
            # what grows by rows is a history; rows of a model without deformable bodies may be of no values
            if item.ndim > 0 and item.maxshape[0] is None and 0 not in item.shape[1:]:
                found[name] = item

        with self.reading("history"):
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
        """Complete rows of the datasets of a group; files of older programs do not state the number of complete
        rows."""
        rows = min(map(len, datasets), default=0)
        return min(rows, int(self.file[group].attrs.get("rows", rows)))

    def complete_rows(self, path: str) -> NDArray[Any]:
        """The complete rows of a dataset by its path in the file, which starts with `history/`."""
        if 0 in (shape := self.item(path).shape[1:]):
            return np.zeros((self.rows, *shape))
        name = path.removeprefix("history/")
        event = name.partition("/")[0]
        if name in self.histories:
            rows = self.rows
        elif event in EVENTS:
            rows = self._complete(f"history/{event}", self.file[f"history/{event}"].values())
        else:
            return self.read(path)
        return self.read(path)[:rows]


def _open(path: Path) -> h5py.File:
    """Opens a file without a lock, because a run may be writing it."""
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
