"""Gears and shafts: speeds that follow each other exactly, and torque that comes through."""

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle
from trackvib_sim.numerics.units import RPM
from trackvib_sim.vehicle.drive.driveline import build_driveline, crank_speed, full_load, new_shaft, turn_shaft
from trackvib_sim.vehicle.vehicle_file import VehicleFileError, parse_vehicle


@pytest.fixture(scope="module")
def driveline(vehicle):
    """The shipped vehicle's."""
    return build_driveline(vehicle, gears=True)


@pytest.mark.analytic
@pytest.mark.parametrize(
    ("rate", "gear"), [(0.0, 1), (12.0, 1), (13.0, 2), (60.0, 5), (80.0, 6), (95.0, 6), (-13.0, 2)]
)
def test_the_first_gear_is_the_lowest_that_does_not_overspeed(driveline, rate, gear):
    """Crankshaft over sprocket is the ratio, but never below idle."""
    shaft = new_shaft(driveline, rate)
    assert shaft.gear[0] == gear
    assert crank_speed(driveline, shaft) == max(driveline.ratio[gear - 1] * abs(rate), 450.0 * RPM)


@pytest.mark.analytic
def test_full_load_is_the_files_curve(vehicle, driveline):
    """Times ratio and efficiency at its points, and nothing from a tenth beyond its end on."""
    d = vehicle.driveline
    for speed, torque in zip(d.curve_speed, d.curve_torque, strict=True):
        shaft = new_shaft(driveline, 0.0)
        shaft.gear[0], shaft.rate[0] = 3, speed * RPM / d.ratios[2]
        assert full_load(driveline, shaft) == pytest.approx(torque * d.efficiency * d.ratios[2])
    shaft.rate[0] *= 1.1001
    assert full_load(driveline, shaft) == 0.0


@pytest.mark.slow(reason="seconds of the driveline")
@pytest.mark.analytic
def test_a_steady_torque_comes_through_whole(driveline):
    """With the sprockets held the shafts twist by torque over stiffness."""
    shaft = new_shaft(driveline, 0.0)
    for _ in range(300_000):
        passed = turn_shaft(driveline, shaft, 2e4, 0.0, 0.0, 1e-4)
    assert passed == pytest.approx(2e4, rel=1e-3)
    assert shaft.twist[0] == pytest.approx(2e4 / driveline.stiffness, rel=1e-3)


@pytest.mark.slow(reason="seconds of the driveline at each frequency")
@pytest.mark.analytic
@pytest.mark.parametrize("frequency", [2.0, 10.0, 55.0])
def test_ripple_comes_through_as_stiffness_and_inertia_let_it(driveline, frequency):
    """Beside the transmissibility of one mass on spring and damper, the sprockets being held."""
    shaft, dt = new_shaft(driveline, 0.0), 2e-5
    shaft.gear[0] = gear = 4
    fixed = driveline._replace(shift_up=np.inf, shift_down=0.0)
    inertia, omega = fixed.inertia * fixed.ratio[gear - 1] ** 2, 2.0 * np.pi * frequency
    steps = round(20.0 / frequency / dt)
    passed = [turn_shaft(fixed, shaft, 0.0, 1e3 * np.sin(omega * k * dt), 0.0, dt) for k in range(steps + 200_000)]
    last = np.array(passed[-round(5.0 / frequency / dt) :])
    spring = fixed.stiffness + 1j * omega * fixed.damping
    assert np.ptp(last) / 2e3 == pytest.approx(abs(spring / (spring - inertia * omega**2)), rel=0.03)


@pytest.mark.slow(reason="drives through all gears")
@pytest.mark.property
def test_gears_are_shifted_up_and_down(driveline):
    """A vehicle that runs up and down goes through all gears one by one, the engine within its range but for idle."""
    shaft, gears = new_shaft(driveline, 0.0), []
    rates = np.concatenate([np.linspace(0.0, 90.0, 200_000), np.linspace(90.0, 0.0, 200_000)])
    for rate in rates:
        shaft.rate[0], shaft.twist[0] = rate, 0.0
        turn_shaft(driveline, shaft, 0.0, 0.0, rate, 1e-4)
        if not gears or gears[-1] != shaft.gear[0]:
            gears.append(int(shaft.gear[0]))
        assert 450.0 * RPM <= crank_speed(driveline, shaft) <= 2001.0 * RPM or shaft.gear[0] == 6
    assert gears == [1, 2, 3, 4, 5, 6, 5, 4, 3, 2, 1]


@pytest.mark.property
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("ratios: {value: [17.0, 10.0", "ratios: {value: [17.0, 18.0", "each must be below the one before"),
        ("shift_down: {value: 1000.0", "shift_down: {value: 1900.0", "shift_down is 1900 r/min, must be below"),
        ("curve_torque: {value: [2800.0, ", "curve_torque: {value: [", "must have equal numbers, at least 2"),
        (
            "curve_speed: {value: [450.0, 900.0",
            "curve_speed: {value: [950.0, 900.0",
            "above the one before",
        ),
        ("ripple: {value: [120.0, ", "ripple: {value: [", "driveline.ripple has 2 numbers"),
        ("efficiency: {value: 0.9", "efficiency: {value: 1.2", "efficiency"),
    ],
)
def test_a_driveline_that_makes_no_sense_is_refused(old, new, words):
    """With item, value and what is accepted."""
    text = find_vehicle().read_text(encoding="utf-8")
    assert text.count(old) == 1
    with pytest.raises(VehicleFileError, match=words):
        parse_vehicle(text.replace(old, new), "vehicle.yaml")


@pytest.mark.property
def test_gears_that_are_not_there_are_refused(vehicle):
    """The message names the vehicle and the section."""
    without = vehicle.model_copy(update={"driveline": None})
    with pytest.raises(ValueError, match="vehicle 'tao2025' has no section driveline"):
        build_driveline(without, gears=True)
