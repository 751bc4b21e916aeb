"""The engine's orders and the paper's imposed displacement."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.kinematics import rotation
from trackvib_sim.vehicle.engine import (
    RunUp,
    add_engine,
    angle_before,
    build_engine,
    imposed_displacement,
    speed_growth,
    turn_crank,
)


@pytest.fixture(scope="module")
def spectrum(vehicle, rows, system, random_motion, added):
    """Fourier amplitudes of the force and of the moment about the point of attack, powertrain axes, by order."""

    def analyse(speed):
        record, motion = build_engine(vehicle, rows, speed, False), random_motion(4)
        body = rows["powertrain"]
        turn = np.reshape(rotation(motion, body), (3, 3))
        samples = 64  # a revolution, enough for order 31
        waves = np.zeros((samples, 2, 3))
        for k in range(samples):
            cuts = new_cuts(system.tree)
            add_engine(record, 2.0 * np.pi * k / samples, motion, cuts)
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
    record, cuts = build_engine(vehicle, rows, 0.0, imposed), new_cuts(system.tree)
    add_engine(record, 1.0, random_motion(1), cuts)
    assert not cuts.cells.any()
    assert imposed_displacement(record, 1.0) == (0.0, 0.0)


@pytest.mark.analytic
def test_run_up_turns_the_crank_by_its_integral(vehicle, rows):
    """Constant speed, then from 450 to 2100 r/min at 75 r/min a second, then constant, to 1e-9 of the angle."""
    record, dt = build_engine(vehicle, rows, 450.0, False, RunUp(0.0, 75.0, 2100.0)), 1e-4
    angle, crank = angle_before(record, 1.0), np.pi / 30.0
    for step in range(250_000):
        angle = turn_crank(record, angle, dt)
        if step % 10_000 == 9_999:
            time = (step + 1) * dt - 1.0
            rising, after = min(max(time, 0.0), 22.0), max(time - 22.0, 0.0)
            expected = 450.0 * min(time, 22.0) + 0.5 * 75.0 * rising**2 + 2100.0 * after
            assert angle == pytest.approx(crank * expected, rel=1e-9, abs=1e-6)
            assert np.sqrt(speed_growth(record, angle)) * 450.0 == pytest.approx(450.0 + 75.0 * rising, rel=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("speed", [450.0, 900.0, 2100.0])
def test_forces_of_a_run_up_are_those_of_its_speed(vehicle, rows, system, random_motion, added, speed):
    """Where it has reached a speed, the loads are those of an engine that runs at that speed, at the same angle."""
    record, steady = (
        build_engine(vehicle, rows, 450.0, False, RunUp(0.0, 75.0, 2100.0)),
        build_engine(vehicle, rows, speed, False),
    )
    angle = 2.0 * np.pi * (speed**2 - 450.0**2) / (2.0 * 75.0 * 60.0) + 1e-9
    loads = []
    for each in (record, steady):
        cuts = new_cuts(system.tree)
        add_engine(each, angle, random_motion(1), cuts)
        loads.append(added(cuts))
    for ours, theirs in zip(*loads, strict=True):
        assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)
    assert loads[0].force.any()
    imposed = (
        build_engine(vehicle, rows, 450.0, True, RunUp(0.0, 75.0, 2100.0)),
        build_engine(vehicle, rows, speed, True),
    )
    assert_allclose(*(imposed_displacement(each, angle) for each in imposed), rtol=1e-9)


@pytest.mark.property
def test_engine_without_run_up_stays_within_a_cycle(vehicle, rows):
    """The angle of a constant speed is kept within two revolutions, and its forces do not grow."""
    record, angle = build_engine(vehicle, rows, 1650.0, False), 0.0
    for _ in range(1000):
        angle = turn_crank(record, angle, 1e-4)
        assert 0.0 <= angle < 4.0 * np.pi and speed_growth(record, angle) == 1.0
    assert angle == pytest.approx(0.1 * 1650.0 * np.pi / 30.0 % (4.0 * np.pi))


@pytest.mark.literature
@pytest.mark.parametrize("speed", [900.0, 1650.0])
def test_imposed_displacement_is_the_papers(vehicle, rows, speed):
    """The alternative is 2e-4 sin(2 angle) m with its own rate, and replaces the forces."""
    record = build_engine(vehicle, rows, speed, True)
    assert not record.force.any() and not record.moment.any()
    crank = speed * 2.0 * np.pi / 60.0
    for time in np.linspace(0.0, 0.1, 7):
        displacement, rate = imposed_displacement(record, crank * time)
        assert displacement == pytest.approx(2e-4 * np.sin(2.0 * crank * time), abs=1e-17)
        assert rate == pytest.approx(2e-4 * 2.0 * crank * np.cos(2.0 * crank * time), rel=1e-9, abs=1e-15)


@pytest.mark.property
def test_forces_leave_no_imposed_displacement(vehicle, rows):
    """Where forces excite, nothing is imposed."""
    assert imposed_displacement(build_engine(vehicle, rows, 1650.0, False), 0.3) == (0.0, 0.0)
