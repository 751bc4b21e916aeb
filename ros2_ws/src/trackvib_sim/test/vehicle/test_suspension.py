"""Torsion bars, shock absorbers and bump stops of the twelve arms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.rui.sweeps.kinematics import point_place
from trackvib_sim.rui.sweeps.tree import new_rows, rest_lanes
from trackvib_sim.vehicle.body_tree import GRAVITY, SIDES, sprung_bodies, wheel_name
from trackvib_sim.vehicle.suspension import add_suspension, shock_force

ANGLES = st.floats(-0.5, 1.2)
RATES = st.floats(-20.0, 20.0)


def torques(system, angle, rate):
    """The torques of all twelve arms at one angle and rate, left first."""
    state = rest_lanes(system.tree)
    state.hinge[system.suspension.row], state.hinge_rate[system.suspension.row] = angle, rate
    added = new_rows(system.tree)
    add_suspension(system.suspension, state, added)
    result = added[system.suspension.row]
    added[system.suspension.row] = 0.0
    assert not added.any()
    return result


def wheel_height(system, rows, moved, angle):
    """Height of the first left wheel's centre over the level hull's origin."""
    state = rest_lanes(system.tree)
    state.hinge[system.suspension.row[0]] = angle
    return point_place(moved(system.tree, state), rows[wheel_name(0, 0)], (0.0, 0.0, 0.0))[2]


@pytest.mark.analytic
def test_bars_carry_the_hull_at_ride_height(vehicle, system, table):
    """At angle zero and at rest, the arms' torques over their level reach add up to what the hull carries.

    That is the sprung weight, the upper runs of both tracks, and their pull down to the end wheels.
    """
    reach = vehicle.swing_arms.length * np.cos(np.radians(vehicle.swing_arms.static_angle))
    sprung = sum(body.mass for body in table if body.name in sprung_bodies(vehicle))
    tracks = system.supports.upper_weight.sum() - system.supports.pull[..., 1].sum()
    assert tracks > 0.0
    assert -torques(system, 0.0, 0.0).sum() / reach == pytest.approx(sprung * GRAVITY + tracks, rel=1e-12)


@pytest.mark.analytic
def test_bar_has_its_rate_at_the_wheel(vehicle, system, rows, moved):
    """Over a small travel about ride height, torque times angle is wheel_rate times travel squared."""
    small = 1e-4
    travel = wheel_height(system, rows, moved, small) - wheel_height(system, rows, moved, -small)
    change = torques(system, -small, 0.0)[0] - torques(system, small, 0.0)[0]
    # force change times travel = torque change times angle; the reach changes by 1e-4 of itself, evenly to both sides
    assert change * 2.0 * small / travel**2 == pytest.approx(vehicle.swing_arms.wheel_rate[0], rel=1e-6)


@pytest.mark.analytic
@given(speed=st.floats(-5.0, 5.0))
def test_shock_absorber_blows_off(vehicle, system, speed):
    """Force against speed is odd, linear up to the blow-off force and flatter beyond it, without a jump."""
    s = vehicle.shock_absorbers
    knee = s.blow_off_force[0] / s.damping[0]
    size = min(abs(speed), knee) * s.damping[0] + max(abs(speed) - knee, 0.0) * s.blow_off_damping[0]
    assert shock_force(system.suspension, 0, speed) == pytest.approx(np.copysign(size, speed), rel=1e-12, abs=1e-12)


@pytest.mark.property
@given(angle=ANGLES, rate=RATES)
def test_only_the_stations_of_the_file_have_shock_absorbers(vehicle, system, angle, rate):
    """Against an arm without, an arm with a shock absorber has its force times the arm's reach along x more."""
    left = torques(system, angle, rate)[:6]
    carriers = [station for station, damping in enumerate(vehicle.shock_absorbers.damping) if damping > 0.0]
    assert carriers == [0, 1, 5]
    bare = [i for i in range(6) if i not in carriers]
    reach = vehicle.swing_arms.length * np.cos(np.radians(vehicle.swing_arms.static_angle))
    extra = reach * shock_force(system.suspension, 0, reach * rate)
    assert np.ptp(left[bare]) == 0.0
    # torques up to 1e5 N m at the stop
    assert_allclose(left[carriers], left[bare[0]] - extra, rtol=1e-12, atol=1e-9)


@pytest.mark.property
@given(angle=ANGLES, rate=RATES)
def test_left_and_right_are_alike(system, angle, rate):
    """The right side's torques are those of the left, station by station."""
    left, right = torques(system, angle, rate).reshape(len(SIDES), 6)
    assert left.tolist() == right.tolist()


@pytest.mark.property
@given(angle=ANGLES, rate=RATES)
def test_bump_stop_only_pushes(system, angle, rate):
    """A stop is silent short of its angle and pushes the arm down beyond it, never up, however fast it leaves."""
    free = system._replace(suspension=system.suspension._replace(stop_angle=np.full(12, 10.0)))
    extra = torques(system, angle, rate) - torques(free, angle, rate)
    if angle <= system.suspension.stop_angle[0]:
        assert not extra.any()
    assert (extra <= 0.0).all()


@pytest.mark.analytic
def test_bump_stop_pushes_beyond_its_travel(vehicle, system, rows, moved):
    """The stop begins where the wheel has risen by bump_travel, and has its stiffness at the wheel at ride height."""
    stop = system.suspension.stop_angle[0]
    rise = wheel_height(system, rows, moved, stop) - wheel_height(system, rows, moved, 0.0)
    assert rise == pytest.approx(vehicle.swing_arms.bump_travel[0], abs=1e-12)
    free = system._replace(suspension=system.suspension._replace(stop_angle=np.full(12, 10.0)))
    extra = torques(system, stop + 0.01, 0.0) - torques(free, stop + 0.01, 0.0)
    reach = vehicle.swing_arms.length * np.cos(np.radians(vehicle.swing_arms.static_angle))
    assert_allclose(extra, -vehicle.swing_arms.bump_stiffness[0] * reach**2 * 0.01, rtol=1e-9)


@pytest.mark.analytic
def test_damping_is_along_the_same_direction_as_the_rate(vehicle, system, rows, moved):
    """At ride height the power of a shock absorber and of friction is that of their rates at the wheel's rise."""
    small, rate = 1e-6, 0.1
    climb = wheel_height(system, rows, moved, small) - wheel_height(system, rows, moved, -small)
    speed = climb / (2.0 * small) * rate
    power = (torques(system, 0.0, 0.0) - torques(system, 0.0, rate))[0] * rate
    damping = vehicle.swing_arms.friction[0] + vehicle.shock_absorbers.damping[0]
    assert power == pytest.approx(damping * speed**2, rel=1e-6)


@pytest.mark.property
@given(angle=ANGLES, rate=st.floats(1e-6, 20.0))
def test_damping_takes_power_both_ways(system, angle, rate):
    """Moving either way, the torque opposes the motion more than at rest, short of the stop."""
    angle = min(angle, system.suspension.stop_angle[0])
    still = torques(system, angle, 0.0)
    assert (torques(system, angle, rate) < still).all()
    assert (torques(system, angle, -rate) > still).all()
