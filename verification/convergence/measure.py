"""Convergence of the passes: no cutbacks, few passes, few factorisations."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import runner  # noqa: E402  (first: it finds the modules of scripts/)
import numpy as np  # noqa: E402
from stickslip.result import Result  # noqa: E402

MASONRY = ("stack", "arch", "card_house")
"""Groups of bodies on bodies."""

LOOSE, STIFF = 1e-7, 1e3
"""Tolerance and Courant number from which the energy balance has a limit of its own."""


def element_size(results: Result) -> float:
    """Length of the shortest edge."""
    place = results.coordinates
    return min(
        float(np.linalg.norm(place[cell] - place[np.roll(cell, -1)], axis=1).min())
        for cell in results.cells
    )


def accuracy(case: runner.Run) -> str:
    """What limits the energy balance of a case, if not the program: an end of a quantity's name."""
    if float(case.parameters.get("tolerance", 0.0)) >= LOOSE:
        return ", loose tolerance"
    is_stiff = float(case.parameters.get("courant", 0.0)) >= STIFF
    return ", stiff body, SS22" if is_stiff and case.parameters.get("scheme") == "ss22" else ""


def first_cutback(results: Result) -> str:
    """The first cutback with its cause, as the log tells it; nothing without any."""
    log = results.path.with_suffix(".log").read_text()
    found = re.search(r"^cutback +(.*)\n +(.*)", log, re.M)
    return f"{found[1]}: {found[2]}" if found else ""


def check(study: runner.Study, case: runner.Run, results: Result) -> list[object]:
    """Checks one case; its row of the table."""
    name = case.name
    place = ", walls" if case.group == "wall" else ", bodies on bodies" if case.group in MASONRY else ""
    # general contact is surface to surface there: the block lies on the other
    if case.parameters.get("kind") == "" or case.group == "dropped":
        place = ", means"
    study.check_run(name, element_size(results), accuracy(case), place)
    passes = results.history.solver["passes"][1:]
    factorizations = int(results.history.solver["factorizations"].sum())
    cutbacks = int(results.run["cutbacks"])
    study.check("cutbacks", name, cutbacks)
    sheared = ", sheared blocks" if case.group == "blocks" else ""
    study.check(f"mean passes{sheared}", name, float(passes.mean()))
    study.check("largest number of passes", name, int(passes.max()))
    if case.group == "rotation":
        turn = results.history.time[-1] / 0.3  # it turns by 1 rad in a unit of time
        study.check("factorisations per 0.3 rad", name, factorizations / turn)
    balance = np.abs(results.history.energy["balance"]).max() / results.history.energy.largest
    return [
        name,
        len(passes),
        cutbacks,
        float(passes.mean()),
        int(passes.max()),
        factorizations,
        float(results.run["seconds_total"]),
        float(balance),
        first_cutback(results),
    ]


def measure(study: runner.Study) -> None:
    """Checks, tabulates and draws what the runs give."""
    cases = study.runs
    rows = [check(study, case, study.results[case.name]) for case in cases]
    header = ("case", "increments", "cutbacks", "mean passes", "largest", "factorisations")
    header += ("seconds", "balance", "first cutback")
    study.table("Runs", header, rows)
