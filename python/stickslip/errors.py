"""Errors that the user can correct."""

EXTRAS = {
    "PIL": "plot",
    "dask": "sweep",
    "distributed": "sweep",
    "gmsh": "mesh",
    "matplotlib": "plot",
    "meshio": "mesh",
    "pandas": "convert",
    "pyarrow": "sweep",
    "pyvista": "convert",
    "xarray": "convert",
}
"""Packages that only some uses need, and the extra of this package that installs each."""


class Fault(Exception):
    """An error that the user can correct; its text is one line."""


class Missing(Fault, KeyError):
    """A result has no data with a given name; the text lists the names that exist."""

    __str__ = Exception.__str__


def one_line(error: BaseException) -> str:
    """The text of an error as one line."""
    return " ".join(str(error).split()) or type(error).__name__


def not_installed(name: str) -> Fault:
    """The error for a package that is not installed; the text says what to install."""
    what = f'"stickslip[{EXTRAS[name]}]"' if name in EXTRAS else name
    return Fault(f"this needs the package {name}: pip install {what}")
