"""The increments that end with the frames of a result: their schemes, and the positions at their starts."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.arrays import Array, Flags, Integers
from stickslip.frame import Frame
from stickslip.result import Result

EPS = float(np.finfo(np.float64).eps)

STATIC, ENERGY_MOMENTUM, EULER = 0, 1, 3
"""Schemes of /model/steps; 2 is SS22."""


@dataclass(frozen=True)
class Increment:
    """The increment that ends with a frame."""

    row: int
    """Of the history."""
    step: int
    """Index of its step."""
    scheme: int
    theta: Array
    dt: float
    start: Array | None
    """Displacements at its start; none where the file does not tell them."""
    exact: bool
    """Whether the start is that of a frame, and not what velocities and accelerations tell."""


@dataclass(frozen=True)
class ReadOnce(Frame):
    """A frame that reads each field only once for all checks; checks may not change the fields."""

    kept: dict[str, NDArray[Any]] = field(default_factory=dict)

    __hash__ = object.__hash__

    def full(self, name: str) -> NDArray[Any]:
        """A field in the form of the file."""
        if name not in self.kept:
            self.kept[name] = super().full(name)
            self.kept[name].flags.writeable = False
        return self.kept[name]


class Increments:
    """The increments of the frames of a result."""

    def __init__(self, result: Result) -> None:
        self.result = result
        self.time = result.history["time"]
        self.step, self.dt = result.history["step"], result.history["dt"]
        self.scheme = result.read("model/steps/scheme")
        self.theta = result.read("model/steps/theta")
        self.supported = result.read("model/supported_nodes")
        self.constrained = result.read("model/constrained_nodes")
        self.is_redistributed = "CONTACT_MASS" in result.frames.fields
        self.returned: set[int] = set()
        if "returns" in result.file["history"]:
            self.returned = set(result.complete_rows("history/returns/increment").tolist())

    @cached_property
    def has_rigid_parts(self) -> Flags:
        """Whether some nodes of each body move as rigid parts [B]."""
        has_rigid = np.zeros(len(self.result.read("model/bodies/mass")), np.bool_)
        if "rigid" in self.result.file["history"]:
            parts = self.result.read("model/bodies/node")[self.constrained]
            has_rigid[parts[parts >= 0]] = True
        return has_rigid

    @cached_property
    def impelled(self) -> Integers:
        """Nodes whose velocity and acceleration the impulse (11.12) changes, so that the start displacement U0 does not
        follow from these."""
        impelled = np.append(self.has_rigid_parts, False)
        return np.flatnonzero(impelled[self.result.read("model/bodies/node")])

    def frames(self) -> Iterator[tuple[Frame, Increment | None]]:
        """All frames with their increments; a frame has None if no increment ends at its time."""
        last: tuple[int, Array] | None = None
        for index in range(len(self.result.frames)):
            frame = ReadOnce(self.result.frames, index)
            rows = np.flatnonzero(self.time == frame.time)
            if len(rows) == 0:
                yield frame, None
                continue
            row = int(rows[-1])
            yield frame, self._increment(frame, row, last)
            last = (row, frame["U"])

    def _increment(self, frame: Frame, row: int, last: tuple[int, Array] | None) -> Increment:
        """The increment of a frame; its start follows from the last frame, or from eqs (4.1) and (4.2)."""
        step = int(self.step[row]) - 1
        scheme, theta = int(self.scheme[step]), self.theta[step]
        dt = float(self.dt[row])
        start, exact = None, False
        if last is not None and last[0] == row - 1:
            start, exact = last[1], True
        elif scheme != STATIC and row not in self.returned and not self.is_redistributed:
            # d = dt V1, or d = dt V1 - dt² A/2, from V1 = V0+ + dt A
            start = frame["U"] - dt * frame["V"]
            if scheme != EULER:
                start += 0.5 * dt * dt * frame["A"]
        return Increment(row, step, scheme, theta, dt, start, exact)

    def start_is_told(self, frame: Frame, increment: Increment) -> Flags:
        """Whether the position of each node at the start of the increment is known [N]."""
        told = np.ones(len(frame["U"]), np.bool_)
        if not increment.exact:
            a = np.abs(frame["A"]).max(axis=1) * increment.dt**2
            size = np.abs(self.result.coordinates + frame["U"]).max()
            driven = np.concatenate([self.supported, self.constrained, self.impelled])
            told[driven[a[driven] > 4 * EPS * size]] = False
        return told
