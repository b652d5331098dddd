"""Two cantilevers: displacements and motion as the paper shows them, convergence."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
DECKS = HERE.parents[1] / "input" / "two_cantilevers"
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.plot.motion import Look, panels, shown_at  # noqa: E402
from stickslip.result import Result  # noqa: E402

beams = runner.load(DECKS / "generate.py")

LABELS = {"paper": "SS22 (1, 1), the paper's scheme", "default": "energy-momentum, the default"}


def tip(results: Result, name: str = "UPPER_TIP") -> Array:
    """Displacement of the middle of an end face [I, 2]."""
    history = results.history.nodes[name]
    return history.U[:, len(history.labels) // 2]


@style.styled
def draw_displacement(study: runner.Study, name: str, label: str) -> None:
    """Horizontal and vertical displacement of a tip against time, all mu in one figure."""
    figure, axes = style.subplots(2, 2, figsize=(11, 7), sharex=True)
    for column, load in enumerate("AB"):
        for group, line in (("paper", "-"), ("default", "--")):
            cases = [(c, r) for c, r in study.group(group) if c.deck[0] == load]
            for colour, (case, results) in zip(style.COLOURS, cases):
                friction = beams.FRICTION[Path(case.deck).stem[2:]]
                for row in range(2):
                    axes[row, column].plot(
                        results.history.time,
                        tip(results, name)[:, row],
                        line,
                        color=colour,
                        lw=1.3 if group == "paper" else 0.9,
                        label=f"mu = {friction}" if group == "paper" else None,
                    )
        axes[0, column].set_title(f"load case {load}")
        axes[1, column].set_xlabel("time")
    axes[0, 0].plot([], [], "k--", lw=0.9, label="default scheme")
    axes[0, 0].legend()
    axes[0, 0].set_ylabel(f"horizontal displacement of {label}")
    axes[1, 0].set_ylabel(f"vertical displacement of {label}")
    style.save(figure, study.output / f"displacement_{name.lower()}.png")


def draw_motion(study: runner.Study, group: str) -> None:
    """Shapes at t = 0, 2, 4, ... at mu = 0.4 for both load cases."""
    cases = [study.results[f"{group}_{load}_mu04"] for load in "AB"]
    rows = [shown_at(results, np.arange(0.0, 15.0, 2.0)) for results in cases]
    figure = panels(rows, Look("von-mises"), columns=4)
    style.save(figure, study.output / f"motion_{group}.png", 120)


def sequence(study: runner.Study, group: str, kind: str) -> list[runner.Run]:
    """Cases of increasing resolution, from the deck's own."""
    first = [case for case in study.runs if case.name == f"{group}_A_mu04"]
    return first + [case for case, _ in study.group(f"{group}_{kind}")]


def deviation(results: Result, reference: Result) -> float:
    """Largest distance of the upper tip's paths, at the increments of the coarser run."""
    other = tip(reference)
    at = np.stack(
        [np.interp(results.history.time, reference.history.time, other[:, i]) for i in range(2)], axis=1
    )
    return float(np.linalg.norm(tip(results) - at, axis=1).max())


@style.styled
def study_convergence(study: runner.Study) -> None:
    """Path of the upper tip against the finest run of each sequence."""
    figure, axes = style.subplots(2, 2, figsize=(11, 7), sharex=True, sharey=True)
    rows = []
    for row, group in enumerate(LABELS):
        for column, kind in enumerate(("dt", "mesh")):
            cases = sequence(study, group, kind)
            finest = study.results[cases[-1].name]
            for case in cases:
                results = study.results[case.name]
                edge, dt = 0.5 / case.refine, beams.DT / case.divide
                label = f"dt {dt:g}" if kind == "dt" else f"edge {edge:g}"
                axes[row, column].plot(results.history.time, tip(results)[:, 1], label=label)
                if results is not finest:
                    rows.append((group, kind, edge, dt, deviation(results, finest)))
            axes[row, column].set_title(f"{LABELS[group]}; A, mu = 0.4", fontsize=9)
            axes[row, column].legend()
        axes[row, 0].set_ylabel("vertical displacement of the upper tip")
    for at in axes[1]:
        at.set_xlabel("time")
    style.save(figure, study.output / "convergence.png")
    study.table(
        "Convergence of the upper tip's path, A, mu = 0.4 (largest distance from the finest run)",
        ("scheme", "refined", "edge", "increment", "distance"),
        rows,
    )


def tabulate(study: runner.Study) -> None:
    """Tips and energies at the end of the runs."""
    rows = []
    for group in LABELS:
        for case, results in study.group(group):
            upper, lower = tip(results)[-1], tip(results, "LOWER_TIP")[-1]
            account = results.history.energy
            rows.append(
                (
                    case.name,
                    *map(float, upper),
                    *map(float, lower),
                    *(
                        float(account[name][-1])
                        for name in (
                            "external_work",
                            "friction_dissipation",
                            "impact_loss",
                            "numerical_dissipation",
                            "normal_contact_work",
                        )
                    ),
                )
            )
    study.table(
        "End of the runs",
        ("case", "upper x", "upper y", "lower x", "lower y", "work", "friction", "impact")
        + ("numerical", "normal contact"),
        rows,
    )


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    for case in study.runs:
        study.check_run(case.name, 0.5 / case.refine)
    for case, results in study.group("otherwise"):
        reference = study.results["default_A_mu04"]
        part = deviation(results, reference) / float(np.abs(tip(reference)).max())
        study.check("path solved otherwise: deviation / largest displacement", case.name, part)
    tabulate(study)
    if any(study.group("paper_dt")):
        draw_displacement(study, "UPPER_TIP", "the upper tip")
        draw_displacement(study, "LOWER_TIP", "the lower tip")
        for group in LABELS:
            draw_motion(study, group)
        study_convergence(study)
