"""Fields by the names that users know, at nodes, and the drawing of elements."""

import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from bodies import FAMILIES, bent_bodies, two_materials
from conftest import ROOT, Job
from decks import CANTILEVERS, shortened
from oracle.shapes import shape_functions
from stickslip.deck import Deck
from stickslip.errors import Fault, Missing
from stickslip.fields import ABAQUS, ALIASES, also, known, part, words
from stickslip.quantity import find, force_against_displacement
from stickslip.result import Result

REVOLUTION = ROOT / "tests" / "decks" / "revolution.inp"
DISC_SPRING = ROOT / "input" / "disc_spring" / "disc_spring_mu014.inp"


@pytest.fixture
def contact(job: Job) -> Result:
    """The cantilevers in contact."""
    return Result(job(shortened(CANTILEVERS / "A_mu04.inp", 60), "--frames", "6"))


# Names.


def test_names_of_abaqus_and_words_are_names_of_fields(contact: Result) -> None:
    frame = contact.frames[-1]
    stress = frame["S"]
    for name, expected in {
        "S11": stress[:, 0],
        "s22": stress[:, 1],
        "S:xy": stress[:, 2],
        "S12": stress[:, 2],
        "U2": frame["U"][:, 1],
        "u:y": frame["U"][:, 1],
        "CPRESS": frame["CONTACT_PRESSURE"],
        "contact-pressure": frame["CONTACT_PRESSURE"],
        "contact pressure": frame["CONTACT_PRESSURE"],
        "speed": frame["V"],
        "V:magnitude": np.linalg.norm(frame["V"], axis=1),
        "mean-stress": stress[:, :2].mean(axis=1),
        "S:max": np.linalg.eigvalsh(stress[:, [0, 2, 2, 1]].reshape(-1, 2, 2))[:, 1],
        "von-mises": frame["MISES"],
    }.items():
        assert np.allclose(frame[name], expected, rtol=1e-12, atol=1e-9, equal_nan=True), name
        assert name in frame
    for name, message in {
        "S:zz": "say which part of S, such as S:1, S:2, S:3, S:xx, ",
        "MISES:1": "leave out the :1",
        "S44": "has no field S44; there are",
    }.items():
        with pytest.raises(Missing, match=message):
            frame[name]
    data = contact.to_xarray("S11", "CPRESS", "U")
    assert data["S11"].dims == ("frame", "element") and data["CPRESS"].dims == ("frame", "node")
    assert data["S11"].attrs["dimension"] == "force/length^2"


def test_every_alias_names_a_field_and_a_component() -> None:
    for name, target in ALIASES.items():
        field, _, component = target.partition(":")
        count = {"S": 3, "E": 3, "LE": 3}.get(field, 2 if component or field in ("U", "V") else None)
        assert known(name.lower(), ()) == target
        assert part(target, count, False).label.startswith(words(field))
    assert also("S", 3) == {"xx": "S11", "yy": "S22", "xy": "S12"} and also("MISES", 1) == {}
    assert also("CONTACT_PRESSURE", 1) == {"": "CPRESS"} and set(also("U", 2).values()) < set(ABAQUS)


def test_histories_have_these_names_too(contact: Result) -> None:
    assert np.array_equal(contact.quantity("nodes/UPPER_TIP/U2"), contact.quantity("nodes/UPPER_TIP/U:2"))
    label = contact.history.nodes["UPPER_TIP"].labels[0]
    assert np.array_equal(contact.quantity(f"nodes/UPPER_TIP[{label}]/v1"), contact.history.nodes["UPPER_TIP"].V[:, 0, 0])
    with pytest.raises(Fault, match="UPPER_TIP has RF, U, V"):
        find(contact, "nodes/UPPER_TIP/CPRESS")


def test_bodies_of_revolution_have_a_radius_and_an_axis(job: Job) -> None:
    with Result(job(Deck.read(DISC_SPRING), "--frames", "2")) as result:
        assert list(find(result, "nodes/PLATE/U").parts) == ["r", "z"]
        assert result.frames.part("U2").label == "displacement, z" and result.frames.part("S12").label == "stress, rz"
        assert result.frames.part("S33").label == "stress around the axis"
        # the plate that is pressed down comes first
        assert force_against_displacement(result)[0] == ("nodes/PLATE/U:2", "nodes/PLATE/RF:2")


@pytest.mark.parametrize("deck", [REVOLUTION, CANTILEVERS / "A_mu04.inp"], ids=lambda deck: deck.stem)
def test_files_with_tensors_of_three_components_are_read(deck: Path, job: Job, tmp_path: Path) -> None:
    """As the first programs wrote them: S [., 3] and S33 [.], and E33 in bodies of revolution only."""
    path = job(shortened(deck, 20), "--frames", "3")
    old = Path(shutil.copy(path, tmp_path / "old.vtkhdf"))
    with h5py.File(old, "r+") as file:
        cells, offsets = file["VTKHDF/CellData"], file["VTKHDF/Steps/CellDataOffsets"]
        for name in ("S", "E"):
            stored = cells[name]
            rows, meanings = stored[()], dict(stored.attrs)
            del cells[name]
            for field, columns in ((name, [0, 1, 3]), (f"{name}33", 2)):
                if field != "E33" or deck == REVOLUTION:
                    cells.create_dataset(field, data=rows[:, columns], maxshape=(None, 3)[: 2 - (columns == 2)])
                    cells[field].attrs.update(meanings)
                    offsets.require_dataset(field, offsets["MISES"].shape, "i8", data=offsets["MISES"][()])
    with Result(path) as result, Result(old) as read:
        assert set(read.frames.fields) == set(result.frames.fields) - ({"E33"} if deck != REVOLUTION else set())
        for frame, other in zip(result.frames, read.frames, strict=True):
            assert all(np.array_equal(frame[name], other[name], equal_nan=True) for name in other)
            assert np.array_equal(frame.nodal("MISES"), other.nodal("MISES"))
        assert read.to_xarray("S").equals(result.to_xarray("S").assign_attrs(job="old"))
        assert np.array_equal(read.frames[-1].to_pyvista()["S33"], result.frames[-1].to_pyvista()["S"][:, 2], equal_nan=True)


# Values at nodes.


@pytest.mark.parametrize("kind", ["CPE3", "CPS4", "CPE6", "CAX8"])
def test_values_at_nodes_are_exact_for_linear_fields_on_both_sides_of_materials(kind: str, job: Job) -> None:
    with Result(job(two_materials(kind))) as result:
        recovery, cells = result.recovery, result.cells
        corners = [cell[: len(cell) // 2] if len(cell) > 4 else cell for cell in cells]
        middles = np.array([result.coordinates[one].mean(axis=0) for one in corners])
        material = result.read("model/element_materials")
        slope, step = np.array([3.0, -2.0]), 100.0
        found = recovery(middles @ slope + step * material)
        for cell, places, of in zip(cells, recovery.cells, material):
            at = result.coordinates[cell]
            if len(cell) > 4:  # straight between corners
                at[len(cell) // 2 :] = 0.5 * (at[: len(cell) // 2] + np.roll(at[: len(cell) // 2], -1, axis=0))
            assert np.allclose(found[places], at @ slope + step * of, rtol=0.0, atol=1e-9)
        line = (np.abs(result.coordinates[recovery.twins][:, 0] - 1.5) < 0.05).all()
        assert line and len(recovery.twins) == (9 if kind[3] in "68" else 5)
        # no value falls below zero where none of the elements has one
        assert recovery(np.where(np.arange(len(cells)) % 7 == 0, 5.0, 0.0)).min() == 0.0
        assert np.array_equal(recovery(np.ones((len(cells), 3))).round(12), np.ones((recovery.places, 3)))


def test_values_that_the_program_has_written_at_nodes_are_taken(job: Job) -> None:
    deck = bent_bodies("CPE")
    deck.cards[-1:-1] = Deck.parse("*ELEMENT OUTPUT, POSITION=NODES\nS\n").cards
    output = Deck.parse("*OUTPUT, FIELD\n").cards
    deck.cards[-2:-2] = output
    with Result(job(deck)) as result:
        frame = result.frames[-1]
        assert np.array_equal(frame.nodal("MISES"), frame["MISES_AT_NODES"])
        assert np.array_equal(frame.nodal("S11"), frame["S_AT_NODES"][:, 0])
        assert np.array_equal(frame.nodal("U"), frame["U"])


# The drawing.


@pytest.mark.parametrize("family", FAMILIES)
def test_outlines_lie_on_the_sides_of_the_elements(family: str, job: Job) -> None:
    with Result(job(bent_bodies(family), "--frames", "1")) as result:
        positions = result.frames[-1].positions
        at = result.drawing.positions(positions)
        area = 0.0
        for cell, around, ring in zip(result.cells, result.outlines, result.drawing.rings):
            assert np.array_equal(ring[ring < len(positions)], around)
            count = 3 if len(cell) in (3, 6) else 4
            parent = np.array([[0, 0], [1, 0], [0, 1]] if count == 3 else [[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
            parts = len(ring) // count
            share = np.arange(parts)[:, None] / parts
            way = np.concatenate([a + share * (b - a) for a, b in zip(parent, np.roll(parent, -1, axis=0))])
            exact = shape_functions(len(cell), way)[0] @ positions[cell]
            assert np.allclose(at[ring], exact, rtol=0.0, atol=1e-12)
            x, y = at[ring].T
            area += 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
        x, y = at[result.drawing.outline].transpose(2, 0, 1)
        assert 0.5 * (x[:, 0] * y[:, 1] - y[:, 0] * x[:, 1]).sum() == pytest.approx(area, rel=1e-12)
        a, b, c = result.drawing.with_middles(at)[result.drawing.triangles].transpose(1, 0, 2)
        areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        assert areas.min() > 0.0 and areas.sum() == pytest.approx(area, rel=1e-12)
