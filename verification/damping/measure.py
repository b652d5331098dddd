"""Free decay of the first mode of a bar: logarithmic decrement, period and motion in closed form."""

import sys
from dataclasses import dataclass
from math import exp, log, pi, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

bar = runner.load(HERE / "generate.py")

DAMPED = bar.OMEGA * sqrt(1 - bar.RATIO**2)
"""Frequency of the damped vibration."""
DECREMENT = 2 * pi * bar.RATIO / sqrt(1 - bar.RATIO**2)
AMPLITUDE = bar.SPEED / DAMPED


def closed_form(time: Array) -> Array:
    """Displacement of the free end."""
    return AMPLITUDE * np.exp(-bar.RATIO * bar.OMEGA * time) * np.sin(DAMPED * time)


def motion(results: Result) -> Array:
    """Displacement of the free end of a run."""
    return results.history.nodes["END"].U[:, :, 0].mean(axis=1)


def peaks(time: Array, u: Array) -> tuple[Array, Array]:
    """Times and values of the maxima, from parabolas through three points."""
    k = np.flatnonzero((u[1:-1] > u[:-2]) & (u[1:-1] >= u[2:])) + 1
    left, mid, right = u[k - 1], u[k], u[k + 1]
    shift = 0.5 * (left - right) / (left - 2 * mid + right)
    return time[k] + shift * (time[k] - time[k - 1]), mid - 0.25 * (left - right) * shift


@dataclass(frozen=True)
class Figures:
    """Measured figures of one run."""

    decrement: float
    period: float
    deviation: float
    dissipated: float
    numerical: float

    @classmethod
    def of(cls, results: Result) -> "Figures":
        """Measures a run; all but the deviation, of the amplitude, relative to the closed form."""
        time, u = results.history.time, motion(results)
        at, heights = peaks(time, u)
        account = results.history.energy
        energy = account["kinetic"] + account["strain"]
        lost = energy[0] - energy[-1]
        return cls(
            log(heights[0] / heights[-1]) / (len(heights) - 1) / DECREMENT,
            float(at[-1] - at[0]) / (len(at) - 1) * DAMPED / (2 * pi),
            float(np.abs(u - closed_form(time)).max()) / AMPLITUDE,
            float(account["damping"][-1] / lost),
            float(np.abs(account["numerical_dissipation"]).max() / energy[0]),
        )


@style.styled
def draw(study: runner.Study) -> None:
    """Motion of the free end of all runs, with the closed form and its envelope."""
    figure, axes = style.subplots(figsize=(9, 4))
    for case in study.runs:
        results = study.results[case.name]
        axes.plot(
            results.history.time / bar.PERIOD, motion(results) / AMPLITUDE, lw=0.9, label=case.name
        )
    time = np.linspace(0.0, bar.PERIODS * bar.PERIOD, 1201)
    axes.plot(time / bar.PERIOD, closed_form(time) / AMPLITUDE, "k--", lw=0.7, label="closed form")
    for sign in (1, -1):
        envelope = [sign * exp(-bar.RATIO * bar.OMEGA * t) for t in time]
        axes.plot(time / bar.PERIOD, envelope, "k:", lw=0.7)
    axes.set(xlabel="time / period", ylabel="displacement of the end / amplitude")
    axes.legend(loc="upper right", fontsize="small")
    style.save(figure, study.output / "decay.png")


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    rows = []
    for case in study.runs:
        results = study.results[case.name]
        figures = Figures.of(results)
        study.check_run(case.name, bar.LENGTH / bar.ELEMENTS)
        suffix = f", {case.group}" if case.group else ""
        study.check(f"decrement / closed form{suffix}", case.name, figures.decrement)
        study.check(f"period / closed form{suffix}", case.name, figures.period)
        study.check(f"largest deviation{suffix}", case.name, figures.deviation)
        study.check("damping / energy lost", case.name, figures.dissipated)
        if case.name.startswith("em"):
            study.check("numerical dissipation / energy", case.name, figures.numerical)
        rows.append((case.name, figures.decrement, figures.period, figures.deviation))
    study.table(
        "Free decay of a bar", ("case", "decrement", "period", "largest deviation"), rows
    )
    draw(study)
