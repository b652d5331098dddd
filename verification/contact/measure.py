"""Contact of many kinds: nobody inside anybody, momenta and energy of free flight."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.arrays import Array  # noqa: E402
from stickslip.penetration import intrusion as penetration  # noqa: E402
from stickslip.plot import style  # noqa: E402
from stickslip.plot.motion import Look, panels, shown_at  # noqa: E402
from stickslip.result import Result  # noqa: E402

MOTION = {
    "rings_mu02": (0.0, 0.6, 1.2, 2.0, 3.0, 4.0),
    "corners_left_mu00": (0.0, 0.05, 0.2, 0.5, 1.0, 1.5),
    "corners_right_mu00": (0.0, 0.05, 0.2, 0.5, 1.0, 1.5),
    "rubber_ring_mu05": (0.0, 0.1, 0.2, 0.3, 0.5, 0.8),
    "bullet_one": (0.0, 0.1, 0.12, 0.15, 0.2, 0.3),
    "column_mu02": (2.0, 4.0, 6.0, 8.0, 9.0, 12.0),
    "shapes_two": (0.0, 0.2, 0.4, 0.8, 1.2, 1.6),
    "pile": (0.0, 0.4, 0.8, 1.2, 2.0, 4.0),
}
"""Times of the pictures."""

FLOOR = 1e-18
"""Least value in logarithmic pictures."""


def element_size(results: Result) -> float:
    """Length of the shortest edge."""
    place = results.coordinates
    return min(
        float(np.linalg.norm(place[cell] - place[np.roll(cell, -1)], axis=1).min())
        for cell in results.cells
    )


def momentum_changes(results: Result) -> tuple[Array, Array]:
    """Changes of the linear and the angular momentum at every increment, relative.

    The scale is the sum of m |v| at the start, which is 2 T / |v| as all nodes start with about
    the same speed; times the size of the model.
    """
    speed = float(np.linalg.norm(results.frames[0]["V"], axis=1).max())
    scale = 2 * float(results.history.energy["kinetic"][0]) / speed
    size = float(np.ptp(results.coordinates, axis=0).max())
    linear = results.history.momentum.linear - results.history.momentum.linear[0]
    angular = results.history.momentum.angular - results.history.momentum.angular[0]
    return np.linalg.norm(linear, axis=1) / scale, np.abs(angular) / (scale * size)


def energy(results: Result) -> Array:
    """Kinetic and strain energy at every increment, without the work put in from outside."""
    account = results.history.energy
    return account["kinetic"] + account["strain"] - account["external_work"]


def rise(results: Result) -> float:
    """Largest rise of the energy above what it has been."""
    total = energy(results)
    return float((total - np.minimum.accumulate(total)).max())


def put_in(results: Result) -> float:
    """Work of the normal contact forces in increments in which it is positive, against the largest
    energy."""
    account = results.history.energy
    works = np.diff(account["normal_contact_work"])
    largest = max(np.abs(account[name]).max() for name in ("kinetic", "strain", "external_work"))
    return float(works[works > 0.0].sum() / largest)


def imbalance(results: Result) -> float:
    """Largest sum of all contact forces of a frame against the sum of their magnitudes."""
    worst = 0.0
    for frame in range(len(results.frames)):
        force = results.frames[frame]["CONTACT_FORCE"]
        size = float(np.linalg.norm(force, axis=1).sum())
        if size > 0.0:
            worst = max(worst, float(np.linalg.norm(force.sum(axis=0))) / size)
    return worst


def above(results: Result) -> float:
    """Height of the bullet's centre above that of the plate at the end, in plate lengths."""
    position = results.frames[-1].positions
    bullet, plate = (position[results.node_set(name)] for name in ("BULLET", "PLATE"))
    gap = bullet[:, 1].mean() - plate[:, 1].mean()
    return float(gap / np.ptp(plate[:, 0]))


def outside(results: Result) -> int:
    """Nodes of bodies that are not between the walls and above the floor at the end."""
    position = results.frames[-1].positions
    box = results.node_set("BOX")
    bodies = np.setdiff1d(np.arange(len(position)), box)
    x, y = position[bodies].T
    width = np.abs(position[box][:, 0]).max()
    return int(((np.abs(x) > width) | (y < position[box][:, 1].min())).sum())


def check(study: runner.Study, case: runner.Run, results: Result) -> list[object]:
    """Checks one case; its row of the table."""
    name = case.name
    is_of_means = case.formulation == "SURFACE TO SURFACE"
    kind = ", surface to surface" if is_of_means else ""
    study.check_run(name, element_size(results), place=kind)
    overlaps = penetration.follow(results)
    worst = max(range(len(overlaps)), key=lambda frame: overlaps[frame].depth)
    crossed = sum(overlap.crossings > 0 for overlap in overlaps)
    depth = overlaps[worst].depth
    study.check(f"deepest node in a body / element size{kind}", name, depth)
    if not is_of_means:
        study.check("frames in which edges cross", name, crossed)
        if depth > penetration.LIMIT:
            print(f"      {penetration.describe(results, worst, overlaps[worst])}")
    study.check("sum of contact forces / their magnitudes", name, imbalance(results))
    study.check("energy that contact put in / largest", name, put_in(results))
    account = results.history.energy
    if case.group == "free":
        linear, angular = momentum_changes(results)
        study.check("change of linear momentum", name, float(linear.max()))
        study.check("change of angular momentum", name, float(angular.max()))
    if case.group in ("free", "bullet", "rubber"):
        study.check("rise of the energy / start", name, rise(results) / energy(results)[0])
    if case.group == "bullet":
        study.check("bullet above the plate at the end", name, above(results))
    if case.group in ("pile", "shapes"):
        study.check("nodes outside the box", name, outside(results))
    if case.group == "pile" and case.until is None:
        kinetic = account["kinetic"]
        study.check(
            "energy at rest / kinetic energy before", name, float(kinetic[-1] / kinetic.max())
        )
    closed = sum(contact.closed for contact in results.contact.values())
    return [
        name,
        len(results.history.time) - 1,
        int(results.run["cutbacks"]),
        float(results.run["seconds_total"]),
        int(np.max(closed)),
        depth,
        rise(results) / results.history.energy.largest,
        *(
            float(account[entry][-1] / results.history.energy.largest)
            for entry in ("friction_dissipation", "impact_loss", "normal_contact_work")
        ),
    ]


def compare_passes(study: runner.Study) -> None:
    """Passes of an increment and cutbacks from surface to surface beside those of node to surface."""
    rows = []
    for case in study.runs:
        means, nodes = (study.results.get(name) for name in (case.name, case.name.removesuffix("_STS")))
        if means is None or nodes is None or means is nodes:
            continue
        of = [float(results.history.solver["passes"][1:].mean()) for results in (means, nodes)]
        cut = [int(results.run["cutbacks"]) for results in (means, nodes)]
        study.check("passes beside those of node to surface", case.name, of[0] / of[1])
        rows.append((case.name.removesuffix("_STS"), *of, *cut))
    header = ("case", "passes, surface to surface", "node to surface", "cutbacks, surface to surface", "node to surface")
    study.table("Surface to surface beside node to surface, passes of an increment", header, rows)


def tabulate_corners(study: runner.Study) -> None:
    """How the upper square flies off; left and right are mirror images."""
    rows = []
    for case, results in study.group("free"):
        if case.name.startswith("corners"):
            frame = len(results.frames) - 1
            x, y = results.frames[frame]["V"][results.node_set("UPPER")].mean(axis=0)
            rows.append((case.name, float(x), float(y)))
    study.table("Mean velocity of the upper square at the end", ("case", "x", "y"), rows)


@style.styled
def draw_conservation(study: runner.Study) -> None:
    """What free flight keeps, against time."""
    figure, axes = style.subplots(3, 1, figsize=(8, 8))
    for case, results in study.group("free"):
        label = {"label": case.name, "lw": 0.8}
        part = results.history.time / results.history.time[-1]
        for axis, change in zip(axes, momentum_changes(results)):
            axis.semilogy(part, np.maximum(change, FLOOR), **label)
        axes[2].plot(part, energy(results) / energy(results)[0], **label)
    titles = ("change of linear momentum", "change of angular momentum", "energy / start")
    for axis, title in zip(axes, titles):
        axis.set_title(title)
    for axis in axes[:2]:
        axis.axhline(penetration.LIMIT, color="k", ls="--", lw=0.8)
    axes[2].set_xlabel("time / duration")
    axes[2].legend(ncols=2)
    style.save(figure, study.output / "conservation.png")


def draw_motion(study: runner.Study) -> None:
    """The motion of the cases."""
    for name, times in MOTION.items():
        results = study.results.get(name)
        if results is None:
            continue
        figure = panels([shown_at(results, times)], Look("von-mises"))
        style.save(figure, study.output / f"motion_{name}.png", 90)


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    cases = study.runs
    rows = [check(study, case, study.results[case.name]) for case in cases]
    study.table(
        "Runs (energies against the largest of the ledger)",
        ("case", "increments", "cutbacks", "seconds", "pairs", "deepest", "rise of energy")
        + ("friction", "impact", "normal contact"),
        rows,
    )
    compare_passes(study)
    tabulate_corners(study)
    if study.draws:
        draw_conservation(study)
        draw_motion(study)
