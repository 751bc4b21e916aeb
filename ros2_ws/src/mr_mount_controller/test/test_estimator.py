"""The motion estimator against its transfer function s / (s + w)^2, and on bodies that tilt and turn."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.estimator import GRAVITY, MotionEstimator, VerticalMotion
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

PERIOD = 1e-3
STILL = (0.0, 0.0, 0.0)


def response(frequency, corner, period=PERIOD):
    """Complex gain from a sinusoidal vertical acceleration, whose samples are means over their period, to velocity."""
    s = 2j * np.pi * frequency
    estimator = VerticalMotion(period, corner)
    settle = int(20.0 / (2.0 * np.pi * corner) / period)  # exp(-20) (1 + 20) = 4e-8 of the start is left
    count = settle + int(round(4.0 / frequency / period))
    end = period * np.arange(1, count + 1)
    mean = (np.exp(s * end) - np.exp(s * (end - period))) / (s * period)
    velocity = [estimator.update((0.0, 0.0, GRAVITY + a), STILL)[1] for a in mean.real]
    basis = np.exp(s * end[settle:])
    fit = np.linalg.lstsq(np.stack((basis.real, -basis.imag), axis=1), np.array(velocity)[settle:], rcond=None)[0]
    return fit[0] + 1j * fit[1]


@pytest.mark.analytic
@pytest.mark.parametrize("corner", [0.2, 0.5, 2.0])
@pytest.mark.parametrize("frequency", [0.1, 0.5, 2.0, 8.7, 50.0])
def test_frequency_response_is_the_transfer_function(frequency, corner):
    """Amplitude and phase are those of s / (s + w)^2.

    Each of the two first-order filters takes its input as constant over a period, which puts a relative error of at
    most |s + w| period / 2 on the first one (the second is exact for the mean that it gets), plus the same again for
    the product of the two at the end of the period.
    """
    s, w = 2j * np.pi * frequency, 2.0 * np.pi * corner
    exact = s / (s + w) ** 2
    assert abs(response(frequency, corner) / exact - 1.0) < abs(s + w) * PERIOD


@pytest.mark.analytic
def test_error_shrinks_with_the_period():
    """Half the period halves the error against the transfer function, as a first-order error does."""
    s, w = 2j * np.pi * 2.0, np.pi
    error = [abs(response(2.0, 0.5, period) / (s / (s + w) ** 2) - 1.0) for period in (4e-3, 2e-3, 1e-3)]
    # second-order terms are |s + w| period smaller, 5 % at most
    assert error[0] / error[1] == pytest.approx(2.0, rel=0.05)
    assert error[1] / error[2] == pytest.approx(2.0, rel=0.05)


@pytest.mark.analytic
def test_step_of_acceleration_is_forgotten():
    """After a step of 1 m/s^2 the velocity follows t exp(-w t), whose peak is 1 / (e w), and dies out."""
    w = 2.0 * np.pi * 0.5
    estimator = VerticalMotion(PERIOD, 0.5)
    estimator.update((0.0, 0.0, GRAVITY), STILL)
    velocity = np.array([estimator.update((0.0, 0.0, GRAVITY + 1.0), STILL)[1] for _ in range(10_000)])
    time = PERIOD * np.arange(1, 10_001)
    # first-order error of the cascade: w period of the peak
    assert np.abs(velocity - time * np.exp(-w * time)).max() < 2.0 * w * PERIOD / (np.e * w)
    assert abs(velocity[-1]) < 1e-11


@pytest.mark.property
@settings(max_examples=30)
@given(roll=st.floats(-1.0, 1.0), pitch=st.floats(-1.0, 1.0))
def test_constant_tilt_leaves_no_velocity(roll, pitch):
    """On a slope at rest velocities are zero but for rounding, from the first sample on."""
    up = Rotation.from_euler("yx", [pitch, roll]).inv().apply([0.0, 0.0, GRAVITY])
    estimator = VerticalMotion(PERIOD, 0.5)
    for _ in range(200):
        assert np.abs(estimator.update(tuple(up.tolist()), STILL)).max() < 1e-12


@pytest.mark.analytic
@pytest.mark.parametrize("rate", [(0.0, 0.5, 0.0), (0.3, -0.2, 0.7)])
def test_turning_leaves_no_velocity(rate):
    """A body that turns steadily, far beyond its first attitude, feels gravity turn and no velocity.

    The specific force is the mean of turning gravity over the period, taken at its middle: g (rate period / 2)
    against its end, along the turn and so seen in the square only: 1e-6 m/s^2. Without angular rates the estimated
    vertical lags behind, which leaves a thousand times as much.
    """
    step = Rotation.from_rotvec(PERIOD * np.array(rate))
    attitude, up = Rotation.identity(), np.array([0.0, 0.0, GRAVITY])
    aided, blind = VerticalMotion(PERIOD, 0.5), VerticalMotion(PERIOD, 0.5)
    largest = np.zeros(2)
    for _ in range(3000):
        middle = attitude * Rotation.from_rotvec(0.5 * PERIOD * np.array(rate))
        force = tuple(middle.inv().apply(up).tolist())
        attitude = attitude * step
        velocity = aided.update(force, rate)[1], blind.update(force, STILL)[1]
        largest = np.maximum(largest, np.abs(velocity))
    assert largest[0] < 1e-5
    assert largest[1] > 5e-3


@pytest.mark.analytic
def test_vertical_acceleration_of_a_tilted_body():
    """A body on a slope of 0.3 rad that shakes vertically and along the slope shows the vertical part.

    Shaking of 3 m/s^2 at 10 Hz turns the estimated vertical by 3 / 9.81 w / (2 pi 10) = 0.015 rad, which costs that
    part of the horizontal shaking.
    """
    turn = Rotation.from_euler("y", 0.3)
    estimator, found, true = VerticalMotion(PERIOD, 0.5), [], []
    for k in range(6000):
        shake = np.sin(2.0 * np.pi * 10.0 * PERIOD * k)
        acceleration = np.array([3.0 * np.cos(2.0 * np.pi * 10.0 * PERIOD * k), 0.0, shake])
        force = turn.inv().apply(acceleration + [0.0, 0.0, GRAVITY])
        found.append(estimator.update(tuple(force.tolist()), STILL)[0])
        true.append(shake)
    # the washout leads by 2 * 0.5 / 10 / 2 = 0.05 rad
    assert_allclose(found[-1000:], true[-1000:], atol=0.05 + 0.05)


@pytest.mark.analytic
def test_relative_velocity_is_that_across_the_mounts():
    """Powertrain and hull that move apart: the estimate is the difference of their velocities, above the corner."""
    estimator, w = MotionEstimator(PERIOD, 0.2), 2.0 * np.pi * 8.0
    for k in range(8000):
        s = np.sin(w * PERIOD * (k + 0.5))
        sample = Sample(PERIOD * (k + 1), (0.0, 0.0, GRAVITY - 2.0 * s), STILL, (0.0, 0.0, GRAVITY + s), STILL)
        motion = estimator.update(sample)
        if k > 7000:
            # acceleration sin gives velocity -cos / w; the lead of the washout is 2 * 0.2 / 8 = 0.05 rad
            expected = -np.cos(w * PERIOD * (k + 1)) / w
            assert motion.velocity == pytest.approx(expected, abs=0.08 / w)
            assert motion.relative_velocity == pytest.approx(3.0 * expected, abs=0.24 / w)


@pytest.mark.property
@settings(max_examples=20)
@given(values=st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=6, max_size=6))
@pytest.mark.parametrize("period", [1e-3, 0.1])
def test_faults_of_a_sensor_pass(values, period):
    """After any finite sample, estimates are finite, and a second at rest at the highest corner makes them small."""
    estimator = VerticalMotion(period, 10.0)
    estimator.update((0.0, 0.0, GRAVITY), STILL)
    assert np.isfinite(estimator.update(tuple(values[:3]), tuple(values[3:]))).all()
    rest = [estimator.update((0.0, 0.0, GRAVITY), STILL) for _ in range(round(1.0 / period))]
    assert np.abs(rest[-1]).max() < 1e-6
