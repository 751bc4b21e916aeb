"""The magnetorheological mounts as a controller knows them: stiffness and damping of one mount over its current.

The fits are those printed in [Tao2025]. Laws use the currents at which they describe a mount: below 0.641 A the fit of
the damping ratio is negative, and the rubber's is what is left. Damping is firmest at 3.71 A and hardly less at 4 A,
stiffness grows all the way.

[Tao2025] Y. Tao et al., "Analysis of the vibration characteristics of a moving tracked vehicle considering the
powertrain magnetorheological damping system", Appl. Sci. 15 (2025) 8997.
"""

from bisect import bisect_left
from math import sqrt

STIFFNESS_FIT = (0.0412e6, -0.581e6, 2.8317e6, 0.904e6)  # N/m over A, highest power first
DAMPING_RATIO_FIT = (0.0121, -0.1567, 0.6526, -0.3573)
CARRIED_MASS = 1000.0  # kg, to which the damping ratio refers
RUBBER_DAMPING_RATIO = 0.02  # without a field
LOWEST_CURRENT, HIGHEST_CURRENT = 0.7, 4.0  # A, where laws use the fits
COIL_LAG = 0.008  # s, time constant of driver and coil

_STEP = 0.01  # A, of the table that is searched for a wanted damping


def stiffness(current):
    """Return k(I) [N/m] of a mount, the current [A] kept between zero and the end of the fit."""
    return _fit(STIFFNESS_FIT, current)


def damping(current):
    """Return c(I) = 2 zeta(I) sqrt(k(I) m) [N s/m] of a mount, the current [A] kept likewise."""
    zeta = max(_fit(DAMPING_RATIO_FIT, current), RUBBER_DAMPING_RATIO)
    return 2.0 * zeta * sqrt(_fit(STIFFNESS_FIT, current) * CARRIED_MASS)


def current_for_damping(wanted):
    """Return the smallest current [A] at which a mount has the damping `wanted` [N s/m], or comes nearest to it.

    Linear between the currents of a table 0.01 A apart: the damping at the current found is right to 1 N s/m.
    """
    place = bisect_left(_DAMPINGS, wanted)
    if place == 0:
        return LOWEST_CURRENT
    if place == len(_DAMPINGS):
        return _CURRENTS[-1]
    low, high = _DAMPINGS[place - 1], _DAMPINGS[place]
    part = (wanted - low) / (high - low)
    return _CURRENTS[place - 1] + part * (_CURRENTS[place] - _CURRENTS[place - 1])


def _fit(coefficients, current):
    i = min(max(current, 0.0), HIGHEST_CURRENT)
    a, b, c, d = coefficients
    return ((a * i + b) * i + c) * i + d


def _rising():
    """Return currents and dampings from the lowest current to that of the firmest damping."""
    count = round((HIGHEST_CURRENT - LOWEST_CURRENT) / _STEP)
    currents = [LOWEST_CURRENT + _STEP * n for n in range(count + 1)]
    dampings = [damping(current) for current in currents]
    end = dampings.index(max(dampings)) + 1
    return currents[:end], dampings[:end]


_CURRENTS, _DAMPINGS = _rising()
