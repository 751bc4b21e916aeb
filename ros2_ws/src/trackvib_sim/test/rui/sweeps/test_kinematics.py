"""Places, velocities and attitudes of whole trees, against finite differences and scipy's rotations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.numerics.spatial import turn_quaternion
from trackvib_sim.rui.reference.placement import parent_rows, place_bodies
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.kinematics import MotionOffset, body_axes, point_place, point_velocity
from trackvib_sim.rui.sweeps.response import ResponseOffset, new_response
from trackvib_sim.rui.sweeps.tree import LANES, BodyOffset, build_tree, rest_lanes, to_lanes, to_table

SEEDS = st.integers(0, 2**32 - 1)
FEW = settings(max_examples=20)
SHAPES = ("single", "chain", "bush", "branches", "stalk", "hung")
EVERY_KIND = ("revolute", "prismatic", "prescribed", "locked", "elastic")
shapes = pytest.mark.parametrize("shape", SHAPES)


@pytest.mark.property
def test_shapes_are_packed_in_every_way(shaped_table):
    """The shapes of these tests make trees of one lane and of eight, with empty lanes and bodies that stand alone."""
    widths, empty, alone, free_with_branches = set(), 0, 0, 0
    for shape in SHAPES:
        tree = build_tree(shaped_table(shape, 0, ("revolute", "elastic"))[0])
        w = len(tree.lanes)
        widths.add(w)
        if w > 1:
            taken = np.bincount(tree.row // w, minlength=len(tree.parent))
            assert (taken[tree.alone] == 1).all()
            empty += np.count_nonzero(taken[~tree.alone] < w)
            alone += np.count_nonzero(tree.alone & (tree.parent >= 0))
            free_with_branches += len(set(tree.parent[tree.parent >= 0]) & set(np.flatnonzero(tree.parent < 0)))
    assert widths == {1, LANES}
    assert empty > 0 and alone > 0 and free_with_branches > 1


@pytest.mark.property
@shapes
@FEW
@given(seed=SEEDS)
def test_every_body_has_a_row_below_its_parents(shaped_table, shape, seed):
    """Rows are all different, and the block of a body's parent stands before its own, in the same lane or alone.

    That block is the one above, or for a second branch in a lane the foot of the branches. What it counts there is all.
    """
    bodies, _, _ = shaped_table(shape, seed, EVERY_KIND)
    tree = build_tree(bodies)
    w = len(tree.lanes)
    assert len(set(tree.row)) == len(bodies)
    for body, parent in enumerate(parent_rows(bodies)):
        block, lane = divmod(tree.row[body], w)
        if tree.parent[block] < 0:
            assert parent < 0 or bodies[body].hinge.kind == "elastic"
            continue
        above, its_lane = divmod(tree.row[parent], w)
        share, foot_share = (
            tree.body[block, BodyOffset.SHARE * w + lane],
            tree.body[block, BodyOffset.FOOT_SHARE * w + lane],
        )
        second = foot_share == 1.0
        assert above == (tree.foot if second else tree.parent)[block] < block
        assert tree.alone[above] or its_lane == lane
        assert share == (0.0 if second else 1.0 / w if tree.alone[block] else 1.0)


@pytest.mark.property
def test_vehicle_fills_seven_blocks(table):
    """The two leaves that three full blocks on the hull leave over share a block with road wheels."""
    tree = build_tree(table)
    assert len(tree.parent) == 7
    assert np.count_nonzero(tree.foot == 0) == 1
    assert np.bincount(tree.row // 8).tolist() == [1, 8, 8, 8, 8, 7, 1]


@pytest.mark.property
@shapes
@FEW
@given(seed=SEEDS)
def test_state_survives_the_way_through_rows(shaped_table, shape, seed):
    """A state turned into rows and back is the same, but that hinges without coordinate are at zero."""
    bodies, state, _ = shaped_table(shape, seed, EVERY_KIND)
    tree = build_tree(bodies)
    back = to_table(tree, to_lanes(tree, state))
    moves = [body.hinge is not None and body.hinge.kind in ("revolute", "prismatic") for body in bodies]
    for got, expected in zip(back, (*state[:4], *(np.where(moves, x, 0.0) for x in state[4:])), strict=True):
        np.testing.assert_array_equal(got, expected)


@pytest.mark.analytic
@shapes
@FEW
@given(seed=SEEDS)
def test_bodies_are_where_the_plain_kinematics_put_them(shaped_table, moved, shape, seed):
    """Pose, speeds and hinge axes of every body are those of the plain form, which turns with scipy."""
    bodies, state, _ = shaped_table(shape, seed, EVERY_KIND)
    tree = build_tree(bodies)
    motion, at = moved(tree, to_lanes(tree, state)), place_bodies(bodies, state)
    parents, free = np.array(parent_rows(bodies)), tree.parent[tree.row // len(tree.lanes)] < 0
    lever = np.where(free[:, None], 0.0, at.origin - at.origin[parents])
    for first, expected in (
        (MotionOffset.ROTATION, at.rotation.reshape(-1, 9)),
        (MotionOffset.ORIGIN, at.origin),
        (MotionOffset.VELOCITY, at.velocity),
        (MotionOffset.ANGULAR_VELOCITY, at.angular_velocity),
        (MotionOffset.LEVER, lever),
    ):
        # metres and rad/s of some 1e1 at most
        assert_allclose(columns(motion, first, expected.shape[1])[tree.row], expected, rtol=0, atol=1e-13)
    assert_allclose(
        columns(motion, MotionOffset.HINGE_AXIS, 3)[tree.row][tree.moves], at.axis[tree.moves], rtol=0, atol=1e-14
    )


@pytest.mark.analytic
@shapes
@FEW
@given(seed=SEEDS)
def test_velocity_is_the_rate_of_place(shaped_table, moved, shape, seed, drifted):
    """The velocity of a point of every body is the derivative of its place."""
    bodies, state, _ = shaped_table(shape, seed, EVERY_KIND)
    tree, h = build_tree(bodies), 1e-5
    now, before, after = (moved(tree, to_lanes(tree, drifted(state, t))) for t in (0.0, -h, h))
    point = (0.3, -0.2, 0.5)
    for body in tree.row:
        place = np.array([point_place(motion, body, point) for motion in (before, after)])
        velocity = point_velocity(now, body, point_place(now, body, point))
        # central difference: h^2 / 6 of the third derivative (rate^3 * 5 m, a few 1e2), and 1e-15 / h of rounding
        assert_allclose((place[1] - place[0]) / (2.0 * h), velocity, rtol=0, atol=1e-7)


@pytest.mark.analytic
@shapes
@FEW
@given(seed=SEEDS)
def test_rate_is_the_rate_of_attitude(shaped_table, moved, shape, seed, drifted):
    """The angular velocity of every body is the derivative of its attitude."""
    bodies, state, _ = shaped_table(shape, seed, EVERY_KIND)
    tree, h = build_tree(bodies), 1e-5
    now, before, after = (moved(tree, to_lanes(tree, drifted(state, t))) for t in (0.0, -h, h))
    turns = [
        Rotation.from_matrix(columns(motion, MotionOffset.ROTATION, 9)[tree.row].reshape(-1, 3, 3))
        for motion in (before, after)
    ]
    rate = (turns[1] * turns[0].inv()).as_rotvec() / (2.0 * h)
    assert_allclose(rate, columns(now, MotionOffset.ANGULAR_VELOCITY, 3)[tree.row], rtol=0, atol=1e-7)


@pytest.mark.analytic
@shapes
@FEW
@given(seed=SEEDS)
def test_drift_is_the_rate_of_velocity_at_constant_speeds(shaped_table, moved, shape, seed, drifted):
    """While no hinge and no free body accelerates, the velocity and rate of every body change by their drift."""
    bodies, state, _ = shaped_table(shape, seed, EVERY_KIND)
    tree, h = build_tree(bodies), 1e-5
    now, before, after = (moved(tree, to_lanes(tree, drifted(state, t))) for t in (0.0, -h, h))
    for quantity, drift in (
        (MotionOffset.VELOCITY, MotionOffset.DRIFT),
        (MotionOffset.ANGULAR_VELOCITY, MotionOffset.ANGULAR_DRIFT),
    ):
        change = columns(after, quantity, 3)[tree.row] - columns(before, quantity, 3)[tree.row]
        # central difference: h^2 / 6 of rate^4 * 5 m, some 1e3, and 1e-14 / h of rounding
        assert_allclose(change / (2.0 * h), columns(now, drift, 3)[tree.row], rtol=0, atol=1e-7)


@pytest.mark.property
@shapes
def test_body_axes_turn_back(shaped_table, moved, shape):
    """A vector in a body's axes is the global one turned back by the body's rotation."""
    bodies, state, _ = shaped_table(shape, 1, EVERY_KIND)
    tree, a = build_tree(bodies), (1.0, -2.0, 3.0)
    motion = moved(tree, to_lanes(tree, state))
    for row, turn in zip(tree.row, place_bodies(bodies, state).rotation, strict=True):
        assert_allclose(body_axes(motion, row, a), turn.T @ a, rtol=0, atol=1e-13)


@pytest.mark.property
@given(seed=SEEDS, dt=st.floats(1e-9, 2.0))
def test_turning_a_quaternion_is_a_rotation(seed, dt):
    """An attitude turned at a constant rate is scipy's and stays a unit quaternion, whatever the angle."""
    random = np.random.default_rng(seed)
    q, rate = Rotation.random(rng=random), random.normal(size=3)
    got = turn_quaternion(tuple(q.as_quat(scalar_first=True)), tuple(rate), dt)
    expected = Rotation.from_rotvec(dt * rate) * q
    assert np.linalg.norm(got) == pytest.approx(1.0, abs=1e-15)
    assert (Rotation.from_quat(got, scalar_first=True) * expected.inv()).magnitude() < 1e-14


@pytest.mark.analytic
@pytest.mark.parametrize("shape", SHAPES)
def test_integration_is_symplectic_euler(shaped_table, shape):
    """A step changes the speeds by the accelerations, and then the places by the new speeds."""
    bodies, state, _ = shaped_table(shape, 3, EVERY_KIND)
    tree, dt = build_tree(bodies, gravity=(0.3, -0.2, -9.81)), 1e-3
    lanes, before, response = to_lanes(tree, state), to_lanes(tree, state), new_response(tree)
    random = np.random.default_rng(1)
    response.cells[:] = random.normal(size=response.cells.shape)
    integrate(tree, lanes, response, dt)
    hinged = np.array([body.hinge is not None and body.hinge.kind != "elastic" for body in bodies])
    rows, found = tree.row[hinged], columns(response, ResponseOffset.LINEAR, 6)[tree.row[~hinged]]
    linear, angular = found[:, :3] + tree.gravity, found[:, 3:]
    assert_allclose(lanes.velocity, before.velocity + dt * linear, rtol=1e-15, atol=1e-17)
    assert_allclose(lanes.angular_velocity, before.angular_velocity + dt * angular, rtol=1e-15, atol=1e-17)
    assert_allclose(lanes.position, before.position + dt * lanes.velocity, rtol=1e-15, atol=1e-17)
    hinge_rate = before.hinge_rate[rows] + dt * columns(response, ResponseOffset.HINGE, 1)[rows, 0]
    assert_allclose(lanes.hinge_rate[rows], hinge_rate, rtol=1e-14)
    assert_allclose(lanes.hinge[rows], before.hinge[rows] + dt * hinge_rate, rtol=1e-14)
    turned = Rotation.from_rotvec(dt * lanes.angular_velocity) * Rotation.from_quat(before.attitude, scalar_first=True)
    assert (Rotation.from_quat(lanes.attitude, scalar_first=True) * turned.inv()).magnitude().max() < 1e-15


@pytest.mark.analytic
@pytest.mark.parametrize("shape", SHAPES)
def test_falling_tree_falls(shaped_table, solved, shape):
    """A tree in free fall drops by g t^2 / 2, and a step more of the method; no hinge moves."""
    bodies, _, _ = shaped_table(shape, 2)
    tree, dt, steps = build_tree(bodies), 1e-3, 100
    state = rest_lanes(tree)
    for _ in range(steps):
        _, _, response = solved(tree, state)
        integrate(tree, state, response, dt)
    # symplectic Euler sums 1 + 2 + ... + n
    assert state.position[0, 2] == pytest.approx(-9.81 * dt**2 * steps * (steps + 1) / 2, rel=1e-11)
    assert np.abs(state.hinge).max() < 1e-11
