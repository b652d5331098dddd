"""Curved faces in motion: colliding and sliding arches, whose certificate is made from the bulges in the result file."""

import subprocess
from math import cos, pi, sin
from pathlib import Path

import h5py
import numpy as np
import pytest
from stickslip.bulges import Bulges
from stickslip.certificate.certify import certify
from stickslip.decks import Grid, card, dry, elastic
from stickslip.penetration.outlines import between_chord_and_curve, distances
from stickslip.program import binary

INNER, OUTER, OFFSET = 0.6, 1.0, 0.3
VELOCITY = 2.0


def arches(formulation: str, friction: float, scheme: str = "") -> str:
    """Two arches of a quarter of a ring, 6 and 10 elements around each, thrown at each other; one hits the other off its middle."""

    def arch(name: str, around: int, faces_right: bool, **labels: int) -> Grid:
        side = 1.0 if faces_right else -1.0
        centre = (0.0, 0.0) if faces_right else (2.0 * OUTER + 0.02, OFFSET)

        def place(i: int, j: int) -> tuple[float, float]:
            radius, angle = INNER + (OUTER - INNER) * i / 2, pi / 2 * (j / around - 0.5)
            return centre[0] + side * radius * cos(angle), centre[1] + side * radius * sin(angle)

        return Grid(name, 2, around, place, **labels)

    left = arch("LEFT", 6, True)
    right = arch("RIGHT", 10, False, first_node=left.next_node, first_element=left.next_element)
    return "".join(
        [
            left.mesh("CPE4") + right.mesh("CPE4"),
            left.side_surface("OF_LEFT", "right") + right.side_surface("OF_RIGHT", "right"),
            elastic(1000.0, 0.3, 1.0, "LEFT", "RIGHT"),
            dry(friction),
            card(f"CONTACT PAIR, INTERACTION=DRY{formulation}", ("OF_LEFT", "OF_RIGHT")),
            card("INITIAL CONDITIONS, TYPE=VELOCITY", ("LEFT", 1, VELOCITY), ("RIGHT", 1, -VELOCITY)),
            card("STEP, NLGEOM, INC=1000") + card(f"DYNAMIC, DIRECT{scheme}", (1e-3, 0.1)) + card("END STEP"),
        ]
    )


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("formulation", ["", ", TYPE=SURFACE TO SURFACE"])
def test_arches_that_collide_keep_energy_and_momenta_and_the_law_of_contact(
    tmp_path: Path, formulation: str, friction: float
) -> None:
    """Gaps, cones and slips of the certificate are those between curved faces; chords would be off by a hundredth."""
    (tmp_path / "deck.inp").write_text(arches(formulation, friction))
    command = [binary(), "run", tmp_path / "deck.inp", "-o", tmp_path, "-q", "--frames", "25"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    result = tmp_path / "deck.vtkhdf"
    certificate = certify(result)
    assert certificate.holds, [check for check in certificate.checks if not check.holds]
    told = {check.name for check in certificate.checks if check.is_told}
    assert {"gap", "cone", "penetration", "balance", "momentum"} <= told
    with h5py.File(result) as file:
        (name,) = file["model/contacts"]
        bulges = file[f"model/contacts/{name}/bulges"][:]
        momentum = file["history/momentum/linear"][:, :2]
        scale = file["history/energy/kinetic"][0] / VELOCITY
    # sagittas of ten chords of a quarter: R (1 - cos(phi/2)) with phi = 9 degrees
    rise = bulges @ [1.0, 0.5, 0.25, 0.125]
    assert rise == pytest.approx(OUTER * (1 - cos(pi / 40)), rel=2e-3)
    assert np.abs(momentum - momentum[0]).max() < 1e-12 * scale


def test_points_between_a_chord_and_its_curve_are_inside_of_the_body() -> None:
    """The face from (0, 0) to (1, 0) with the body above it, 0.1 out of its chord in the middle; and 0.1 into it."""
    start, end = np.array([[0.0, 0.0]]), np.array([[1.0, 0.0]])
    points = np.array([[0.5, -0.05], [0.5, -0.15], [0.5, 0.05], [1.5, -0.05]])
    outwards, inwards = (Bulges(np.array([[0.0, c, -c, 0.0]])) for c in (0.4, -0.4))
    assert between_chord_and_curve(points, start, end, outwards).ravel().tolist() == [1, 0, 0, 0]
    assert between_chord_and_curve(points, start, end, inwards).ravel().tolist() == [0, 0, -1, 0]
    assert distances(points[:3], start, end, outwards).ravel() == pytest.approx([0.05, 0.05, 0.15])
