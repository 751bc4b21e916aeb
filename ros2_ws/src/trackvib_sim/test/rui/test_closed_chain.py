"""Closed chains by cut pins: against dense algebra with all closure equations and closed forms."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.closed_chain import closed_accelerations, closure_error
from trackvib_sim.rui.cut_pin import CutPin
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.solve import accelerations

from .closed_chains import GRAVITY, ROUNDING, DenseChain, ladders, parallelogram, polygon

DENSE = 1e-8  # rounding for long chains by a dense mass matrix, which is ill-conditioned and leaves some 1e-9


def _differ(found, reference):
    """Largest difference of accelerations, each kind relative to its largest."""
    return max(
        np.max(np.abs(np.subtract(f, r))) / np.max(np.abs(r)) for f, r in zip(found[:3], reference[:3], strict=True)
    )


@pytest.mark.cross_engine
@pytest.mark.parametrize("links", [4, 12, 40, 86, 120])
@pytest.mark.parametrize("seed", range(3))
def test_closed_polygons(links, seed):
    """A free closed chain accelerates as dense algebra with all five closure equations says."""
    bodies, cut, state, loads = polygon(10 * links + seed, links)
    miss = closure_error(bodies, [cut], state)
    assert np.abs(miss.position).max() < 1e-13 * links
    assert np.abs(miss.velocity).max() < 1e-13 * links
    found, _ = closed_accelerations(bodies, [cut], state, loads, GRAVITY)
    dense = DenseChain(bodies, [cut], state)
    reference, hinges = dense.accelerations(loads), dense.hinges_by_inverse(loads, place_bodies(bodies, state).axis[1])
    assert _differ(found, reference) < (ROUNDING if links < 80 else DENSE)
    assert_allclose(found.hinge, hinges, rtol=0, atol=0.2 * ROUNDING * np.abs(hinges).max())
    # the pin is what does it
    assert _differ(accelerations(bodies, state, loads, GRAVITY), reference) > 1e-3


@pytest.mark.cross_engine
@pytest.mark.parametrize("loops", [1, 2, 3, 24])
def test_several_loops_on_one_body(loops):
    """Loops with a prismatic hinge and with axes of their own, by as many pins, and those side by side."""
    bodies, pins, state, loads = ladders(loops, loops)
    found, force = closed_accelerations(bodies, pins, state, loads, GRAVITY)
    assert force.shape == (loops, 3)
    assert _differ(found, DenseChain(bodies, pins, state).accelerations(loads)) < ROUNDING


@pytest.mark.analytic
@pytest.mark.parametrize("links", [4, 40, 120])
def test_newton_and_euler_of_a_link(links):
    """Wrenches in the hinges and the force in the pin are what accelerates each link about its mass centre."""
    bodies, cut, state, loads = polygon(links, links)
    found, force = closed_accelerations(bodies, [cut], state, loads, GRAVITY)
    at, size = place_bodies(bodies, state), np.abs(found.wrench).max()
    end = at.rotation[0] @ cut.point_b + at.origin[0]
    assert np.abs(np.cross(force[0], at.axis[1]) @ at.axis[1]) < ROUNDING * size
    assert np.abs(force[0] @ at.axis[1]) < ROUNDING * size
    for row, body in enumerate(bodies):
        A, om, al = at.rotation[row], at.angular_velocity[row], found.angular[row]
        c, J = A @ body.centre, A @ body.inertia @ A.T
        push, turn = loads.force[row] + body.mass * GRAVITY, loads.moment[row] - np.cross(c, loads.force[row])
        # own hinge at the origin, the next link's, the pin
        wrenches = [(-found.wrench[row], at.origin[row]), (np.append(np.sum(force, axis=0), (0, 0, 0)), end)]
        if row + 1 < links:
            wrenches.append((found.wrench[row + 1], at.origin[row + 1]))
        for wrench, place in wrenches if row in (0, links - 1) else wrenches[::2]:
            sign = -1.0 if row == 0 and place is end else 1.0
            push = push + sign * wrench[:3]
            turn = turn + sign * wrench[3:] + np.cross(place - at.origin[row] - c, sign * wrench[:3])
        a = found.linear[row] + np.cross(al, c) + np.cross(om, np.cross(om, c))
        assert_allclose(push, body.mass * a, rtol=0, atol=ROUNDING * size)
        assert_allclose(turn, J @ al + np.cross(om, J @ om), rtol=0, atol=ROUNDING * size)


@pytest.mark.property
def test_either_body_may_be_the_first():
    """The accelerations do not depend on which end is called a; the force is opposite."""
    bodies, cut, state, loads = polygon(7, 12)
    other = CutPin(cut.body_b, cut.point_b, cut.body_a, cut.point_a, -3.0 * np.array(cut.axis))
    found, force = closed_accelerations(bodies, [cut], state, loads)
    turned, opposite = closed_accelerations(bodies, [other], state, loads)
    assert _differ(turned, found) < ROUNDING
    assert_allclose(opposite, -force, rtol=0, atol=ROUNDING * np.abs(force).max())


@pytest.mark.property
def test_without_pins_it_is_the_tree():
    """No pin, no force."""
    bodies, _, state, loads = polygon(8, 5)
    found, force = closed_accelerations(bodies, [], state, loads)
    assert force.shape == (0, 3)
    for value, reference in zip(found, accelerations(bodies, state, loads), strict=True):
        assert np.array_equal(value, reference)


@pytest.mark.analytic
@pytest.mark.parametrize("angle", [0.3, 1.2, -2.0])
def test_four_bar_linkage(angle):
    """A parallelogram swings like a pendulum: J thdd = -g S sin(th), J = sum J_crank + m_rod l^2."""
    bodies, cut, state, loads = parallelogram(angle, 1.7)
    found, force = closed_accelerations(bodies, [cut], state, loads)
    inertia = 0.2 + 2.0 * 0.3**2 + 0.1 + 1.0 * 0.5**2 + 3.0 * 0.8**2
    moment = 9.81 * (2.0 * 0.3 + 1.0 * 0.5 + 3.0 * 0.8) * np.sin(angle)
    expected = -moment / inertia
    assert_allclose(found.hinge[1:], (expected, -expected, expected), rtol=1e-10)
    assert_allclose(found.angular[2], 0.0, atol=1e-10)
    # the right crank alone: gravity and the rod's force at its end turn it
    end = Rotation.from_rotvec((0.0, angle, 0.0)).apply((0.0, 0.0, -0.8))
    torque = np.cross(end, -force[0])[1] - 9.81 * 0.5 * np.sin(angle)
    assert torque == pytest.approx((0.1 + 0.25) * expected, rel=1e-9)
