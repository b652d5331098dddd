"""Examples of input/ against closed forms and equations of motion: roller, cam and tappet, brake pad on a spring."""

from math import pi, sqrt

import numpy as np
import pytest
from conftest import Job
from decks import CAM, PAD, ROLLER, generated
from oracle.checks import assert_holds
from stickslip.deck import Deck
from stickslip.result import STICK, Result


def test_a_braked_roller_creeps_as_carter_says(job: Job) -> None:
    made = generated(ROLLER)
    with Result(job(Deck.read(ROLLER / "roller_braked.inp"))) as results:
        pull = made["PULL"]["roller_braked"]
        creep = made["FRICTION"] * made["HALF_WIDTH"] / made["RADIUS"] * (1 - sqrt(1 - pull))
        turn = (results.history.time - 1.0) * made["TURN"]
        late = turn > 0.4
        way = results.history.nodes["AXIS"].U[late, 0, 0]
        assert 1 - np.polyfit(turn[late], way, 1)[0] / made["RADIUS"] == pytest.approx(creep, rel=0.02)
        drag = pull * made["FRICTION"] * made["PRESS"]
        work = results.history.energy.friction_dissipation[late]
        assert np.polyfit(turn[late], work, 1)[0] == pytest.approx(drag * creep, rel=0.03)
        frame = results.frame(2.0)
        touching = np.nan_to_num(frame["CONTACT_PRESSURE"]) > 0.0
        sticks = frame["CONTACT_STATUS"][touching] == STICK
        assert sticks.mean() == pytest.approx(sqrt(1 - pull), abs=0.08)
        assert frame["CONTACT_PRESSURE"][touching].max() == pytest.approx(
            2 * made["PRESS"] / (pi * made["HALF_WIDTH"]), rel=0.05
        )
        assert_holds(results)


def test_a_tappet_follows_a_slow_cam_and_flies_over_a_fast_one(job: Job) -> None:
    made = generated(CAM)
    with Result(job(Deck.read(CAM / "cam_slow.inp"))) as results:
        omega = made["SPEED"]["cam_slow"]
        time = results.history.time
        places = omega * time - pi / 2
        exact = np.array([made["lift"](angle)[0] for angle in places])
        lift = results.history.nodes["STEM"].U[:, 0, 1]
        assert np.abs(lift - exact).max() < 0.004 * made["LIFT"]
        # the force of an increment is that of its middle
        middle = (places[1:] + places[:-1]) / 2
        s, _, s2 = np.array([made["lift"](angle) for angle in middle]).T
        mass = made["MASS"] + made["DENSITY"] * made["WIDTH"] * made["HEIGHT"] * made["THICKNESS"]
        force = made["PRELOAD"] + made["SPRING"] * s + mass * omega**2 * s2
        error = (results.history.contact["FACE_CAM"].normal[1:] - force)[middle > -1.2]
        assert sqrt(np.mean(error**2)) < 0.02 * force.max()
    with Result(job(Deck.read(CAM / "cam_fast.inp"))) as results:
        lift = results.history.nodes["STEM"].U[:, 0, 1]
        assert lift.max() > made["LIFT"] + 0.5
        at_top = np.abs(made["SPEED"]["cam_fast"] * results.history.time - pi / 2) < 0.5
        assert (results.history.contact["FACE_CAM"].normal[at_top] == 0.0).all()
        # in flight the loads are small: bounds follow the force of the spring
        assert_holds(results)


def test_a_pad_sticks_and_slips_as_one_mass(job: Job) -> None:
    made = generated(PAD)
    with Result(job(Deck.read(PAD / "pad_fast.inp"))) as results:
        time = results.history.time
        place = results.history.nodes["HOLDER"].U[time >= 1.0, 0, 0]
        time = time[time >= 1.0] - 1.0
    dt = 1e-4
    exact = np.array(made["one_mass"](made["SPEED"]["pad_fast"], dt))
    at = made["SLIDING"] * made["NORMAL"] / made["SPRING"]

    def cycles(t: np.ndarray, x: np.ndarray) -> tuple[float, float]:
        back = np.flatnonzero((x[:-1] > at) & (x[1:] <= at))
        when = t[back] + (x[back] - at) / (x[back] - x[back + 1]) * np.diff(t)[back]
        return float(np.diff(when).mean()), float(np.ptp(x[back[0] :]))

    expected = cycles(dt * np.arange(len(exact)), exact)
    assert cycles(time, place) == pytest.approx(expected, rel=0.007)
