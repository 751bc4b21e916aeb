"""Vertical absorbed power: the power that vertical vibration leaves in a seated human body.

The human response of Pradko, Lee and Kaluza (1966), with the constants of [Lins1972] and [Lee1968] as later authors
pass them on: F/a, the force on the seat over its acceleration, is K0 (F1 + s F2) / (F3 + s F4) with F1 to F4 even
polynomials in s = jω, so that a sine of RMS a leaves

    P = K1 K0 (F1 F4 - F2 F3) / (F3² + ω² F4²) a²      with a in ft/s², P in W.

Neither report, nor any later text with the constants, could be had: they were written down from memory, and nothing is
held against the values that the reports tabulate. What can be checked holds: at
rest F/a is 4.3537 slug = 63.5 kg, a man's mass on a seat; all poles are stable; P is nowhere negative; and the
independent filter of third order that Project Chrono has for it (`ChAbsorbed_Power_Vertical`) gives the same within its
roughness, with the same greatest value, 0.20 W/(ft/s²)² at 4.5 Hz (`test_absorbed_power.py`).

For a signal the factor is split into H(s) H(-s), with the poles and zeros of H in the left half-plane: the mean square
of what H passes is the absorbed power, and its square at an instant belongs there as well as a filter can say.

[Lee1968] R. A. Lee, F. Pradko: Analytical analysis of human vibration. SAE Technical Paper 680091.
[Lins1972] W. F. Lins: Human vibration response measurement. TACOM Technical Report 11551.
"""

from math import sqrt

import numpy as np
from numpy.polynomial import Polynomial

from .iso2631 import require_rate
from .vibration import through

RIDE_LIMIT = 6.0  # W, that drivers take for long: the limit of ride in the NATO Reference Mobility Model
FOOT = 0.3048  # m
_K0, _K1 = 4.3537, 1.356  # slug; W over ft lbf/s
# in rising powers of ω²
_F1 = Polynomial((1.0, -0.44600e-2, 0.17583e-5, -0.10245e-9))
_F2 = Polynomial((0.10543, -0.93394e-4, 0.12882e-7))
_F3 = Polynomial((1.0, -0.56104e-2, 0.37667e-5, -0.45416e-9))
_F4 = Polynomial((0.10543, -0.17947e-3, 0.51728e-7, -0.21179e-11))
_ABOVE = _F1 * _F4 - _F2 * _F3
_BELOW = _F3**2 + Polynomial((0.0, 1.0)) * _F4**2


def absorbed_by_frequency(frequency):
    """Return the absorbed power over the square of the RMS acceleration, W/(m/s²)², of sines at frequencies [Hz]."""
    square = (2.0 * np.pi * np.asarray(frequency)) ** 2
    return _K0 * _K1 * _ABOVE(square) / _BELOW(square) / FOOT**2


def transfer(frequency):
    """Return the transfer function (n,) at frequencies (n,) [Hz], whose gain squared is `absorbed_by_frequency`."""
    s = 2j * np.pi * np.asarray(frequency, dtype=float)
    gain = sqrt(_K0 * _K1 * _ABOVE.coef[-1] / _BELOW.coef[-1]) / FOOT
    return gain * np.prod(np.subtract.outer(s, _ZEROS), axis=-1) / np.prod(np.subtract.outer(s, _POLES), axis=-1)


def _left_roots(even):
    """Return the roots s with s² = -ω² of a polynomial in ω² that do not lie in the right half-plane."""
    return -np.sqrt(-even.roots().astype(complex))


_ZEROS, _POLES = _left_roots(_ABOVE), _left_roots(_BELOW)
_MEMORY = 35.0 / -_POLES.real.max()  # s, after which the slowest part has fallen by exp(-35)


def absorbed_power(acceleration, rate):
    """Return the absorbed power (k,) [W] at each sample of vertical accelerations (k,) [m/s²].

    The body is at rest at first, as if the first sample had lasted for ever, so that gravity leaves no transient.

    Raises
    ------
    ValueError
        The rate [Hz] is below `iso2631.LEAST_RATE`.
    """
    require_rate(rate, "absorbed power")
    return np.square(through(transfer, acceleration, rate, _MEMORY))
