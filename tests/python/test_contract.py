"""The result file holds what docs/output.md promises, for both examples."""

import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from compare import datasets, dimension
from conftest import ROOT, Job
from decks import BLOCK, CANTILEVERS, SHAPES, parse, shortened
from stickslip.deck import Deck
from stickslip.history import ENERGIES
from stickslip.result import Result

FRAMES = 5
EXAMPLES = {
    "block": (
        BLOCK / "block_slope_mu02.inp",
        40,
        "BLOCK_FACE_SLOPE_FACE",
        ("BLOCK", "BLOCK_CENTRE"),
    ),
    "cantilevers": (
        CANTILEVERS / "B_mu04.inp",
        200,
        "UPPER_FACE_LOWER_FACE",
        ("UPPER_TIP", "LOWER_TIP"),
    ),
}

POINT_DATA = {
    "U": ("f8", (3,), "length"),
    "V": ("f8", (3,), "length/time"),
    "A": ("f8", (3,), "length/time^2"),
    "RF": ("f8", (3,), "force"),
    "CONTACT_FORCE": ("f8", (3,), "force"),
    "GAP": ("f8", (), "length"),
    "CONTACT_STATUS": ("u1", (), "1"),
    "CONTACT_PRESSURE": ("f8", (), "force/length^2"),
    "SLIP": ("f8", (), "length"),
}
CELL_DATA = {
    "S": ("f8", (6,), "force/length^2"),
    "MISES": ("f8", (), "force/length^2"),
    "E": ("f8", (6,), "1"),
}
CONTACT = {
    "force": (2,),
    "moment": (),
    "normal": (),
    "tangential": (),
    "closed": (),
    "sticking": (),
    "min_gap": (),
    "friction_coefficient": (),
    "cone_violation": (),
    "impulse_cone_violation": (),
    "handover_work": (),
    "normal_work": (),
    "friction_dissipation": (),
    "landing_return": (),
    "release_loss": (),
    "return_impulse": (),
    "return_impulse_sum": (),
    "impulse": (2,),
    "normal_impulse": (),
    "tangential_impulse": (),
    "impact_normal_impulse": (),
    "impact_tangential_impulse": (),
    "impulse_sum": (2,),
    "normal_impulse_sum": (),
    "tangential_impulse_sum": (),
    "impact_normal_impulse_sum": (),
    "impact_tangential_impulse_sum": (),
}
BODIES = {
    "center": (2,),
    "velocity": (2,),
    "angular_velocity": (),
    "kinetic": (),
    "strain": (),
    "contact_force": (2,),
    "contact_moment": (),
}
SUMS = ("sum/RF", "sum/CF", "sum/CONTACT_FORCE", "mean/U", "mean/V", "mean/A")
SOLVER = (
    "passes lcps lcp_size pivots active_set_iterations gauss_seidel_sweeps lemke_calls "
    "factorizations held converged"
).split()
IMPACTS = {
    "time": (),
    "increment": (),
    "slave": (),
    "segment": (2,),
    "xi": (),
    "approach_speed": (),
}
RUN = (
    "program version commit deck deck_sha256 command started finished exit_status threads"
).split()


@pytest.fixture(params=EXAMPLES)
def example(request: pytest.FixtureRequest, job: Job) -> tuple[Path, int, str, tuple[str, ...]]:
    """Result file, increments, contact name, history sets."""
    deck, increments, contact, sets = EXAMPLES[request.param]
    path = job(shortened(deck, increments), "--frames", str(FRAMES))
    return path, increments, contact, sets


def test_every_dataset_says_what_it_is(example: tuple) -> None:
    with h5py.File(example[0]) as file:
        for name, data in datasets(file):
            assert data.attrs["description"], name
            dimension(data.attrs["dimension"])


def test_fields(example: tuple) -> None:
    with h5py.File(example[0]) as file:
        grid = file["VTKHDF"]
        assert grid.attrs["Type"] in (b"UnstructuredGrid", "UnstructuredGrid")
        nodes, elements = int(grid["NumberOfPoints"][0]), int(grid["NumberOfCells"][0])
        frames = grid["Steps/Values"].shape[0]
        assert frames == FRAMES + 1 == grid["Steps"].attrs["NSteps"]
        for group, fields, rows in (
            ("PointData", POINT_DATA, nodes),
            ("CellData", CELL_DATA, elements),
        ):
            for name, (kind, shape, unit) in fields.items():
                data = grid[group][name]
                assert data.dtype == np.dtype(kind), name
                assert data.shape == (frames * rows, *shape), name
                assert dimension(data.attrs["dimension"]) == dimension(unit), name


def test_model(example: tuple) -> None:
    with h5py.File(example[0]) as file:
        model = file["model"]
        nodes = model["node_labels"].shape[0]
        assert model["coordinates"].shape == (nodes, 2)
        assert np.array_equal(model["coordinates"][:], file["VTKHDF/Points"][:, :2])
        assert np.array_equal(model["connectivity"][:], file["VTKHDF/Connectivity"][:])
        assert model["element_labels"].shape[0] == file["VTKHDF/NumberOfCells"][0]
        for name in example[3]:
            members = model["node_sets"][name][:]
            assert members.size and members.min() >= 0 and members.max() < nodes


def test_histories_have_one_row_per_increment(example: tuple) -> None:
    path, increments, contact, sets = example
    rows = increments + 1
    with h5py.File(path) as file:
        history = file["history"]
        assert history.attrs["rows"] == rows
        for name in ("time", "dt", "step", "momentum/angular"):
            assert history[name].shape == (rows,), name
        assert history["momentum/linear"].shape == (rows, 2)
        for name in ENERGIES:
            assert history["energy"][name].shape == (rows,), name
        for name, shape in CONTACT.items():
            assert history["contact"][contact][name].shape == (rows, *shape), name
        for name in SOLVER:
            assert history["solver"][name].shape == (rows,), name
        landings = history["impacts/time"].shape[0]
        assert history["impacts"].attrs["rows"] == landings
        assert history["touches"].attrs["rows"] == len(history["touches/start"])
        for name, shape in IMPACTS.items():
            assert history["impacts"][name].shape == (landings, *shape), name
        assert set(history["nodes"]) == set(sets)
        for name in sets:
            nodes = history["nodes"][name]
            for field in ("U", "V", "RF"):
                assert nodes[field].shape == (rows, nodes["labels"].shape[0], 2)
            for field in SUMS:
                assert nodes[field].shape == (rows, 2)
            assert np.allclose(nodes["sum/RF"][:], nodes["RF"][:].sum(axis=1), atol=0.0)
            assert np.allclose(nodes["mean/U"][:], nodes["U"][:].mean(axis=1), atol=0.0)
        bodies = file["model/bodies/mass"].shape
        for name, shape in BODIES.items():
            assert history["bodies"][name].shape == (rows, *bodies, *shape), name
        for energy in ("kinetic", "strain"):
            total = history["energy"][energy][:]
            assert np.allclose(history["bodies"][energy][:].sum(axis=1), total, atol=1e-30)


RIGID = ROOT / "tests" / "decks" / "rigid_floor.inp"
GENERAL = SHAPES / "shapes_one.inp"


def documented() -> list[re.Pattern[str]]:
    """Paths of all datasets in the tables of docs/output.md, `<NAME>` and `*` being any name."""
    patterns, folder = [], ""
    text = (ROOT / "docs" / "output.md").read_text()
    for line in text.splitlines():
        if heading := re.match(r"### /(\w+)", line):
            folder = heading[1]
        if folder and line.startswith("| `"):
            names = re.findall(r"`([^`]+)`", line.split(" | ")[0])
            full = [re.sub(r"^\.\.\.", names[0].rpartition("/")[0], name) for name in names]
            patterns += [re.sub(r"<\w+>(_<\w+>)?|\*", "[^/]+", f"{folder}/{name}") for name in full]
    return [re.compile(pattern) for pattern in patterns]


@pytest.mark.parametrize("deck", [RIGID, GENERAL, CANTILEVERS / "B_mu04.inp"], ids=lambda d: d.stem)
def test_the_documents_name_every_dataset(deck: Path, job: Job) -> None:
    patterns = documented()
    with h5py.File(job(shortened(deck, 20), "--frames", "2")) as file:
        names = [name for name, _ in datasets(file)]
    missing = [name for name in names if not any(p.fullmatch(name) for p in patterns)]
    assert not missing


def test_a_rigid_surface_reacts_at_its_reference_node(job: Job) -> None:
    with h5py.File(job(Deck.read(RIGID), "--frames", "2")) as file:
        floor, contact = file["history/rigid/FLOOR"], file["history/contact/BOT_FLOOR"]
        force = contact["force"][:]
        assert np.abs(force).max() > 1.0
        scale = np.abs(force).max()
        assert np.allclose(floor["force"][:], force, rtol=0.0, atol=1e-12 * scale)
        moment = contact["reference_moment"][:]
        assert np.allclose(floor["moment"][:], moment, rtol=0.0, atol=1e-11 * scale)
        assert np.allclose(floor["V"][:], [0.5, 0.0], rtol=0.0, atol=1e-15)
        label = int(floor["node"][0])
        index = int(np.flatnonzero(file["model/node_labels"][:] == label)[0])
        nodes = file["model/node_labels"].size
        reaction = file["VTKHDF/PointData/RF"][-nodes:, :2]
        assert np.array_equal(reaction[index], floor["force"][-1])
        assert np.count_nonzero(reaction.any(axis=1)) <= 1, "nothing is counted twice"
        path = floor["position"][:] - floor["U"][:]
        assert np.allclose(path, [0.0, -1.0], rtol=0.0, atol=1e-15)


def test_totals_only_leaves_sums_and_means(tmp_path: Path, job: Job) -> None:
    text = RIGID.read_text().replace(
        "*END STEP", "*NODE PRINT, NSET=REF, TOTALS=ONLY\nRF\n*END STEP"
    )
    with h5py.File(job(parse(text, tmp_path), "--frames", "2")) as file:
        reference = file["history/nodes/REF"]
        assert set(reference) == {"labels", "sum", "mean"}
        force = file["history/rigid/FLOOR/force"][:]
        assert np.array_equal(reference["sum/RF"][:], force)


def test_run_record(example: tuple) -> None:
    with h5py.File(example[0]) as file:
        attributes = file["run"].attrs
        assert all(name in attributes for name in RUN)
        assert attributes["exit_status"] == 0
        assert "*NODE, NSET=" in attributes["deck"], "the deck's includes are in place"


def test_history_and_frames_agree(example: tuple) -> None:
    with Result(example[0]) as results:
        history = results.history.nodes[example[3][0]]
        index = np.searchsorted(results.node_labels, history.labels)
        last = len(results.frames) - 1
        assert results.frames.times[last] == results.history.time[-1]
        assert np.array_equal(results.frames[last]["U"][index], history.U[-1])
        assert np.array_equal(results.frames[last]["V"][index], history.V[-1])


def test_every_increment_converged_and_the_ledger_closes(example: tuple) -> None:
    with Result(example[0]) as results:
        assert results.history.solver["converged"].all()
        assert (
            np.abs(results.history.energy["balance"]).max() < 1e-8 * results.history.energy.largest
        )
