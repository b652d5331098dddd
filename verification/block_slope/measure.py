"""Block falling on a slope: against a point mass, where the energy went, how it rebounds."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
DECKS = HERE.parents[1] / "input" / "block_slope"
sys.path[:0] = [str(HERE), str(HERE.parent)]

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.plot.page import Legends, Page  # noqa: E402
from stickslip.plot.motion import shades, shown_at, time_legend  # noqa: E402
from pointmass import PointMass  # noqa: E402
from stickslip.plot.shapes import draw_overlay, limits  # noqa: E402
from stickslip.result import Result  # noqa: E402

slope = runner.load(DECKS / "generate.py")

ACCELERATION = (slope.FORCE / slope.MASS * slope.SINE, -slope.FORCE / slope.MASS * slope.COSINE)
FRAME = np.array([[slope.COSINE, slope.SINE], [-slope.SINE, slope.COSINE]])
"""Columns: the directions down the slope and out of it; vectors @ FRAME are (along, normal)."""
LABELS = {"paper": "SS22 (1, 1), the paper's scheme", "default": "energy-momentum, the default"}
IMPACT = 2e-3
"""Time from the landing in which the first impact is over, repeated touches included."""


def point_mass(friction: float) -> PointMass:
    """The reference."""
    return PointMass(slope.GAP, ACCELERATION, friction)


class Centre:
    """Motion of the block's mass centre, along the slope and normal to it."""

    def __init__(self, results: Result) -> None:
        history = results.history.nodes["BLOCK"]
        index = {int(label): i for i, label in enumerate(results.node_labels)}
        nodes = np.array([index[int(label)] for label in history.labels])
        # Row sums of the mass matrix: equal elements give a quarter to each of their nodes.
        share = np.zeros(len(results.coordinates))
        for cell in results.cells:
            np.add.at(share, cell, 1.0)
        weight = share[nodes] / share[nodes].sum()
        self.displacement: Array = np.einsum("n,inj->ij", weight, history.U) @ FRAME
        self.velocity: Array = np.einsum("n,inj->ij", weight, history.V) @ FRAME

    @property
    def kinetic(self) -> Array:
        """Kinetic energy of the mass centre."""
        return 0.5 * slope.MASS * (self.velocity**2).sum(axis=1)


def landing_time(results: Result) -> float:
    """Time of the first landing."""
    return float(results.history.impacts["time"].min())


def after_first_impact(results: Result) -> int:
    """Row of the last increment with contact in the first impact."""
    (contact,) = results.contact.values()
    start = landing_time(results)
    touching = (contact.closed > 0) & (results.history.time <= start + IMPACT)
    return int(np.flatnonzero(touching)[-1])


def rebound(results: Result) -> float:
    """Speed of the mass centre normal to the slope after the first impact / landing speed."""
    speed = Centre(results).velocity[after_first_impact(results), 1]
    return float(speed / point_mass(0.0).landing_speed)


def accounts(results: Result) -> dict[str, Array]:
    """Where the energy is: accounts that sum up to what was put in."""
    account = results.history.energy
    rigid = Centre(results).kinetic
    return {
        "motion of the mass centre": rigid,
        "vibration": account["kinetic"] - rigid + account["strain"],
        "friction": account["friction_dissipation"],
        "impact loss": account["impact_loss"],
        "numerical dissipation": account["numerical_dissipation"],
        "normal contact (taken)": -account["normal_contact_work"],
    }


def check_main(study: runner.Study) -> None:
    """Landing, motion along the slope, and what every run has to satisfy."""
    for case in study.runs:
        results = study.results[case.name]
        study.check_run(case.name, slope.SIDE / 8 / case.refine)
        study.check("landing time", case.name, case.flight + landing_time(results))
        if case.deck == "block_slope_mu00.inp" and case.flight == 0.0:
            along = Centre(results).displacement[1:, 0]
            reference = point_mass(0.0).displacement(results.history.time[1:])[:, 0]
            deviation = float((np.abs(along - reference) / reference).max())
            study.check("deviation along the slope, mu = 0", case.name, deviation)


def tabulate_energy(study: runner.Study) -> None:
    """The ledger after the first impact and at the end."""
    header: list[str] = []
    rows = []
    for group in LABELS:
        for case, results in study.group(group):
            parts = accounts(results)
            header = ["case", "when", "put in", *parts]
            for when, row in (("first impact", after_first_impact(results)), ("end", -1)):
                values = [float(part[row]) for part in parts.values()]
                rows.append(
                    (case.name, when, float(results.history.energy["external_work"][row]), *values)
                )
    if rows:
        study.table("Where the energy went", header, rows)


def tabulate_tumbling(study: runner.Study) -> None:
    """How far the block turns, and whether a face that is not in the contact would touch."""
    rows = []
    for group in LABELS:
        for case, results in study.group(group):
            history = results.history.nodes["BLOCK"]
            nodes = np.searchsorted(results.node_labels, history.labels)
            face = np.isin(nodes, results.node_set("BLOCK_FACE"))
            position = (results.coordinates[nodes] + history.U) @ FRAME
            along, out = (position[:, face][:, -1] - position[:, face][:, 0]).T
            turned = np.degrees(np.unwrap(np.arctan2(out, along)))[-1]
            others = position[:, ~face, 1].min(axis=1)
            inside = results.history.time[others < 0.0]
            touch = float(inside[0]) if inside.size else "never"
            rows.append((case.name, float(turned), float(others.min()), touch))
    study.table(
        "Tumbling: rotation at the end (degrees), smallest distance of the block's other faces "
        "from the undeformed slope (cm), time from which they would be inside (s)",
        ("case", "rotation", "distance", "inside from"),
        rows,
    )


def tabulate_rebound(study: runner.Study) -> None:
    """Rebound ratio against mesh, increment and scheme."""
    rows = []
    for case, results in study.group("study"):
        row = after_first_impact(results)
        parts = {name: float(part[row]) for name, part in accounts(results).items()}
        arrival = 0.5 * slope.MASS * point_mass(0.0).landing_speed ** 2
        lost = ("vibration", "impact loss", "numerical dissipation", "normal contact (taken)")
        shares = [parts[name] / arrival for name in lost]
        scheme = "default" if case.scheme == "default" else "paper"
        edge, dt = 0.5 / case.refine, slope.DT / case.divide
        rows.append((scheme, edge, dt, rebound(results), *shares))
    header = ("scheme", "block edge", "increment", "rebound", "vibration", "impact loss")
    header += ("numerical", "normal contact")
    study.table(
        "First rebound, mu = 0 (speed after / before; energies / normal kinetic energy)",
        header,
        rows,
    )


@style.styled
def draw_displacement(study: runner.Study) -> None:
    """Horizontal and vertical displacement against time, all mu in one figure."""
    figure, axes = style.subplots(2, 2, figsize=(11, 7.5), sharex=True, sharey="row")
    for column, (group, label) in enumerate(LABELS.items()):
        for colour, (case, results) in zip(style.COLOURS, study.group(group)):
            friction = slope.FRICTION[Path(case.deck).stem]
            computed = Centre(results).displacement @ FRAME.T
            reference = point_mass(friction).displacement(results.history.time) @ FRAME.T
            for row in range(2):
                axes[row, column].plot(
                    results.history.time, computed[:, row], color=colour, label=f"mu = {friction}"
                )
                axes[row, column].plot(
                    results.history.time, reference[:, row], "--", color=colour, lw=0.8
                )
        axes[0, column].plot([], [], "k--", lw=0.8, label="point mass, elastic")
        axes[0, column].set_title(label)
        axes[0, column].legend()
        axes[1, column].set_xlabel("time (s)")
    axes[0, 0].set_ylabel("horizontal displacement of the mass centre (cm)")
    axes[1, 0].set_ylabel("vertical displacement of the mass centre (cm)")
    style.save(figure, study.output / "displacement.png")


@style.styled
def draw_motion(study: runner.Study) -> None:
    """Shapes every 0.04 s."""
    runs = {
        (row, column): (label, *each)
        for row, (group, label) in enumerate(LABELS.items())
        for column, each in enumerate(study.group(group))
    }
    shown = {place: shown_at(run[2], np.arange(6) * 0.04) for place, run in runs.items()}
    everything = [each for frames in shown.values() for each in frames]
    legends = Legends(time_legend(max(shown.values(), key=len)))
    page = Page((2, 3), limits(everything), legends)
    for (row, column), (label, case, _) in runs.items():
        axes = page.panel(row, column, row == 1)
        frames = shown[row, column]
        draw_overlay(axes, frames, shades(len(frames)))
        friction = slope.FRICTION[Path(case.deck).stem]
        axes.set_title(f"mu = {friction}; {label}", fontsize=8)
    style.save(page.figure, study.output / "motion.png")


@style.styled
def draw_energy(study: runner.Study) -> None:
    """The ledger against time."""
    figure, axes = style.subplots(3, 2, figsize=(11, 10), sharex=True, sharey="row")
    for column, (group, label) in enumerate(LABELS.items()):
        for row, (case, results) in enumerate(study.group(group)):
            parts = accounts(results)
            at = axes[row, column]
            at.stackplot(
                results.history.time,
                list(parts.values()),
                labels=list(parts),
                alpha=0.85,
                linewidth=0,
            )
            at.plot(
                results.history.time,
                results.history.energy["external_work"],
                "k--",
                lw=1,
                label="put in",
            )
            friction = slope.FRICTION[Path(case.deck).stem]
            at.set_title(f"mu = {friction}; {label}", fontsize=9)
            at.set_ylabel("energy (kg cm$^2$/s$^2$)")
        axes[-1, column].set_xlabel("time (s)")
    axes[0, 0].legend(loc="upper left")
    style.save(figure, study.output / "energy.png")


@style.styled
def draw_rebound(study: runner.Study) -> None:
    """Speed normal to the slope during the first impact, by mesh and increment."""
    figure, axes = style.subplots(2, 2, figsize=(11, 7), sharex=True, sharey=True)
    speed = point_mass(0.0).landing_speed
    for case, results in study.group("study"):
        row = 1 if case.scheme == "default" else 0
        time = 1e3 * (case.flight + results.history.time - point_mass(0.0).landing)
        normal = Centre(results).velocity[:, 1] / speed
        edge, dt = 0.5 / case.refine, slope.DT / case.divide
        for column, shown in enumerate((case.divide == 1, case.refine == 1)):
            if shown:
                label = f"edge {edge:g}" if column == 0 else f"dt {dt:.3g}"
                axes[row, column].plot(time, normal, label=label)
    for row, label in enumerate(LABELS.values()):
        axes[row, 0].set_title(f"meshes; {label}")
        axes[row, 1].set_title(f"increments; {label}")
        axes[row, 0].set_ylabel("normal speed / landing speed")
        for at in axes[row]:
            at.axhline(1.0, color="k", ls="--", lw=0.8, label="point mass")
            at.legend(loc="lower right")
            at.set_xlim(-0.05, 0.6)
    for at in axes[1]:
        at.set_xlabel("time since the landing (ms)")
    style.save(figure, study.output / "rebound.png")


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    check_main(study)
    tabulate_energy(study)
    tabulate_rebound(study)
    if any(study.group("paper")):
        tabulate_tumbling(study)
    if study.draws:
        draw_rebound(study)
    if study.draws and any(study.group("paper")):
        draw_displacement(study)
        draw_motion(study)
        draw_energy(study)
