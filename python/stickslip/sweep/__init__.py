"""Parameter studies on a Dask cluster: points, their runs, the table and pictures (docs/sweeps.md)."""

from stickslip.sweep.engine import Settings, sweep
from stickslip.sweep.points import latin_hypercube, product, read_points
from stickslip.sweep.table import Table

__all__ = ["Settings", "Table", "latin_hypercube", "product", "read_points", "sweep"]
