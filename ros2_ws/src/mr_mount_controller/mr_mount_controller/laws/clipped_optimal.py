"""Clipped-optimal control: LQG on the linear model of the mounts, and of its force what a mount can give.

[Dyke1996] S. J. Dyke, B. F. Spencer, M. K. Sain, J. D. Carlson, "Modeling and control of magnetorheological dampers for
seismic response reduction", Smart Mater. Struct. 5 (1996) 565-575: a linear-quadratic regulator with a Kalman filter
on measured accelerations wants a force; the damper is driven so that its own force comes nearest. They switch between
no and full current by a measured force; here the current is set at which the estimated damping force is the wanted one.
"""

from functools import cache
from math import exp
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm, solve, solve_continuous_are

from ..node_base.parameters import Parameter
from .mount_model import DEFLECTION, mount_model
from .semi_active import SEMI_ACTIVE, DampingLaw

TRAVEL = Parameter(
    "travel", 3.0e-3, "Deflection weighted equally with 1 m/s^2 of powertrain acceleration.", "m", 1.0e-4, 1.0
)
FORCE = Parameter("force", 2.0e4, "Total mount force weighted equally with 1 m/s^2.", "N", 1.0e3, 1.0e6)

# spectral densities of white noise, of which only the ratios matter
ROAD_NOISE = 3.0e3**2  # N^2/Hz
ENGINE_NOISE = 1.0e3**2  # N^2/Hz
SENSOR_NOISE = 0.02**2  # (m/s^2)^2/Hz; sets what is too slow for the filter to integrate

_LARGEST_FORCE = 1.0e5  # N, of all mounts; the filter must stay finite at any rate
_DIGITS = 9  # of the gains: last bits of LAPACK must not reach the currents


class ClippedOptimal(DampingLaw):
    """Minimises the powertrain's acceleration, deflection and force in the mean, as far as mounts can dissipate."""

    parameters = (*SEMI_ACTIVE, TRAVEL, FORCE)

    def reset(self):
        """Forget the motion; the coils are taken to be soft."""
        super().reset()
        self._gain, self._filter = _designed(self.soft_current, self.mounting, self.travel, self.force, self.period)
        curve = self.mounting.curve
        self._nominal = curve.stiffness(self.soft_current), curve.damping(self.soft_current)
        self._coil_step = 1.0 - exp(-self.period / curve.coil_lag) if curve.coil_lag > 0.0 else 1.0
        self._state = 0.0, 0.0, 0.0, 0.0
        self._coils = [self.soft_current] * self.mounting.coils

    def continue_from(self, earlier):
        """Keep the estimated motion of the mounts and the currents in their coils, too."""
        super().continue_from(earlier)
        self._state, self._coils = earlier._state, earlier._coils

    def currents(self, motion, sample):
        """Return the current of each coil, or one if turning moves none."""
        self._follow(motion)
        currents = super().currents(motion, sample)
        wanted = currents if isinstance(currents, list) else [currents] * len(self._coils)
        self._coils = [coil + self._coil_step * (each - coil) for coil, each in zip(self._coils, wanted, strict=True)]
        return currents

    def _follow(self, motion):
        """Take the filter a period on from the `estimator.Motion` at the sensors, and the regulator's force from it."""
        _, d, _, d_rate = self._state
        k, c = self._nominal
        curve = self.mounting.curve
        force = -sum((curve.stiffness(coil) - k) * d + (curve.damping(coil) - c) * d_rate for coil in self._coils)
        force = min(max(force, -_LARGEST_FORCE), _LARGEST_FORCE)
        self._state = z, d, z_rate, d_rate = _product(
            self._filter, (*self._state, force, motion.acceleration, motion.base_acceleration)
        )
        gain = self._gain
        self._wanted = -(gain[0] * z + gain[1] * d + gain[2] * z_rate + gain[3] * d_rate)
        self._at_sensors = motion.velocity

    def damping_for(self, motion):
        """Return the damping [N s/m] of a mount whose force is its share of the regulator's."""
        rate = self._state[3] + (motion.velocity - self._at_sensors)
        c = self._nominal[1]
        return c - self._wanted / len(self._coils) / rate if rate != 0.0 else c


@cache
def _designed(current, mounting, travel, force, period):
    """Return gain and filter; the same for every run on the same mounts."""
    model = mount_model(current, mounting)
    gain = _rounded(regulator_gain(model, travel, force))[0]
    return gain, _rounded(discrete_filter(model, kalman_gain(model), period))


class Weights(NamedTuple):
    """J = integral of x' q x + 2 x' n u + u' r u."""

    q: np.ndarray
    r: np.ndarray
    n: np.ndarray


def weights(model, travel, force):
    """Return the `Weights` of powertrain acceleration^2 + (deflection / travel)^2 + (force / `force`)^2."""
    c, d = model.c[:1], model.d[:1]
    q = c.T @ c
    q[DEFLECTION, DEFLECTION] += 1.0 / travel**2
    return Weights(q, d.T @ d + 1.0 / force**2, c.T @ d)


def regulator_gain(model, travel, force):
    """Return the gain (1, 4) of the linear-quadratic regulator, u = -K x."""
    q, r, n = weights(model, travel, force)
    p = solve_continuous_are(model.a, model.b, q, r, s=n)
    return solve(r, model.b.T @ p + n.T)


def kalman_gain(model):
    """Return the gain (4, 2) of the Kalman filter, whose measurements feel the disturbances at once."""
    disturbance = np.diag([ROAD_NOISE, ENGINE_NOISE])
    q = model.g @ disturbance @ model.g.T
    r = model.f @ disturbance @ model.f.T + SENSOR_NOISE * np.eye(2)
    n = model.g @ disturbance @ model.f.T
    p = solve_continuous_are(model.a.T, model.c.T, q, r, s=n)
    return solve(r, (p @ model.c.T + n).T).T


def discrete_filter(model, gain, period):
    """Return (4, 7): the state after a period [s] from state, force, and both accelerations, held over it."""
    a = model.a - gain @ model.c
    inputs = np.hstack((model.b - gain @ model.d, gain))
    block = np.zeros((7, 7))
    block[:4] = period * np.hstack((a, inputs))
    return expm(block)[:4]


def _rounded(matrix):
    return [tuple(float(f"{value:.{_DIGITS}g}") for value in row) for row in matrix.tolist()]


def _product(rows, x):
    x0, x1, x2, x3, x4, x5, x6 = x
    return [a * x0 + b * x1 + c * x2 + d * x3 + e * x4 + f * x5 + g * x6 for a, b, c, d, e, f, g in rows]
