"""The folding wedges, an assembly deck: driving force, energy, self-locking."""

from math import atan, tan

import numpy as np
from conftest import Job
from decks import WEDGES, generated
from stickslip.deck import Deck
from stickslip.result import Result


def test_the_driving_force_is_that_of_rigid_wedges_and_they_lock(job: Job) -> None:
    wedges = generated(WEDGES)
    start, drive = wedges["RAMP"], wedges["DRIVE"]
    with Result(job(Deck.read(WEDGES / "folding_wedges.inp"))) as results:
        time = results.history.time
        push = results.history.nodes["Push"]
        force, way = push.RF[:, :, 0].sum(axis=1), push.U[:, :, 0].mean(axis=1)
        balance = (
            np.abs(results.history.energy["balance"]).max()
            / results.history.energy["external_work"].max()
        )
    middle = np.abs(time - start - 0.5 * drive) < 0.2 * drive
    load = wedges["PRESSURE"] * wedges["LENGTH"]
    # F = W tan(slope + friction angle)
    rigid = load * tan(atan(wedges["SLOPE"]) + atan(wedges["FRICTION"]))
    assert abs(force[middle].mean() / rigid - 1.0) < 0.01
    assert balance < 1e-10
    driven = way[np.searchsorted(time, start + drive)]
    assert abs(driven - wedges["TRAVEL"]) < 1e-9
    released = way[time > start + drive + 1e-9]
    assert np.abs(released - driven).max() < 1e-3 * driven
