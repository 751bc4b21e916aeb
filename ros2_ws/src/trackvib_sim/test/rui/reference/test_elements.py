"""The element matrices one by one: against Newton and Euler, and against motion differentiated numerically."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.elements import (
    elastic_hinge,
    further_input,
    geometric_rows,
    locked_hinge,
    prescribed_hinge,
    prismatic_hinge,
    revolute_hinge,
    rigid_body,
)
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.state import TreeState
from trackvib_sim.rui.table import Body, Hinge

H = 1e-3  # s, step of central differences; their error h^2 times a third derivative of order 10 is the bound below
DIFFERENCED = 1e-4


@pytest.fixture
def random():
    """Random numbers."""
    return np.random.default_rng(7)


@pytest.mark.analytic
def test_rigid_body_obeys_newton_and_euler(random):
    """A body pushed at two points: force and moment left at the output are those that its motion does not take up."""
    mass, r_io, r_ic, rate = 3.0, *random.normal(size=(3, 3))
    half = random.normal(size=(3, 3))
    inertia = half @ half.T
    a_i, al, m_i, q_i, force, moment = random.normal(size=(6, 3))
    z_o = rigid_body(mass, inertia, rate, r_io, r_ic, force, moment) @ [*a_i, *al, *m_i, *q_i, 1.0]

    def acceleration(r):
        return a_i + np.cross(al, r) + np.cross(rate, np.cross(rate, r))

    q_o = q_i + force - mass * acceleration(r_ic)
    m_o = m_i + moment + np.cross(-r_ic, q_i) - np.cross(r_io - r_ic, q_o)
    m_o -= inertia @ al + np.cross(rate, inertia @ rate)
    assert_allclose(z_o, [*acceleration(r_io), *al, *m_o, *q_o, 1.0], rtol=0, atol=1e-13)


@pytest.mark.analytic
def test_second_input_adds_its_force_and_nothing_else(random):
    """A body's second input, moved there as an external load, gives the same output; its one is not handed on."""
    r_1o, r_1c, r_12, rate, m_2, q_2 = random.normal(size=(6, 3))
    z_1, z_2 = np.append(random.normal(size=12), 1.0), np.array([*np.zeros(6), *m_2, *q_2, 1.0])
    body = 2.0, np.diag((1.0, 2.0, 2.5)), rate, r_1o, r_1c
    both = rigid_body(*body, np.zeros(3), np.zeros(3)) @ z_1 + further_input(r_1o - r_12) @ z_2
    loaded = rigid_body(*body, q_2, m_2 + np.cross(r_12 - r_1c, q_2)) @ z_1
    assert_allclose(both, loaded, rtol=0, atol=1e-13)


@pytest.mark.analytic
def test_geometric_rows_are_those_of_a_body_to_the_point(random):
    """The acceleration that H gives a further input is that of an output at the same point."""
    rate, r_12 = random.normal(size=(2, 3))
    U = rigid_body(1.0, np.eye(3), rate, r_12, np.zeros(3), np.zeros(3), np.zeros(3))
    assert_allclose(geometric_rows(rate, r_12), U[:6], rtol=0, atol=1e-15)


@pytest.fixture
def passed(random):
    """A function that moves a child on a parent along th + thd t + thdd t^2 / 2 by placing both at three times.

    It returns the matrices' arguments (axis, child's rate, th, thd), the differenced [a; al] of input and output, thdd.
    """

    def move(kind):
        axis, place, velocity, rate = random.normal(size=(4, 3))
        th, thd, thdd = 0.4, -1.3, 2.1
        table = [
            Body(1, "p", 1.0, (0, 0, 0), np.eye(3)),
            Body(2, "c", 1.0, (0, 0, 0), np.eye(3), Hinge(3, kind, "p", place, axis)),
        ]

        def at(t):
            attitude = Rotation.from_rotvec(rate * t).as_quat(scalar_first=True)
            hinge, speed = np.array([[0.0, th + thd * t + thdd * t**2 / 2], [0.0, thd + thdd * t]])
            return place_bodies(
                table, TreeState(velocity[None] * t, attitude[None], velocity[None], rate[None], hinge, speed)
            )

        before, now, after = at(-H), at(0.0), at(H)
        assert_allclose(now.velocity, (after.origin - before.origin) / (2 * H), rtol=0, atol=DIFFERENCED)
        child = (
            (after.velocity[1] - before.velocity[1]) / (2 * H),
            (after.angular_velocity[1] - before.angular_velocity[1]) / (2 * H),
        )
        point = (after.hinge_point[1] - 2 * now.hinge_point[1] + before.hinge_point[1]) / H**2
        return (now.axis[1], now.angular_velocity[1], th, thd), np.hstack(child), np.hstack((point, np.zeros(3))), thdd

    return move


@pytest.mark.analytic
def test_revolute_passes_the_acceleration_of_a_turning_child(passed):
    """U_H and b give the parent's acceleration from that of a child that turns on it."""
    (axis, rate, _, thd), child, parent, thdd = passed("revolute")
    hinge = revolute_hinge(axis, rate, thd, 0.0)
    assert_allclose((hinge.U @ [*child, *np.zeros(6), 1.0] + hinge.b * thdd)[:6], parent, rtol=0, atol=DIFFERENCED)


@pytest.mark.analytic
def test_slide_passes_the_acceleration_of_a_sliding_child(passed):
    """U_H and b give the acceleration of the parent's hinge point from that of the child's, Coriolis term included."""
    (axis, rate, s, sd), child, parent, sdd = passed("prismatic")
    hinge = prismatic_hinge(axis, rate, s, sd, 0.0)
    assert_allclose((hinge.U @ [*child, *np.zeros(6), 1.0] + hinge.b * sdd)[:6], parent, rtol=0, atol=DIFFERENCED)


@pytest.mark.analytic
def test_hinges_pass_the_wrench(random):
    """Hinges have no mass: the force passes, the moment is that about the parent's point, E knows the axis part."""
    axis, rate, m, q = *random.normal(size=(3, 3)), np.array([1.0, 2.0, 3.0])
    axis /= np.linalg.norm(axis)
    z = np.array([*np.zeros(6), *m, *q, 1.0])
    revolute, prismatic = revolute_hinge(axis, rate, 0.3, -axis @ m), prismatic_hinge(axis, rate, 0.2, 0.3, -axis @ q)
    assert_allclose((revolute.U @ z)[6:12], [*m, *q])
    # from the child's point, 0.2 m along the axis, to the parent's
    assert_allclose((prismatic.U @ z)[6:12], [*(m + np.cross(0.2 * axis, q)), *q])
    assert_allclose([revolute.E @ z, prismatic.E @ z], 0.0, atol=1e-15)


@pytest.mark.analytic
def test_locked_and_prescribed_hinges(random):
    """A locked hinge passes everything, a prescribed one is the free one with its acceleration put in."""
    z = np.append(random.normal(size=12), 1.0)
    assert_allclose(locked_hinge().U @ z, z)
    free = prismatic_hinge((0.0, 0.6, 0.8), random.normal(size=3), 0.2, 0.3, 5.0)
    given = prescribed_hinge(free, 1.7)
    assert_allclose(given.U @ z, free.U @ z + 1.7 * free.b, rtol=0, atol=1e-15)
    assert given.b is None and given.E is None


@pytest.mark.analytic
def test_elastic_hinge_does_the_work_its_potential_loses(random):
    """Undamped, the power of the pair of wrenches is minus the rate of the potential (equal rotational stiffnesses)."""
    k = np.array([1.0, 2.0, 3.0, 4.0, 4.0, 4.0])
    place, shift, v_p, v_c, om_p, om_c = random.normal(size=(6, 3))
    turn_p, turn_c = Rotation.from_rotvec(random.normal(size=3)), Rotation.from_rotvec(random.normal(size=3))

    def at(t):
        """Rotations, displacement, arm from the parent's origin; the parent's origin is at v_p t."""
        axes_p = (Rotation.from_rotvec(om_p * t) * turn_p).as_matrix()
        axes_c = (Rotation.from_rotvec(om_c * t) * turn_c).as_matrix()
        origin = turn_p.as_matrix() @ (place + shift) + v_c * t
        return axes_p, axes_c, origin - v_p * t - axes_p @ place, origin - v_p * t

    def potential(t):
        axes_p, axes_c, displacement, _ = at(t)
        turned = Rotation.from_matrix(axes_p.T @ axes_c).as_rotvec()
        return 0.5 * np.sum(k * np.append(axes_p.T @ displacement, turned) ** 2)

    axes_p, axes_c, displacement, arm = at(0.0)
    q, m = elastic_hinge(k, np.zeros(6), axes_p, axes_c, displacement, np.zeros(3), np.zeros(3))
    power = q @ (v_p - v_c) + m @ (om_p - om_c) + np.cross(arm, q) @ om_p
    assert_allclose(power, -(potential(H) - potential(-H)) / (2 * H), rtol=DIFFERENCED)


@pytest.mark.analytic
def test_elastic_hinge_damps_in_the_parents_axes(random):
    """Each damping coefficient answers its own component of the relative velocity, seen by the parent."""
    axes = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
    speed, c = random.normal(size=6), np.arange(1.0, 7.0)
    q, m = elastic_hinge(np.zeros(6), c, axes, axes, np.zeros(3), axes @ speed[:3], axes @ speed[3:])
    assert_allclose(np.append(axes.T @ q, axes.T @ m), c * speed, rtol=1e-13)
