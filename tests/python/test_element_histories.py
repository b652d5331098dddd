"""Histories of element sets: against closed forms, the frames and the energies of the model."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import Job
from decks import BLOCK, CANTILEVERS, parse, shortened
from stickslip.errors import Fault
from stickslip.quantity import find
from stickslip.result import Result

STRETCHED = """*NODE, NSET=ALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*NSET, NSET=LEFT
1, 4
*NSET, NSET=RIGHT
2, 3
*ELEMENT, TYPE=CPE4, ELSET=BODY
7, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
100., 0.25
*DENSITY
3.
*SOLID SECTION, ELSET=BODY, MATERIAL=M
0.5
*BOUNDARY
ALL, 2
LEFT, 1
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.1, 1.
*BOUNDARY, TYPE=VELOCITY
RIGHT, 1, 1, 0.4
*EL PRINT, ELSET=BODY
S, E, ENER, ELSE, ELKE, EVOL
*CLOAD
4, 2, 3.
*NODE FILE
CF
*EL FILE
ENER, LE, SP, PRESS
*EL FILE, POSITION=NODES
S, LE, E, PRESS
*END STEP
"""

STRESSES = ("SP1", "SP2", "SP3", "PRESS")


def test_a_stretched_element(tmp_path: Path, job: Job) -> None:
    """Stretch 1.2 along x in plane strain, lambda = mu = 40: E_xx = 0.22, S = (26.4, 8.8, 8.8)."""
    with h5py.File(job(parse(STRETCHED, tmp_path), "--frames", "1")) as file:
        group = file["history/elements/BODY"]
        total = {name: data[:] for name, data in group["sum"].items()}
        body = {name: group[name][:] for name in group if name != "sum"}
        fields = {name: file["VTKHDF/CellData"][name][:] for name in ("ENER", "LE", *STRESSES)}
        loads = file["VTKHDF/PointData/CF"][:]
        at_nodes = {name: file[f"VTKHDF/PointData/{name}_AT_NODES"][-4:] for name in ("S", "LE", "E", "PRESS", "MISES")}
    assert body["labels"] == [7]
    assert np.allclose(body["EVOL"], [1.0], rtol=1e-14)
    cauchy = np.array([26.4 * 1.2, 8.8 / 1.2, 0.0])
    assert np.allclose(body["S"][-1, 0], cauchy, rtol=1e-12, atol=1e-12)
    assert np.allclose(body["S33"][-1], 8.8 / 1.2, rtol=1e-12)
    assert np.allclose(body["MISES"][-1], cauchy[0] - cauchy[1], rtol=1e-12)
    principal = np.sort([cauchy[0], cauchy[1], 8.8 / 1.2])
    for name, value in zip(STRESSES, [*principal, -principal.sum() / 3.0], strict=True):
        assert np.allclose(body[name][-1], value, rtol=1e-12), name
        assert np.allclose(fields[name][-1], value, rtol=1e-12), name
    assert np.allclose(body["E"][-1, 0], [0.22, 0.0, 0.0], rtol=1e-12, atol=1e-13)
    # lambda tr(E)^2/2 + mu E:E
    density = 60.0 * 0.22**2
    assert np.allclose(body["ENER"][-1], density, rtol=1e-12)
    assert np.allclose(body["ELSE"][-1], density, rtol=1e-12)
    # v = 0.4 x/2 along the bar: 3 * 0.4^2/6
    assert np.allclose(body["ELKE"][1:], 0.08, rtol=1e-9)
    strain = [np.log(1.2), 0.0, 0.0]
    assert np.allclose(body["LE"][-1, 0], strain, rtol=1e-12, atol=1e-13)
    assert np.allclose(fields["LE"][-1], np.insert(strain, [2, 3, 3], 0.0), rtol=1e-12, atol=1e-13)
    assert np.allclose(fields["ENER"][-1], density, rtol=1e-12)
    for name, values in at_nodes.items():
        expected = body[name][-1]
        if name in ("S", "E", "LE"):
            across = body["S33"][-1, 0] if name == "S" else 0.0
            expected = np.insert(expected, 2, across, axis=-1)
            assert not values[:, 4:].any()
            values = values[:, :4]
        assert np.allclose(values, expected, rtol=1e-12, atol=1e-12), name
    assert np.array_equal(loads[-4:], [[0.0] * 3] * 3 + [[0.0, 3.0, 0.0]])
    for energy in ("ELSE", "ELKE"):
        assert np.array_equal(total[energy], body[energy][:, 0])


@pytest.mark.parametrize("path", [BLOCK / "block_slope_mu02.inp", CANTILEVERS / "B_mu04.inp"])
def test_frames_and_energies(path: Path, tmp_path: Path, job: Job) -> None:
    """All elements, in a set each for their bodies: the fields of all frames, the energies of bodies."""
    deck = shortened(path, 20)
    sets = sorted(h5py.File(job(deck, "--frames", "20"))["model/element_sets"])
    cards = "".join(f"*ELEMENT OUTPUT, ELSET={name}\nS\n" for name in sets)
    text = deck.text().replace("*END STEP", f"*OUTPUT, HISTORY\n{cards}*END STEP")
    result = job(parse(text, tmp_path), "--frames", "20")
    with h5py.File(result) as file:
        cells, rows = file["VTKHDF/NumberOfCells"][0], file["history/time"].size
        assert np.array_equal(file["VTKHDF/Steps/Values"][:], file["history/time"][:])
        of_body = file["model/bodies/element"][:]
        seen = np.zeros(of_body.max() + 1, bool)
        for name in sets:
            index, elements = file["model/element_sets"][name][:], file["history/elements"][name]
            for field, dataset, columns in (
                ("S", "S", [0, 1, 3]),
                ("S33", "S", 2),
                ("MISES", "MISES", None),
                ("E", "E", [0, 1, 3]),
            ):
                frames = file["VTKHDF/CellData"][dataset][:]
                frames = frames.reshape(rows, cells, *frames.shape[1:])[:, index]
                expected = frames if columns is None else frames[..., columns]
                assert np.array_equal(elements[field][:], expected), field
            assert np.allclose(elements["ELSE"][:], elements["ENER"][:] * elements["EVOL"][:])
            body = of_body[index[0]]
            if np.array_equal(index, np.flatnonzero(of_body == body)):
                seen[body] = True
                for ours, theirs in (("ELSE", "strain"), ("ELKE", "kinetic")):
                    energy = file["history/bodies"][theirs][:, body]
                    assert np.allclose(elements["sum"][ours][:], energy, rtol=1e-10, atol=0.0)
        assert seen.any()
    with Result(result) as results:
        name, labels = sets[0], results.read(f"history/elements/{sets[0]}/labels")
        (part,) = find(results, f"elements/{name}[{labels[-1]}]/S:2").parts.values()
        assert np.array_equal(part, results.history[f"elements/{name}/S"][:, -1, 1])
        (part,) = find(results, f"elements/{name}/ELSE").parts.values()
        assert np.allclose(part, results.history[f"elements/{name}/sum/ELSE"])


def test_names_hold_where_a_result_has_only_sums_and_means(tmp_path: Path, job: Job) -> None:
    """`nodes/RIGHT/U:1` is the mean over the set, `nodes/RIGHT/RF:1` the sum, with TOTALS=ONLY or without."""
    asked = "*NODE PRINT, NSET=RIGHT{}\nU, RF\n*EL PRINT"
    all_results = []
    for totals in ("", ", TOTALS=ONLY"):
        text = STRETCHED.replace("*EL PRINT", asked.format(totals))
        text = text.replace("ELSET=BODY\nS,", f"ELSET=BODY{totals}\nS,")
        all_results.append(Result(job(parse(text, tmp_path))))
    each, only = all_results
    assert "nodes/RIGHT/U" in each.histories and "nodes/RIGHT/U" not in only.histories
    for name in ("nodes/RIGHT/U:1", "nodes/RIGHT/V:1", "nodes/RIGHT/RF:1", "elements/BODY/ELKE"):
        (expected,), (found,) = (find(r, name).parts.values() for r in (each, only))
        assert np.allclose(found, expected, rtol=1e-12, atol=1e-12), name
    assert find(only, "nodes/RIGHT/A:1").parts.keys() == {"x"}
    assert find(only, "nodes/RIGHT/CF").parts.keys() == {"x", "y"}
    with pytest.raises(Fault, match="mean"):
        find(only, "nodes/RIGHT[2]/U:1")
