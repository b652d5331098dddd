"""VTK's own reader opens the file and sees every frame; exported files hold the same."""

import sys
from pathlib import Path

import numpy as np
import pandas
import pytest
import pyvista
from ccx2paraview.common import FRD
from conftest import ROOT, Job
from decks import CANTILEVERS, parse, shortened
from stickslip import export
from stickslip.deck import Deck
from stickslip.result import Result
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersTensor import vtkYieldCriteria
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
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
                expected = results.frames[frame][name]
                assert np.array_equal(grid.cell_data[name][:, [0, 1, 3]], expected)
                assert np.array_equal(grid.cell_data[name][:, 2], results.frames[frame][f"{name}33"])
                assert not grid.cell_data[name][:, 4:].any()
            cells = results.file["model/bodies/element"][:]
            assert set(cells) == {0, 1}
            assert np.array_equal(grid.cell_data["BODY"], cells)
            rows = slice(frame * grid.n_cells, (frame + 1) * grid.n_cells)
            stored = results.file["VTKHDF/CellData/MISES"][rows]
            assert np.array_equal(grid.cell_data["MISES"], stored)


@pytest.mark.parametrize("deck", ["quadratic", "revolution", "plane_stress"])
def test_six_components_are_a_tensor_of_vtk(deck: str, job: Job, tmp_path: Path) -> None:
    """ParaView names six components XX YY ZZ XY YZ XZ, and its filters take them in this order."""
    text = (ROOT / "tests" / "decks" / f"{'quadratic' if deck == 'plane_stress' else deck}.inp").read_text()
    if deck == "plane_stress":
        text = text.replace("CPE", "CPS")
    grid = pyvista.HDFReader(str(job(parse(text, tmp_path), "--frames", "2")))
    grid.reader.UpdateInformation()
    grid.reader.SetStep(2)
    invariants = vtkYieldCriteria()
    invariants.SetInputData(grid.read())
    invariants.SetInputArrayToProcess(0, 0, 0, 1, "S")
    invariants.Update()
    found = pyvista.wrap(invariants.GetOutput()).cell_data
    size = found["MISES"].max()
    assert size > 0.0
    assert np.allclose(found["S - Von Mises Criterion"], found["MISES"], rtol=1e-12, atol=1e-12 * size)
    xx, yy, across = found["E"][:, :3].T
    assert (np.abs(across).max() > 0.0) == (deck != "quadratic")
    if deck == "plane_stress":  # the base of steel: no stress across it
        assert np.allclose(across[:4], -0.3 / 0.7 * (xx + yy)[:4], rtol=1e-9)


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
    monkeypatch.setattr(sys, "argv", ["stickslip export", str(path), "--to", kind, "-o", str(folder)])
    export.run()


DECKS = pytest.mark.parametrize("deck", ["quadratic", "rigid_floor", "revolution"])


@DECKS
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
        assert [stress.GetComponentName(k) for k in range(6)] == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
        assert np.array_equal(vtk_to_numpy(stress), result.frames[-1].rows("S"), equal_nan=True)
        exported(monkeypatch, path, "csv", tmp_path)
        table = pandas.read_csv(tmp_path / f"{result.job}.csv", index_col="time")
        assert table.equals(result.to_dataframe().astype(table.dtypes)) and len(table.columns) > 30


@DECKS
def test_a_series_of_xdmf_names_the_values_in_the_result(
    deck: str, job: Job, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = job(Deck.read(ROOT / "tests" / "decks" / f"{deck}.inp"), "--frames", "3")
    exported(monkeypatch, path, "xdmf", tmp_path / "a & b")
    reader = vtkXdmfReader()
    reader.SetFileName(str(tmp_path / "a & b" / f"{path.stem}.xdmf"))
    reader.UpdateInformation()
    with Result(path) as result:
        times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        assert np.array_equal(times, result.frames.times)
        for frame in result.frames:
            reader.UpdateTimeStep(frame.time)
            grid = pyvista.wrap(reader.GetOutputDataObject(0))
            whole = frame.to_pyvista()
            assert np.array_equal(grid.points, whole.points)
            lines = whole.celltypes == pyvista.CellType.LINE
            types = np.where(lines, pyvista.CellType.POLY_LINE, whole.celltypes)
            assert np.array_equal(grid.celltypes, types)
            assert np.array_equal(grid.cell_connectivity, whole.cell_connectivity)
            for name in ("U", "RF", "GAP", "CONTACT_STATUS"):
                assert np.array_equal(grid.point_data[name], whole.point_data[name], equal_nan=True), name
            for name in ("MISES", "BODY"):
                assert np.array_equal(grid.cell_data[name], whole.cell_data[name], equal_nan=True), name
            for name in ("S", "E"):
                for column, component in enumerate(("11", "22", "33", "12")):
                    expected = whole.cell_data[name][:, column]
                    assert np.array_equal(grid.cell_data[name + component], expected, equal_nan=True), name


@DECKS
def test_programs_around_calculix_read_the_frames(
    deck: str, job: Job, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = job(Deck.read(ROOT / "tests" / "decks" / f"{deck}.inp"), "--frames", "3")
    exported(monkeypatch, path, "frd", tmp_path)
    with (tmp_path / f"{path.stem}.frd").open() as text, Result(path) as result:
        found = FRD(text)
        found.parse_mesh()
        grid, whole = pyvista.wrap(found.ugrid), result.frames[0].to_pyvista()
        assert np.allclose(grid.points, whole.points, rtol=1e-5, atol=0.0)
        assert np.array_equal(grid.celltypes, whole.celltypes)
        assert np.array_equal(grid.cell_connectivity, whole.cell_connectivity)
        assert found.node_block.get_node_numbers() == sorted(result.node_labels)
        found.count_increments()
        for frame, (step, time) in zip(result.frames, found.steps_increments, strict=True):
            assert step == frame.index + 1 and time == pytest.approx(frame.time, rel=1e-5)
            blocks = {block.name: block for block in found.parse_results(step, time)}
            assert blocks["U"].components == ["D1", "D2", "D3"]
            assert blocks["S"].components == ["XX", "YY", "ZZ", "XY", "YZ", "ZX"]
            displacement, stress = (
                np.array([blocks[name].results[label] for label in result.node_labels]) for name in "US"
            )
            assert np.allclose(displacement[:, :2], frame["U"], rtol=1e-5, atol=1e-98)
            expected = np.insert(frame.nodal("S"), 2, frame.nodal("S33"), axis=1)
            assert np.allclose(stress[result.in_cells, :4], expected[result.in_cells], rtol=1e-5, atol=1e-98)
            assert not stress[:, 4:].any() and not displacement[:, 2].any()
        assert np.abs(stress).max() > 0.0
