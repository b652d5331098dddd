"""Results in the containers of other packages, which are imported only when they are asked for."""

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.arrays import Array
from stickslip.errors import Fault
from stickslip.frame import Frame
from stickslip.quantity import Members

if TYPE_CHECKING:
    import pandas
    import pyvista
    import xarray

    from stickslip.result import Result

COMPONENTS = {2: ("1", "2"), 3: ("11", "22", "12")}
"""Names of the components of vectors and of tensors in the plane."""


def to_dataframe(result: "Result") -> "pandas.DataFrame":
    """All histories, one row per increment with the time as index.

    Columns bear the names of `Result.quantity`: `energy/kinetic`, `contact/A_B/force:1`,
    `nodes/TIP[12]/U:2`, `elements/E/points[7.2]/S:1`, `connectors[9]/force`, `bodies/velocity[0]:1`.
    """
    pandas = _package("pandas")
    columns = {name: values for path in result.histories for name, values in _columns(result, path)}
    time = columns.pop("time")
    return pandas.DataFrame(columns, index=pandas.Index(time, name="time"))


def _columns(result: "Result", path: str) -> Iterator[tuple[str, Array]]:
    """The columns of a history, each with its name."""
    data = result.history[path]
    names = Members.of(result, path).paths
    if not names:
        names, data = [path], data[:, None]
    for at, name in enumerate(names):
        values = data[:, at]
        if values.ndim == 1:
            yield name, values
        else:
            for component, column in enumerate(values.T, start=1):
                yield f"{name}:{component}", column


def to_xarray(result: "Result", fields: Sequence[str]) -> "xarray.Dataset":
    """All histories along `time`, named by their paths, and some fields along `frame`.

    Every variable has the attributes `description` and `dimension` of the result file.
    """
    xarray = _package("xarray")
    coordinates: dict[str, Any] = {"time": result.history.time}
    variables = {}
    for path, stored in result.histories.items():
        if path == "time":
            continue
        each = Members.of(result, path)
        axes = ["time"]
        if each.names:
            axes.append(each.axis)
            are_numbers = all(re.fullmatch(r"-?\d+", name) for name in each.names)
            coordinates[each.axis] = list(map(int, each.names)) if are_numbers else each.names
        variables[path] = _variable(axes, result.history[path], stored.attrs, coordinates)
    if fields:
        coordinates["frame"] = result.frames.times
    for name in fields:
        kind = result.frames.kind(name)
        where = "node" if kind == "PointData" else "element"
        labels = result.node_labels if where == "node" else result.element_labels
        coordinates[where] = labels
        data = np.stack([frame[name] for frame in result.frames])
        stored = result.file[f"VTKHDF/{kind}/{name}"]
        variables[name] = _variable(["frame", where], data, stored.attrs, coordinates)
    return xarray.Dataset(variables, coordinates, {"job": result.job})


def _variable(
    axes: list[str], data: Array, attributes: Any, coordinates: dict[str, Any]
) -> tuple[list[str], Array, dict[str, str]]:
    """Axes, values and attributes; the last axis of vectors and tensors has the names of components."""
    if data.ndim > len(axes):
        components = COMPONENTS[data.shape[-1]]
        axis = "component" if len(components) == 2 else "tensor"
        coordinates[axis] = list(components)
        axes = [*axes, axis]
    return axes, data, {key: str(attributes[key]) for key in ("description", "dimension")}


def to_pyvista(frame: Frame) -> "pyvista.UnstructuredGrid":
    """The frame as an unstructured grid with all its fields, rigid segments included."""
    pyvista = _package("pyvista")
    result = frame.result
    ends = result.read("VTKHDF/Offsets")
    connectivity = result.read("VTKHDF/Connectivity")
    cells = np.insert(connectivity, ends[:-1], np.diff(ends))
    grid = pyvista.UnstructuredGrid(
        cells, result.read("VTKHDF/Types"), result.read("VTKHDF/Points")
    )
    for name, kind in result.frames.fields.items():
        data = grid.point_data if kind == "PointData" else grid.cell_data
        data[name] = frame.full(name)
    grid.field_data["TimeValue"] = [frame.time]
    return grid


def _package(name: str) -> Any:
    """A package that the user has installed or not."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        raise Fault(f"the package {name} is needed for this: pip install {name}") from None
