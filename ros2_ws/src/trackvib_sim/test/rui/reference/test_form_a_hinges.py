"""The overall transfer equation, Forms A and X: laws of motion with hinges of every kind."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.form_a import form_a, hinge_torques, overall_transfer
from trackvib_sim.rui.reference.form_x import form_x
from trackvib_sim.rui.reference.placement import parent_rows, place_bodies
from trackvib_sim.rui.state import Loads, TreeState, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

GRAVITY = np.array([0.0, 0.0, -9.81])
ROUNDING = 1e-9  # relative to the largest; products along the paths leave some 1e-12
EVERY_KIND = ("revolute", "prismatic", "locked", "elastic", "prescribed")


@pytest.mark.analytic
def test_single_body(form):
    """A body alone, which is root and tip: Newton's and Euler's equations about its mass centre."""
    J, centre, rate = np.diag([1.0, 2.0, 2.5]), np.array([0.1, 0.2, -0.3]), np.array([1.0, -2.0, 0.5])
    bodies = [Body(1, "one", 4.0, centre, J)]
    state, loads = rest_state(bodies)._replace(angular_velocity=rate[None]), no_loads(bodies)
    loads.force[0], loads.moment[0] = (3.0, 4.0, 5.0), (0.3, -0.2, 0.1)
    result = form(bodies, state, loads)
    al = np.linalg.solve(J, loads.moment[0] - np.cross(centre, loads.force[0]) - np.cross(rate, J @ rate))
    a = loads.force[0] / 4.0 + GRAVITY - np.cross(al, centre) - np.cross(rate, np.cross(rate, centre))
    assert_allclose(result.angular[0], al, rtol=1e-13)
    assert_allclose(result.linear[0], a, rtol=1e-13)


def _momentum_rates(bodies, state, result):
    """Rates of the linear and angular momentum about the global origin, from the accelerations."""
    at = place_bodies(bodies, state)
    linear, angular = np.zeros(3), np.zeros(3)
    for row, body in enumerate(bodies):
        A, rate, al = at.rotation[row], at.angular_velocity[row], result.angular[row]
        arm, J = A @ np.asarray(body.centre, dtype=float), A @ body.inertia @ A.T
        push = body.mass * (result.linear[row] + np.cross(al, arm) + np.cross(rate, np.cross(rate, arm)))
        linear += push
        angular += np.cross(at.origin[row] + arm, push) + J @ al + np.cross(rate, J @ rate)
    return linear, angular


@pytest.mark.property
def test_momentum_of_tables_with_hinges_of_every_kind(random_table, form):
    """No hinge of whatever kind, elastic ones included, changes the momentum: only external loads and weight do."""
    for seed in range(20):
        bodies, state, loads = random_table(1000 + seed, 2 + seed, EVERY_KIND)
        at = place_bodies(bodies, state)
        centre = np.array([o + A @ b.centre for o, A, b in zip(at.origin, at.rotation, bodies, strict=True)])
        weight = np.array([[body.mass] for body in bodies]) * GRAVITY
        applied = np.sum(loads.force + weight, axis=0)
        turning = np.sum(np.cross(at.origin, loads.force) + loads.moment + np.cross(centre, weight), axis=0)
        linear, angular = _momentum_rates(bodies, state, form(bodies, state, loads))
        size = sum(np.abs(loads.force).max(axis=1)) + np.abs(weight).sum()
        assert_allclose(linear, applied, rtol=0, atol=1e-10 * size)
        assert_allclose(angular, turning, rtol=0, atol=1e-10 * size * np.max(np.abs(at.origin)))


@pytest.mark.slow(reason="a hundred trees")
@pytest.mark.property
def test_forms_agree_on_hinges_of_every_kind(random_table):
    """Both forms give the same on tables with locked, prescribed and elastic hinges."""
    for seed in range(40):
        case = random_table(2000 + seed, 2 + seed, EVERY_KIND)
        for value, reference in zip(form_x(*case), form_a(*case), strict=True):
            assert np.max(np.abs(value - reference)) <= ROUNDING * max(np.max(np.abs(reference)), 1.0), seed


@pytest.mark.property
def test_prescribed_hinge_recovers_the_torque(random_table, relative, form):
    """Prescribing the accelerations that given torques cause gives back the torques and every other acceleration."""
    for seed in range(20):
        bodies, state, loads = random_table(3000 + seed, 3 + seed)
        free = form(bodies, state, loads)
        driven = [
            body if body.hinge is None or row % 2 else _with_hinge(body, prescribed=True)
            for row, body in enumerate(bodies)
        ]
        given = loads._replace(acceleration=free.hinge, torque=np.where(np.arange(len(bodies)) % 2, loads.torque, 0.0))
        result = form(driven, state, given)
        torque = hinge_torques(overall_transfer(driven, state, given), result)
        assert relative(torque[1:], loads.torque[1:]) < ROUNDING
        for value, reference in zip(result, free, strict=True):
            assert relative(value, reference) < ROUNDING


def _with_hinge(body, **changes):
    return Body(body.number, body.name, body.mass, body.centre, body.inertia, Hinge(**{**vars(body.hinge), **changes}))


@pytest.mark.property
def test_locked_hinge_makes_one_body(random_table, relative, form):
    """Locking a hinge gives the accelerations of a table in which both bodies are one."""
    for seed in range(10):
        bodies, state, loads = random_table(4000 + seed, 12)
        row = 1 + seed
        p = parent_rows(bodies)[row]
        locked = [*bodies]
        locked[row] = _with_hinge(bodies[row], kind="locked")
        result = form(locked, state, loads)
        place = np.asarray(bodies[row].hinge.place)
        merged, keep = [*bodies], [k for k in range(12) if k != row]
        merged[p] = _joined(bodies[p], bodies[row], place)
        for k in keep:
            if bodies[k].hinge is not None and bodies[k].hinge.parent == bodies[row].name:
                merged[k] = _with_hinge(bodies[k], parent=bodies[p].name, place=place + bodies[k].hinge.place)
        lever = place_bodies(locked, state).rotation[p] @ place
        moved = Loads(*(np.array(item) for item in loads))
        moved.force[p] += loads.force[row]
        moved.moment[p] += loads.moment[row] + np.cross(lever, loads.force[row])
        small_state = state._replace(hinge=state.hinge[keep], hinge_rate=state.hinge_rate[keep])
        small = form([merged[k] for k in keep], small_state, Loads(*(item[keep] for item in moved)))
        assert relative(result.linear[keep], small.linear) < ROUNDING
        assert relative(result.angular[keep], small.angular) < ROUNDING
        assert relative(result.hinge[keep], small.hinge) < ROUNDING
        assert result.hinge[row] == 0.0


def _joined(a, b, place):
    """Body a with body b fixed to it, b's origin at `place`, axes parallel."""
    mass, c_b = a.mass + b.mass, place + b.centre
    centre = (a.mass * np.asarray(a.centre) + b.mass * c_b) / mass
    inertia = np.zeros((3, 3))
    for body, c in ((a, np.asarray(a.centre)), (b, c_b)):
        d = c - centre
        inertia += body.inertia + body.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return Body(a.number, a.name, mass, centre, inertia, a.hinge)


@pytest.mark.analytic
def test_bushing_between_two_bodies(form):
    """Two free bodies with parallel axes, turned by a small angle about z and moved: Newton and Euler by hand."""
    k, c = (1e3, 2e3, 3e3, 40.0, 50.0, 60.0), (10.0, 20.0, 30.0, 1.0, 2.0, 3.0)
    J = np.diag([1.0, 2.0, 2.5])
    bodies = [
        Body(1, "frame", 20.0, (0, 0, 0), J),
        Body(2, "engine", 5.0, (0, 0, 0), 0.1 * J, Hinge(3, "elastic", "frame", (1, 0, 0), stiffness=k, damping=c)),
    ]
    half_turn = 0.5 * 0.3
    state = TreeState(
        np.array([[0, 0, 0], [1.01, -0.02, 0.03]]),
        np.array([[1, 0, 0, 0], [np.cos(half_turn), 0, 0, np.sin(half_turn)]]),
        np.array([[0, 0, 0], [0.1, 0.2, 0.3]]),
        np.array([[0, 0, 0.5], [0, 0, 0.7]]),
        np.zeros(2),
        np.zeros(2),
    )
    result = form(bodies, state, no_loads(bodies))
    # the parent's own point at (1.01, -0.02) moves with 0.5 rad/s about z
    velocity = np.array([0.1 - 0.5 * 0.02, 0.2 - 0.5 * 1.01, 0.3])
    q = np.array(k[:3]) * (0.01, -0.02, 0.03) + np.array(c[:3]) * velocity
    m = np.array([0.0, 0.0, 60.0 * 0.3 + 3.0 * 0.2])
    assert_allclose(result.linear[1], GRAVITY - q / 5.0, rtol=1e-12)
    assert_allclose(result.linear[0], GRAVITY + q / 20.0, rtol=1e-12)
    turn = Rotation.from_rotvec((0, 0, 0.3)).as_matrix()
    assert_allclose(result.angular[1], np.linalg.solve(turn @ (0.1 * J) @ turn.T, -m), rtol=1e-12)
    assert_allclose(result.angular[0], np.linalg.solve(J, m + np.cross((1.01, -0.02, 0.03), q)), rtol=1e-12)
    assert_allclose(result.wrench[1], [*q, *(m + np.cross((0.01, -0.02, 0.03), q))], rtol=1e-12)
