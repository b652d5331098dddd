"""A result in the text format of CalculiX, .frd, for cgx, PrePoMax and others: mesh, displacements and stresses at
nodes.

The columns follow the manual of CalculiX GraphiX, section "Result Format". Numbers in the file have six digits.
Stresses are averaged at nodes within a body and a material (see `nodal`); a node between two materials gets only the
value of one material. Segments of rigid surfaces are beams of two nodes.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.errors import Fault
from stickslip.frame import Frame
from stickslip.result import Result

SHAPES = {3: 11, 5: 7, 9: 9, 22: 8, 23: 10}
"""Numbers of the shapes by the type of VTK; both order nodes in the same way."""

DISPLACEMENT = ("DISP", [f"D{k}          1    2    {k}    0" for k in (1, 2, 3)] + ["ALL         1    2    0    0    1ALL"])
STRESS = (
    "STRESS",
    [f"S{ij}         1    4    {i}    {j}" for ij, i, j in
     (("XX", 1, 1), ("YY", 2, 2), ("ZZ", 3, 3), ("XY", 1, 2), ("YZ", 2, 3), ("ZX", 3, 1))],
)  # fmt: skip
"""Names of the sets of results and of their components, each with its kind and its place."""

LARGEST = 9_999_999_999
"""Largest number of a node, in ten columns."""


def text_of(result: Result) -> Iterator[str]:
    """The lines of the file."""
    labels = result.node_labels
    if labels.max(initial=0) > LARGEST:
        raise Fault(f"{result.path}: node {labels.max()} has more digits than the ten of an .frd file")
    yield "    1C"
    yield f"    1UJOB                 {result.job}"
    yield f"    2C                  {len(labels):12d}{'1':>38}"
    place = np.column_stack([result.coordinates, np.zeros(len(labels))])
    yield from _rows(labels, place)
    yield " -3"
    types = result.read("VTKHDF/Types").tolist()
    yield f"    3C                  {len(types):12d}{'1':>38}"
    yield from _elements(result, types)
    yield " -3"
    in_cells = result.in_cells
    for number, frame in enumerate(result.frames, start=1):
        displacement = np.column_stack([frame["U"], np.zeros(len(labels))])
        yield from _results(frame, number, DISPLACEMENT, labels, displacement)
        stress = frame.nodal("S")[in_cells]
        (xx, yy, xy), across, none = stress.T, frame.nodal("S33")[in_cells], np.zeros(len(stress))
        tensor = np.column_stack([xx, yy, across, xy, none, none])
        yield from _results(frame, number, STRESS, labels[in_cells], tensor)
    yield " 9999"


def _elements(result: Result, types: list[int]) -> Iterator[str]:
    """Each element with its shape, its group and its material, and then its nodes."""
    labels = result.element_labels
    beams = labels.max(initial=0) + 1 + np.arange(len(types) - len(labels))
    numbers = np.concatenate([labels, beams])
    materials = result.read("model/element_materials") + 1
    of = np.concatenate([materials, np.zeros(len(beams), materials.dtype)])
    nodes = np.split(result.read("VTKHDF/Connectivity"), result.read("VTKHDF/Offsets")[1:-1])
    for number, kind, material, each in zip(numbers, types, of, nodes):
        yield f" -1{number:10d}{SHAPES[kind]:5d}{0:5d}{material:5d}"
        yield " -2" + "".join(f"{label:10d}" for label in result.node_labels[each])


def _results(
    frame: Frame, number: int, kind: tuple[str, list[str]], labels: Integers, values: Array
) -> Iterator[str]:
    """The lines of a set of results at nodes."""
    name, components = kind
    yield f"    1PSTEP{number:26d}{1:12d}{number:12d}"
    yield f"  100C{'':6}{frame.time:12.5E}{len(labels):12d}{'':20}{1:2d}{number:5d}{'':10}{1:2d}"
    yield f" -4  {name:8}{len(components):5d}{1:5d}"
    yield from (f" -5  {component}" for component in components)
    yield from _rows(labels, values)
    yield " -3"


def _rows(labels: Integers, values: Array) -> Iterable[str]:
    """A line for each node; a number whose exponent would need three digits is written as 0 if its size is too small,
    and as NaN if its size is too large."""
    size = np.abs(values)
    written = np.where(size < 1e-99, 0.0, np.where(size < 9.9999e99, values, np.nan))
    numbers = "".join(["%12.5E"] * values.shape[1])
    return (f" -1{label:10d}{numbers % tuple(row)}" for label, row in zip(labels, written.tolist()))
