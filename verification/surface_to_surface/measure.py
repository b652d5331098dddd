"""How smooth pressures and forces are: surface to surface beside node to surface."""

import sys
from math import pi, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of python/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.result import Result  # noqa: E402

decks = runner.load(HERE / "generate.py")

HALF_WIDTH = decks.flat.HALF_WIDTH
PEAK = 2 * decks.flat.PRESS / (pi * HALF_WIDTH)
"""Of Hertz' pressure."""

INNER = 0.85
"""Part of the half width in which pressures are compared with a smooth curve."""

SLIDES = 1.15
"""Time from which on the slider slides in steady state."""

CHECKED = ("iron_fine", "iron_smooth", "iron_equal")
"""Pairs of runs whose slave is the slider, on a foundation no coarser than 1.3 times the slider. Nodes of the foundation meet
its curved faces, whose vertices do not show."""

OF_BULK = {"iron_coarse": "iron_coarse_bulk", "iron_reversed": "iron_reversed_bulk"}
"""Runs on a coarse foundation, and those with a slider so fine that contact is exact on its segments."""


def pressures(result: Result, name: str) -> tuple[Array, Array]:
    """Places and pressures of the nodes of a set: nodal forces over tributary lengths."""
    frame = result.frames[-1]
    nodes = result.node_set(name)
    nodes = nodes[np.argsort(frame.positions[nodes, 0])]
    x = frame.positions[nodes]
    lengths = np.linalg.norm(np.diff(x, axis=0), axis=1)
    tributary = (np.append(lengths, 0.0) + np.append(0.0, lengths)) / 2.0
    return x[:, 0], np.linalg.norm(frame["CONTACT_FORCE"][nodes], axis=1) / tributary


def deviation(x: Array, pressure: Array) -> tuple[float, float]:
    """Largest deviation from a smooth curve, and the peak of this curve, beside Hertz' peak."""
    inner = np.abs(x) < INNER * HALF_WIDTH
    part = (x[inner] / HALF_WIDTH) ** 2
    shapes = np.sqrt(1.0 - part)[:, None] * np.stack([part**0, part, part**2], axis=1)
    factors, *_ = np.linalg.lstsq(shapes, pressure[inner], rcond=None)
    off = pressure[inner] - shapes @ factors
    return float(np.abs(off).max() / PEAK), float(factors[0] / PEAK)


def half_width(x: Array, pressure: Array) -> float:
    """From the second moment of the pressures, beside Hertz' half width."""
    force = pressure * np.gradient(x)
    return 2.0 * sqrt((force * x**2).sum() / force.sum()) / HALF_WIDTH


def oscillation(result: Result) -> tuple[float, float]:
    """Peak to peak of horizontal and vertical force beside the mean vertical one, less a cubic trend."""
    force = next(iter(result.contact.values())).force
    time = result.history.time
    slides = time > SLIDES
    way = time[slides] - SLIDES
    of = []
    for values in force[slides].T:
        trend = np.polyval(np.polyfit(way, values, 3), way)
        of.append(float(np.ptp(values - trend)))
    mean = abs(float(force[slides, 1].mean()))
    return of[0] / mean, of[1] / mean


def check_hertz(study: runner.Study, name: str, result: Result) -> list[object]:
    """Checks a contact of cylinders; its row of the table."""
    slave, master = (pressures(result, set_name) for set_name in ("NFOOT", "NGROUND"))
    (of_slave, peak), (of_master, _) = deviation(*slave), deviation(*master)
    if name.endswith("STS"):
        kind = "largest deviation of the pressure of the {} from a smooth curve / peak"
        study.check(kind.format("slave"), name, of_slave)
        study.check(kind.format("master"), name, of_master)
        study.check("half width / Hertz", name, half_width(*slave))
        study.check("peak pressure / Hertz", name, peak)
    return [name, of_slave, of_master, half_width(*slave), peak]


@style.styled
def draw_ironing(study: runner.Study) -> None:
    """Horizontal forces of all pairs of runs."""
    names = [run.name[:-4] for run in study.runs if run.name.endswith("STS") and run.group == "iron"]
    if not names:
        return
    figure, axes = style.subplots(len(names), 1, figsize=(8, 2.2 * len(names)), squeeze=False)
    for axis, name in zip(axes[:, 0], names):
        for kind, label in (("NTS", "node to surface"), ("STS", "surface to surface")):
            result = study.results.get(f"{name}_{kind}")
            if result is None:
                continue
            force = next(iter(result.contact.values())).force
            slides = result.history.time > SLIDES
            axis.plot(result.history.time[slides], force[slides, 0], lw=0.8, label=label)
        axis.set_title(f"{name}: horizontal force")
    axes[0, 0].legend()
    style.save(figure, study.output / "ironing.png")


def check_blocks(study: runner.Study) -> None:
    """Checks cutbacks and passes of sheared blocks, and tabulates them."""
    passes = {run.name: int(result.history.solver.passes.sum()) for run, result in study.group("blocks")}
    rows = []
    for run, result in study.group("blocks"):
        name, kind = run.name.rsplit("_", 1)
        if kind != "STS" or f"{name}_NTS" not in passes:
            continue
        other = passes[f"{name}_NTS"]
        study.check("cutbacks of sheared blocks", run.name, result.run["cutbacks"])
        study.check(
            "passes of sheared blocks beside those of node to surface",
            run.name,
            passes[run.name] / other,
        )
        rows.append((name, passes[run.name], other))
    study.table("Passes of sheared blocks", ("case", "surface to surface", "node to surface"), rows)


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    for run in study.runs:
        hangs_over = run.group == "blocks" and run.name.endswith("STS")
        place = ", over the end of the master" if hangs_over else ""
        study.check_run(run.name, study.results[run.name].edge_length, place=place)
    pressed = [check_hertz(study, run.name, result) for run, result in study.group("hertz")]
    header = ("case", "slave", "master", "half width / Hertz", "peak / Hertz")
    study.table("Deviation of pressures from a smooth curve / peak", header, pressed)
    found = {run.name: oscillation(result) for run, result in study.group("iron")}
    rows = [(name, *of) for name, of in found.items()]
    study.table("Peak to peak / mean vertical force", ("case", "horizontal", "vertical"), rows)
    for name in CHECKED:
        if {f"{name}_STS", f"{name}_NTS"} <= found.keys():
            ratio = found[f"{name}_STS"][0] / found[f"{name}_NTS"][0]
            kind = "oscillation of the horizontal force beside that of node to surface"
            study.check(kind, f"{name}_STS", ratio)
    for name, bulk in OF_BULK.items():
        if {f"{name}_STS", f"{bulk}_STS"} <= found.keys():
            ratio = found[f"{name}_STS"][0] / found[f"{bulk}_STS"][0]
            kind = "oscillation of the horizontal force beside that of the foundation's mesh"
            study.check(kind, f"{name}_STS", ratio)
    check_blocks(study)
    if study.draws:
        draw_ironing(study)
