"""Velocity from acceleration, as far as an inertial sensor can know it."""

from math import exp, pi


class WashoutIntegrator:
    """Integrates an acceleration above a corner frequency: G(s) = s / (s + w)^2 with w = 2 pi corner.

    The washout removes gravity, tilt and sensor offset; the leaky integration forgets what it gathered wrongly. Both
    are first-order filters discretised exactly for a constant input over a period, which is what a sample, the mean
    over its period, is.
    """

    def __init__(self, period, corner):
        self._w = 2.0 * pi * corner
        self._decay = exp(-self._w * period)
        self._mean = None  # the first sample is taken as the steady state
        self.velocity = 0.0

    def update(self, acceleration):
        """Return the velocity [m/s] after a period of mean acceleration [m/s^2]."""
        if self._mean is None:
            self._mean = acceleration
        self._mean += (1.0 - self._decay) * (acceleration - self._mean)
        change = (1.0 - self._decay) / self._w * (acceleration - self._mean)
        self.velocity = self._decay * self.velocity + change
        return self.velocity
