"""Results in the data types of other packages (pandas, xarray, pyvista), which are imported only when they are
needed."""

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.arrays import Array
from stickslip.errors import not_installed
from stickslip.fields import DIRECTIONS, IN_SPACE, TENSOR, VECTORS
from stickslip.quantity import Members
from stickslip.result_file import ResultFile

if TYPE_CHECKING:
    import pandas
    import pyvista
    import xarray

COMPONENTS = {2: ("1", "2"), 3: ("11", "22", "12")}
"""Names of the components of vectors and of tensors in the plane."""


def to_dataframe(result: ResultFile) -> "pandas.DataFrame":
    """All histories as a table with one row per increment and the time as index.

    Columns have the names of `Result.quantity`: `energy/kinetic`, `contact/A_B/force:1`, `nodes/TIP[12]/U:2`,
    `elements/E/points[7.2]/S:1`, `connectors[9]/force`, `bodies/velocity[0]:1`.
    """
    pandas = _package("pandas")
    columns = columns_of(result)
    time = columns.pop("time")
    return pandas.DataFrame(columns, index=pandas.Index(time, name="time"))


def columns_of(result: ResultFile) -> dict[str, Array]:
    """The columns of the table of all histories by their names; `time` is one of them."""
    return {name: values for path in result.histories for name, values in _columns(result, path)}


def _columns(result: ResultFile, path: str) -> Iterator[tuple[str, Array]]:
    """The columns of a history, each with its name."""
    data = result.complete_rows(f"history/{path}")
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


def to_xarray(
    result: ResultFile, times: Array | None, fields: Mapping[str, tuple[str, NDArray[Any]]]
) -> "xarray.Dataset":
    """All histories along `time`, named by their paths with dots, and some fields along `frame`.

    Dots are used because `to_netcdf` cannot write names with a `/`. `times` holds the times of the frames. Each field
    is given by the path of its dataset and its values in all frames [F, N or E, ...].

    Every variable has the attributes `description` and `dimension` of the result file.
    """
    xarray = _package("xarray")
    coordinates: dict[str, Any] = {"time": result.complete_rows("history/time")}
    variables = {}
    for path, stored in result.histories.items():
        if path == "time":
            continue
        each = Members.of(result, path)
        axes = ["time"]
        if each.names:
            axes.append(dotted(each.axis))
            are_numbers = all(re.fullmatch(r"-?\d+", name) for name in each.names)
            coordinates[axes[1]] = list(map(int, each.names)) if are_numbers else each.names
        variables[dotted(path)] = _variable(axes, result.complete_rows(f"history/{path}"), stored.attrs, coordinates)
    if times is not None:
        coordinates["frame"] = times
    for name, (dataset, data) in fields.items():
        where = "node" if "/PointData/" in dataset else "element"
        labels = result.node_labels if where == "node" else result.element_labels
        coordinates[where] = labels
        variables[name] = _variable(["frame", where], data, result.item(dataset).attrs, coordinates)
    return xarray.Dataset(variables, coordinates, {"job": result.job})


def dotted(path: str) -> str:
    """The path of a history as the name of a variable or an axis: `energy.kinetic`."""
    return path.replace("/", ".")


def _variable(
    axes: list[str], data: Array, attributes: Any, coordinates: dict[str, Any]
) -> tuple[list[str], Array, dict[str, str]]:
    """Axes, values and attributes of a variable; the last axis of a vector or tensor is labelled with the names of its
    components."""
    if data.ndim > len(axes):
        components = COMPONENTS[data.shape[-1]]
        axis = "component" if len(components) == 2 else "tensor"
        coordinates[axis] = list(components)
        axes = [*axes, axis]
    return axes, data, {key: str(attributes[key]) for key in ("description", "dimension")}


def to_pyvista(
    result: ResultFile, time: float, fields: Mapping[str, tuple[str, NDArray[Any]]]
) -> "pyvista.UnstructuredGrid":
    """A frame as an unstructured grid with all its fields, rigid segments included.

    Each field is given by its group, PointData or CellData, and its rows as in the file.
    """
    pyvista = _package("pyvista")
    ends = result.read("VTKHDF/Offsets")
    connectivity = result.read("VTKHDF/Connectivity")
    cells = np.insert(connectivity, ends[:-1], np.diff(ends))
    grid = pyvista.UnstructuredGrid(
        cells, result.read("VTKHDF/Types"), result.read("VTKHDF/Points")
    )
    for name, (kind, rows) in fields.items():
        data = grid.point_data if kind == "PointData" else grid.cell_data
        data[name] = rows
        if rows.ndim == 2 and name not in VECTORS:
            for k, component in enumerate(IN_SPACE if rows.shape[1] == TENSOR else DIRECTIONS[rows.shape[1]]):
                data.GetArray(name).SetComponentName(k, component)
    grid.field_data["TimeValue"] = [time]
    return grid


def _package(name: str) -> Any:
    """Imports a package that may not be installed."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError:
        raise not_installed(name) from None
