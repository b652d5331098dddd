"""A point mass that falls on a slope and bounces perfectly elastically, in closed form.

Normal to the slope v_n becomes -v_n at each impact; friction lowers the speed along it by
min(2 mu |v_n|, |v_t|).
"""

from dataclasses import dataclass

import numpy as np
from stickslip.arrays import Array


@dataclass(frozen=True)
class PointMass:
    """Starts at rest at `gap` above the slope."""

    gap: float
    acceleration: tuple[float, float]
    """Along the slope (downhill) and normal to it (outward)."""
    friction: float

    @property
    def landing(self) -> float:
        """Time of the first impact."""
        return float(np.sqrt(-2.0 * self.gap / self.acceleration[1]))

    @property
    def landing_speed(self) -> float:
        """Speed normal to the slope at every impact."""
        return -self.acceleration[1] * self.landing

    def impacts(self, end: float) -> Array:
        """Times of the impacts up to `end`."""
        count = int((end / self.landing + 1.0) // 2.0)
        return self.landing * (1.0 + 2.0 * np.arange(count))

    def displacement(self, time: Array) -> Array:
        """Displacement along the slope and normal to it at increasing times, [times, 2]."""
        along, normal = self.acceleration
        result = np.empty((len(time), 2))
        start, place, speed = 0.0, np.zeros(2), np.zeros(2)
        for end in [*self.impacts(float(time[-1])), np.inf]:
            flight = (time >= start) & (time < end)
            t = (time[flight] - start)[:, None]
            result[flight] = place + speed * t + 0.5 * np.array([along, normal]) * t**2
            if np.isfinite(end):
                t = end - start
                place = np.array([place[0] + speed[0] * t + 0.5 * along * t**2, -self.gap])
                arriving = speed + np.array([along, normal]) * t
                lost = min(2.0 * self.friction * abs(arriving[1]), abs(arriving[0]))
                speed = np.array([arriving[0] - np.sign(arriving[0]) * lost, -arriving[1]])
                start = end
        return result
