"""The engine's orders and the paper's imposed displacement."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.numerics.units import RPM
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.kinematics import rotation
from trackvib_sim.vehicle.drive.engine import Crank, add_engine, build_engine, imposed_displacement, turn_crank


def crank(angle, speed):
    """A crankshaft at an angle [rad] and speed [r/min]."""
    return Crank(np.array([angle]), np.array([speed * RPM]))


@pytest.fixture(scope="module")
def spectrum(vehicle, rows, system, random_motion, added):
    """Fourier amplitudes of the force and of the moment about the point of attack, powertrain axes, by order."""

    def analyse(speed):
        record, motion = build_engine(vehicle, rows, False), random_motion(4)
        body = rows["powertrain"]
        turn = np.reshape(rotation(motion, body), (3, 3))
        samples = 64  # a revolution, enough for order 31
        waves = np.zeros((samples, 2, 3))
        for k in range(samples):
            cuts = new_cuts(system.tree)
            add_engine(record, crank(2.0 * np.pi * k / samples, speed), motion, cuts)
            loads = added(cuts)
            arm = turn @ vehicle.engine.place
            moment = loads.moment[body] - np.cross(arm, loads.force[body])
            waves[k] = turn.T @ loads.force[body], turn.T @ moment
            loads.force[body] = loads.moment[body] = 0.0
            assert not loads.force.any() and not loads.moment.any() and not loads.torque.any()
        return 2.0 * np.fft.rfft(waves, axis=0) / samples

    return analyse


@pytest.mark.analytic
def test_engine_has_lines_only_at_its_orders(vehicle, spectrum):
    """At rated speed the lines are those of the file, at orders 2, 3 and 6, fixed in the powertrain's axes."""
    lines = spectrum(vehicle.engine.rated_speed)
    for order in range(len(lines)):
        expected = np.zeros((2, 3))
        if order in (2, 3, 6):
            i = vehicle.engine.orders.index(float(order))
            expected = np.array([vehicle.engine.force[i], vehicle.engine.moment[i]])
        # amplitudes up to 3000 N
        assert_allclose(np.abs(lines[order]), expected, atol=1e-9)


@pytest.mark.literature
def test_engine_orders_are_those_of_the_paper(vehicle):
    """Second and third order are there, the second is the strongest vertical force, rated speed is 1650 r/min."""
    e = vehicle.engine
    assert {2.0, 3.0} <= set(e.orders) and e.rated_speed == 1650.0
    assert np.argmax(np.array(e.force)[:, 2]) == e.orders.index(2.0)
    assert e.imposed_amplitude == 2e-4


@pytest.mark.analytic
@pytest.mark.parametrize("speed", [450.0, 825.0, 2100.0])
def test_engine_forces_grow_with_speed_squared(vehicle, spectrum, speed):
    """Every line at another speed is that at rated speed times the ratio of the speeds squared."""
    rated = spectrum(vehicle.engine.rated_speed)
    assert_allclose(spectrum(speed), rated * (speed / vehicle.engine.rated_speed) ** 2, atol=1e-9)


@pytest.mark.property
@pytest.mark.parametrize("imposed", [False, True])
def test_standing_engine_is_silent(vehicle, rows, system, random_motion, imposed):
    """At 0 r/min there is no force, no moment and no displacement in either kind of excitation."""
    record, cuts = build_engine(vehicle, rows, imposed), new_cuts(system.tree)
    add_engine(record, crank(1.0, 0.0), random_motion(1), cuts)
    assert not cuts.cells.any()
    assert imposed_displacement(record, crank(1.0, 0.0)) == (0.0, 0.0)


@pytest.mark.analytic
def test_a_run_up_turns_the_crank_by_its_integral():
    """Constant speed, then from 450 to 2100 r/min at 75 r/min a second, then constant, to 1e-6 rad."""
    dt, shaft = 1e-4, crank(-450.0 * RPM % (4.0 * np.pi), 450.0)
    for step in range(250_000):
        time = (step + 1) * dt - 1.0
        rising, after = min(max(time, 0.0), 22.0), max(time - 22.0, 0.0)
        turn_crank(shaft, (450.0 + 75.0 * rising) * RPM, dt)
        if step % 10_000 == 9_999:
            expected = RPM * (450.0 * min(time, 22.0) + 0.5 * 75.0 * rising**2 + 2100.0 * after)
            apart = (shaft.angle[0] - expected + 2.0 * np.pi) % (4.0 * np.pi) - 2.0 * np.pi
            assert abs(apart) < 1e-6 and 0.0 <= shaft.angle[0] < 4.0 * np.pi


@pytest.mark.literature
@pytest.mark.parametrize("speed", [900.0, 1650.0])
def test_imposed_displacement_is_the_papers(vehicle, rows, speed):
    """The alternative is 2e-4 sin(2 angle) m with its own rate, and replaces the forces."""
    record = build_engine(vehicle, rows, True)
    assert not record.force.any() and not record.moment.any()
    turning = speed * 2.0 * np.pi / 60.0
    for angle in turning * np.linspace(0.0, 0.1, 7):
        displacement, rate = imposed_displacement(record, crank(angle, speed))
        assert displacement == pytest.approx(2e-4 * np.sin(2.0 * angle), abs=1e-17)
        assert rate == pytest.approx(2e-4 * 2.0 * turning * np.cos(2.0 * angle), rel=1e-9, abs=1e-15)


@pytest.mark.property
def test_forces_leave_no_imposed_displacement(vehicle, rows):
    """Where forces excite, nothing is imposed."""
    assert imposed_displacement(build_engine(vehicle, rows, False), crank(0.3, 1650.0)) == (0.0, 0.0)
