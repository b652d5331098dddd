"""Checks of every frame that need no element: NaN in fields, sums, invariants of stresses, and balance of contact
forces."""

import numpy as np

from stickslip.certificate.check import Checks
from stickslip.certificate.contacts import Contact
from stickslip.certificate.increments import ENERGY_MOMENTUM, EULER, STATIC, Increment, Increments
from stickslip.certificate.law import ContactLaw
from stickslip.frame import Frame
from stickslip.result import Result

SUMS = 1e-11
"""Resultants of contact forces as a part of the sum of their sizes; invariants of stresses as a part of the largest stress."""

MOMENTS = 1e-9
"""Moment of all contact forces, as a part of their sum times the largest arm."""

HEAT = 1e-10
"""Difference of sums over nodes from sums over pairs that is round-off."""


class Frames:
    """Data that the checks of all frames share."""

    def __init__(self, result: Result, contacts: list[Contact], checks: Checks) -> None:
        self.result, self.contacts, self.checks = result, contacts, checks
        self.increments = Increments(result)
        self.law = ContactLaw(self.increments, contacts, checks)

    def check(self) -> None:
        """All checks of all frames."""
        for frame, increment in self.increments.frames():
            if increment is None:
                self.checks["time"].add(1.0, 0.0, f"frame {frame.index} has no increment")
                continue
            self._finite(frame)
            self._invariants(frame)
            self._actions(frame, increment)
            self.law.check(frame, increment)
            self._sets(frame, increment.row)
            self._heat(frame, increment.row)

    def _finite(self, frame: Frame) -> None:
        """Checks that no field of motion and force is NaN."""
        for name in ("U", "V", "A", "RF", "CONTACT_FORCE"):
            bad = ~np.isfinite(frame.full(name)).all()
            self.checks["time"].add(float(bad), 0.0, f"{name} of frame {frame.index} is no number")

    def _invariants(self, frame: Frame) -> None:
        """Checks the stress of von Mises, the principal stresses and the pressure against the stresses."""
        if not len(self.result.cells):
            return
        (xx, yy, xy), across = frame["S"].T, frame["S33"]
        mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - across) ** 2 + (across - xx) ** 2) + 3.0 * xy**2)
        mean, half = (xx + yy) / 2.0, np.hypot((xx - yy) / 2.0, xy)
        principal = np.sort([mean - half, mean + half, across], axis=0)
        size = max(float(np.abs(values).max()) for values in (xx, yy, xy, across))
        of_stresses = zip(
            ("MISES", "SP1", "SP2", "SP3", "PRESS"),
            (mises, *principal, -(xx + yy + across) / 3.0),
            strict=True,
        )
        check = self.checks["invariants"]
        check.scale = max(check.scale, size)
        for name, values in of_stresses:
            if name in self.result.frames.fields:
                place = f"{name} of element {{}}, t = {frame.time:g}"
                check.add(np.abs(values - frame[name]), SUMS * size, place)

    def _sets(self, frame: Frame, row: int) -> None:
        """Checks histories of sets against the frames."""
        check, place = self.checks["accounts"], f"t = {frame.time:g}"
        groups = (
            (self.result.history.nodes, self.result.node_labels, ("U", "V", "RF")),
            (self.result.history.elements, self.result.element_labels, ("S", "E", "MISES")),
        )
        for group, labels, names in groups:
            for name, members in group.items():
                at = np.flatnonzero(np.isin(labels, members["labels"]))
                at = at[np.argsort(labels[at])][np.argsort(np.argsort(members["labels"]))]
                for field in names:
                    if field in members:
                        differ = (members[field][row] != frame[field][at]).any()
                        check.add(float(differ), 0.0, f"{field} of the set {name}, {place}")

    def _heat(self, frame: Frame, row: int) -> None:
        """Checks the heat of all nodes against the heat of the contacts."""
        if "FRICTION_HEAT" not in self.result.frames.fields:
            return
        work = {one.name: self.result.contact[one.name]["friction_dissipation"] for one in self.contacts}
        largest = sum(one.heat * float(np.abs(work[one.name]).max(initial=0.0)) for one in self.contacts)
        told = sum(one.heat * float(work[one.name][row]) for one in self.contacts)
        error = abs(float(np.nansum(frame["FRICTION_HEAT"])) - told)
        if largest > 0.0:
            place = f"FRICTION_HEAT of all nodes, t = {frame.time:g}"
            self.checks["accounts"].add(error / largest, HEAT, place)

    def _actions(self, frame: Frame, increment: Increment) -> None:
        """Checks that the contact forces of a frame have no resultant and no moment."""
        force = frame["CONTACT_FORCE"]
        size = np.abs(force).sum()
        if size == 0.0:
            return
        check = self.checks["action"]
        place = f"t = {frame.time:g}"
        check.add(np.abs(force.sum(axis=0)).max() / size, SUMS, place)
        for contact in self.contacts:
            others = [one for one in self.contacts if one is not contact]
            alone = np.concatenate(
                [
                    contact.segments.ravel(),
                    *(np.append(o.slaves, o.segments.ravel()) for o in others),
                ]
            )
            slaves = contact.slaves if contact.disc is None else np.append(contact.slaves, contact.disc.arm)
            if not np.isin(slaves, alone).any():
                total = force[slaves].sum(axis=0)
                stored = self.result.contact[contact.name]["force"][increment.row]
                check.add(
                    np.abs(total - stored).max() / size,
                    SUMS,
                    f"{contact.name}, t = {frame.time:g}",
                )
        if increment.scheme in (STATIC, EULER) and "connectors" in self.result.file["history"]:
            check.skip("moments are left out where springs are soft: bodies still move in the last pass of a static step")
            return
        x = self.result.coordinates + frame["U"]
        loaded = np.abs(force).max(axis=1) > 0.0
        if increment.scheme == ENERGY_MOMENTUM:
            # discrete gradients act halfway
            if increment.start is None or not self.increments.start_is_told(frame, increment)[loaded].all():
                return
            x = self.result.coordinates + 0.5 * (increment.start + frame["U"])
        moment = x[:, 0] * force[:, 1] - x[:, 1] * force[:, 0]
        arm = np.abs(x[loaded]).max()
        check.add(abs(moment.sum()) / (size * arm), MOMENTS, f"moment, t = {frame.time:g}")
