"""Writes the decks of the snap-fit hook that is pushed over a ramp: `generate.py [-o FOLDER]`."""

import sys
from math import cos, pi
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import Grid, card, dry, material, step, write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY, THICKNESS = 1300.0, 0.35, 9e-10, 5.0
"""Polypropylene in N, mm, t, s."""
LENGTH, DEPTH = 20.0, 2.0
ALONG, ACROSS = 40, 4
HOOK = ((16.0, 0.0), (17.0, -1.5), (17.5, -1.5), (20.0, -0.2))
"""Lower edge from the beam to the tip."""
RAMP = ((10.0, -2.5), (22.0, -2.5), (24.6, -0.2), (25.0, -0.2), (26.0, -2.5), (45.0, -2.5))
STROKE = 11.0
PUSH = 0.02
"""Time of the push, and of the pull that follows it."""
POINTS = 400
"""Intervals of the table of the motion."""
FRICTION = 0.2
DT = 2e-5
BETA = {"snap_fit_undamped": 0.0, "snap_fit_damped": 1e-5}

INCLUDE = "snap_fit.inc"


def lower_edge(x: float) -> float:
    """Height of the lower edge of the hook."""
    for (x0, y0), (x1, y1) in zip(HOOK, HOOK[1:]):
        if x0 <= x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return 0.0


def place(i: int, j: int) -> tuple[float, float]:
    """Coordinates of a node."""
    x = LENGTH * i / ALONG
    low = lower_edge(x)
    return x, low + (DEPTH - low) * j / ACROSS


def push_and_pull() -> list[tuple[float, float]]:
    """Part of the stroke against the time: (1 - cos)/2, without a jump of the velocity."""
    times = [2 * PUSH * k / POINTS for k in range(POINTS + 1)]
    return [(time, 0.5 - 0.5 * cos(pi * time / PUSH)) for time in times]


def model(element_type: str = "CPE4") -> str:
    """Everything but the material and the step."""
    hook = Grid("HOOK", ALONG, ACROSS, place)
    reference = hook.next_node
    profile = [("START", *RAMP[0]), *(("LINE", *point) for point in RAMP[1:])]
    return "".join(
        [
            "** Written by generate.py; N, mm, t, s.\n",
            hook.mesh(element_type),
            hook.side_nodes("CLAMP", "left"),
            hook.side_surface("UNDER", "bottom"),
            card("NSET, NSET=TIP", (hook.node(ALONG, ACROSS),)),
            card("NODE, NSET=REF", (reference, RAMP[1][0], -4.0)),
            card("SURFACE, NAME=RAMP, TYPE=SEGMENTS", *profile),
            card(f"RIGID BODY, ANALYTICAL SURFACE=RAMP, REF NODE={reference}"),
            card("SOLID SECTION, ELSET=HOOK, MATERIAL=PP", (THICKNESS,)),
            dry(FRICTION),
            card("CONTACT PAIR, INTERACTION=DRY", ("UNDER", "RAMP")),
            card("AMPLITUDE, NAME=PUSHPULL", *push_and_pull()),
            card("BOUNDARY", ("REF", 1, 2), ("CLAMP", 2, 2)),
        ]
    )


def problem(beta: float, model: str = card(f"INCLUDE, INPUT={INCLUDE}")) -> str:
    """A deck: heading, model, material, step."""
    damping = f"beta {beta!r} s" if beta > 0.0 else "no damping"
    return "".join(
        [
            card("HEADING", (f"snap-fit hook over a ramp and back; {damping}",)),
            model,
            material("PP", YOUNG, POISSON, DENSITY, beta=beta),
            step(
                DT,
                round(2 * PUSH / DT),
                card("BOUNDARY, AMPLITUDE=PUSHPULL", ("CLAMP", 1, 1, STROKE)),
                card("OUTPUT, FIELD, NUMBER INTERVAL=80"),
                card("NODE PRINT, NSET=CLAMP", ("U", "RF")),
                card("NODE PRINT, NSET=TIP", ("U",)),
            ),
        ]
    )


def write(folder: Path) -> None:
    """Writes the include file and all decks into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / INCLUDE).write_text(model())
    for name, beta in BETA.items():
        (folder / f"{name}.inp").write_text(problem(beta))
    enhanced = problem(max(BETA.values()), model("CPE4I"))
    (folder / "snap_fit_cpe4i.inp").write_text(enhanced)


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
