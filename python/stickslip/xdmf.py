"""A result as a series of XDMF: a text that refers to the fields of every frame in JOB.vtkhdf without copying them.

Every component of a tensor is a separate field with its name in Abaqus, such as `S11`, because XDMF orders six
components differently from the result file.
"""

import os
from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from stickslip.fields import AT_NODES, TENSOR, VECTORS
from stickslip.result import Result

CELLS = {3: [2, 2], 5: [4], 9: [5], 22: [36], 23: [37]}
"""What stands before the nodes of a cell in a mixed topology, by the type of VTK."""

TYPES = {"f": "Float", "i": "Int", "u": "UInt"}
"""Kinds of numbers."""

MESH = "/Xdmf/Domain/Grid[1]/Grid[1]/*[self::Topology or self::Geometry]"
"""Where the mesh of all frames stands, in the first."""

COMPONENTS = ("11", "22", "33", "12")
"""Components of a tensor in the file that are not always 0."""


def text_of(result: Result, folder: Path) -> Iterator[str]:
    """The lines of the file, which will be written to `folder`."""
    source = os.path.relpath(result.path, folder)
    yield '<?xml version="1.0"?>'
    yield '<Xdmf Version="2.0" xmlns:xi="http://www.w3.org/2001/XInclude"><Domain>'
    yield f'<Grid Name={quoteattr(result.job)} GridType="Collection" CollectionType="Temporal">'
    for frame in result.frames:
        yield f'<Grid Name="frame {frame.index}"><Time Value="{frame.time!r}"/>'
        if frame.index == 0:
            yield from _mesh(result, source)
        else:
            yield f'<xi:include xpointer="xpointer({MESH})"/>'
        for field in dict.fromkeys(stored for stored, _ in result.frames.stored.values()):
            yield from _field(result, frame.index, field, source)
        yield "</Grid>"
    yield "</Grid></Domain></Xdmf>"


def _mesh(result: Result, source: str) -> Iterator[str]:
    """The text for the cells, whose numbers are part of the text, and for the nodes."""
    nodes = np.split(result.read("VTKHDF/Connectivity"), result.read("VTKHDF/Offsets")[1:-1])
    types = result.read("VTKHDF/Types").tolist()
    rows = [[*CELLS[kind], *each.tolist()] for kind, each in zip(types, nodes)]
    size = sum(map(len, rows))
    yield f'<Topology TopologyType="Mixed" NumberOfElements="{len(types)}">'
    yield f'<DataItem Dimensions="{size}" NumberType="Int" Precision="8" Format="XML">'
    yield from (" ".join(map(str, row)) for row in rows)
    yield '</DataItem></Topology><Geometry GeometryType="XYZ">'
    yield _whole(result, "VTKHDF/Points", source) + "</Geometry>"


def _field(result: Result, index: int, field: str, source: str) -> Iterator[str]:
    """The text for a field of a frame; for a tensor, one field for every component."""
    frames = result.frames
    kind, dataset = frames.fields[field], frames.dataset(field)
    rows, first = frames.sizes[kind], frames.first_row(kind, field, index)
    shape = result.item(dataset).shape
    center = "Node" if kind == "PointData" else "Cell"
    components = COMPONENTS if shape[1:] == (TENSOR,) else ("",)
    base = field.removesuffix(AT_NODES)
    for column, component in enumerate(components):
        named = f"{base}{component}{field[len(base):]}"
        is_vector = field in VECTORS
        # of every dimension its first place, its stride and its number
        block = [[first, column][: len(shape)], [1] * len(shape), [rows, 3 if is_vector else 1][: len(shape)]]
        numbers = " ".join(str(number) for each in block for number in each)
        yield f'<Attribute Name="{named}" Center="{center}" AttributeType="{"Vector" if is_vector else "Scalar"}">'
        yield f'<DataItem ItemType="HyperSlab" Dimensions="{" ".join(map(str, block[2]))}">'
        yield f'<DataItem Dimensions="3 {len(shape)}" NumberType="Int" Format="XML">{numbers}</DataItem>'
        yield _whole(result, dataset, source) + "</DataItem></Attribute>"


def _whole(result: Result, dataset: str, source: str) -> str:
    """A dataset of the result file."""
    data = result.item(dataset)
    dimensions = " ".join(map(str, data.shape))
    numbers = f'NumberType="{TYPES[data.dtype.kind]}" Precision="{data.dtype.itemsize}"'
    return f'<DataItem Dimensions="{dimensions}" {numbers} Format="HDF">{escape(source)}:/{dataset}</DataItem>'
