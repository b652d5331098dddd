"""The default scheme keeps energy and momentum; contact keeps both momenta."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Job
from decks import oblique_impact, spinning_bar
from lab.bench_dense import thrown, wall
from stickslip.deck import Deck
from stickslip.result import Result

TOLERANCE = 1e-10


def momentum_errors(results: Result) -> tuple[float, float]:
    """Largest change of both momenta, relative to their scales sqrt(2 m T) and size times that.

    The mass follows from density 1 and thickness 1.
    """
    mass = sum(area(results.coordinates[cell]) for cell in results.cells)
    scale = float(np.sqrt(2.0 * mass * results.history.energy["kinetic"].max()))
    size = float(np.ptp(results.coordinates, axis=0).max())
    linear = np.abs(results.history.momentum.linear - results.history.momentum.linear[0]).max()
    angular = np.abs(results.history.momentum.angular - results.history.momentum.angular[0]).max()
    return float(linear / scale), float(angular / (scale * size))


def area(corners: np.ndarray) -> float:
    """Area of a polygon."""
    x, y = corners.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_free_flight_keeps_energy_and_momentum(job: Job, tmp_path: Path) -> None:
    with Result(job(spinning_bar(tmp_path))) as results:
        total = results.history.energy["kinetic"] + results.history.energy["strain"]
        assert results.history.energy["strain"].max() > 0.02 * total[0], "the bar vibrates"
        assert np.abs(total / total[0] - 1.0).max() < TOLERANCE
        assert max(momentum_errors(results)) < TOLERANCE


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_oblique_impact_keeps_both_momenta(friction: float, job: Job, tmp_path: Path) -> None:
    with Result(job(oblique_impact(friction, tmp_path))) as results:
        (contact,) = results.contact.values()
        assert contact.closed.max() > 0, "the bodies meet"
        assert contact.closed[-1] == 0, "and part again"
        assert max(momentum_errors(results)) < TOLERANCE
        assert (results.history.energy["friction_dissipation"][-1] > 0.0) == (friction > 0.0)


def test_nodes_on_corners_of_bricks_below_get_no_energy(job: Job) -> None:
    # the nodes in the middle of the bricks at the end of every other course stand on the last corner below
    deck = Deck.parse(wall(5, 5, 1, increments=6, shaking=8.0))
    with Result(job(deck)) as results:
        assert results.file["run"].attrs["cutbacks"] == 0
        work = results.history.energy["normal_contact_work"]
        assert work[-1] < 0.0 and np.diff(work).max() < TOLERANCE * results.history.energy.largest


def test_a_thrown_lattice_takes_few_passes_and_no_pivots(job: Job) -> None:
    # flat sides all over the lattice close in one increment, and each has one set of conditions
    with Result(job(Deck.parse(thrown(4, 4)))) as results:
        assert results.file["run"].attrs["cutbacks"] == 0
        solver = results.history.solver
        assert solver["passes"].sum() < 70
        assert solver["active_set_iterations"].sum() < 300
        assert solver["lemke_calls"].sum() == 0
