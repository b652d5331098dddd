"""The certificate of results, and the oracle beside it: they hold for what the program writes, and fail for every spoiled quantity."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import COMMAND, ROOT, Job
from decks import CANTILEVERS, parse, shortened
from oracle.checks import TEXTS as OF_ORACLE
from oracle.checks import assert_holds, recompute
from stickslip.certificate.certify import Certificate, certify
from stickslip.certificate.check import Check
from stickslip.certificate.histories import OWN
from stickslip.certificate.own import own_checks, write_table
from stickslip.deck import Deck
from stickslip.errors import Fault
from stickslip.penetration.intrusion import compare
from stickslip.penetration.outlines import outlines
from stickslip.result import Result

DECKS = ROOT / "tests" / "decks"
CONTACT = "UPPER_FACE_LOWER_FACE"

Spoil = Callable[[h5py.File], object]


@pytest.fixture(scope="module")
def result(job: Job) -> Path:
    """The cantilevers in contact, with friction; every second increment is a frame."""
    return job(shortened(CANTILEVERS / "B_mu04.inp", 60), "--frames", "30")


def copied(result: Path, folder: Path, spoil: Spoil) -> Path:
    """A copy of a result that has been spoiled."""
    path = Path(shutil.copy(result, folder / "spoiled.vtkhdf"))
    with h5py.File(path, "r+") as file:
        spoil(file)
    return path


def spoiled(result: Path, folder: Path, spoil: Spoil) -> Certificate:
    """The certificate of a copy of a result that has been spoiled."""
    return certify(copied(result, folder, spoil))


def broken(certificate: Certificate) -> list[str]:
    """Names of the checks that fail."""
    return [check.name for check in certificate.checks if not check.holds]


def add(path: str, part: float, at: tuple[int, ...] | None = None) -> Spoil:
    """Adds a part of the largest value to one number of a dataset: its largest, where none is named."""

    def spoil(file: h5py.File) -> None:
        values = file[path][()]
        size = np.abs(np.nan_to_num(values.astype(float)))
        place = at or np.unravel_index(size.argmax(), values.shape)
        values[place] += part * (size.max() or 1.0)
        file[path][...] = values

    return spoil


def accelerate(file: h5py.File) -> None:
    """Changes the largest acceleration of a node without support in the last frame."""
    values = file["VTKHDF/PointData/A"][()]
    last = values[-file["model/node_labels"].size :]
    size = np.abs(last).max(axis=1)
    size[file["model/supported_nodes"][()]] = 0.0
    last[size.argmax()] *= 1.0 + 1e-6
    file["VTKHDF/PointData/A"][...] = values


def shift(field: str, status: int, amount: float) -> Spoil:
    """Adds an amount to a field, at one of the slave nodes that have a contact state."""

    def spoil(file: h5py.File) -> None:
        states = file["VTKHDF/PointData/CONTACT_STATUS"][()]
        data = file[f"VTKHDF/PointData/{field}"]
        values = data[()]
        finite = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        rows = np.flatnonzero((states == status) & finite)
        row = int(rows[len(rows) // 2])
        values[row] += amount
        data[...] = values

    return spoil


def turned(file: h5py.File) -> None:
    """Turns the contact forces of the last frame that has some, which takes them out of their cones."""
    data = file["VTKHDF/PointData/CONTACT_FORCE"]
    force = data[()]
    force[:, :2] = force[:, 1::-1] * (1.0, -1.0)
    data[...] = force


def forget_balance(file: h5py.File) -> None:
    """Books a millionth of the energy where it does not belong."""
    file["history/energy/balance"][-1] += 1e-6 * file["history/energy/strain"][()].max()


def less_friction(file: h5py.File) -> None:
    """Less friction than the forces have needed."""
    file[f"model/contacts/{CONTACT}/friction"][...] *= 0.5


def less_of_the_law(file: h5py.File) -> None:
    """A law of less friction than the forces have: what a run with a wrong coefficient writes."""
    file[f"model/contacts/{CONTACT}/friction_coefficients"][...] *= 0.9


def more_of_the_law(file: h5py.File) -> None:
    """A law of more friction than nodes have that slip."""
    file[f"model/contacts/{CONTACT}/friction_coefficients"][...] *= 1.1


SPOILED: dict[str, tuple[Spoil, str]] = {
    "a displacement": (add("VTKHDF/PointData/U", 1e-6), "stresses"),
    "a displacement of a set": (add("VTKHDF/PointData/U", 1e-6), "accounts"),
    "a velocity": (add("VTKHDF/PointData/V", 1e-6), "kinetic energy"),
    "an acceleration": (accelerate, "equilibrium"),
    "a reaction": (add("VTKHDF/PointData/RF", 1e-6), "equilibrium"),
    "a contact force": (add("VTKHDF/PointData/CONTACT_FORCE", 1e-6), "equilibrium"),
    "the sum of contact forces": (add("VTKHDF/PointData/CONTACT_FORCE", 1e-6), "action"),
    "turned contact forces": (turned, "cone"),
    "a gap of a closed node": (shift("GAP", 2, 1e-6), "gap"),
    "a gap of an open node": (shift("GAP", 1, 1e-4), "gap"),
    "a state": (shift("CONTACT_STATUS", 1, 1), "gap"),
    "a force where nothing touches": (shift("CONTACT_FORCE", 1, 1e-3), "complementarity"),
    "no number": (add("VTKHDF/PointData/V", np.nan), "time"),
    "a stress": (add("VTKHDF/CellData/S", 1e-6), "stresses"),
    "a strain": (add("VTKHDF/CellData/E", 1e-6), "strains"),
    "a stress beside its invariants": (add("VTKHDF/CellData/S", 1e-6), "invariants"),
    "a stress of von Mises": (add("VTKHDF/CellData/MISES", 1e-6), "invariants"),
    "a stress across": (add("VTKHDF/CellData/S", 1e-3, (-1, 2)), "invariants"),
    "the time": (add("history/time", 1e-6), "time"),
    "an increment": (add("history/dt", 1e-6), "time"),
    "a pass": (add("history/solver/converged", -1.0), "time"),
    "a residual": (add("history/certificate/residual", 1e5), "law"),
    "an overlap": (add("history/certificate/overlap", 1e-6), "law"),
    "a gap of the solver": (add("history/certificate/gap", 1e9), "law"),
    "a slip of the solver": (add("history/certificate/slip", 1e9), "law"),
    "a density": (add("model/materials/density", 1e-6), "mass"),
    "a mass": (add("model/bodies/mass", 1e-6), "mass"),
    "a modulus": (add("model/materials/young", 1e-6), "stresses"),
    "a thickness": (add("model/thickness", 1e-6), "mass"),
    "a coordinate": (add("model/coordinates", 1e-6), "stresses"),
    "friction": (less_friction, "cone"),
    "the law of friction": (less_of_the_law, "cone"),
    "more friction by the law": (more_of_the_law, "cone"),
    "cone": (add(f"history/contact/{CONTACT}/cone_violation", 1e-6), "cone"),
    "impulse cone": (add(f"history/contact/{CONTACT}/impulse_cone_violation", 1e-6), "cone"),
    "a normal force": (add(f"history/contact/{CONTACT}/normal", -2.0), "cone"),
    "a tangential force": (add(f"history/contact/{CONTACT}/tangential", 9.0), "cone"),
    "a resultant": (add(f"history/contact/{CONTACT}/force", 1e-6), "accounts"),
    "an impulse": (add(f"history/contact/{CONTACT}/impulse", 1e-6), "accounts"),
    "a sum of impulses": (add(f"history/contact/{CONTACT}/normal_impulse_sum", 1e-6), "accounts"),
    "the work of a contact": (add(f"history/contact/{CONTACT}/normal_work", 1e-6), "accounts"),
    "the friction of a contact": (
        add(f"history/contact/{CONTACT}/friction_dissipation", 1e-6),
        "accounts",
    ),
    "a momentum": (add("history/momentum/linear", 1e-6), "momentum"),
    "the angular momentum": (add("history/momentum/angular", 1e-6, (-1,)), "momenta"),
    "a velocity of a body": (add("history/bodies/velocity", 1e-6), "momentum"),
    "a centre": (add("history/bodies/center", 1e-6, (-1, 0, 0)), "momenta"),
    "an energy of a body": (add("history/bodies/strain", 1e-6, (-1, 0)), "strain energy"),
    "a motion of a body": (add("history/bodies/kinetic", 1e-6, (-1, 0)), "kinetic energy"),
    "the sum of strain energies": (add("history/bodies/strain", 1e-6, (-1, 0)), "accounts"),
    "the sum of kinetic energies": (add("history/bodies/kinetic", 1e-6, (-1, 0)), "accounts"),
    "a force on a body": (add("history/bodies/contact_force", 1e-6), "accounts"),
    "a history of a node": (add("history/nodes/UPPER_TIP/U", 1e-6, (-1, 0, 0)), "accounts"),
    **{
        f"the account {name}": (add(f"history/energy/{name}", 1e-3), "balance")
        for name in (
            "kinetic",
            "strain",
            "external_work",
            "normal_contact_work",
            "friction_dissipation",
            "impact_loss",
            "landing_return",
            "release_loss",
            "damping",
            "material_dissipation",
            "numerical_dissipation",
        )
    },
    "the balance": (forget_balance, "balance"),
}
"""What is spoiled, how, and a check that must fail."""


def test_a_result_holds(result: Path) -> None:
    certificate = certify(result)
    assert certificate.holds and not broken(certificate), certificate.table()
    assert certificate.line.startswith("all ")
    told = {check.name: check for check in certificate.checks if check.is_told}
    assert {"gap", "cone", "complementarity", "balance", "penetration", "invariants"} <= set(told)
    # the figures are round-off: a bound is not merely wide
    for name in ("action", "cone", "gap", "invariants"):
        assert told[name].shown()[0] < 1e-13, (name, told[name])


def test_the_elements_of_a_result_are_those_of_the_oracle(result: Path) -> None:
    certificate = recompute(result)
    assert certificate.holds, certificate.table()
    told = {check.name: check for check in certificate.checks if check.is_told}
    assert {*told} == {*OF_ORACLE}
    for name in ("strain energy", "kinetic energy", "momenta", "mass"):
        assert told[name].shown()[0] < 1e-13, (name, told[name])
    assert told["equilibrium"].shown()[0] < 1e-11 and told["equilibrium"].count > 1000


@pytest.mark.parametrize("law", [4, 77])
def test_a_law_that_nobody_knows_is_no_false_alarm(result: Path, tmp_path: Path, law: int) -> None:
    def rename(file: h5py.File) -> None:
        """Another number of every law, and constants that no equation of the oracle has."""
        file["model/materials/law"][...] = law
        file["model/materials/shape"][...] = np.nan

    path = copied(result, tmp_path, rename)
    found, before = certify(path), certify(result)
    assert found.holds and found.line == before.line
    assert found.table() == before.table()
    of_oracle = {check.name: check for check in recompute(path).checks}
    assert all(check.holds for check in of_oracle.values())
    untold = {"strain energy", "stresses", "equilibrium"}
    assert {name for name, check in of_oracle.items() if not check.is_told} == untold
    for name in untold:
        assert f"elements of the law {law} are left out: the oracle does not know it" in of_oracle[name].reasons


def test_an_element_type_that_nobody_knows_is_no_false_alarm(result: Path, tmp_path: Path) -> None:
    def rename(file: h5py.File) -> None:
        file["model/element_types"][...] = 77

    path = copied(result, tmp_path, rename)
    assert certify(path).table() == certify(result).table()
    of_oracle = recompute(path).checks
    assert not any(check.is_told for check in of_oracle)
    assert {reason for check in of_oracle for reason in check.reasons} == {"the oracle does not know the element type 77"}


def test_the_run_keeps_its_checks_in_one_table(result: Path, tmp_path: Path) -> None:
    with Result(result) as read:
        checks = {check.name.rpartition("/")[2]: check for check in own_checks(read)}
        # two bodies, one of which is clamped: no momentum is kept
        assert {*checks} == {*OWN, "penetration"} - {"momentum", "surface_work"}
        bounds = {name: check.bound for name, check in checks.items() if name != "penetration"}
        assert bounds == {name: OWN[name] for name in bounds}
        assert np.isnan(checks["penetration"].bound)
        for name in ("cone", "impulse_cone"):
            of_contacts = [contact[f"{name}_violation"] for contact in read.contact.values()]
            assert (checks[name].values == np.max(of_contacts, axis=0)).all()
        energy = read.history.energy
        accounts = [np.abs(energy[name]) for name in ("kinetic", "strain", "external_work")]
        largest = np.maximum.accumulate(np.max(accounts, axis=0))
        assert np.allclose(
            checks["balance"].values * largest, np.abs(energy.balance), rtol=1e-14, atol=0.0
        )
        write_table(read, tmp_path / "own.csv")
        increments = len(largest)
    rows = (tmp_path / "own.csv").read_text().splitlines()
    assert len(rows) == increments + 1
    assert rows[0].startswith("increment,time,certificate/")


@pytest.mark.parametrize("what", SPOILED)
def test_a_spoiled_file_fails(result: Path, tmp_path: Path, what: str) -> None:
    spoil, check = SPOILED[what]
    path = copied(result, tmp_path, spoil)
    certificate = recompute(path) if check in OF_ORACLE else certify(path)
    assert not certificate.holds
    assert check in broken(certificate), certificate.table()
    assert " fail: " in certificate.line and check in certificate.line


def test_a_node_inside_of_a_body_fails(result: Path, tmp_path: Path) -> None:
    def push(file: h5py.File) -> None:
        """Moves a slave node that is closed by a hundredth of an edge into its master."""
        states = file["VTKHDF/PointData/CONTACT_STATUS"][()]
        force = file["VTKHDF/PointData/CONTACT_FORCE"][()]
        row = int(np.flatnonzero(states >= 2)[-1])
        values = file["VTKHDF/PointData/U"][()]
        values[row] -= 1e-2 * force[row] / np.linalg.norm(force[row])
        file["VTKHDF/PointData/U"][...] = values

    path = copied(result, tmp_path, push)
    assert {"gap", "penetration", "complementarity"} <= set(broken(certify(path)))
    assert "equilibrium" in broken(recompute(path))


def test_edges_that_cross_beyond_what_is_recorded_fail(job: Job, tmp_path: Path) -> None:
    deck = parse(CROSSING, tmp_path)
    path = job(deck, "--frames", "20")
    certificate = certify(path)
    assert certificate.holds, certificate.table()
    with Result(path) as result:
        assert result.history.certificate.penetration.max() > 1e-3

    def forget(file: h5py.File) -> None:
        file["history/certificate/penetration"][...] = 0.0

    assert broken(spoiled(path, tmp_path, forget)) == ["crossing"]


def test_nodes_between_means_are_as_deep_as_is_recorded(job: Job, tmp_path: Path) -> None:
    path = job(Deck.read(DECKS / "quadratic_means.inp"), "--frames", "1")
    with Result(path) as result:
        assert result.history.certificate.penetration.max() > 5e-5
        found = compare(result.frames[-1].positions, outlines(result))
        assert result.history.certificate.penetration[-1] == pytest.approx(found.depth, rel=1e-6)
    assert certify(path).holds

    def forget(file: h5py.File) -> None:
        file["history/certificate/penetration"][...] = 0.0

    assert broken(spoiled(path, tmp_path, forget)) == ["crossing"]


CROSSING = """*HEADING
the corner of a narrow punch between the nodes of a block that is the slave
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
5, 0., 1.
6, 1., 1.
7, 2., 1.
8, 3., 1.
11, 0.9, 1.01
12, 1.5, 1.01
13, 0.9, 2.
14, 1.5, 2.
*NSET, NSET=FLOOR
1, 2, 3, 4
*NSET, NSET=HEAD
13, 14
*ELEMENT, TYPE=CPE4, ELSET=BLOCK
1, 1, 2, 6, 5
2, 2, 3, 7, 6
3, 3, 4, 8, 7
*ELEMENT, TYPE=CPE4, ELSET=PUNCH
11, 11, 12, 14, 13
*ELSET, ELSET=BODIES
BLOCK, PUNCH
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*SOLID SECTION, ELSET=BODIES, MATERIAL=M
1.
*SURFACE, NAME=TOP
BLOCK, S3
*SURFACE, NAME=TIP
PUNCH, S1
PUNCH, S2
*SURFACE INTERACTION, NAME=DRY
*FRICTION
0.3
*CONTACT PAIR, INTERACTION=DRY
TOP, TIP
*BOUNDARY
FLOOR, 1, 2
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.01, 0.2
*BOUNDARY
HEAD, 1, 1
HEAD, 2, 2, -0.05
*END STEP
"""
"""One slave node holds the punch; its corner goes behind the edge between two slave nodes."""


@pytest.mark.parametrize(
    "name",
    [
        *("assembly", "connections", "drop", "every_card", "friction", "quadratic", "rigid_floor"),
        *("static_steps", "steps", "quadratic_means", "self_contact"),
    ],
)
def test_decks_of_all_kinds_hold(job: Job, name: str) -> None:
    deck = Deck.read(DECKS / f"{name}.inp")
    assert_holds(job(deck, "--frames", "20"))


PARTLY_RIGID = """
*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 1., 2.
6, 0., 2.
9, 0.5, 2.2
*ELEMENT, TYPE=CPE4, ELSET=E
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=R
2, 4, 3, 5, 6
{mass}*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*SOLID SECTION, ELSET=R, MATERIAL=M
1.
*RIGID BODY, ELSET=R, REF NODE=9
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*BOUNDARY
1, 1, 2
2, 1, 2
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.01, 0.2
*CLOAD
9, 1, 10.
*END STEP
"""
"""The upper half of a column is rigid and turns with a node, under a force."""


@pytest.mark.parametrize("mass", ["", "*ELEMENT, TYPE=MASS, ELSET=EM\n7, 9\n*MASS, ELSET=EM\n3.\n"])
def test_rigid_parts_of_bodies_hold(job: Job, mass: str) -> None:
    path = job(Deck.parse(PARTLY_RIGID.format(mass=mass)))
    assert_holds(path)
    with h5py.File(path) as file:
        assert file["model/bodies/mass"][0] == pytest.approx(5.0 if mass else 2.0)
    told = {check.name for check in recompute(path).checks if check.is_told}
    assert {"strain energy", "equilibrium"} <= told
    # V of the nodes between both parts leaves the rigid motion by second order in dt
    assert "kinetic energy" not in told


def test_command_line(result: Path, tmp_path: Path) -> None:
    command = [*COMMAND, "certify"]

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*command, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True
        )

    done = run(str(result))
    assert done.returncode == 0, done.stderr
    assert "hold: gap" in done.stdout and "\ninvariants " in done.stdout
    assert "\nnot checked: masses, momenta, energies, stresses, strains and equilibrium of elements" in done.stdout
    bad = Path(shutil.copy(result, tmp_path / "bad.vtkhdf"))
    with h5py.File(bad, "r+") as file:
        SPOILED["the sum of contact forces"][0](file)
    done = run("-q", str(result), str(bad))
    assert done.returncode == 1
    assert len(done.stdout.splitlines()) == 2 and "fail: " in done.stdout
    done = run(str(tmp_path / "none.vtkhdf"))
    assert done.returncode == 2 and "there is no file" in done.stderr


def test_a_file_of_an_older_program_is_refused(result: Path, tmp_path: Path) -> None:
    def forget(file: h5py.File) -> None:
        del file["model/steps"]

    with pytest.raises(Fault, match="before there were certificates"):
        spoiled(result, tmp_path, forget)


def test_a_check_keeps_its_worst_value() -> None:
    check = Check("x", "a number")
    assert check.holds and not check.is_told
    check.add([1e-3, 2e-3], [1.0, 1.0], "row {}")
    check.add([1e-4], [1e-3], "other {}")
    assert (check.value, check.bound) == pytest.approx((1e-4, 1e-3), rel=1e-15)
    assert (check.place, check.count) == ("other 0", 3)
    check.add([0.0], [0.0], "zero")
    assert check.holds and check.place == "other 0"
    check.add([1e-300], [0.0], "above zero")
    assert not check.holds and check.place == "above zero"
    check.add([np.nan], [1.0], "no number")
    assert not check.holds and check.count == 6


def test_values_are_rounded_up_and_bounds_down() -> None:
    check = Check("gap", "")
    check.add(1.0, 1.0, "")
    assert check.value > 1.0 > check.bound and not check.holds
    check = Check("gap", "", scale=3.0)
    check.add([0.3, 0.0], 1.0, "")
    assert check.holds and check.shown()[0] == 0.11 and check.shown(1)[0] == 0.2
    exact = Check("time", "")
    exact.add(0.0, 0.0, "")
    assert exact.holds and exact.shown() == (0.0, 0.0)
