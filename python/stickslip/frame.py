"""Frames of a result: all fields at one time (docs/output.md, /VTKHDF)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from stickslip import convert
from stickslip.arrays import Array
from stickslip.errors import Fault, Missing
from stickslip.fields import (
    AT_NODES,
    INVARIANTS,
    TENSOR,
    VECTORS,
    Columns,
    Part,
    known,
    part,
    tensor_columns,
    without_third,
)
from stickslip.result_file import ResultFile

if TYPE_CHECKING:
    import pyvista

LARGEST = 1e150
"""Largest position whose square is a number."""

ROUND_OFF = 1e-9
"""Times that differ by this part of the duration are the same."""


@dataclass(frozen=True)
class Frame(Mapping[str, Any]):
    """A frame gives fields at one time by name: `frame["U"]` [N, 2] at the nodes, `frame["S"]` [E, 3] of elements.

    Vectors lose their third component, which is 0. Stresses and strains are means over the elements, (xx, yy, xy).
    Values at nodes, `frame["S_AT_NODES"]` [N, 3], have the same components. Components have names, such as
    `frame["S11"]` [E] (see `fields`).
    """

    frames: "Frames"
    index: int

    @property
    def result(self) -> ResultFile:
        """The file from which the frame is read."""
        return self.frames.result

    @property
    def time(self) -> float:
        """Time of the frame."""
        return float(self.frames.times[self.index])

    @property
    def positions(self) -> Array:
        """Current coordinates of the nodes [N, 2]; areas that overflow raise a Fault."""
        positions = self.result.coordinates + self["U"]
        if not (np.abs(positions) < LARGEST).all():
            place = f"{self.result.path}: frame {self.index}"
            raise Fault(f"{place} has positions that are no numbers or huge")
        return positions

    def __getitem__(self, name: str) -> NDArray[Any]:
        field, colon, _ = self.frames.known(name).partition(":")
        rows = self._whole(field)
        return self.frames.part(name).of(rows) if colon else rows

    def _whole(self, field: str) -> NDArray[Any]:
        """A field of the file, with the components of vectors in the plane and without rigid segments among
        elements."""
        kind = self.frames.kind(field)
        rows = without_third(field, self.full(field))
        return rows[: len(self.result.cells)] if kind == "CellData" else rows

    def nodal(self, name: str) -> NDArray[Any]:
        """A field at the nodes [N, ...]; a field of elements is averaged within a body and a material (see `nodal`)."""
        return self.at_places(name)[: len(self.result.coordinates)]

    def at_places(self, name: str) -> NDArray[Any]:
        """A field at the places [P, ...] of `nodal.Recovery`; a node between materials has a place for each of these
        materials.

        Invariants of stresses are computed from the stresses at the places. If the program has written a field at nodes
        (`POSITION=NODES`), these values are used at nodes of one material.
        """
        spelled = self.frames.known(name)
        field, colon, _ = spelled.partition(":")
        recovery = self.result.recovery
        if self.frames.kind(field) == "PointData":
            rows = self._whole(field)
            rows = np.concatenate([rows, rows[recovery.twins]])
        else:
            if field in INVARIANTS and "S33" in self.frames.fields:
                rows = INVARIANTS[field](self.at_places("S"), self.at_places("S33"))
            else:
                rows = recovery(self._whole(field))
            if field + AT_NODES in self.frames.fields:
                rows[recovery.alone] = self.full(field + AT_NODES)[recovery.alone]
        return self.frames.part(spelled).of(rows) if colon else rows

    def full(self, name: str) -> NDArray[Any]:
        """A field, including third components of vectors, and values at rigid segments."""
        stored, columns = self.frames.stored[self.frames.known(name)]
        rows = self.rows(stored)
        return rows if columns is None else rows[:, columns]

    def rows(self, stored: str) -> NDArray[Any]:
        """The rows of a dataset of fields in the form of the file."""
        kind = self.frames.fields[stored]
        first = self.frames.first_row(kind, stored, self.index)
        return self.result.read(f"VTKHDF/{kind}/{stored}", first, first + self.frames.sizes[kind])

    def __iter__(self) -> Iterator[str]:
        return iter(self.frames.fields)

    def __len__(self) -> int:
        return len(self.frames.fields)

    def __repr__(self) -> str:
        return f"<frame {self.index} of {self.result.path}: t = {self.time:g}, {', '.join(self)}>"

    __hash__ = object.__hash__

    def to_pyvista(self) -> "pyvista.UnstructuredGrid":
        """The frame as a grid of PyVista, in the reference configuration, with all fields.

        `grid.warp_by_vector("U")` is the deformed shape. The function needs the package pyvista.
        """
        datasets = dict.fromkeys(stored for stored, _ in self.frames.stored.values())
        fields = {name: (self.frames.fields[name], self.rows(name)) for name in datasets}
        return convert.to_pyvista(self.result, self.time, fields)


class Frames(Sequence[Frame]):
    """The complete frames of a result, in the order of time."""

    def __init__(self, result: ResultFile) -> None:
        self.result = result
        """The file that they are read from."""
        nodes = len(result.coordinates)
        self.sizes = {"PointData": nodes, "CellData": len(result.cells) + len(result.rigid)}
        """Rows of a frame in the nodal and in the element fields."""
        self.fields: dict[str, str] = {}
        """Fields by name, with the group that holds them: PointData or CellData."""
        self.stored: dict[str, tuple[str, Columns]] = {}
        """Fields by name, with the dataset that holds them and their columns there, None for all."""
        with result.reading("frames"):
            grid = result.file["VTKHDF"]
            steps = grid["Steps"]
            self._offsets = {
                (kind, name): data[()]
                for kind in self.sizes
                for name, data in steps[f"{kind}Offsets"].items()
            }
            frames = min(int(steps.attrs["NSteps"]), len(steps["Values"]))
            for kind, size in self.sizes.items():
                for name, data in grid[kind].items():
                    own = tensor_columns(name) if data.shape[1:] == (TENSOR,) else {name: None}
                    self.fields |= dict.fromkeys(own, kind)
                    self.stored |= {field: (name, columns) for field, columns in own.items()}
                    if (kind, name) in self._offsets:
                        ends = self._offsets[kind, name] + size
                        frames = min(frames, int((ends <= len(data)).sum()))
        if frames == 0:
            raise Fault(f"{result.path} has no frame yet")
        self.times: Array = result.read("VTKHDF/Steps/Values")[:frames]
        """Times of the frames [F]."""

    def known(self, name: str) -> str:
        """The name of a field with the spelling of the file, with its component (see `fields`); a name without a field
        raises Missing."""
        spelled = known(name, self.fields)
        if spelled.partition(":")[0] not in self.fields:
            there = ", ".join(self.fields)
            raise Missing(f"{self.result.path} has no field {name}; there are {there}")
        return spelled

    def kind(self, name: str) -> str:
        """Whether a field is PointData or CellData."""
        return self.fields[self.known(name).partition(":")[0]]

    def part(self, name: str) -> Part:
        """The number that a name asks for; a name that lacks a necessary component raises a Fault."""
        spelled = self.known(name)
        field = spelled.partition(":")[0]
        shape = self.result.item(self.dataset(field)).shape[1:]
        columns = self.stored[field][1]
        count = 2 if field in VECTORS else shape[0] if shape else None
        if columns is not None:
            count = None if isinstance(columns, int) else len(columns)
        return part(spelled, count, self.result.is_axisymmetric)

    def dataset(self, field: str) -> str:
        """Path of the dataset that holds a field with exactly the given name."""
        return f"VTKHDF/{self.fields[field]}/{self.stored[field][0]}"

    def field(self, name: str) -> tuple[str, NDArray[Any]]:
        """Path of the dataset of a field, and its values in all frames [F, N or E, ...]."""
        field = self.known(name).partition(":")[0]
        return self.dataset(field), np.stack([frame[name] for frame in self])

    def first_row(self, kind: str, name: str, index: int) -> int:
        """First row of a frame in the dataset of a field; a field that does not change is stored once."""
        offsets = self._offsets.get((kind, name))
        return 0 if offsets is None else int(offsets[index])

    def nearest(self, time: float) -> Frame:
        """The frame nearest to a time, at any distance."""
        return self[int(np.abs(self.times - time).argmin())]

    def at(self, time: float) -> Frame:
        """The frame nearest to a time of the run; a time before or after all frames raises a Fault."""
        first, last = float(self.times[0]), float(self.times[-1])
        margin = ROUND_OFF * max(last - first, abs(last))
        if not first - margin <= time <= last + margin:
            path = self.result.path
            raise Fault(f"{path} has frames from t = {first:g} to {last:g}, none at {time:g}")
        return self.nearest(time)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        places = range(len(self))[index]
        if isinstance(places, range):
            return [Frame(self, place) for place in places]
        return Frame(self, places)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<{len(self)} frames of {self.result.path}: t = {self.times[0]:g} to {self.times[-1]:g}>"
