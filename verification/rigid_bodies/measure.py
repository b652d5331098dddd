"""Rigid bodies that turn: pendulum, moment, collision, tumbling square, Painleve's rod, cam, gears, linkages."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

made = runner.load(HERE / "generate.py")


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


def check_cam(study: runner.Study) -> None:
    """Lift, force and friction of the cam against those of a circle."""
    for name in ("cam", "cam_720"):
        results = study.results[name]
        theta = made.CAM_SPEED * results.history.time
        lift = made.OFFSET * (1 - np.cos(theta))
        error = np.abs(of_body(results, "EFOLLOWER", "U")[:, 1] - lift).max() / made.OFFSET
        at_corners = name == "cam"
        end = ", corners at the increments" if at_corners else ""
        study.check("lift / closed form" + end, name, float(error))
        if not at_corners:
            continue
        inertia = made.OFFSET * made.CAM_SPEED**2 * np.cos(theta)
        force = made.PRELOAD + made.SPRING * lift + inertia
        (contact,) = results.history.contact.values()
        # the force of an increment is that of its middle; the first two are the start
        error = np.abs(contact.normal - force)[2:].max() / force.max()
        study.check("force / closed form" + end, name, float(error))
        height = made.RADIUS - made.OFFSET * np.cos(theta)
        work = made.CAM_FRICTION * float(np.trapezoid(force * height, theta))
        spent = results.history.energy["friction_dissipation"][-1]
        study.check("friction work / closed form" + end, name, float(spent / work))


def check_gears(study: runner.Study) -> None:
    """The ratio of the gears at every angle, and what their contact takes."""
    results = study.results["gears"]
    drive, driven = (of_body(results, name, "angle") for name in ("EDRIVE", "EDRIVEN"))
    ratio = made.TEETH[0] / made.TEETH[1]
    study.check(
        "angle of the driven gear / closed form",
        "gears",
        float(np.abs(driven + ratio * drive).max()),
    )
    account = results.history.energy
    lost = account["external_work"][-1] - account["kinetic"][-1] + account["kinetic"][0]
    done = made.MOMENT * abs(driven[-1])
    study.check("work lost between the gears", "gears", float(lost / done))


def two_rods(time: float) -> Array:
    """Angles of two hanging rods at a time, by Runge and Kutta."""
    inertia = (1 + made.THICKNESS**2) / 12

    def rate(y: Array) -> Array:
        (first, second), rates = y
        off = np.cos(first - second) / 2
        mass = np.array([[inertia + 1.25, off], [off, inertia + 0.25]])
        turn = np.sin(first - second) / 2
        load = [
            -1.5 * made.GRAVITY * np.cos(first) - turn * rates[1] ** 2,
            -0.5 * made.GRAVITY * np.cos(second) + turn * rates[0] ** 2,
        ]
        return np.array([rates, np.linalg.solve(mass, load)])

    y = np.array([made.HANGING[:2], (0.0, 0.0)])
    count = 5000
    h = time / count
    for _ in range(count):
        k1 = rate(y)
        k2 = rate(y + h / 2 * k1)
        k3 = rate(y + h / 2 * k2)
        k4 = rate(y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.asarray(y[0])


def check_chains(study: runner.Study) -> None:
    """Energy and momenta of bars on hinges, and the order of their error."""
    for name, results in study.results.items():
        if "chain" not in name:
            continue
        account = results.history.energy
        total = account["kinetic"] - account["external_work"]
        error = np.abs(total - total[0]).max() / account.largest
        study.check("change of the energy on hinges", name, float(error))
        if "flying" in name:
            study.check("change of the momenta", name, momentum_error(results))
    exact = two_rods(made.CHAIN_TIME)
    errors = []
    for name in ("hanging_chain", "hanging_chain_400", "hanging_chain_800"):
        results = study.results[name]
        angles = [of_body(results, f"EBAR{k}", "angle")[-1] for k in (1, 2)]
        errors.append(float(np.linalg.norm(np.add(angles, made.HANGING[:2]) - exact)))
    order = np.log2(errors[-2] / errors[-1])
    study.check("order of the error on hinges", "hanging_chain_800", float(order))


def check_slider_crank(study: runner.Study) -> None:
    """Position of the slider, torque without friction, and friction work."""
    radius, rod, speed = made.CRANK, made.ROD, made.CRANK_SPEED

    def motion(theta: Array) -> tuple[Array, Array, Array]:
        """Angle of the rod, its rate, and the velocity of the slider."""
        angle = np.arcsin(-radius * np.sin(theta) / rod)
        rate = -radius * np.cos(theta) * speed / (rod * np.cos(angle))
        return angle, rate, -radius * np.sin(theta) * speed - rod * np.sin(angle) * rate

    def kinetic(theta: Array) -> Array:
        """Of rod and slider."""
        angle, rate, velocity = motion(theta)
        mass = made.LIGHT * made.THICKNESS * rod
        x = -radius * np.sin(theta) * speed - rod / 2 * np.sin(angle) * rate
        y = radius * np.cos(theta) * speed + rod / 2 * np.cos(angle) * rate
        inertia = mass * (rod**2 + made.THICKNESS**2) / 12
        return np.asarray((velocity**2 + mass * (x**2 + y**2) + inertia * rate**2) / 2)

    for name in ("slider_crank", "slider_crank_mu03"):
        results = study.results[name]
        theta = speed * results.history.time
        exact = radius * np.cos(theta) + np.sqrt(rod**2 - (radius * np.sin(theta)) ** 2)
        error = np.abs(of_body(results, "ESLIDER", "position")[:, 0] - exact).max() / rod
        study.check("position of the slider / closed form", name, float(error))
    results = study.results["slider_crank"]
    theta = speed * results.history.time
    middle, half = (theta[1:] + theta[:-1]) / 2, 1e-5
    torque = (kinetic(middle + half) - kinetic(middle - half)) / (2 * half)
    error = np.abs(of_body(results, "ECRANK", "moment")[1:] - torque)[1:].max() / np.abs(torque).max()
    study.check("torque of the crank / closed form", "slider_crank", float(error))

    results = study.results["slider_crank_mu03"]
    theta = np.linspace(0.0, 2 * np.pi, 100_001)
    angle, _, velocity = motion(theta)
    acceleration = np.gradient(velocity, theta) * speed
    mu, side = 0.3, np.sign(velocity)
    force = (acceleration + mu * made.PRESS * side) / (np.cos(angle) + mu * side * np.sin(angle))
    work = np.trapezoid(mu * (made.PRESS - force * np.sin(angle)) * np.abs(velocity), theta) / speed
    spent = results.history.energy["friction_dissipation"][-1]
    study.check(
        "friction work of the slider / closed form", "slider_crank_mu03", float(spent / work)
    )


@style.styled
def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    for case in study.runs:
        study.check_run(case.name, 1.0)
    all_results = study.results

    pendulum = all_results["pendulum"]
    omega = np.abs(of_body(pendulum, "EBAR", "angular_velocity"))
    # m = 0.2, l = 1, I = m (4 + 0.01)/12 + m
    exact = np.sqrt(2 * GRAVITY / ((4 + 0.01) / 12 + 1))
    study.check("largest angular velocity / closed form", "pendulum", omega.max() / exact)
    height = of_body(pendulum, "EBAR", "center")[:, 1]
    energy = of_body(pendulum, "EBAR", "kinetic") + 0.2 * GRAVITY * height
    study.check(
        "work of gravity / energy", "pendulum", float(np.abs(energy).max() / (0.2 * GRAVITY))
    )

    moment = all_results["moment"]
    omega = of_body(moment, "ESQUARE", "angular_velocity")
    study.check("angular velocity / closed form", "moment", float(omega[-1] / 18.0))
    loaded = moment.history.time <= 1.0
    angle = of_body(moment, "ESQUARE", "angle")[loaded]
    kinetic = of_body(moment, "ESQUARE", "kinetic")[loaded]
    study.check("T / M theta", "moment", float(kinetic[-1] / (3.0 * angle[-1])))

    study.check("change of the momenta", "boxes", momentum_error(all_results["boxes"]))
    for name in ("boxes", "square", "rod"):
        study.check("largest rise of the energy", name, rise(all_results[name]))
    for name in ("boxes", "square", "rod"):
        study.check("cutbacks", name, int(all_results[name].run["cutbacks"]))
    square = of_body(all_results["square"], "ESQUARE", "center")
    study.check("height at rest / closed form", "square", float(square[-1, 1] / 0.5))

    check_cam(study)
    check_gears(study)
    check_chains(study)
    check_slider_crank(study)

    figure, axes = style.subplots(figsize=(8, 4))
    for name, body in (("square", "ESQUARE"), ("rod", "NENDS")):
        time = all_results[name].history.time
        axes.plot(time, of_body(all_results[name], body, "angle"), label=f"{name}: angle")
    axes.set(xlabel="time", ylabel="angle (rad)")
    axes.legend()
    style.save(figure, study.output / "angles.png")
