"""Engine speed from the powertrain's accelerations, without a tachometer.

What turns the powertrain about its pivot, beyond what the pivot's own acceleration makes of it, is the moment of engine
and mounts; the shaking that road and tracks pass on through a hinge drops out. Every speed that the engine may
have is a hypothesis: it predicts lines in that moment at the engine's orders. A bank of damped resonators measures
the power at each of them, recursively, and compares it with that of the neighbours. The product over the orders, and a
speed that only wanders, give the probability of each hypothesis, as in [Leclere2016], here as a filter that uses the
past only; that no engine runs is a hypothesis, too. The second order, the strongest in [Tao2025], tells most.

[Leclere2016] Q. Leclere, H. Andre, J. Antoni, "A multi-order probabilistic approach for instantaneous angular speed
tracking: debriefing of the CMMNO'14 diagnosis contest", Mech. Syst. Signal Process. 81 (2016) 375-386.
"""

from math import exp, pi

import numpy as np
from scipy.signal import butter

ORDERS = np.array([2.0, 3.0, 6.0])  # of a twelve-cylinder engine, cycles a revolution
SPEEDS = np.arange(250.0, 2201.0, 10.0)  # r/min
SLOWEST = 430.0  # r/min; lower hypotheses only take in what the mounts' own motion leaves there
MEMORY = 60.0 / (2.0 * pi * ORDERS * 20.0)  # s, of the resonators: as wide as four hypotheses are apart

_LARGEST = 1.0e6  # N m; what is beyond is a fault
_HIGH_PASS = 12.0  # Hz; the moment of the mounts is the larger one below
_LOOK = 0.02  # s between looks at the resonators
_NEIGHBOURS, _NEAREST = 24, 4  # hypotheses to either side that make the mean, and those left out of it
_FAINTEST = 5.0**2  # (N m)^2; squared amplitude below which there is no line
_CLEAREST = 100.0  # ratio to the neighbours beyond which a line tells no more
_TRUST = np.array([[0.13], [0.04], [0.03]])  # in each order; small, because looks overlap
_NO_ENGINE = exp(0.22)  # what noise, or the third or sixth order alone, may pretend to be
_CHANGE = 1e-3  # probability that within a look the engine starts or stops
_WANDER = np.array([0.25, 0.5, 0.25])  # of the speed between looks, up to some 500 r/min a second
_LAG = 0.34  # s, of the most probable speed behind one that changes
_SURE = 0.6  # probability of the best hypothesis and its neighbours that makes it known
_NEAR = 3


class EngineSpeedEstimator:
    """Tracks the speed of an engine that shakes the powertrain at `ORDERS`.

    Parameters
    ----------
    period : float
        Sampling period [s].
    carried : mounting.Carried
        The powertrain.
    """

    def __init__(self, period, carried):
        frequency = SPEEDS * ORDERS[:, None] / 60.0
        seen = frequency < 0.45 / period  # lines near half the sampling rate and above it are not
        decay = np.exp(-period / MEMORY)[:, None]
        self._turn = np.where(seen, decay * np.exp(2j * pi * frequency * period), 0.0)
        # a line of amplitude A gives a resonator A / 2 / (1 - decay)
        self._scale = np.where(seen, (2.0 * (1.0 - decay)) ** 2, 0.0)
        self._resonators = np.zeros_like(self._turn)
        self._neighbours = _window_sums(np.ones_like(frequency))
        self._moment = PivotMoment(period, carried)
        self._probability = np.full(SPEEDS.size, _CHANGE / SPEEDS.size)
        self._no_engine = 1.0
        self._hop = max(1, round(_LOOK / period))
        self._samples = 0
        self._follow = 1.0 - exp(-self._hop * period / _LAG)
        self._late = None
        self.speed = None

    def update(self, sample):
        """Return the speed [r/min] after another `Sample`, or None while it is not known."""
        self._resonators *= self._turn
        self._resonators += self._moment.update(sample.powertrain_force, sample.powertrain_angular_velocity)
        self._samples += 1
        if self._samples % self._hop == 0:
            self._weigh((self._clearness() ** _TRUST).prod(axis=0))
            self.speed = self._best()
        return self.speed

    def _clearness(self):
        """Return how far each line stands out (orders, speeds), from 1 on."""
        power = self._scale * (self._resonators.real**2 + self._resonators.imag**2)
        mean = _window_sums(power) / self._neighbours + _FAINTEST
        return 1.0 + np.minimum(power / mean, _CLEAREST)

    def _weigh(self, likelihood):
        """Take in the likelihoods of a look."""
        running = np.convolve(self._probability, _WANDER, mode="same")
        self._probability = ((1.0 - _CHANGE) * running + _CHANGE * self._no_engine / SPEEDS.size) * likelihood
        no_engine = ((1.0 - _CHANGE) * self._no_engine + _CHANGE * float(running.sum())) * _NO_ENGINE
        total = float(self._probability.sum()) + no_engine
        self._probability /= total
        self._no_engine = no_engine / total

    def _best(self):
        """Return the mean of the best hypothesis and its neighbours if one is, less the lag of the resonators."""
        best = int(self._probability.argmax())
        near = slice(max(best - _NEAR, 0), best + _NEAR + 1)
        weight = float(self._probability[near].sum())
        if weight < _SURE:
            self._late = None
            return None
        speed = float((self._probability[near] * SPEEDS[near]).sum()) / weight
        # what lags as much again shows how far a changing speed is ahead
        self._late = speed if self._late is None else self._late + self._follow * (speed - self._late)
        ahead = min(2.0 * speed - self._late, float(SPEEDS[-1]))
        return ahead if ahead >= SLOWEST else None


class PivotMoment:
    """Moment of engine and mounts on the powertrain about its pivot's y axis, above the mounts' own frequencies.

    M = I alpha + m (c x a)_y: the pivot's acceleration a follows from that of the sensor. Alpha is the difference of
    two angular rates, and the force beside it their mean.
    """

    def __init__(self, period, carried):
        self._period, self._carried = period, carried
        self._last = None
        sections = butter(4, min(_HIGH_PASS, 0.2 / period), "highpass", fs=1.0 / period, output="sos")
        self._sections = [tuple(section) for section in np.delete(sections, 3, axis=1).tolist()]
        self._memory = [(0.0, 0.0)] * len(self._sections)

    def update(self, force, rate):
        """Return the moment [N m] half a period before the end of the sample."""
        x, _, z = force
        last_x, last_z, last_rate = self._last or (x, z, rate[1])
        self._last = x, z, rate[1]
        alpha = (rate[1] - last_rate) / self._period
        carried = self._carried
        (sensor_x, sensor_z), (centre_x, centre_z) = carried.sensor, carried.centre
        a_x = 0.5 * (x + last_x) - alpha * sensor_z
        a_z = 0.5 * (z + last_z) + alpha * sensor_x
        moment = carried.pivot_inertia * alpha + carried.powertrain_mass * (centre_z * a_x - centre_x * a_z)
        return self._filtered(min(max(moment, -_LARGEST), _LARGEST))

    def _filtered(self, value):
        """Pass a value through the second-order sections (transposed direct form II)."""
        for n, (b0, b1, b2, a1, a2) in enumerate(self._sections):
            first, second = self._memory[n]
            result = b0 * value + first
            self._memory[n] = b1 * value - a1 * result + second, b2 * value - a2 * result
            value = result
        return value


def _window_sums(values):
    """Return in each row the sums over the neighbours of a hypothesis, without it and the nearest."""
    reach, count = _NEIGHBOURS, values.shape[1]
    sums = np.zeros((len(values), count + 2 * reach + 1))
    np.cumsum(values, axis=1, out=sums[:, reach + 1 : reach + 1 + count])
    sums[:, reach + 1 + count :] = sums[:, reach + count, None]

    def window(half):
        return sums[:, reach + half + 1 : reach + half + 1 + count] - sums[:, reach - half : reach - half + count]

    return window(_NEIGHBOURS) - window(_NEAREST)
