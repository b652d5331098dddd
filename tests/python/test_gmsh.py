"""Meshes that the Python package gmsh writes are read as they are: triangles and quadrilaterals,
boundary curves that become surfaces, groups of nodes; and run with contact."""

from collections.abc import Iterator
from pathlib import Path

import gmsh
import h5py
import numpy as np
import pytest
from stickslip import program
from stickslip.decks import card, dry, elastic, step

SIZES = {"BASE": (-2.0, -1.0, 4.0, 1.0), "BLOCK": (-0.5, 0.01, 1.0, 1.0)}
"""Left, bottom, width and height of the two rectangles."""
CURVES = {"BASE_FLOOR": ("BASE", 0), "BASE_TOP": ("BASE", 2), "BLOCK_BOTTOM": ("BLOCK", 0)}
"""Named sides of the rectangles, counted from the bottom on."""
WEIGHT = 10.0


@pytest.fixture(autouse=True)
def session() -> Iterator[None]:
    """Opens and closes the package's only model."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def rectangle(name: str, size: float, quads: bool) -> list[int]:
    """Adds a rectangle of SIZES with elements of this size; returns its sides."""
    x, y, width, height = SIZES[name]
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    geometry = gmsh.model.geo
    points = [geometry.addPoint(*corner, 0.0, size) for corner in corners]
    sides = [geometry.addLine(a, b) for a, b in zip(points, points[1:] + points[:1], strict=True)]
    surface = geometry.addPlaneSurface([geometry.addCurveLoop(sides)])
    geometry.synchronize()
    if quads:
        gmsh.model.mesh.setRecombine(2, surface)
    gmsh.model.addPhysicalGroup(2, [surface], name=name)
    return sides


def write_mesh(path: Path, quads: bool, nodes: bool) -> None:
    """Writes both rectangles as gmsh does, with its node sets of the groups or without."""
    sides = {name: rectangle(name, size, quads) for name, size in [("BASE", 0.5), ("BLOCK", 0.3)]}
    for name, (body, side) in CURVES.items():
        gmsh.model.addPhysicalGroup(1, [sides[body][side]], name=name)
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", int(nodes))
    gmsh.model.mesh.generate(2)
    gmsh.write(str(path))


def deck(nodes: bool) -> str:
    """Cards around the mesh: the block falls on the base. Only names of groups appear in them."""
    floor = "BASE_FLOOR" if nodes else "FLOOR"
    return "".join(
        [
            card("INCLUDE, INPUT=mesh.inp"),
            "" if nodes else card("NSET, NSET=FLOOR, ELSET=BASE_FLOOR"),
            card("SURFACE, NAME=LOWER", ("BASE_TOP",)),
            card("SURFACE, NAME=UPPER", ("BLOCK_BOTTOM",)),
            elastic(1e4, 0.3, 1.0, "BASE", "BLOCK"),
            dry(0.3),
            card("CONTACT PAIR, INTERACTION=DRY", ("UPPER", "LOWER")),
            card("BOUNDARY", (floor, "ENCASTRE")),
            step(0.001, 150, card("DLOAD", ("BLOCK", "GRAV", WEIGHT, 0.0, -1.0))),
        ]
    )


@pytest.mark.parametrize("nodes", [True, False], ids=["node sets", "no node sets"])
@pytest.mark.parametrize("quads", [False, True], ids=["triangles", "quads"])
def test_a_mesh_of_gmsh_runs_with_contact(tmp_path: Path, quads: bool, nodes: bool) -> None:
    """The block lands, and its momentum is that of its weight and of contact."""
    write_mesh(tmp_path / "mesh.inp", quads, nodes)
    written = (tmp_path / "mesh.inp").read_text()
    assert ("CPS4" in written) == quads
    assert "T3D2" in written and "Line1" in written
    path = tmp_path / "block.inp"
    path.write_text(deck(nodes))
    with h5py.File(program.run(path, tmp_path / "out").path) as file:
        assert file["run"].attrs["exit_status"] == 0
        time = file["history/time"][-1]
        velocity = file["history/bodies/velocity"][-1, 1, 1]
        contact = file["history/contact/UPPER_LOWER/impulse_sum"][-1, 1]
        block = file["model/bodies/mass"][:]
        nodes_of_top = file["model/node_sets/BASE_FLOOR" if nodes else "model/node_sets/FLOOR"]
        places = file["model/coordinates"][:][nodes_of_top[:]]
    assert block == pytest.approx([4.0, 1.0], rel=1e-12)
    assert np.all(places[:, 1] == -1.0) and len(places) == 9
    # the momentum of the block of mass 1 is the impulse of contact less that of its weight
    assert contact > 0.1 * WEIGHT * time
    assert velocity == pytest.approx(contact - WEIGHT * time, abs=1e-9 * WEIGHT * time)
