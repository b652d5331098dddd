"""Bodies that bounce without friction: energy, momenta, and the force on a wall."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

impact = runner.load(HERE / "generate.py")

TRANSIT = 2 * impact.LENGTH / impact.WAVE_SPEED
FORCE = impact.WAVE_SPEED * impact.SPEED * impact.DEPTH
IMPULSE = 2 * impact.LENGTH * impact.DEPTH * impact.SPEED


def energy(results: Result) -> Array:
    """T + W as a part of its value at the start."""
    total = results.history.energy["kinetic"] + results.history.energy["strain"]
    return total / total[0]


def not_returned(results: Result) -> float:
    """What contact forces and releases have taken and was not given back, as a part of the energy."""
    account = results.history.energy
    taken = account["release_loss"] - account["normal_contact_work"] - account["landing_return"]
    return float(np.abs(taken[-1]) / results.history.energy.largest)


def unshared(results: Result) -> float:
    """What the contacts of the ledger's returns and releases lack or have too much of, of the energy."""
    worst = 0.0
    for name in ("landing_return", "release_loss"):
        shares = [results.history[f"contact/{contact}/{name}"] for contact in results.contact]
        worst = max(worst, float(np.abs(sum(shares) - results.history.energy[name]).max()))
    return worst / results.history.energy.largest


def momentum_error(results: Result) -> float:
    """Largest change of the momenta, beside the mass times the speed at the start."""
    linear = np.abs(results.history.momentum.linear - results.history.momentum.linear[0]).max()
    angular = np.abs(results.history.momentum.angular - results.history.momentum.angular[0]).max()
    return float(max(linear, angular)) / (2.0 * results.history.energy["kinetic"][0]) ** 0.5


def wall(results: Result) -> tuple[float, float, float]:
    """Mean force in the middle of the contact and its deviation, over rho c v0; impulse over 2 m v0."""
    (contact,) = results.contact.values()
    landing = float(results.history.impacts["time"].min())
    middle = np.abs(results.history.time - landing - 0.5 * TRANSIT) <= 0.2 * TRANSIT
    force = contact.normal[middle] / FORCE
    impulse = results.history[f"contact/{contact.name}/normal_impulse_sum"][-1] / IMPULSE
    return float(force.mean()), float(force.std()), float(impulse)


@style.styled
def draw(study: runner.Study) -> None:
    """Energy of all runs over time."""
    decks = [deck for deck in impact.DECKS if any(deck in c.deck for c in study.runs)]
    figure, axes = style.subplots(len(decks), 1, figsize=(8, 3 * len(decks)), squeeze=False)
    for at, deck in zip(axes[:, 0], decks):
        for case in study.runs:
            if deck in case.deck:
                results = study.results[case.name]
                at.plot(results.history.time, energy(results), label=case.name)
        at.set(ylabel="energy / energy at the start", title=deck)
        at.legend(fontsize="small")
    axes[-1, 0].set_xlabel("time")
    style.save(figure, study.output / "energy.png")


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    rows, walls = [], []
    for case in study.runs:
        results = study.results[case.name]
        deck = case.deck.removesuffix(".inp")
        study.check_run(case.name, impact.edge(deck))
        kept = energy(results)
        study.check("largest rise of the energy", case.name, float(np.diff(kept).max()))
        study.check(f"energy kept, {case.group}", case.name, float(kept[-1]))
        if not case.group.startswith("plastic"):
            suffix = ", events" if case.group.endswith("events") else ""
            taken = f"taken and not returned{suffix}"
            study.check(taken, case.name, not_returned(results))
        study.check("contacts / ledger", case.name, unshared(results))
        if deck == "rings":
            study.check("change of the momenta", case.name, momentum_error(results))
        if deck == "bar":
            force, scatter, impulse = wall(results)
            if case.group != "both" or case.parameters.get("courant", 1.0) <= 1.0:
                study.check("mean force / rho c v0", case.name, force)
            study.check("impulse / change of momentum", case.name, change(results))
            walls.append((case.name, force, scatter, impulse))
        passes = float(results.history.solver["passes"][1:].mean())
        landings = len(results.history.impacts["time"])
        rows.append((case.name, float(results.history.time[-1]), float(kept[-1]), landings, passes))
    header = ("case", "time", "energy kept", "landings", "passes")
    study.table("Bodies that bounce", header, rows)
    study.table("Bar on a wall", ("case", "force", "deviation", "impulse"), walls)
    draw(study)


def change(results: Result) -> float:
    """Impulse of the contact on the bar over the change of its momentum."""
    (contact,) = results.contact.values()
    impulse = results.history[f"contact/{contact.name}/impulse_sum"][-1, 0]
    return float(
        impulse / (results.history.momentum.linear[-1, 0] - results.history.momentum.linear[0, 0])
    )
