"""The package stickslip: results, meshes, decks made of them, runs and their errors, tutorials."""

import re
import runpy
import sys
from pathlib import Path

import h5py
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np
import pytest
import stickslip
import xarray
from conftest import ROOT, Job
from decks import CANTILEVERS, shortened
from stickslip import Deck, DeckRejected, Fault, Progress, Result, RunFailed, RunStopped
from stickslip.certificate.certify import certify
from stickslip.certificate.own import write_table
from stickslip.mesh import Mesh
from stickslip.plot.style import save
from stickslip.quantity import Members, find, listed
from stickslip.__main__ import main
from stickslip.sweep.table import Table
from stickslip.whole import whole

CONTACT = "UPPER_FACE_LOWER_FACE"
SQUARES = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]


@pytest.fixture
def result(job: Job) -> Result:
    """The cantilevers up to contact."""
    return Result(job(shortened(CANTILEVERS / "A_mu04.inp", 60), "--frames", "6"))


def test_histories_are_attributes_and_items(result: Result) -> None:
    with h5py.File(result.path, locking=False) as file:
        kinetic = file["history/energy/kinetic"][()]
        force = file[f"history/contact/{CONTACT}/force"][()]
        tip = file["history/nodes/UPPER_TIP/U"][()]
    assert np.array_equal(result.history.energy.kinetic, kinetic)
    assert np.array_equal(result.history["energy/kinetic"], kinetic)
    assert np.array_equal(result.contact[CONTACT].force, force) and force.any()
    assert np.array_equal(result.history.nodes["UPPER_TIP"].U, tip)
    assert np.array_equal(result.quantity("nodes/UPPER_TIP/U:2"), tip[:, :, 1].mean(axis=1))
    assert result.quantity("nodes/UPPER_TIP/U").shape == (61, 2)
    assert list(result.contact) == [CONTACT] and len(result.history.rigid) == 0
    assert "kinetic" in dir(result.history.energy) and "kinetic" in result.history.energy
    assert result.history.energy.get("heat") is None


def test_what_is_missing_is_told_with_what_there_is(result: Result) -> None:
    with pytest.raises(AttributeError, match="energy has no heat; there is .*kinetic"):
        _ = result.history.energy.heat
    with pytest.raises(Fault, match=f"contact has no A_B; there is {CONTACT}"):
        _ = result.contact["A_B"]
    with pytest.raises(Fault, match="has no field MISSES; there are .*MISES"):
        _ = result.frames[0]["MISSES"]
    assert "MISSES" not in result.frames[0] and "MISES" in result.frames[0]
    energy = result.history.energy
    result.file.close()
    with pytest.raises(Fault, match="is closed"):
        _ = energy.kinetic


def test_frames_by_time(result: Result) -> None:
    assert len(result.frames) == 7 and result.frames[-1].time == result.history.time[-1]
    assert result.frame(0.44).index == 3 and result.frame(0.9).index == 6
    for time in (-0.01, 0.91, np.nan):
        with pytest.raises(Fault, match="has frames from t = 0 to 0.9"):
            result.frame(time)
    frame = result.frame(0.9)
    assert frame["U"].shape == (126, 2) and frame["S"].shape == (80, 3)
    assert frame["MISES"].shape == (80,) and frame["BODY"].shape == (80,)
    assert np.array_equal(frame.positions, result.coordinates + frame["U"])
    assert result.frames[1:3] == [result.frames[1], result.frames[2]]


def test_a_dataframe_has_the_names_of_quantities(result: Result) -> None:
    table = result.to_dataframe()
    assert np.array_equal(table.index, result.history.time)
    label = result.history.nodes["UPPER_TIP"].labels[1]
    names = ["energy/kinetic", f"contact/{CONTACT}/force:2", "bodies/velocity[1]:1"]
    for name in [*names, f"nodes/UPPER_TIP[{label}]/U:2", "solver/passes"]:
        assert np.array_equal(table[name], result.quantity(name)), name
    assert not any(name.startswith("impacts") for name in table)


LOCAL = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
9, 1., 3.
*ELEMENT, TYPE=CPE4I, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*ELEMENT, TYPE=SPRINGA, ELSET=K
9, 9, 3
*SPRING, ELSET=K

2.
*BOUNDARY
9, 1, 2
1, 1, 2
2, 1, 2
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.01, 0.2
*CLOAD
3, 2, 1.
*EL PRINT, ELSET=E, POSITION=INTEGRATION POINTS
S
*EL PRINT, ELSET=E, POSITION=NODES
S
*END STEP
"""
"""One element, with values at its points and its nodes, and a spring."""

SLOW = ("beam_lands_with_events", "stack_with_events")
REJECTED = ("cycle", "faulty_include", "keyword_in_rows", "missing_include")


@pytest.fixture(scope="module")
def all_decks(job: Job) -> list[Path]:
    """Results of the decks of tests/decks, and of one with what these lack."""
    paths = sorted((ROOT / "tests" / "decks").glob("*.inp"))
    decks = [Deck.read(path) for path in paths if path.stem not in SLOW + REJECTED]
    return [job(deck, "--frames", "1") for deck in [*decks, Deck.parse(LOCAL)]]


def converted(result: Result, netcdf: Path) -> set[str]:
    """Kinds of members of a result of which every history and field converts."""
    rows = result.file["history"].attrs["rows"]
    frame = result.frames[-1]
    table, data = result.to_dataframe(), result.to_xarray(*frame)
    assert len(table) == len(data.time) == result.rows == rows
    histories = {name.replace("/", ".") for name in result.histories}
    assert set(data.data_vars) == histories - {"time"} | set(frame)
    data.to_netcdf(netcdf, engine="h5netcdf")
    with xarray.open_dataset(netcdf, engine="h5netcdf") as back:
        assert back.equals(data)
    grid = frame.to_pyvista()
    found = {*grid.point_data, *grid.cell_data}
    assert found == {stored for stored, _ in result.frames.stored.values()}
    for name in set(frame) - found:  # the components across the plane stand in the tensors
        tensor = grid[name.replace("33", "")]
        assert np.array_equal(tensor[:, 2], frame.full(name), equal_nan=True), name
    for name in table:
        assert np.array_equal(table[name], result.quantity(name), equal_nan=True), name
    for name in listed(result):
        path = re.sub(r":1 to :\d+$", "", name)
        if "[" not in path:  # else the name of a member is to be chosen
            assert len(find(result, path).parts) == (1 if path == name else int(name[-1])), name
    return {Members.of(result, path).kind for path in result.histories}


def test_every_history_and_field_of_every_deck_converts(all_decks: list[Path], tmp_path: Path) -> None:
    """All rows are there, and every column has the name that `quantity` and plots use."""
    places = set()
    for path in all_decks:
        with Result(path) as result:
            places |= converted(result, tmp_path / "all.nc")
    assert places == {"", "body", "node", "element", "point", "hinge"}
    local = Result(all_decks[-1])
    assert local.rows == 21
    data = local.to_xarray()
    assert data["connectors.force"].dims == ("time", "connectors")
    assert data["elements.E.points.S"].dims == ("time", "elements.E.points", "tensor")
    assert list(data["elements.E.points"].values) == ["1.1", "1.2", "1.3", "1.4"]
    assert list(data["elements.E.at_nodes"].values) == [1, 2, 3, 4]
    for place, third in (("points", "1.3"), ("at_nodes", "3")):
        stress = local.file[f"history/elements/E/{place}/S"][()]
        assert np.array_equal(local.quantity(f"elements/E/{place}[{third}]/S"), stress[:, 2])
        assert np.array_equal(local.quantity(f"elements/E/{place}/S"), stress.mean(axis=1))
    assert certify(local).holds


def test_files_are_written_whole_and_through_no_link(
    result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    precious = tmp_path / "precious"
    precious.write_text("precious")
    with pytest.raises(ZeroDivisionError), whole(tmp_path / "out.csv") as draft:
        draft.write_text(str(1 / 0))
    with whole(tmp_path / "out.csv") as draft:
        draft.write_text("all")
        assert not (tmp_path / "out.csv").exists()
    assert (tmp_path / "out.csv").read_text() == "all"
    for name in ("deck.inp", "page.html", "checks.csv", "table.csv", "picture.png"):
        (tmp_path / name).symlink_to(precious)
    table = Table(["mu"], [], [])
    figure = plt.figure()
    for write in (
        lambda: falling(3).write(tmp_path / "deck.inp"),
        lambda: write_table(result, tmp_path / "checks.csv"),
        lambda: table.write(tmp_path),
        lambda: save(figure, tmp_path / "picture.png"),
    ):
        with pytest.raises(Fault, match="is no regular file"):
            write()
    line = ["stickslip", "report", str(result.path), "-o", str(tmp_path / "page.html")]
    monkeypatch.setattr(sys, "argv", line)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    plt.close(figure)
    assert precious.read_text() == "precious"
    assert not list(tmp_path.glob("*.part*")) and not list(tmp_path.glob(".*"))


def test_xarray_has_axes_labels_and_dimensions(result: Result) -> None:
    data = result.to_xarray("U", "MISES")
    tip = data["nodes.UPPER_TIP.U"]
    assert tip.dims == ("time", "nodes.UPPER_TIP", "component")
    label = int(result.history.nodes["UPPER_TIP"].labels[0])
    chosen = tip.sel({"nodes.UPPER_TIP": label, "component": "2"})
    assert np.array_equal(chosen, result.quantity(f"nodes/UPPER_TIP[{label}]/U:2"))
    assert tip.attrs["dimension"] == "length" and data.attrs["job"] == result.job
    assert data["bodies.velocity"].dims == ("time", "body", "component")
    assert data["MISES"].dims == ("frame", "element")
    node = int(result.node_labels[7])
    shown = data["U"].sel(frame=0.9, node=node, method="nearest")
    assert np.array_equal(shown, result.frames[-1]["U"][7])


def test_pyvista_has_fields_and_rigid_segments(job: Job) -> None:
    with Result(job(Deck.read(ROOT / "tests/decks/rigid_floor.inp"), "--frames", "1")) as result:
        assert len(result.rigid)
        grid = result.frames[-1].to_pyvista()
        assert grid.n_points == len(result.coordinates)
        assert grid.n_cells == len(result.cells) + len(result.rigid)
        assert np.array_equal(grid.point_data["U"][:, :2], result.frames[-1]["U"])
        mises = grid.cell_data["MISES"]
        assert np.array_equal(mises[: len(result.cells)], result.frames[-1]["MISES"])
        assert grid.warp_by_vector("U").bounds != grid.bounds
        x, y = result.coordinates[result.cells[0]].T
        area = 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
        assert grid.compute_cell_sizes()["Area"][0] == pytest.approx(area)


def test_warnings_are_those_of_the_log(result: Result) -> None:
    assert any(text.startswith("the time integration scheme changed") for text in result.warnings)
    assert not any("\n" in text for text in result.warnings)


# Runs.


def test_a_rejected_deck_is_told_with_places(tmp_path: Path) -> None:
    path = tmp_path / "bad.inp"
    path.write_text("*NODE\n1, 0., x\n*BOUNDRY\n1, 2\n")
    with pytest.raises(DeckRejected) as told:
        stickslip.run(path, tmp_path)
    first, second = told.value.diagnostics[:2]
    assert (first.severity, first.code, first.line, first.column) == ("error", "D108", 2, 8)
    assert first.file == str(path) and "expected a number" in first.message
    assert (second.line, second.column) == (3, 1) and told.value.code == 2
    with pytest.raises(DeckRejected):
        stickslip.check(path)


def falling(increments: int = 20) -> Deck:
    """A square above another one, meshed with numpy arrays."""
    deck = Deck.titled("falling square")
    lower = [[0, 1, 4, 3], [1, 2, 5, 4]]
    sides = {"TOP": [[5, 4], [3, 4]]}
    deck.add_mesh(Mesh(SQUARES, lower, {"BASE": [0, 1]}, {"FLOOR": [0, 1, 2]}, sides))
    points = np.array(SQUARES)[[0, 1, 3, 4]] * 0.5 + np.array([0.7, 1.001])
    block = Mesh(points, [[0, 1, 3], [0, 2, 3]], {"BLOCK": [0, 1]}, {}, {"BOTTOM": [[0, 1]]})
    assert deck.add_mesh(block) == 7
    deck.elastic("SOFT", 1e4, 0.3, 1.0, alpha=0.1).section("BASE", "SOFT").section("BLOCK", "SOFT")
    deck.contact("BOTTOM", "TOP", friction=0.2).support("FLOOR").velocity("BLOCK", 0.0, -1.0)
    with deck.step(1e-3, increments * 1e-3, impact_time="EVENT"):
        deck.gravity("BLOCK", 10.0).history("BLOCK")
    return deck


def test_a_deck_of_arrays_runs(tmp_path: Path) -> None:
    deck = falling()
    (warning,) = stickslip.check(deck)
    assert (warning.severity, warning.code) == ("warning", "D417"), "damping of a free body"
    told: list[Progress] = []
    with stickslip.run(deck, tmp_path, job="square", frames=4, progress=told.append) as result:
        assert result.path == tmp_path / "square.vtkhdf" and len(result.frames) == 5
        assert result.contact["BOTTOM_TOP"].closed.max() == 2
        assert result.coordinates.shape == (10, 2) and len(result.cells) == 4
        assert result.read("model/bodies/mass") == pytest.approx([2.0, 0.25])
        # the triangle that was given clockwise is turned
        x, y = result.coordinates[result.cells[3]].T
        assert x @ np.roll(y, -1) - y @ np.roll(x, -1) > 0.0
        assert result.history.nodes["BLOCK"].V[0, :, 1] == pytest.approx(-1.0)
    assert told[-1].part == pytest.approx(1.0) and told[-1].end == pytest.approx(0.02)


def test_a_run_that_stops_keeps_its_result(tmp_path: Path) -> None:
    """With one pass for an increment none converges, however small."""
    deck = falling()
    deck.set_settings(MAX_PASSES="1")
    with pytest.raises(RunStopped) as told:
        stickslip.run(deck, tmp_path)
    assert told.value.code == 1 and "increment 1" in told.value.message
    assert told.value.result.history.time[-1] == 0.0 and len(told.value.result.frames) == 1


def test_options_are_those_of_the_program(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="run has no option fames"):
        stickslip.run(falling(), tmp_path, fames=3)
    with pytest.raises(RunFailed) as told:
        stickslip.run(falling(), tmp_path, threads=100000)
    assert told.value.code == 3 and "threads" in str(told.value)
    stickslip.run(falling(2), tmp_path)
    with pytest.raises(RunFailed, match="--overwrite"):
        stickslip.run(falling(2), tmp_path, overwrite=False)
    (tmp_path / "file").touch()
    with pytest.raises(Fault, match="file cannot be written"):
        stickslip.run(falling(2), tmp_path / "file")
    with pytest.raises(RunFailed, match="none.inp"):
        stickslip.run(tmp_path / "none.inp", tmp_path, progress=True)


def test_progress_is_that_of_this_run(tmp_path: Path) -> None:
    """The status file of an earlier run counts only when this run has written it."""
    stickslip.run(falling(2), tmp_path)
    told: list[Progress] = []
    stickslip.run(falling(20), tmp_path, checkpoint=60, progress=told.append)
    assert told[0].increment == 0 and told[-1].increment >= 20
    stickslip.run(falling(20), tmp_path, resume=True, extend=0.004, progress=told.append)
    assert told[-1].increment >= 24 and told[-1].end is None and told[-1].part is None


# Meshes.


def test_a_mesh_that_is_none_is_told() -> None:
    quads = [[0, 1, 4, 3], [1, 2, 5, 4]]
    with pytest.raises(Fault, match="the elements have node 6: there are 0 to 5"):
        Mesh(SQUARES, [[0, 1, 6, 3]])
    with pytest.raises(Fault, match="element 0 has 5 nodes"):
        Mesh(SQUARES, [[0, 1, 2, 4, 3]])
    six = Mesh([[0, 0], [2, 0], [0, 2], [1, 0], [1, 1], [0, 1]], [[0, 2, 1, 5, 4, 3]])
    assert list(six.elements[0]) == [1, 2, 0, 4, 5, 3]
    with pytest.raises(Fault, match="not plane"):
        Mesh([[*point, 0.1 * point[0]] for point in SQUARES], quads)
    with pytest.raises(Fault, match="whole numbers"):
        Mesh(SQUARES, quads, {"A": [0.5]})
    with pytest.raises(Fault, match="S: the side from node 1 to 4 belongs to two elements"):
        Mesh(SQUARES, quads, sides={"S": [[1, 4]]}).faces("S")
    with pytest.raises(Fault, match="S: the side from node 0 to 4 belongs to no element"):
        Mesh(SQUARES, quads, sides={"S": [[0, 4]]}).faces("S")
    assert Mesh(SQUARES, quads, sides={"S": [[5, 4], [0, 1]]}).faces("S") == [(1, 3), (0, 1)]


@pytest.mark.parametrize("order", [1, 2])
def test_gmsh_and_meshio_give_the_same_mesh(tmp_path: Path, order: int) -> None:
    gmsh, meshio = pytest.importorskip("gmsh"), pytest.importorskip("meshio")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addRectangle(0.0, 0.0, 0.0, 2.0, 1.0, tag=1)
        gmsh.model.occ.addRectangle(3.0, 0.0, 0.0, 1.0, 1.0, tag=2)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.setRecombine(2, 2)
        bottom = gmsh.model.getEntitiesInBoundingBox(-1, -0.1, -1, 2.5, 0.1, 1, dim=1)
        gmsh.model.addPhysicalGroup(2, [1], name="LEFT")
        gmsh.model.addPhysicalGroup(2, [2], name="RIGHT")
        gmsh.model.addPhysicalGroup(1, [tag for _, tag in bottom], name="BOTTOM")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        direct = Mesh.from_gmsh(gmsh.model)
        gmsh.write(str(tmp_path / "mesh.msh"))
    finally:
        gmsh.finalize()
    read = Mesh.from_meshio(meshio.read(tmp_path / "mesh.msh"))
    for mesh in (direct, read):
        assert {len(element) for element in mesh.elements} == {3 * order, 4 * order}
        assert {len(mesh.elements[at]) for at in mesh.element_sets["LEFT"]} == {3 * order}
        floor = mesh.points[mesh.node_sets["BOTTOM"]]
        assert np.all(floor[:, 1] == 0.0) and sorted(floor[:, 0])[:: len(floor) - 1] == [0.0, 2.0]
        assert len(mesh.faces("BOTTOM")) * order == len(floor) - 1

        def area(name: str, mesh: Mesh = mesh) -> float:
            nodes = [mesh.elements[at] for at in mesh.element_sets[name]]
            corners = [mesh.points[one[: len(one) // order]] for one in nodes]
            return sum(
                0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
                for x, y in (corner.T for corner in corners)
            )

        assert (area("LEFT"), area("RIGHT")) == pytest.approx((2.0, 1.0))
    assert len(direct.points) == len(read.points)
    assert len(direct.elements) == len(read.elements)


# Tutorials.


def test_the_tutorial_from_a_geometry_to_a_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("gmsh")
    monkeypatch.chdir(tmp_path)
    names = runpy.run_path(str(ROOT / "docs" / "tutorial_gmsh.py"))
    plt.close("all")
    picture = matplotlib.image.imread(tmp_path / "results" / "tutorial_gmsh.png")
    assert min(picture.shape[:2]) > 300 and picture.std() > 0.01
    result = names["result"]
    assert names["contact"].closed.max() > 1
    assert abs(result.history.energy.balance).max() < 1e-8 * result.history.energy.largest
    assert "most nodes in contact" in capsys.readouterr().out


def test_the_tutorial_of_a_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The block slides as far as the formula says."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    names = runpy.run_path(str(ROOT / "docs" / "tutorial_study.py"))
    look = {"dashboard_address": ":0", "silence_logs": "CRITICAL"}
    with distributed.LocalCluster(1, 1, processes=False, **look) as cluster:
        settings = stickslip_settings(names["Settings"], cluster.scheduler_address)
        monkeypatch.setitem(names["main"].__globals__, "Settings", settings)
        names["main"]()
    rows = [line for line in capsys.readouterr().out.splitlines() if line.startswith("mu ")]
    assert len(rows) == 6
    for row in rows:
        way, formula = (float(row.replace(",", " ").split()[at]) for at in (4, 6))
        assert way == pytest.approx(formula, rel=0.01)


def stickslip_settings(settings: type, address: str) -> object:
    """Settings of a study on the cluster of a test."""
    return lambda **options: settings(scheduler=address, **options)


def test_what_the_document_says_works(
    result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The blocks of docs/python.md, one after the other, beside a result and a deck of their names."""
    text = (ROOT / "docs" / "python.md").read_text()
    blocks = [part.partition("```")[0] for part in text.split("```python\n")[1:]]
    assert len(blocks) > 4
    (tmp_path / "job.vtkhdf").write_bytes(result.path.read_bytes())
    falling(3).write(tmp_path / "block.inp")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["python"])
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)
