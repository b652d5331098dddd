"""The elastic bar at the wall, also without its script: force, contact time, landing."""

import numpy as np
import pytest
from conftest import Job
from decks import BAR, generated
from stickslip.deck import Deck
from stickslip.result import Result


@pytest.mark.parametrize("scheme", ["ss22", "em"])
def test_wall_force_follows_wave_theory(scheme: str, job: Job) -> None:
    bar = generated(BAR)
    with Result(job(Deck.read(BAR / f"{scheme}_impulse.inp"))) as results:
        (contact,) = results.contact.values()
        dt, transit = bar["DT"], 2.0 * bar["LENGTH"] / bar["WAVE_SPEED"]
        landing = results.history.impacts["time"].min()
        assert abs(landing - bar["GAP"] / bar["SPEED"]) <= dt
        middle = np.abs(results.history.time - landing - 0.5 * transit) <= 0.2 * transit
        force = contact.normal[middle] / (bar["WAVE_SPEED"] * bar["SPEED"])
        assert abs(force.mean() - 1.0) < 0.01
        assert force.std() < 0.01 * force.mean()
        duration = results.history.time[contact.closed > 0][-1] - landing
        element = bar["LENGTH"] / bar["ELEMENTS"] / bar["WAVE_SPEED"]
        assert abs(duration - transit) <= 2.0 * dt + 2.0 * element


@pytest.mark.parametrize("scheme", ["ss22", "em"])
def test_without_impulses_the_wall_force_chatters(scheme: str, job: Job) -> None:
    with Result(job(Deck.read(BAR / f"{scheme}_none.inp"))) as results:
        (contact,) = results.contact.values()
        force = contact.normal[(results.history.time > 0.24) & (results.history.time < 0.49)]
        assert force.std() > 0.3 * force.mean()
