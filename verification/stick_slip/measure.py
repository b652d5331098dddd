"""Stick-slip of one and two blocks on springs on a belt against their equations of motion."""

import sys
from functools import cache
from math import exp
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

made = runner.load(HERE / "generate.py")

STEP = 2e-5
"""Of the Runge-Kutta method for the equations of motion."""


def stiffness(number: int) -> Array:
    """Of the springs of one or two blocks."""
    k, c = made.GROUND, made.COUPLING
    return np.array([[k]]) if number == 1 else np.array([[k + c, -c], [-c, c]])


@cache
def motion(number: int, decay: float) -> tuple[Array, Array]:
    """Times and displacements of the blocks, from m x'' = -K x + friction.

    A block that sticks moves with the belt as long as mu_s N holds it. One that slides has the friction mu(|v|) N of its
    slip rate v, and sticks again when v comes to zero and mu_s N can hold it.
    """
    springs = stiffness(number).tolist()
    most, fall = made.AT_REST * made.NORMAL, (made.AT_REST - made.SLIDING) * made.NORMAL
    x, v = [0.0] * number, [made.SPEED] * number
    sign = [0] * number

    def pull(x: list[float], i: int) -> float:
        return -sum(k * u for k, u in zip(springs[i], x))

    def rate(x: list[float], v: list[float]) -> list[float]:
        forces = []
        for i in range(number):
            slip = abs(v[i] - made.SPEED)
            friction = most - fall + fall * exp(-decay * slip)
            forces.append(0.0 if sign[i] == 0 else (pull(x, i) - sign[i] * friction) / made.MASS)
        return forces

    def moved(a: list[float], b: list[float], h: float) -> list[float]:
        return [p + h * q for p, q in zip(a, b)]

    times, places = [0.0], [list(x)]
    for n in range(round(made.TIME / STEP)):
        # what the springs pull beyond friction at rest begins to slide
        for i in range(number):
            if sign[i] == 0 and abs(pull(x, i)) > most:
                sign[i] = 1 if pull(x, i) > 0 else -1
        h = STEP
        a1 = rate(x, v)
        v2 = moved(v, a1, h / 2)
        a2 = rate(moved(x, v, h / 2), v2)
        v3 = moved(v, a2, h / 2)
        a3 = rate(moved(x, v2, h / 2), v3)
        v4 = moved(v, a3, h)
        a4 = rate(moved(x, v3, h), v4)
        x = [p + h / 6 * (q + 2 * r + 2 * s + t) for p, q, r, s, t in zip(x, v, v2, v3, v4)]
        v = [p + h / 6 * (q + 2 * r + 2 * s + t) for p, q, r, s, t in zip(v, a1, a2, a3, a4)]
        for i in range(number):
            slip = v[i] - made.SPEED
            if sign[i] != 0 and slip * sign[i] <= 0.0 and abs(pull(x, i)) < most:
                v[i], sign[i] = made.SPEED, 0
        times.append((n + 1) * STEP)
        places.append(list(x))
    return np.array(times), np.array(places)


def onsets(time: Array, x: Array) -> Array:
    """Times at which a block is farthest along: shortly after it has begun to slide."""
    near = int(0.2 * len(time) / made.TIME)
    farthest = [i for i in range(1, len(x) - near) if x[i] == x[max(0, i - near) : i + near].max()]
    return time[farthest]


def places(results: Result, number: int) -> Array:
    """Displacements of the blocks."""
    return np.array([results.history[f"rigid/EB{k}/U"][:, 0] for k in range(number)]).T


def face_period(results: Result) -> float:
    """Mean period between the times of turning back over that of the closed form."""
    time, v = results.history.time, results.history["rigid/EB0/V"][:, 0]
    k = np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0))
    turns = time[k] + (time[k + 1] - time[k]) * v[k] / (v[k] - v[k + 1])
    return float(np.diff(turns).mean() / made.face_period())


@style.styled
def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    finest: dict[tuple[int, float], tuple[Array, Array]] = {}
    for case in study.runs:
        study.check_run(case.name, 1.0)
        if case.deck == "face.inp":
            study.check("period / closed form", case.name, face_period(study.results[case.name]))
            continue
        number = 1 if case.deck == "one.inp" else 2
        decay = float(case.parameters["decay"])
        results = study.results[case.name]
        time, x = results.history.time, places(results, number)
        times, exact = motion(number, decay)
        amplitude = np.ptp(exact[len(exact) // 3 :])
        at_times = np.array([np.interp(time, times, exact[:, k]) for k in range(number)]).T
        error = np.abs(x - at_times).max() / amplitude
        study.check(f"largest error / amplitude, {case.group}", case.name, float(error))
        if number == 1:
            found, expected = onsets(time, x[:, 0]), onsets(times, exact[:, 0])
            period = np.diff(found).mean() / np.diff(expected).mean()
            study.check(f"period / equation, {case.group}", case.name, float(period))
            height = np.ptp(x[len(x) // 3 :]) / amplitude
            study.check(f"amplitude / equation, {case.group}", case.name, float(height))
        finest[number, decay] = (time, x)
    figure, axes = style.subplots(2, 1, figsize=(8, 6), sharex=True)
    for (number, decay), (time, x) in finest.items():
        ax, (times, exact) = axes[number - 1], motion(number, decay)
        (line, *others) = ax.plot(time, x, label=f"d_c = {decay:g}")
        for other in others:
            other.set_color(line.get_color())
        ax.plot(times, exact, color="black", linestyle=":", linewidth=1)
    for ax, label in zip(axes, ("one block", "two blocks")):
        ax.set(ylabel=f"displacement, {label}")
        ax.legend(title="dotted: equation of motion")
    axes[1].set(xlabel="time")
    style.save(figure, study.output / "motion.png")
