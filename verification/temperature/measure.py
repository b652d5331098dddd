"""Heated bodies beside closed forms: Timoshenko's strip, Lame's rings, a pipe, a block between rough walls."""

import sys
from math import log, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of python/)
import numpy as np  # noqa: E402
from stickslip.result import Result  # noqa: E402

decks = runner.load(HERE / "generate.py")

RISE = decks.HOT - decks.COLD
THETA = 1.0 + decks.EXPANSION * RISE
"""Stretch of a body that is heated from the initial to the highest temperature."""

EDGES = {"free": 0.2, "clamped": 1.0, "bimetal": 0.2, "shrink": 0.05, "pipe": 0.06, "walls": 1.0, "flight": 0.5}
"""Smallest edges of the elements."""


def last(result: Result) -> dict[str, np.ndarray]:
    """Displacements and stresses of the last frame."""
    frame = result.frame(result.history.time[-1])
    return {name: np.asarray(frame[name]) for name in ("U", "S", "S33", "CONTACT_PRESSURE")}


def free(study: runner.Study) -> None:
    """A body that may expand has no stress; plane strain has that across."""
    for case, result in study.group("free"):
        fields, kind = last(result), str(case.parameters["kind"])
        stretch = THETA
        if kind.startswith("CPE"):
            # (E_m)_33 = (1/theta² - 1)/2, and the law is that of St. Venant and Kirchhoff: S = E (E_m)_33 across
            across = (THETA**-2 - 1) / 2
            stretch = THETA * sqrt(1 - 2 * decks.POISSON * across)
            stress = THETA * decks.YOUNG * across / stretch**2
            error = np.abs(fields["S33"] / stress - 1).max()
            study.check("stress across in plane strain, error", case.name, float(error))
        else:
            study.check("stress around, as a part of E", case.name, float(np.abs(fields["S33"]).max()) / decks.YOUNG)
        study.check("stress as a part of E", case.name, float(np.abs(fields["S"]).max()) / decks.YOUNG)
        exact = (stretch - 1) * result.coordinates
        study.check("displacement, error", case.name, float(np.abs(fields["U"][:, :2] - exact).max() / (stretch - 1)))


def clamped(study: runner.Study) -> None:
    """Force of a bar between walls: theta³ times the Kirchhoff stress of the law at the stretch 1/theta."""
    hardening = decks.YIELD / 0.01
    for case, result in study.group("clamped"):
        strain = log(THETA)
        flown = (decks.YOUNG * strain - decks.YIELD) / (decks.YOUNG + hardening)
        exact = {
            "kirchhoff": THETA * decks.YOUNG * (THETA**-2 - 1) / 2,
            "hencky": -(THETA**3) * decks.YOUNG * strain,
            "plastic": -(THETA**3) * (decks.YIELD + hardening * flown),
        }[str(case.parameters.get("law", "kirchhoff"))]
        found = float(result.history.nodes["END"].RF[-1, :, 0].sum())
        study.check("force of a clamped bar, error", case.name, abs(found / exact - 1))


def bimetal(study: runner.Study) -> None:
    """Timoshenko 1925: the curvature of two layers, in their middle."""
    strip = decks.STRIP
    ratio, stiffness = strip["lower"] / strip["upper"], 1 / strip["stiffer"]
    height = strip["lower"] + strip["upper"]
    strain = (strip["expansion"] - 1e-5) * RISE
    curvature = 6 * strain * (1 + ratio) ** 2 / height
    curvature /= 3 * (1 + ratio) ** 2 + (1 + ratio * stiffness) * (ratio**2 + 1 / (ratio * stiffness))
    for case, result in study.group("bimetal"):
        # away from the ends: the turn of the lower side between a quarter and three quarters of the length
        x, y = result.coordinates.T
        u = last(result)["U"]
        line = np.flatnonzero((y == 0.0) & (np.abs(x / strip["length"] - 0.5) < 0.26))
        line = line[np.argsort(x[line])]
        found = 2 * np.polyfit(x[line] + u[line, 0], u[line, 1], 2)[0]
        study.check("curvature / Timoshenko", case.name, float(abs(found) / curvature))


def shrink(study: runner.Study) -> None:
    """Lame: the interference divided by the sum of the compliances of both rings."""
    inner, radius, rim = 0.5 * decks.RINGS["radius"], decks.RINGS["radius"], decks.RINGS["rim"]
    young, poisson = decks.YOUNG, decks.POISSON
    hub = (rim**2 + radius**2) / (rim**2 - radius**2) + poisson
    shaft = (radius**2 + inner**2) / (radius**2 - inner**2) - poisson
    exact = decks.EXPANSION * RISE * young / (hub + shaft)
    for case, result in study.group("shrink"):
        pressure = last(result)["CONTACT_PRESSURE"]
        pressure = pressure[~np.isnan(pressure)]
        study.check("mean pressure / Lame", case.name, float(pressure.mean() / exact))
        study.check("scatter of the pressure", case.name, float(pressure.std() / exact))


def pipe(study: runner.Study) -> None:
    """Timoshenko & Goodier: hoop stress of a pipe with the temperature of steady heat flow, at small strains."""
    inner, outer = decks.PIPE
    young, poisson, alpha = decks.YOUNG, decks.POISSON, 1e-6
    ratio = log(outer / inner)
    factor = young * alpha * RISE / (2 * (1 - poisson) * ratio)
    worst = {}
    for case, result in study.group("pipe"):
        cells = int(case.parameters["cells"])
        edges = np.linspace(inner, outer, cells + 1)
        r = (edges[1:] + edges[:-1]) / 2
        share = inner**2 / (outer**2 - inner**2)
        exact = factor * (1 - np.log(outer / r) - share * (1 + outer**2 / r**2) * ratio)
        largest = factor * (2 * outer**2 / (outer**2 - inner**2) * ratio - 1)
        worst[case.name] = float(np.abs(last(result)["S33"] - exact).max() / largest)
        study.check("hoop stress, error / largest", case.name, worst[case.name])


def walls(study: runner.Study) -> None:
    """A block that slides when it is cold, until its spring takes what friction does not hold, and then no more."""
    block = decks.BLOCK
    for case, result in study.group("walls"):
        theta = 1 + decks.EXPANSION * (block["cold"] - decks.COLD)
        normal = theta * decks.YOUNG * (1 - theta**-2) / 2
        held = 2 * block["friction"] * normal
        slip = (block["load"] - held) / (4 * block["spring"])
        u, history = result.history.nodes["ALL"].U[:, 0, 1], result.history
        ends = [int(np.flatnonzero(history.step == k)[-1]) for k in range(1, history.step.max() + 1)]
        study.check("slip of the first cold time, error", case.name, abs(float(-u[ends[2]] / slip) - 1))
        study.check("slip of later cycles / first", case.name, float(np.ptp(u[ends[2] :]) / slip))
        work = history.energy.friction_dissipation
        study.check("dissipation after the first cycle / before", case.name, float(work[-1] / work[ends[2]]) - 1)


def flight(study: runner.Study) -> None:
    """Momenta of a body that is heated in flight, and its energy."""
    for case, result in study.group("flight"):
        energy, momentum = result.history.energy, result.history.momentum
        scale = float(energy.scale[-1])
        drift = momentum.linear - momentum.linear[0]
        study.check("change of the linear momentum", case.name, float(np.abs(drift[:, 1]).max() / np.abs(momentum.linear[0]).max()))
        if not str(case.parameters["kind"]).startswith("CAX"):
            angular = momentum.angular
            study.check("change of the angular momentum", case.name, float(np.ptp(angular) / abs(angular[0])))
        study.check("numerical dissipation / largest energy", case.name, float(np.abs(energy.numerical_dissipation).max() / scale))
        study.check("work of the temperature / largest energy", case.name, float(np.abs(energy.thermal_work).max() / scale))


def measure(study: runner.Study) -> None:
    """All problems."""
    for case in study.runs:
        study.check_run(case.name, EDGES[case.group], ", heated")
    for problem in (free, clamped, bimetal, shrink, pipe, walls, flight):
        problem(study)
