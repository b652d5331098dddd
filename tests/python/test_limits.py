"""Loads at the limit of equilibrium: below it a static step finds the equilibrium, beyond it the first pass refuses the load and names
the body, what is left over, and its motion."""

import subprocess
from pathlib import Path

import pytest
from stickslip.program import binary

NODES_OF_A_BODY = 1000


def body(name: str, number: int, box: tuple[float, ...], cells: tuple[int, int]) -> list[str]:
    """Cards of a rectangle (x, y, width, height) of elements, with the surfaces of its lowest and highest row."""
    (x, y, width, height), (nx, ny) = box, cells
    first = NODES_OF_A_BODY * number + 1
    cards = [f"*NODE, NSET=N{name}"]
    for j in range(ny + 1):
        for i in range(nx + 1):
            node = first + j * (nx + 1) + i
            cards.append(f"{node}, {x + width * i / nx!r}, {y + height * j / ny!r}")
    cards.append(f"*ELEMENT, TYPE=CPE4, ELSET={name}")
    for j in range(ny):
        for i in range(nx):
            a = first + j * (nx + 1) + i
            cards.append(f"{first + j * nx + i}, {a}, {a + 1}, {a + nx + 2}, {a + nx + 1}")
    for side, face, start in (("BOTTOM", "S1", 0), ("TOP", "S3", (ny - 1) * nx)):
        cards.append(f"*SURFACE, NAME={name}_{side}")
        cards += [f"{first + start + i}, {face}" for i in range(nx)]
    return [*cards, f"*SOLID SECTION, ELSET={name}, MATERIAL=M", "1."]


def stack(blocks: list[tuple[tuple[float, ...], tuple[int, int], float]], push: float) -> str:
    """A deck of blocks on a floor and on each other, each with the coefficient of friction at its foot, under a weight of 1
    and a push of so much of it."""
    cards = ["*HEADING", "a load near its limit"]
    cards += body("FLOOR", 0, (-4.0, -1.0, 8.0, 1.0), (16, 2))
    for k, (box, cells, _) in enumerate(blocks, 1):
        cards += body(f"B{k}", k, box, cells)
    cards += ["*MATERIAL, NAME=M", "*ELASTIC", "1e5, 0.2", "*DENSITY", "1.", "*NSET, NSET=BASE, GENERATE", "1, 17, 1"]
    for k, (_, _, friction) in enumerate(blocks, 1):
        below = "FLOOR" if k == 1 else f"B{k - 1}"
        cards += [f"*SURFACE INTERACTION, NAME=I{k}", "*FRICTION", f"{friction}"]
        cards += [f"*CONTACT PAIR, INTERACTION=I{k}", f"B{k}_BOTTOM, {below}_TOP"]
    cards += ["*BOUNDARY", "BASE, 1, 2", "*STEP, NLGEOM", "*STATIC", "1., 1., 1., 1.", "*DLOAD"]
    for k in range(1, len(blocks) + 1):
        cards += [f"B{k}, GRAV, 1., 0., -1.", f"B{k}, GRAV, {push!r}, 1., 0."]
    return "\n".join([*cards, "*END STEP", ""])


FLAT = ((-1.0, 0.0, 2.0, 1.0), (4, 2), 0.3)
SLIM = ((-0.5, 0.0, 1.0, 2.0), (3, 4), 1.0)
LOWER = ((-1.5, 0.0, 3.0, 1.0), (6, 2), 0.6)
UPPER = ((-1.0, 1.0, 2.0, 1.0), (5, 2), 0.2)

CASES = {
    # blocks, limit of the push, named body, its motion, mass that moves
    "slides": ([FLAT], 0.3, "B1", "slide along (1, 0)", 2.0),
    "tips": ([SLIM], 0.5, "B1", "turn to the right", None),
    "upper of two": ([LOWER, UPPER], 0.2, "B2", "slide along (1, 0)", 2.0),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("beyond", [-1e-3, 1e-4, 1e-3, 1e-2])
def test_a_load_beyond_its_limit_is_refused_in_the_first_pass(
    name: str, beyond: float, tmp_path: Path
) -> None:
    blocks, limit, moves, motion, mass = CASES[name]
    deck = tmp_path / "limit.inp"
    deck.write_text(stack(blocks, limit * (1.0 + beyond)))
    command = [binary(), "run", deck, "-o", tmp_path, "--threads", "1"]
    done = subprocess.run(command, capture_output=True, check=False)
    log = " ".join((tmp_path / "limit.log").read_text().split())
    if beyond < 0.0:
        assert done.returncode == 0, log
        return
    assert done.returncode == 1, log
    assert f"body {moves} with node" in log and f"it is about to {motion}" in log, log
    # a pass that ends is told with its residual
    assert "passes of the last attempt" not in log, log
    if mass is not None:
        force = float(log.split("the force (")[1].split(",")[0])
        assert abs(force / (mass * limit * beyond) - 1.0) < 1e-3, log
