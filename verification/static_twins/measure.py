"""Decks with static steps beside the same decks with dynamic steps."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import runner  # noqa: E402  (first: it finds the modules of python/)
import numpy as np  # noqa: E402
from stickslip.result import Result  # noqa: E402

DYNAMIC = "_dynamic"
END = (200.0 - 21.0) / 24.0
"""Where the pad rests: push and friction (kN) over the stiffness of its springs (kN/m)."""


def brake(result: Result) -> dict[str, float]:
    """Means of the second half, when the pressure is at its full size."""
    history = result.history
    (contact,) = result.contact.values()
    late = history.time > 0.5
    return {
        "pressing force": contact.normal[late].mean(),
        "friction force": -contact.tangential[late].mean(),
        "friction dissipation": history.energy.friction_dissipation[-1],
    }


def snap(result: Result) -> dict[str, float]:
    """On the ramp, and what pulls the hook back over it."""
    history = result.history
    force = history.nodes["CLAMP"].RF[:, :, 0].sum(axis=1)
    tip = history.nodes["TIP"].U[:, :, 1].mean(axis=1)
    return {
        "force on the ramp": force[np.argmin(np.abs(history.time - 0.01))],
        "largest pull": -force.min(),
        "time of the largest pull": history.time[force.argmin()],
        "lift of the tip": tip.max(),
    }


def cam(result: Result) -> dict[str, float]:
    history = result.history
    return {
        "largest force on the axis": np.hypot(*history.nodes["AXIS"].RF.sum(axis=1).T).max(),
        "lift of the stem": history.nodes["STEM"].U[:, :, 1].max(),
        "friction dissipation": history.energy.friction_dissipation[-1],
        "work on the axis": history.energy.external_work[-1],
    }


def blocks(result: Result) -> dict[str, float]:
    """Means of the second half of the shear, of both contact passes together."""
    late = result.history.time > 0.145
    across, along = sum(np.abs(contact.force[late]).mean(axis=0)[::-1] for contact in result.contact.values())
    friction = {"friction force": along} if result.history.energy.friction_dissipation[-1] > 0.0 else {}
    return {"pressing force": across} | friction


def tyre(result: Result) -> dict[str, float]:
    """At rest on the road."""
    nodes = result.node_set("TYRE")
    u = result.frames[-1]["U"][nodes]
    width, height = np.ptp(result.coordinates[nodes, :2] + u[:, :2], axis=0)
    return {"way of the middle": u[:, 1].mean(), "height": height, "width": width}


MEASURES = {"tyre": tyre, "brake": brake, "snap": snap, "cam": cam, "blocks": blocks, "blocks_smooth": blocks}


def measure(study: runner.Study) -> None:
    """Checks and tabulates what the runs give."""
    results = study.results
    rows = []
    for run in study.runs:
        result = results[run.name]
        study.check_run(run.name, result.edge_length)
        heat = np.nansum(result.frames[-1]["FRICTION_HEAT"])
        lost = result.history.energy.friction_dissipation[-1]
        if lost > 0.0:
            study.check("heat of the slave nodes / friction dissipation", run.name, heat / lost)
        if run.name.endswith(DYNAMIC):
            continue
        energy = result.history.energy
        passes = result.history.solver["passes"][1:]
        of_tyre = " of the tyre" if run.name == "tyre" else ""
        study.check(f"passes per increment{of_tyre}", run.name, passes.max())
        if run.name in ("brake", "cam", "pad"):
            other = np.abs(energy.numerical_dissipation).max() / energy.friction_dissipation[-1]
            study.check("numerical dissipation / friction dissipation", run.name, other)
        if run.name == "pad":
            study.check("end / closed form", run.name, result.history.nodes["LEFT"].U[-1, :, 0].mean() / END)
            continue
        found = MEASURES[run.name](result)
        if run.name == "brake":
            study.check("pressing force / pressure", run.name, found["pressing force"] / 20.0)
            study.check("friction force / pressure", run.name, found["friction force"] / (0.5 * 20.0))
        if run.name == "tyre":
            rolled = np.abs([frame["U"][result.node_set("TYRE"), 0].mean() for frame in result.frames])
            study.check("way along the road, tyre / edge", run.name, rolled.max() / result.edge_length)
        if run.name + DYNAMIC not in results:
            continue
        twin = results[run.name + DYNAMIC]
        expected = MEASURES[run.name](twin)
        for quantity, value in found.items():
            rows.append((run.name, quantity, value, expected[quantity]))
            name = f"{quantity}, {run.name}: deviation from the dynamic deck"
            study.check(name, run.name, abs(value / expected[quantity] - 1.0))
        counts = len(result.history.dt) - 1, len(twin.history.dt) - 1
        rows.append((run.name, "increments", *counts))
    study.table("Static and dynamic", ("deck", "quantity", "static", "dynamic"), rows)
