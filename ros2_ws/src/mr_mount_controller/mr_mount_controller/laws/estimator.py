"""Velocities of hull and powertrain, as far as inertial sensors can know them.

A sensor measures specific force: its acceleration and, upwards, gravity, in axes that turn with the body. A vector
that the angular rate turns against the body, and that slowly follows the specific force, is gravity in body axes (a
complementary filter, linear in the vector; [Mahony2008] has it on the group of rotations). What is left along it is
the vertical acceleration, and its leaky integral the velocity. For a body that does not turn, both together are

    G(s) = s / (s + w)^2,  w = 2 pi corner,

from vertical acceleration to velocity: gravity and offsets are washed out, what was gathered wrongly is forgotten. A
body that turns, as on slopes and in pitch, leaves no velocity either, because its gravity vector turns along.

[Mahony2008] R. Mahony, T. Hamel, J.-M. Pflimlin, "Nonlinear complementary filters on the special orthogonal group",
IEEE Trans. Autom. Control 53 (2008) 1203-1218.
"""

from math import exp, pi, sqrt
from typing import NamedTuple

GRAVITY = 9.81  # m/s^2
# full scales of the sensors; what is beyond is a fault, and must not stay in the estimates
LARGEST_FORCE = 1000.0  # m/s^2
LARGEST_RATE = 100.0  # rad/s


class Motion(NamedTuple):
    """Vertical motion at the sensors or at a mount, upwards positive, without what is slower than the corner."""

    acceleration: float  # of the powertrain, m/s^2
    velocity: float  # of the powertrain, m/s
    base_acceleration: float  # of the chassis
    base_velocity: float

    @property
    def relative_velocity(self):
        """Velocity across the mounts [m/s], positive where they lengthen."""
        return self.velocity - self.base_velocity

    def beside(self, velocity):
        """Return the motion at a place where the powertrain's turning against the hull adds a velocity [m/s]."""
        return self._replace(velocity=self.velocity + velocity)


class MotionEstimator:
    """Estimates `Motion` from samples of both sensors.

    Parameters
    ----------
    period : float
        Sampling period [s].
    corner : float
        Corner frequency [Hz] of gravity vectors and integration.
    """

    def __init__(self, period, corner):
        self._powertrain = VerticalMotion(period, corner)
        self._chassis = VerticalMotion(period, corner)

    def update(self, sample):
        """Return the `Motion` at the end of a `Sample`'s period."""
        return Motion(
            *self._powertrain.update(sample.powertrain_force, sample.powertrain_angular_velocity),
            *self._chassis.update(sample.chassis_force, sample.chassis_angular_velocity),
        )


def levers(mounting):
    """Return what turning against the hull adds to the powertrain's vertical velocity at each MR mount of a `Mounting`.

    Each is a pair [m], of the angular velocities about x and y; zero where the powertrain cannot turn.
    """
    about_x, about_y, _ = mounting.turning
    places = [mount.place for mount in mounting.mounts[: mounting.coils]]
    return [(y if about_x else 0.0, -x if about_y else 0.0) for x, y, _ in places]


def turning(sample):
    """Return the angular velocities [rad/s] about x and y of the powertrain against the hull."""
    rates = zip(sample.powertrain_angular_velocity[:2], sample.chassis_angular_velocity[:2], strict=True)
    return [_limited(powertrain) - _limited(hull) for powertrain, hull in rates]


def _limited(rate):
    return min(max(rate, -LARGEST_RATE), LARGEST_RATE)


class VerticalMotion:
    """Vertical acceleration and velocity of one sensor; parameters as for `MotionEstimator`.

    Both first-order filters are discretised exactly for an input that is constant over a period: a sample stands for
    the whole of its period.
    """

    def __init__(self, period, corner):
        w = 2.0 * pi * corner
        self._half_period = 0.5 * period
        self._decay = exp(-w * period)
        self._follow = 1.0 - self._decay
        self._integrate = self._follow / w
        self._gravity = None
        self._velocity = 0.0

    def update(self, force, rate):
        """Return acceleration [m/s^2] and velocity [m/s] after a period of specific force and angular rate (3,)."""
        fx, fy, fz = (min(max(value, -LARGEST_FORCE), LARGEST_FORCE) for value in force)
        if self._gravity is None:
            # at first the direction of gravity is taken from the specific force, its size is known
            length = sqrt(fx * fx + fy * fy + fz * fz)
            gx, gy, gz = (GRAVITY / length * f for f in (fx, fy, fz)) if length > 0.0 else (0.0, 0.0, GRAVITY)
        else:
            gx, gy, gz = self._turned(rate)
        gx += self._follow * (fx - gx)
        gy += self._follow * (fy - gy)
        gz += self._follow * (fz - gz)
        self._gravity = gx, gy, gz
        # nothing is vertical for a sensor that feels no gravity
        length = sqrt(gx * gx + gy * gy + gz * gz) or 1.0
        acceleration = ((fx - gx) * gx + (fy - gy) * gy + (fz - gz) * gz) / length
        self._velocity = self._decay * self._velocity + self._integrate * acceleration
        return acceleration, self._velocity

    def _turned(self, rate):
        """Return gravity in the axes of a body that has turned for a period; Cayley's form keeps its length."""
        x, y, z = (-self._half_period * _limited(value) for value in rate)
        gx, gy, gz = self._gravity
        ux, uy, uz = gx + y * gz - z * gy, gy + z * gx - x * gz, gz + x * gy - y * gx
        part = 2.0 / (1.0 + x * x + y * y + z * z)
        return gx + part * (y * uz - z * uy), gy + part * (z * ux - x * uz), gz + part * (x * uy - y * ux)
