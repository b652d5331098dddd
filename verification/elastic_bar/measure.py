"""Elastic bar on a fixed wall: wall force, contact time and rebound against wave theory."""

import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

bar = runner.load(HERE / "generate.py")

TRANSIT = 2 * bar.LENGTH / bar.WAVE_SPEED
LANDING = bar.GAP / bar.SPEED
FORCE = bar.DENSITY * bar.WAVE_SPEED * bar.SPEED * bar.DEPTH * bar.THICKNESS
LABELS = {"ss22": "SS22 (1, 1)", "em": "energy-momentum"}


@dataclass(frozen=True)
class Figures:
    """Measured figures of one run."""

    landing: float
    mean: float
    deviation: float
    scatter: float
    duration: float
    rebound: float
    energy: float

    @classmethod
    def of(cls, results: Result) -> "Figures":
        """Measures a run; forces are relative to rho c v0, speeds to v0."""
        (contact,) = results.contact.values()
        landing = float(results.history.impacts["time"].min())
        closed = results.history.time[contact.closed > 0]
        middle = np.abs(results.history.time - landing - 0.5 * TRANSIT) <= 0.2 * TRANSIT
        force = contact.normal[middle] / FORCE
        speed = mean_speed(results)
        account = results.history.energy
        total = account["kinetic"] + account["strain"]
        return cls(
            landing,
            float(force.mean()),
            float(np.abs(force - 1.0).max()),
            float(force.std() / force.mean()),
            float(closed[-1]) - landing,
            float(speed[-1] / bar.SPEED),
            float(total[-1] / total[0]),
        )


def mean_speed(results: Result) -> np.ndarray:
    """Speed of the bar's mass centre: two rows of equal elements, end nodes count half."""
    weight = np.ones(bar.ELEMENTS + 1)
    weight[[0, -1]] = 0.5
    speed = results.history.nodes["BAR"].V[:, :, 0].reshape(len(results.history.time), 2, -1)
    return (speed.mean(axis=1) @ weight) / bar.ELEMENTS


@style.styled
def draw(study: runner.Study) -> None:
    """Wall force and speed of the mass centre, with and without impulses."""
    figure, axes = style.subplots(2, 2, figsize=(10, 6.5), sharex=True)
    for column, scheme in enumerate(("ss22", "em")):
        force, speed = axes[:, column]
        for impact, label in (("none", "IMPACT=NONE"), ("impulse", "impact impulses")):
            results = study.results.get(f"{scheme}_{impact}")
            if results is None:
                continue
            (contact,) = results.contact.values()
            look = {"color": style.COLOURS[0 if impact == "impulse" else 1]}
            look["lw"] = 1.4 if impact == "impulse" else 0.8
            force.plot(results.history.time, contact.normal / FORCE, label=label, **look)
            speed.plot(results.history.time, mean_speed(results) / bar.SPEED, label=label, **look)
        wall = [0, LANDING, LANDING, LANDING + TRANSIT, LANDING + TRANSIT, 1.5 * TRANSIT]
        force.plot(wall, [0, 0, 1, 1, 0, 0], "k--", lw=0.8, label="wave theory")
        force.axvspan(LANDING + 0.3 * TRANSIT, LANDING + 0.7 * TRANSIT, color="#eeeeee", zorder=0)
        speed.plot([0, LANDING, LANDING + TRANSIT, 1.5 * TRANSIT], [-1, -1, 1, 1], "k--", lw=0.8)
        force.set(title=LABELS[scheme], ylabel="wall force / (rho c v0)")
        speed.set(xlabel="time", ylabel="speed of the mass centre / v0")
        force.legend(loc="upper right")
    style.save(figure, study.output / "wall_force.png")


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    rows = []
    for case in study.runs:
        results = study.results[case.name]
        figures = Figures.of(results)
        study.check_run(case.name, bar.LENGTH / bar.ELEMENTS)
        study.check("landing time", case.name, figures.landing)
        if case.group != "none":
            study.check("wall force / (rho c v0), middle", case.name, figures.mean)
            study.check(
                "largest deviation of the wall force, middle", case.name, figures.deviation
            )
            study.check("std / mean of the wall force, middle", case.name, figures.scatter)
            study.check("contact time", case.name, figures.duration)
        rows.append(
            (
                case.name,
                figures.mean,
                figures.scatter,
                figures.duration / TRANSIT,
                figures.rebound,
                figures.energy,
            )
        )
    study.table(
        "Impact of the bar",
        ("case", "force", "std / mean", "contact time / (2L/c)", "rebound / v0", "energy kept"),
        rows,
    )
    draw(study)
