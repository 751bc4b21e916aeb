"""The magnetorheological mounts as a controller knows them: stiffness and damping of one mount over its current.

What a simulator describes is used; these fits, those printed in [Tao2025], where nobody does. Laws use the currents at
which the fits describe a mount: below 0.641 A that of the damping ratio is negative, and the rubber's is what is left.
Damping is firmest at 3.71 A and hardly less at 4 A, stiffness grows all the way.

[Tao2025] Y. Tao et al., "Analysis of the vibration characteristics of a moving tracked vehicle considering the
powertrain magnetorheological damping system", Appl. Sci. 15 (2025) 8997.
"""

from bisect import bisect_left
from functools import cache
from math import sqrt
from typing import NamedTuple

LOWEST_CURRENT, HIGHEST_CURRENT = 0.7, 4.0  # A, where laws may be asked to work
_STEP = 0.01  # A, of the table that is searched for a wanted damping


class MountCurve(NamedTuple):
    """Stiffness and damping of a mount over its current.

    Examples
    --------
    >>> from mr_mount_controller.mount import PUBLISHED
    >>> round(PUBLISHED.stiffness(1.0)), round(PUBLISHED.damping(1.0))  # N/m, N s/m
    (3195900, 17074)
    """

    stiffness_fit: tuple  # N/m over A, highest power first
    damping_ratio_fit: tuple  # likewise
    carried_mass: float  # kg, to which the damping ratio refers
    rubber_damping_ratio: float  # without a field
    lowest: float  # A, where the fits are to be used
    highest: float  # A
    coil_lag: float  # s, time constant of driver and coil

    def stiffness(self, current):
        """Return k(I) [N/m] of a mount, the current [A] kept between zero and the end of the fit."""
        return self._fit(self.stiffness_fit, current)

    def damping(self, current):
        """Return c(I) = 2 zeta(I) sqrt(k(I) m) [N s/m] of a mount, the current [A] kept likewise."""
        zeta = max(self._fit(self.damping_ratio_fit, current), self.rubber_damping_ratio)
        return 2.0 * zeta * sqrt(self._fit(self.stiffness_fit, current) * self.carried_mass)

    def current_for_damping(self, wanted):
        """Return the smallest current [A] at which a mount has the damping `wanted` [N s/m], or comes nearest to it.

        Linear between the currents of a table 0.01 A apart: the damping at the current found is right to 1 N s/m.
        """
        currents, dampings = _rising(self)
        place = bisect_left(dampings, wanted)
        if place == 0:
            return currents[0]
        if place == len(dampings):
            return currents[-1]
        low, high = dampings[place - 1], dampings[place]
        part = (wanted - low) / (high - low)
        return currents[place - 1] + part * (currents[place] - currents[place - 1])

    def _fit(self, coefficients, current):
        i = min(max(current, 0.0), self.highest)
        a, b, c, d = coefficients
        return ((a * i + b) * i + c) * i + d


PUBLISHED = MountCurve(
    stiffness_fit=(0.0412e6, -0.581e6, 2.8317e6, 0.904e6),
    damping_ratio_fit=(0.0121, -0.1567, 0.6526, -0.3573),
    carried_mass=1000.0,
    rubber_damping_ratio=0.02,
    lowest=LOWEST_CURRENT,
    highest=HIGHEST_CURRENT,
    coil_lag=0.008,
)


@cache
def _rising(curve):
    """Return currents and the dampings there, which rise, from the lowest current to that of the firmest damping."""
    count = max(round((curve.highest - curve.lowest) / _STEP), 1)
    currents = [curve.lowest + (curve.highest - curve.lowest) * n / count for n in range(count + 1)]
    dampings = [curve.damping(current) for current in currents]
    kept = [0]
    for n in range(1, len(currents)):
        if dampings[n] > dampings[kept[-1]]:
            kept.append(n)
    return [currents[n] for n in kept], [dampings[n] for n in kept]
