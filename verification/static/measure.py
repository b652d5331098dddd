"""Static steps against closed forms: elastica, slope, path of friction, a body on supports, release."""

import sys
from math import cos, pi, radians, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of python/)
import numpy as np  # noqa: E402
from stickslip.result import Result  # noqa: E402

decks = runner.load(HERE / "generate.py")


def elastica(load: float, points: int = 4001) -> tuple[float, float]:
    """Deflection and shortening of the end beside the length, by the angle of the end."""
    s = np.linspace(0.0, 1.0, points)
    h = s[1] - s[0]

    def angles(start: float) -> np.ndarray:
        """theta'' = -load cos(theta) from theta(0) = 0, theta'(0) = start, by Runge-Kutta steps."""
        theta = np.zeros(points)
        state = np.array([0.0, start])

        def rate(y: np.ndarray) -> np.ndarray:
            return np.array([y[1], -load * cos(y[0])])

        for k in range(points - 1):
            a = rate(state)
            b = rate(state + h / 2 * a)
            c = rate(state + h / 2 * b)
            d = rate(state + h * c)
            state = state + h / 6 * (a + 2 * b + 2 * c + d)
            theta[k + 1] = state[0]
        angles.bent = state[1]
        return theta

    low, high = 0.0, 10.0 * load
    for _ in range(60):
        start = 0.5 * (low + high)
        theta = angles(start)
        low, high = (start, high) if angles.bent < 0 else (low, start)
    mean = lambda values: h * (values.sum() - 0.5 * (values[0] + values[-1]))  # noqa: E731
    return mean(np.sin(theta)), 1.0 - mean(np.cos(theta))


def end(results: Result, name: str) -> np.ndarray:
    """Displacement of a set of nodes at the end of the run."""
    return results.history.nodes[name].U[-1].mean(axis=0)


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    results = study.results
    for case in study.runs:
        study.check_run(case.name, 0.1)
        passes = results[case.name].history.solver["passes"][1:]
        study.check("passes per increment", case.name, float(np.max(passes)))
    for load in decks.LOADS:
        name = f"elastica_{load}"
        deflection, shortening = elastica(load)
        u = end(results[name], "END") / decks.LENGTH
        study.check("deflection / elastica", name, float(-u[1] / deflection))
        study.check("shortening / elastica", name, float(-u[0] / shortening))
    history = results["released"].history
    moving = history.step == 2
    energy = history.energy["kinetic"] + history.energy["strain"]
    energy = energy + history.energy["numerical_dissipation"]
    static = energy[~moving][-1]
    drift = np.abs(energy[moving] - static).max() / static
    study.check("energy drift after the release", "released", float(drift))
    u = history.nodes["END"].U[:, 0, 1]
    bent = u[~moving][-1]
    study.check(
        "amplitude / static deflection", "released", float(-u[moving].max() / bent)
    )
    (contact,) = results["incline"].contact.values()
    slope = radians(decks.SLOPE)
    weight = 0.5
    held = contact.tangential[-1] / contact.normal[-1]
    friction = sin(slope) / cos(slope) + decks.MARGIN
    study.check(
        "sliding force / holding force", "incline", float(abs(held) / friction)
    )
    carried = np.hypot(*contact.force[-1]) / weight
    study.check("weight carried", "incline", float(carried))
    pressed = sum(contact.force[-1][1] for contact in results["supports"].contact.values())
    study.check("weight carried", "supports", float(pressed / (decks.SPAN * decks.SUPPORTED)))
    first, last = (results[f"path_{n}"] for n in (decks.PATHS[0], decks.PATHS[-1]))
    u = [end(result, "TOP") for result in (first, last)]
    difference = np.abs(u[0] - u[1]).max() / np.abs(u[1]).max()
    study.check("displacement, 1 against 16 increments", "path_1", float(difference))
    lost = [result.history.energy["friction_dissipation"][-1] for result in (first, last)]
    study.check(
        "dissipation, 1 against 16 increments", "path_1", float(abs(lost[0] / lost[1] - 1))
    )
