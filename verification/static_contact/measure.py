"""Static contact against closed forms: Hertz, Mindlin, shear lag, capstan, a shallow arch."""

import sys
from math import acosh, cos, cosh, log, pi, radians, sin, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of python/)
import numpy as np  # noqa: E402
from stickslip.result import SLIP, Result  # noqa: E402

decks = runner.load(HERE / "generate.py")

PEAK = 2 * decks.PRESS / (pi * decks.HALF_WIDTH)
"""Of Hertz' pressure."""

EDGES = {"lag": 0.025, "capstan": 0.01, "arch": 0.025, "fit": 0.01, "bolt": 0.5}
"""Smallest edges of the elements; those of the cylinders depend on their half width."""


class Touching:
    """Pressed nodes at a time: x beside the half width, both stresses beside the peak."""

    def __init__(self, result: Result, time: float) -> None:
        frame = result.frame(time)
        nodes = np.flatnonzero(np.nan_to_num(frame["CONTACT_PRESSURE"]) > 0)
        self.nodes = nodes[np.argsort(frame.positions[nodes, 0])]
        force = frame["CONTACT_FORCE"][self.nodes]
        self.x = frame.positions[self.nodes, 0] / decks.HALF_WIDTH
        self.pressure = frame["CONTACT_PRESSURE"][self.nodes] / PEAK
        self.shear = self.pressure * np.abs(force[:, 0] / force[:, 1])
        self.slips = frame["CONTACT_STATUS"][self.nodes] == SLIP


def ellipse(x: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Half width and peak of values that form an ellipse: their squares are linear in x^2."""
    slope, start = np.polyfit((x - x.mean()) ** 2 if x.min() < 0 else x**2, values**2, 1)
    return sqrt(-start / slope), sqrt(start)


def bonded(x: np.ndarray) -> np.ndarray:
    """Pressure of a cylinder on a rigid plane without slip, in units of Hertz' a and peak.

    The load grows by flat bonded punches of the half width s, P = c s^2 (Spence 1968), and with
    eta = log(3 - 4 nu)/(2 pi)

        p = int_x^a 2 c s cosh(pi eta)/pi cos(eta log((s+x)/(s-x)))/sqrt(s^2-x^2) ds

    with c from the profile: c int_0^inf 2 tanh u cos(2 eta u)/cosh u du = 2.
    """
    eta = log(3 - 4 * decks.POISSON) / (2 * pi)
    u = np.linspace(0.0, 40.0, 40001)
    c = 2 / np.trapezoid(2 * np.tanh(u) * np.cos(2 * eta * u) / np.cosh(u), u)
    edge = 1 / sqrt(c)
    pressure = np.zeros(len(x))
    for k, place in enumerate(np.maximum(np.abs(x), 1e-6)):
        if place < edge:
            u = np.linspace(0.0, acosh(edge / place), 4001)[1:]
            s = place * np.cosh(u)
            wave = np.cos(eta * np.log((s + place) / (s - place)))
            pressure[k] = np.trapezoid(c * s * cosh(pi * eta) * wave, u)
    return pressure


def hertz(study: runner.Study) -> None:
    """Half width, peak and pressures; two meshes."""
    errors, peaks = {}, {}
    for case, result in study.group("hertz"):
        touching = Touching(result, 1.0)
        inner = touching.x < 0.9
        width, peak = ellipse(touching.x[inner], touching.pressure[inner])
        exact = np.sqrt(np.maximum(1 - touching.x**2, 0))
        errors[case.name] = float(np.sqrt(np.mean((touching.pressure - exact) ** 2)))
        peaks[case.name] = peak
        study.check("half width / Hertz", case.name, width)
        study.check("peak pressure / Hertz", case.name, peak)
        study.check("error of pressure / peak", case.name, errors[case.name])
    for name in ("hertz", "hertz_like"):
        study.check(
            "error of pressure, fine / coarse", name, errors[f"{name}_16"] / errors[f"{name}_8"]
        )
    rough = peaks["hertz_like_mu03_16"] / peaks["hertz_like_16"]
    study.check("peak, rough / smooth", "hertz_like_mu03_16", rough)
    for case, result in study.group("bonded"):
        touching = Touching(result, 1.0)
        exact = bonded(touching.x)
        error = float(np.sqrt(np.mean((touching.pressure - exact) ** 2)))
        study.check("error of bonded pressure / peak", case.name, error)
        study.check("peak, bonded", case.name, touching.pressure[0] / exact[0])


def softening(share: float) -> float:
    """How much farther Q = share mu P moves two like cylinders than it would without slip.

    The shear stress is the difference of two ellipses of the half widths a and c, each of which
    moves a surface by 2 Q/(pi E') (log(2 d/a) + 1/2) beside its far field.
    """
    held = decks.FRICTION * decks.PRESS
    return 2 * held / (pi * decks.MODULUS) * (share + (1 - share) * log(1 - share))


def first_dissipation(share: float) -> float:
    """Dissipation up to Q = share mu P, a quarter of Masing's loop: Q u - 2 int u dQ."""
    held = decks.FRICTION * decks.PRESS
    rest = 1 - share
    integral = share**2 / 2 - 0.25 - rest**2 / 2 * log(rest) + rest**2 / 4
    return share * held * softening(share) - 2 * held * 2 * held / (pi * decks.MODULUS) * integral


def ends(result: Result) -> list[int]:
    """Last row of each step in the history."""
    step = result.history.step
    return [int(np.flatnonzero(step == k)[-1]) for k in range(1, step.max() + 1)]


def mindlin(study: runner.Study) -> None:
    """Stick zone, displacement and dissipation in any number of increments; cycles."""
    way, lost = {}, {}
    groups = [*study.group("mindlin"), *study.group("mindlin_fine")]
    for case, result in groups:
        touching = Touching(result, 2.0)
        sticks = ~touching.slips
        free = decks.FRICTION * touching.pressure - touching.shear
        stick, _ = ellipse(touching.x[sticks], free[sticks])
        study.check("stick zone / (0.632 a)", case.name, stick / sqrt(1 - decks.SHARE))
        u = result.history.nodes["HEAD"].U[:, 0, 0]
        friction = result.history.energy.friction_dissipation
        pressed, sheared = ends(result)
        way[case.name] = u[sheared] - u[pressed]
        lost[case.name] = friction[sheared] - friction[pressed]
        study.check(
            "dissipation / Mindlin", case.name, lost[case.name] / first_dissipation(decks.SHARE)
        )
        if case.parameters["increments"] == 2:
            half = u[pressed + 1] - u[pressed]
            exact = softening(decks.SHARE) - 2 * softening(decks.SHARE / 2)
            value = (way[case.name] - 2 * half) / exact
            study.check("softening of Q / Mindlin", case.name, value)
    for name in way:
        if name not in ("mindlin_1", "mindlin_fine"):
            study.check(
                "displacement, N against 1 increments", name, abs(way[name] / way["mindlin_1"] - 1)
            )
            study.check(
                "dissipation, N against 1 increments", name, abs(lost[name] / lost["mindlin_1"] - 1)
            )
    for case, result in study.group("cycles"):
        u = result.history.nodes["HEAD"].U[:, 0, 0]
        friction = result.history.energy.friction_dissipation
        turns = ends(result)
        way = u[turns] - u[turns[0]]
        closed = max(np.abs(way[3::2] / way[1] - 1).max(), np.abs(way[2::2] / way[1] + 1).max())
        study.check("loop not closed / displacement", case.name, float(closed))
        loss = np.diff(friction[turns])
        cycle = (loss[1] + loss[2]) / (4 * loss[0])
        study.check("dissipation of a cycle / (4 first)", case.name, float(cycle))


def shear_lag(study: runner.Study) -> None:
    """Slip length, displacement and dissipation, and what is left when the strip is let go."""
    errors = []
    for case, result in study.group("lag"):
        thickness = case.parameters["thickness"]
        pull = decks.STRAIN * decks.YOUNG * thickness
        way = decks.STRAIN * decks.SLIP_LENGTH / 2
        u = result.history.nodes["END"].U[:, :, 0].mean(axis=1)
        friction = result.history.energy.friction_dissipation
        pressed, pulled, free = ends(result)
        moved = (u[pulled] - u[pressed]) / way
        errors.append(abs(moved - 1))
        study.check("displacement / shear lag", case.name, moved)
        left = (u[free] - u[pressed]) / (u[pulled] - u[pressed])
        study.check("displacement left / first", case.name, left)
        lost = (friction[pulled] - friction[pressed]) / (pull * way / 3)
        study.check("dissipation / shear lag", case.name, lost)
        touching = Touching(result, 2.0)
        reached = result.coordinates[touching.nodes[touching.slips], 0].min()
        slips = (decks.STRIP - reached) / decks.SLIP_LENGTH
        study.check("slip length / shear lag", case.name, slips)
    study.check("error of displacement, thin / thick", "lag", errors[1] / errors[0])


def capstan(study: runner.Study) -> None:
    """The ratio of the tensions of a strip that slides: mean of the last increments."""
    for case, result in study.group("capstan"):
        wrap = radians(case.parameters["degrees"])
        pull = result.history.nodes["PULLED"].RF.sum(axis=1)
        tension = pull[-4:] @ np.array([cos(wrap / 2), -sin(wrap / 2)])
        load = decks.TENSION * decks.YOUNG * decks.BELT
        exponent = case.parameters["friction"] * wrap / (1 + decks.BELT / 2)
        ratio = float(np.log(tension / load).mean()) / exponent
        study.check("log(T1/T2) / (mu wrap R/r)", case.name, ratio)


def arch(study: runner.Study) -> None:
    """Force and way of the punch before, at and beyond the largest force."""
    path = np.array(decks.punch_forces(*decks.ARCH))
    largest, _ = decks.limit_load(*decks.ARCH)
    way = {
        case.name: -result.history.nodes["HEAD"].U[:, 0, 1]
        for case, result in study.group("arch")
    }
    result = study.results["arch_pushed"]
    (contact,) = result.contact.values()
    force = 2 * np.abs(contact.force[1:, 1])
    exact = np.interp(way["arch_pushed"][1:], *path.T)
    worst = force / exact
    worst = worst[np.abs(worst - 1).argmax()]
    study.check("force of the punch / shallow arch", "arch_pushed", float(worst))
    study.check("largest force / shallow arch", "arch_pushed", force[:-1].max() / largest)
    snapped = path[path[:, 0] > 1.5 * decks.ARCH[1]]
    end = np.interp(1.1 * largest, *snapped.T[::-1])
    study.check("way of the punch / shallow arch", "arch_snaps", way["arch_snaps"][-1] / end)


def fits(study: runner.Study) -> None:
    """Pressure, hoop stress and energy of a ring pressed on a shaft."""
    for case, result in study.group("fit"):
        units, stiffer = (case.parameters.get(name, 1.0) for name in ("units", "stiffer"))
        pressure, hollow = decks.lame()
        scale = stiffer * pressure
        frame = result.frames[-1]
        inside = result.node_set("INSIDE")
        inner = inside[1:-1]
        found = np.nan_to_num(frame["CONTACT_PRESSURE"][inner]) / scale
        name = "hoop stress / Lame"
        if case.parameters.get("ring", 1.0) == 1.0:
            study.check("pressure / Lame", case.name, float(found.mean()))
        else:
            name += ", meshes that do not match"
        ring = result.element_set("HUB")
        corners = np.array([result.cells[element] for element in ring])
        centre = frame.positions[corners].mean(axis=1)
        radius = np.hypot(*centre.T)
        x, y = centre.T / radius
        s = frame["S"][ring]
        around = s[:, 0] * y**2 + s[:, 1] * x**2 - 2 * s[:, 2] * x * y
        exact = scale * hollow * (1 + (units * decks.FIT["rim"] / radius) ** 2)
        study.check(name, case.name, float((around / exact).mean()))
        energy = result.history.energy
        lost = energy.external_work[-1] - energy.strain[-1]
        study.check(
            "external work less strain energy", case.name, abs(lost) / energy.strain[-1]
        )


def bolts(study: runner.Study) -> None:
    """Way of the tightening, and force of the locked bolt beside springs side by side."""
    length, load = decks.BOLT["length"], decks.BOLT["preload"]
    stiff = [decks.YOUNG * decks.BOLT[name] / length for name in ("bolt", "flange")]
    for case, result in study.group("bolt"):
        asked = result.history.nodes["TIGHTENING"]
        tightened, end = ends(result)
        way = load / stiff[0] + load / stiff[1]
        study.check(
            "tightening / springs", case.name, float(asked.U[tightened, 0, 0]) / way
        )
        pull = case.parameters["pull"] * load
        exact = max(load + pull * stiff[0] / sum(stiff), pull)
        force = float(asked.RF[end, 0, 0])
        study.check("force of the bolt / springs", case.name, force / exact)


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    for case in study.runs:
        study.check_run(case.name, EDGES.get(case.group, decks.HALF_WIDTH / 32))
    for part in (hertz, mindlin, shear_lag, capstan, arch, fits, bolts):
        part(study)
    rows = [
        (name, len(result.history.dt) - 1, int(result.history.solver["passes"][1:].max()))
        for name, result in study.results.items()
    ]
    study.table("Passes", ("case", "increments", "most passes"), rows)
