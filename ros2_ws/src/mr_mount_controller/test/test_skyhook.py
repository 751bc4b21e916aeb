"""Skyhook's rule: on two points, at rest, and on a powertrain that turns."""

import numpy as np
import pytest
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.running import answer
from mr_mount_controller.laws.skyhook import Skyhook
from mr_mount_controller.mounting import Kind, Mount, Mounting

PERIOD = 1e-3


@pytest.mark.analytic
@pytest.mark.parametrize("frequency", [2.0, 8.7, 20.0])
@pytest.mark.parametrize(("ratio", "phase"), [(0.5, 0.0), (2.0, 0.0), (1.0, 1.0), (0.7, -2.0)])
def test_skyhook_switches_as_karnopp_says(sample, frequency, ratio, phase):
    """Firm where v_p (v_p - v_c) > 0, for sinusoidal velocities of powertrain and chassis.

    Both estimates lead the true velocities by the phase of s^2 / (s + w)^2, which is the same for both and so moves
    the switching as a whole; one sample either side of a zero crossing is left out for the error
    of the discrete filters, half a sample.
    """
    s, law = 2j * np.pi * frequency, Skyhook(PERIOD, soft_current=0.8, firm_current=3.0)
    lead = np.angle(s**2 / (s + 2.0 * np.pi * law.corner) ** 2)
    seen = {0.8: 0, 3.0: 0}
    for k in range(1, 10_001):
        end = k * PERIOD
        # accelerations as means over the period are differences of the velocities
        v_p, v_c = (np.imag(a * np.exp(s * np.array([end - PERIOD, end]))) for a in (1.0, ratio * np.exp(1j * phase)))
        got = answer(law, sample(end, np.diff(v_c)[0] / PERIOD, np.diff(v_p)[0] / PERIOD))[0]
        # the start dies out as exp(-w t): 4e-11 after 8 s
        if k > 8_000:
            near = np.exp(s * (end + PERIOD * np.array([-1, 0, 1])) + 1j * lead)
            v_p, v_r = near.imag, (near * (1.0 - ratio * np.exp(1j * phase))).imag
            firm = v_p * v_r > 0.0
            if firm.all() or not firm.any():
                assert got == (3.0 if firm[0] else 0.8)
                seen[got] += 1
    assert sum(seen.values()) > 1_500
    # powertrain and chassis in step: the sign never changes
    assert min(seen.values()) > 100 or phase == 0.0


@pytest.mark.property
def test_skyhook_at_rest_is_soft(sample):
    """With nothing but gravity the damper stays soft."""
    law = Skyhook(PERIOD)
    assert all((answer(law, sample(k * PERIOD)) == law.soft_current).all() for k in range(1, 100))


@pytest.mark.analytic
@pytest.mark.parametrize("axis", [0, 1])
def test_skyhook_on_a_powertrain_that_turns(axis):
    """About an axis between two mounts: each is judged by the velocity at its own place.

    The powertrain heaves with v and turns about x or y so that its ends at +-1 m move by +-u beside it; the hull heaves
    with 2 v. So a mount has the velocity v +- u, and v +- u - 2 v across it.
    """
    place = [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0)][axis]
    sign = 1.0 if axis == 0 else -1.0  # about y what lies ahead goes down
    law = Skyhook(PERIOD, corner=0.01)
    law.run_on(Mounting((Mount("plus", Kind.MR, place), Mount("minus", Kind.MR, tuple(-p for p in place)))))
    w, seen = 2.0 * np.pi * 5.0, 0
    for k in range(1, 6001):
        begin, end = (k - 1) * PERIOD, k * PERIOD
        v, u = np.sin(w * end), 0.6 * np.sin(2.0 * w * end + 0.3)
        a = (np.sin(w * end) - np.sin(w * begin)) / PERIOD
        rate = [0.0, 0.0, 0.0]
        rate[axis] = sign * u
        got = answer(law, Sample(end, (0.0, 0.0, 9.81 + 2.0 * a), (0.0,) * 3, (0.0, 0.0, 9.81 + a), tuple(rate)))
        # gravity is taken to turn with the powertrain, which adds to the estimates: only sure signs are looked at
        for current, local in zip(got, (v + u, v - u), strict=True):
            product = local * (local - 2.0 * v)
            if k > 3000 and abs(local) > 0.3 and abs(local - 2.0 * v) > 0.3:
                assert current == (3.0 if product > 0.0 else 0.8)
                seen += 1
    assert seen > 1000
