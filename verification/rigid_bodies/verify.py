"""Rigid bodies that turn: pendulum, moment, collision, tumbling square, Painleve's rod, cam, gears."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Array, Result  # noqa: E402

import generate as made  # noqa: E402

GRAVITY = 9.81


def of_body(results: Result, name: str, quantity: str) -> Array:
    """History of a rigid body."""
    return np.asarray(results.history[f"rigid/{name}/{quantity}"])


def rise(results: Result) -> float:
    """Largest rise of T less the work of the loads from one increment to the next, of the largest energy."""
    account = results.history.energy
    total = account["kinetic"] - account["external_work"]
    return float(np.diff(total).max() / account.largest)


def momentum_error(results: Result) -> float:
    """Largest change of the momenta, beside those of the fastest motion at the start."""
    linear = np.abs(results.history.momentum.linear - results.history.momentum.linear[0]).max()
    angular = np.abs(results.history.momentum.angular - results.history.momentum.angular[0]).max()
    return float(max(linear, angular)) / (2.0 * results.history.energy["kinetic"][0]) ** 0.5


def check_cam(verification: runner.Verification) -> None:
    """Lift, force and friction of the cam against those of a circle."""
    for name in ("cam", "cam_720"):
        results = verification.results[name]
        theta = made.CAM_SPEED * results.history.time
        lift = made.OFFSET * (1 - np.cos(theta))
        error = np.abs(of_body(results, "EFOLLOWER", "U")[:, 1] - lift).max() / made.OFFSET
        at_corners = name == "cam"
        end = ", corners at the increments" if at_corners else ""
        verification.check("lift / closed form" + end, name, float(error))
        if not at_corners:
            continue
        inertia = made.OFFSET * made.CAM_SPEED**2 * np.cos(theta)
        force = made.PRELOAD + made.SPRING * lift + inertia
        (contact,) = results.history.contact.values()
        # the force of an increment is that of its middle; the first two are the start
        error = np.abs(contact.normal - force)[2:].max() / force.max()
        verification.check("force / closed form" + end, name, float(error))
        height = made.RADIUS - made.OFFSET * np.cos(theta)
        work = made.CAM_FRICTION * float(np.trapezoid(force * height, theta))
        spent = results.history.energy["friction_dissipation"][-1]
        verification.check("friction work / closed form" + end, name, float(spent / work))


def check_gears(verification: runner.Verification) -> None:
    """The ratio of the gears at every angle, and what their contact takes."""
    results = verification.results["gears"]
    drive, driven = (of_body(results, name, "angle") for name in ("EDRIVE", "EDRIVEN"))
    ratio = made.TEETH[0] / made.TEETH[1]
    verification.check(
        "angle of the driven gear / closed form",
        "gears",
        float(np.abs(driven + ratio * drive).max()),
    )
    account = results.history.energy
    lost = account["external_work"][-1] - account["kinetic"][-1] + account["kinetic"][0]
    done = made.MOMENT * abs(driven[-1])
    verification.check("work lost between the gears", "gears", float(lost / done))


def main() -> int:
    """Runs, checks, draws, reports."""
    verification = runner.start(HERE)
    for case in verification.cases:
        verification.check_run(case.name, 1.0)
    all_results = verification.results

    pendulum = all_results["pendulum"]
    omega = np.abs(of_body(pendulum, "EBAR", "angular_velocity"))
    # m = 0.2, l = 1, I = m (4 + 0.01)/12 + m
    exact = np.sqrt(2 * GRAVITY / ((4 + 0.01) / 12 + 1))
    verification.check("largest angular velocity / closed form", "pendulum", omega.max() / exact)
    height = of_body(pendulum, "EBAR", "center")[:, 1]
    energy = of_body(pendulum, "EBAR", "kinetic") + 0.2 * GRAVITY * height
    verification.check(
        "work of gravity / energy", "pendulum", float(np.abs(energy).max() / (0.2 * GRAVITY))
    )

    moment = all_results["moment"]
    omega = of_body(moment, "ESQUARE", "angular_velocity")
    verification.check("angular velocity / closed form", "moment", float(omega[-1] / 18.0))
    loaded = moment.history.time <= 1.0
    angle = of_body(moment, "ESQUARE", "angle")[loaded]
    kinetic = of_body(moment, "ESQUARE", "kinetic")[loaded]
    verification.check("T / M theta", "moment", float(kinetic[-1] / (3.0 * angle[-1])))

    verification.check("change of the momenta", "boxes", momentum_error(all_results["boxes"]))
    for name in ("boxes", "square", "rod"):
        verification.check("largest rise of the energy", name, rise(all_results[name]))
    for name in ("boxes", "square", "rod"):
        verification.check("cutbacks", name, int(all_results[name].run["cutbacks"]))
    square = of_body(all_results["square"], "ESQUARE", "center")
    verification.check("height at rest / closed form", "square", float(square[-1, 1] / 0.5))

    check_cam(verification)
    check_gears(verification)

    figure, axes = plt.subplots(figsize=(8, 4))
    for name, body in (("square", "ESQUARE"), ("rod", "NENDS")):
        time = all_results[name].history.time
        axes.plot(time, of_body(all_results[name], body, "angle"), label=f"{name}: angle")
    axes.set(xlabel="time", ylabel="angle (rad)")
    axes.legend()
    style.save(figure, verification.output / "angles.png")
    return verification.finish()


if __name__ == "__main__":
    sys.exit(main())
