"""VTK's own reader opens the file and sees every frame."""

import numpy as np
import pyvista
from conftest import ROOT, Job
from decks import CANTILEVERS, shortened
from stickslip.deck import Deck
from stickslip.result import Result


def test_reader_sees_all_frames(job: Job) -> None:
    path = job(shortened(CANTILEVERS / "B_mu04.inp", 200), "--frames", "5")
    reader = pyvista.HDFReader(str(path))
    with Result(path) as results:
        assert reader.reader.GetNumberOfSteps() == len(results.frames) == 6
        for frame in range(6):
            reader.reader.SetStep(frame)
            grid = reader.read()
            assert grid.n_points == len(results.coordinates)
            assert grid.n_cells == len(results.cells)
            assert np.array_equal(grid.points[:, :2], results.coordinates)
            for name in ("U", "V", "A", "RF", "CONTACT_FORCE"):
                expected = results.frames[frame][name]
                assert np.array_equal(grid.point_data[name][:, :2], expected), (name, frame)
            status = grid.point_data["CONTACT_STATUS"]
            assert np.array_equal(status, results.frames[frame]["CONTACT_STATUS"])
            gap = results.frames[frame]["GAP"]
            assert np.array_equal(grid.point_data["GAP"], gap, equal_nan=True)
            for name in ("S", "E"):
                assert np.array_equal(grid.cell_data[name], results.frames[frame][name])
            cells = results.file["model/bodies/element"][:]
            assert set(cells) == {0, 1}
            assert np.array_equal(grid.cell_data["BODY"], cells)
            rows = slice(frame * grid.n_cells, (frame + 1) * grid.n_cells)
            for name in ("S33", "MISES"):
                stored = results.file[f"VTKHDF/CellData/{name}"][rows]
                assert np.array_equal(grid.cell_data[name], stored)


def test_rigid_surfaces_are_lines(job: Job) -> None:
    path = job(Deck.read(ROOT / "tests/decks/rigid_floor.inp"), "--frames", "2")
    with Result(path) as results:
        assert (len(results.cells), results.rigid.shape) == (1, (91, 2))
        grid = pyvista.read(path)
        assert grid.n_cells == 92
        assert np.array_equal(grid.cell_data["BODY"], [0] + 91 * [-1])
        assert set(grid.celltypes) == {pyvista.CellType.LINE, pyvista.CellType.QUAD}
        floor = results.frames[2]["U"][results.rigid.ravel()]
        assert np.allclose(floor, [0.5, 0.0], rtol=0.0, atol=1e-15)
        assert np.isfinite(results.frames[2]["S"]).all()
