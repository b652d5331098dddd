"""The folding wedges, an assembly deck: driving force, energy, self-locking."""

from math import atan, tan
from pathlib import Path

import numpy as np
from conftest import Job
from decks import WEDGES, generated
from stickslip import program
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


def test_static_steps_drive_the_wedges_with_the_same_force(tmp_path: Path) -> None:
    """The twin of clamp and drive in static steps: ten times fewer increments, no vibration."""
    wedges = generated(WEDGES)
    text, _, _ = (WEDGES / "folding_wedges.inp").read_text().partition("** STEP: Release")
    for dynamic, static in (
        ("*Dynamic,direct\n2e-05,0.001,", "*Static\n1e-3, 0.001"),
        ("*Dynamic,direct\n2e-05,0.01,", "*Static\n1e-4, 0.01, 1e-7, 2e-4"),
    ):
        assert dynamic in text
        text = text.replace(dynamic, static)
    deck = tmp_path / "static_wedges.inp"
    deck.write_text(text)
    with program.run(deck, tmp_path, "--threads", "1") as results:
        push, drives = results.history.nodes["Push"], results.history.step == 2
        force = push.RF[drives, :, 0].sum(axis=1)
        way = push.U[drives, :, 0].mean(axis=1)
        increments = len(results.history.dt) - 1
    load = wedges["PRESSURE"] * wedges["LENGTH"]
    rigid = load * tan(atan(wedges["SLOPE"]) + atan(wedges["FRICTION"]))
    slides = way > 0.1 * wedges["TRAVEL"]
    assert np.abs(force[slides] / rigid - 1.0).max() < 1e-3
    assert increments < 100
