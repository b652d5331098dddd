"""The certificate of a result: all checks, as a table and as one line."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stickslip.certificate.check import Check, Checks
from stickslip.certificate.contacts import contacts
from stickslip.certificate.frames import Frames
from stickslip.certificate.histories import check_histories
from stickslip.certificate.inside import check_penetration
from stickslip.errors import Fault
from stickslip.result import Result

TEXTS = {
    "action": "resultant and moment of all contact forces, part of their sum",
    "gap": "gap of closed nodes, depth of open ones, in lengths of a segment",
    "reach": "distance of closed nodes from the nearest segment itself, in lengths",
    "complementarity": "distance of nodes with a force from what they touch, in lengths",
    "cone": "force outside of Coulomb's cone, part of the largest",
    "slip": "slip of nodes inside of the cone, in lengths",
    "penetration": "depth of slave nodes inside of masters, in edges",
    "crossing": "how far edges cross, or nodes are between means, beyond what the history tells, in edges",
    "invariants": "invariants of the stresses of elements from these stresses, part of the largest",
    "balance": "energy balance from its accounts, part of the largest energy",
    "signs": "energy given back by what dissipates, part of the largest energy",
    "accounts": "sums that must agree, part of the largest value",
    "momentum": "momentum that no impulse accounts for, part of the largest",
    "law": "errors that the run has measured in its increments",
    "time": "increments in order, converged, fields that are numbers",
}

SHOWN = ("gap", "cone", "penetration", "balance", "momentum")
"""Checks that the line of a certificate shows."""

NOT_CHECKED = "not checked: masses, momenta, energies, stresses, strains and equilibrium of elements, which need equations beside the file"


@dataclass(frozen=True)
class Certificate:
    """Outcome of all checks."""

    job: str
    checks: list[Check]
    increments: int
    frames: int
    shown: tuple[str, ...] = SHOWN
    note: str = NOT_CHECKED
    """What no check is about."""

    @property
    def holds(self) -> bool:
        """Whether all checks hold that the file allows."""
        return all(check.holds for check in self.checks)

    @property
    def line(self) -> str:
        """The certificate in one line."""
        told = [check for check in self.checks if check.is_told]
        broken = [check for check in told if not check.holds]
        size = f"{self.increments} increments and {self.frames} frames"
        if broken:
            names = ", ".join("{} {:.1e} above {:.1e}".format(c.name, *c.shown()) for c in broken)
            return f"{len(broken)} of {len(told)} checks of {size} fail: {names}"
        worst = ", ".join(f"{c.name} {c.shown(1)[0]:.0e}" for c in told if c.name in self.shown)
        return f"all {len(told)} checks of {size} hold: {worst}"

    def table(self) -> list[str]:
        """One line for each check."""
        lines = [f"{'check':<16}{'worst':>9}{'bound':>9}{'values':>11}  where"]
        for check in self.checks:
            if check.is_told:
                mark = "" if check.holds else "FAILS "
                figures = "{:9.1e}{:9.1e}".format(*check.shown()) + f"{check.count:11}"
                lines.append(f"{check.name:<16}{figures}  {mark}{check.place}")
            else:
                reason = check.reasons[0] if check.reasons else "nothing in the file to compare"
                lines.append(f"{check.name:<16}{'-':>9}{'-':>9}{'-':>11}  not told: {reason}")
        for check in self.checks:
            if check.is_told:
                lines += [f"note: {check.name}: {reason}" for reason in check.reasons]
        return [*lines, self.note] if self.note else lines


def certify(result: Result | Path | str) -> Certificate:
    """Makes all checks of a result file that the file alone allows."""
    if not isinstance(result, Result):
        with Result(result) as opened:
            return certify(opened)
    if "steps" not in result.file["model"]:
        raise Fault(f"{result.path} was written before there were certificates: run the deck again")
    checks = Checks(TEXTS)
    with np.errstate(all="ignore"):  # what is no number fails
        check_histories(result, checks)
        found = contacts(result)
        Frames(result, found, checks).check()
        check_penetration(result, found, checks)
    return Certificate(result.job, checks.all(), result.rows - 1, len(result.frames))
