"""Road wheels on the ground: enveloping rubber, tangential brushes and the friction limit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import quad
from trackvib_sim.road.store import Road
from trackvib_sim.rui.cells import columns
from trackvib_sim.rui.cuts import new_cuts
from trackvib_sim.rui.kinematics import ORIGIN
from trackvib_sim.rui.tree import rest_lanes
from trackvib_sim.vehicle.running_gear.wheels_on_road import (
    WheelsState,
    add_wheels_on_road,
    radial_force,
    road_height,
)

AHEAD = (1.0, 0.0, 0.0)
STILL = (0.0, 0.0, 0.0)


def pushed(wheels, road, depth, velocity=STILL):
    """Force on a hub [N] pressed in by a depth, and the mean depth."""
    return radial_force(wheels, road, 0, (0.0, 0.0, wheels.radius - depth), velocity, AHEAD)


def discretisation(wheels, depth):
    """Relative error bound of the sum over springs against the integral over the footprint.

    The trapezium rule with step s of a function that ends with slopes +-f' misses the integral by at most s^2 f' / 6
    (Euler and Maclaurin, whatever the phase of the grid); a parabola 2 a wide and d high has f' = 2 d / a and the
    integral 4 a d / 3, hence (s / a)^2 / 4.
    """
    half = np.sqrt(2.0 * wheels.radius * depth)
    return 0.25 * ((wheels.place[1] - wheels.place[0]) / half) ** 2


@pytest.mark.analytic
@given(depth=st.floats(0.002, 0.06))
def test_radial_force_is_the_integral_over_the_footprint(system, level_road, depth):
    """On level ground the springs' sum is the integral of a continuous ring, but for the step of its sum."""
    wheels = system.wheels
    clearance, step = wheels.radius - depth, wheels.place[1] - wheels.place[0]
    half = np.sqrt(wheels.radius**2 - clearance**2)

    def push(u):
        reach = np.hypot(u, clearance)
        return wheels.stiffness / step * (wheels.radius - reach) * clearance / reach

    force, _ = pushed(wheels, level_road, depth)
    expected = quad(push, -half, half)[0]
    # the pressed-in shape is a parabola to within depth / radius
    bound = discretisation(wheels, depth) * (1.0 + depth / wheels.radius)
    assert force[2] == pytest.approx(expected, rel=bound)
    assert force[0] == pytest.approx(0.0, abs=1e-9 * force[2])
    assert force[1] == 0.0


@pytest.mark.analytic
def test_force_at_static_depth_is_the_design_load(system, table, level_road):
    """At static depth a wheel carries a twelfth of the weight.

    The rubber is designed as a parabola that presses straight up; round wheels and slanting springs cost up to the
    order of depth / radius, and the sum over springs its own bound.
    """
    wheels, weight = system.wheels, sum(body.mass for body in table) * 9.81
    force, _ = pushed(wheels, level_road, wheels.static_depth)
    bound = wheels.static_depth / wheels.radius + discretisation(wheels, wheels.static_depth)
    assert bound < 0.065
    assert force[2] == pytest.approx(weight / 12.0, rel=bound)


@pytest.mark.analytic
def test_rate_at_static_depth_is_the_radial_stiffness(vehicle, system, level_road):
    """The force grows with depth at the radial stiffness of the file.

    The rate is the number of springs that touch; over a change of depth that moves each end of the footprint by a
    whole step it is the mean number, which misses the nominal one only by the slant of the springs (depth / radius).
    """
    wheels = system.wheels
    step, half = wheels.place[1] - wheels.place[0], np.sqrt(2.0 * wheels.radius * wheels.static_depth)
    shallow, deep = (((half + t) ** 2) / (2.0 * wheels.radius) for t in (-0.5 * step, 0.5 * step))
    rise = pushed(wheels, level_road, deep)[0][2] - pushed(wheels, level_road, shallow)[0][2]
    # the mean is over equal parts of depth, not of width: at most a quarter of (step / footprint) beside
    bound = wheels.static_depth / wheels.radius + 0.25 * step / half
    assert rise / (deep - shallow) == pytest.approx(vehicle.tyres.radial_stiffness, rel=bound)


@pytest.mark.property
@given(shift=st.floats(-50.0, 50.0), first=st.integers(-900, -300), extra=st.integers(0, 400), side=st.integers(0, 1))
def test_road_height_does_not_depend_on_the_stretch(shift, first, extra, side):
    """A place has the same height, to the last bit, in whatever stretch of road it is looked up."""
    x = 0.2 * shift
    random = np.random.default_rng(8)
    whole = random.normal(size=(2, 3000))  # samples -1000 ... 1999
    stretches = [Road(f, 0.05, whole[:, f + 1000 : 2000 - e]) for f, e in ((-1000, 0), (first, extra))]
    a, b = (road_height(road, side, x) for road in stretches)
    assert a == b
    assert a == pytest.approx(np.interp(x, 0.05 * np.arange(-1000, 2000), whole[side]), abs=1e-11)


def _standing(system, moved, height=None):
    """Motion of the vehicle at zero coordinates with its hubs at one height (default: at static depth)."""
    state = rest_lanes(system.tree)
    state.position[0, 2] = -system.wheels.static_depth if height is None else height - system.wheels.radius
    return state, moved(system.tree, state)


def _brushes(longitudinal=0.0, lateral=0.0):
    return WheelsState(np.full(12, longitudinal), np.full(12, lateral))


@pytest.mark.property
@given(gap=st.floats(1e-6, 1.0), velocity=st.tuples(*[st.floats(-20.0, 20.0)] * 3))
def test_no_force_off_the_ground(system, moved, level_road, gap, velocity):
    """A wheel above the ground feels nothing, however it moves, and its brushes are straight again."""
    state, _ = _standing(system, moved, system.wheels.radius + gap)
    state.velocity[0] = velocity
    cuts, brushes = new_cuts(system.tree), _brushes(0.01, -0.01)
    add_wheels_on_road(system.wheels, brushes, level_road, moved(system.tree, state), cuts, 1e-4)
    assert not cuts.cells.any()
    assert not brushes.longitudinal.any() and not brushes.lateral.any()


@pytest.mark.property
@given(depth=st.floats(1e-5, 0.1), velocity=st.tuples(*[st.floats(-20.0, 20.0)] * 3))
def test_ground_pushes_and_never_pulls(system, level_road, depth, velocity):
    """The ground's radial force is never downwards, and its damper never gives power to the hub."""
    still, _ = pushed(system.wheels, level_road, depth)
    force, mean = pushed(system.wheels, level_road, depth, velocity)
    assert force[2] >= 0.0
    assert 0.0 <= mean <= depth * (1.0 + 1e-9)
    # forces up to 1e6 N, speeds up to 20 m/s
    assert np.dot(np.subtract(force, still), velocity) <= 1e-6


@pytest.mark.property
@settings(max_examples=50)
@given(
    depth=st.floats(1e-4, 0.08),
    velocity=st.tuples(*[st.floats(-15.0, 15.0)] * 3),
    spin=st.floats(-60.0, 60.0),
    brushes=st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)),
    dt=st.sampled_from([1e-5, 1e-4, 1e-3]),
)
def test_friction_limit_is_never_exceeded(system, moved, added, level_road, depth, velocity, spin, brushes, dt):
    """Whatever the slip, the tangential force is at most friction times the radial one."""
    wheels = system.wheels
    state, _ = _standing(system, moved, wheels.radius - depth)
    state.velocity[0] = velocity
    state.hinge_rate[wheels.row] = spin
    motion, cuts = moved(system.tree, state), new_cuts(system.tree)
    add_wheels_on_road(wheels, _brushes(*brushes), level_road, motion, cuts, dt)
    force, origin = added(cuts).force, columns(motion, ORIGIN, 3)
    for row in wheels.row:
        radial, _ = radial_force(wheels, level_road, 0, tuple(origin[row]), velocity, AHEAD)
        tangential = np.linalg.norm(force[row] - radial)
        assert tangential <= wheels.friction * np.linalg.norm(radial) * (1.0 + 1e-9) + 1e-9


@pytest.mark.analytic
@pytest.mark.parametrize("speed", [1.0, 10.0, 20.0])
def test_free_rolling_needs_no_tangential_force(system, moved, added, level_road, speed):
    """A wheel without radial damping that rolls on its contact radius feels only the vertical force."""
    wheels = system.wheels._replace(damping=0.0)
    state, _ = _standing(system, moved)
    _, mean = pushed(wheels, level_road, wheels.static_depth)
    state.velocity[0, 0] = speed
    state.hinge_rate[wheels.row] = speed / (wheels.radius - mean)
    cuts, brushes, motion = new_cuts(system.tree), _brushes(), moved(system.tree, state)
    for _ in range(100):
        cuts.cells[:] = 0.0
        add_wheels_on_road(wheels, brushes, level_road, motion, cuts, 1e-4)
    loads = added(cuts)
    vertical = loads.force[wheels.row, 2]
    assert vertical.min() > 0.0
    # slip is the rounding of the speeds, some 1e-15 m/s, times 1e6 N/m and 1e4 N s/m
    assert_allclose(loads.force[wheels.row, :2], 0.0, atol=1e-8)
    assert_allclose(loads.moment[wheels.row], 0.0, atol=1e-8)


@pytest.mark.analytic
@pytest.mark.parametrize("direction", ["longitudinal", "lateral"])
def test_brush_settles_at_slip_times_relaxation(vehicle, system, moved, added, level_road, direction):
    """Rolling steadily with a small slip ratio, the force is stiffness * relaxation * ratio, and damping * slip."""
    speed, ratio = 10.0, 1e-3
    wheels = system.wheels._replace(damping=0.0)
    state, _ = _standing(system, moved)
    _, mean = pushed(wheels, level_road, wheels.static_depth)
    state.velocity[0, 0] = speed
    state.hinge_rate[wheels.row] = speed / (wheels.radius - mean)
    if direction == "lateral":
        state.velocity[0, 1] = speed * ratio
    else:
        state.hinge_rate[wheels.row] *= 1.0 - ratio
    t = vehicle.tyres
    stiffness, damping = getattr(t, f"{direction}_stiffness"), getattr(t, f"{direction}_damping")
    cuts, brushes, motion = new_cuts(system.tree), _brushes(), moved(system.tree, state)
    for _ in range(20_000):  # 2 s are 80 relaxation lengths
        cuts.cells[:] = 0.0
        add_wheels_on_road(wheels, brushes, level_road, motion, cuts, 1e-4)
    expected = -stiffness * t.relaxation_length * ratio - damping * ratio * speed
    axis = ("longitudinal", "lateral").index(direction)
    assert_allclose(added(cuts).force[wheels.row, axis], expected, rtol=1e-9)
