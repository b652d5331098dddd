"""VTK's own reader opens the file and sees every frame; exported files hold the same."""

import sys
from pathlib import Path

import numpy as np
import pandas
import pytest
import pyvista
from conftest import ROOT, Job
from decks import CANTILEVERS, shortened
from stickslip import export
from stickslip.deck import Deck
from stickslip.result import Result
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


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


def exported(monkeypatch: pytest.MonkeyPatch, path: Path, kind: str, folder: Path) -> None:
    """Runs the command that exports a result."""
    monkeypatch.setattr(sys, "argv", ["stickslip-export", str(path), "--to", kind, "-o", str(folder)])
    export.run()


@pytest.mark.parametrize("deck", ["quadratic", "rigid_floor", "revolution"])
def test_frames_are_exported_with_names_of_components(
    deck: str, job: Job, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = job(Deck.read(ROOT / "tests" / "decks" / f"{deck}.inp"), "--frames", "3")
    with Result(path) as result:
        exported(monkeypatch, path, "vtu", tmp_path / "vtu")
        frames = len(result.frames)
        assert capsys.readouterr().out == f"wrote {tmp_path / 'vtu' / result.job}.pvd and {frames} more\n"
        series = pyvista.get_reader(tmp_path / "vtu" / f"{result.job}.pvd")
        assert np.array_equal(series.time_values, result.frames.times)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(tmp_path / "vtu" / f"{result.job}_{frames - 1:04d}.vtu"))
        reader.Update()
        stress = reader.GetOutput().GetCellData().GetArray("S")
        assert [stress.GetComponentName(k) for k in range(3)] == ["xx", "yy", "xy"]
        assert np.array_equal(vtk_to_numpy(stress), result.frames[-1].full("S"), equal_nan=True)
        exported(monkeypatch, path, "csv", tmp_path)
        table = pandas.read_csv(tmp_path / f"{result.job}.csv", index_col="time")
        assert table.equals(result.to_dataframe().astype(table.dtypes)) and len(table.columns) > 30
