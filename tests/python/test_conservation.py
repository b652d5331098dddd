"""The default scheme keeps energy and momentum; contact keeps both momenta."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Job
from decks import oblique_impact, spinning_bar
from results import Results

TOLERANCE = 1e-10


def momentum_errors(results: Results) -> tuple[float, float]:
    """Largest change of both momenta, relative to their scales sqrt(2 m T) and size times that.

    The mass follows from density 1 and thickness 1.
    """
    mass = sum(area(results.coordinates[cell]) for cell in results.cells)
    scale = float(np.sqrt(2.0 * mass * results.energy["kinetic"].max()))
    size = float(np.ptp(results.coordinates, axis=0).max())
    linear = np.abs(results.linear_momentum - results.linear_momentum[0]).max()
    angular = np.abs(results.angular_momentum - results.angular_momentum[0]).max()
    return float(linear / scale), float(angular / (scale * size))


def area(corners: np.ndarray) -> float:
    """Area of a polygon."""
    x, y = corners.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_free_flight_keeps_energy_and_momentum(job: Job, tmp_path: Path) -> None:
    with Results(job(spinning_bar(tmp_path))) as results:
        total = results.energy["kinetic"] + results.energy["strain"]
        assert results.energy["strain"].max() > 0.02 * total[0], "the bar vibrates"
        assert np.abs(total / total[0] - 1.0).max() < TOLERANCE
        assert max(momentum_errors(results)) < TOLERANCE


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_oblique_impact_keeps_both_momenta(friction: float, job: Job, tmp_path: Path) -> None:
    with Results(job(oblique_impact(friction, tmp_path))) as results:
        (contact,) = results.contacts.values()
        assert contact.closed.max() > 0, "the bodies meet"
        assert contact.closed[-1] == 0, "and part again"
        assert max(momentum_errors(results)) < TOLERANCE
        assert (results.energy["friction_dissipation"][-1] > 0.0) == (friction > 0.0)
