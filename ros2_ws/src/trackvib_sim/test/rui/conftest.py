"""Random tables of bodies, and the same dynamics from an independent engine (Pinocchio)."""

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.form_a import form_a
from trackvib_sim.rui.reference.form_x import form_x
from trackvib_sim.rui.reference.placement import parent_rows, place_bodies
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import Accelerations, Loads, TreeState, free_bodies, rest_state
from trackvib_sim.rui.table import Body, Hinge, check_table
from trackvib_sim.studies.paper.pinocchio_tree import pinocchio_model

GRAVITY = (0.0, 0.0, -9.81)


@pytest.fixture(scope="session")
def random_table():
    """A function `random_table(seed, bodies, kinds)` that returns a table of `bodies` bodies, a state and loads.

    Random topology (from bushes to chains), attitudes, places, axes, boxes of 1 to 100 kg as bodies, speeds, torques
    and external wrenches. `kinds` are hinge kinds to choose from, "prescribed" meaning a revolute or prismatic whose
    motion is given; without it only revolute and prismatic hinges come.
    """
    return _random_table


# Parent row of every body after the root, and which of them hang on elastic hinges where those are asked for.
SHAPES = {
    "single": ((), ()),
    "chain": ((0, 1, 2, 3, 4, 5), (3,)),
    "bush": ((0,) * 12, ()),
    "branches": ((*(0,) * 9, *range(1, 10), *range(1, 9), 9, 18), ()),
    "stalk": ((0, *(1,) * 16, 2, 2), ()),
    "hung": ((0, *(0,) * 9, *(1,) * 10, 12), (1, 21)),
}


@pytest.fixture(scope="session")
def shaped_table():
    """A function `shaped_table(shape, seed, kinds)` that returns a random table of one of `SHAPES`, a state and loads.

    `kinds` are hinge kinds to choose from; "prescribed" is a revolute or prismatic whose motion is given, and "elastic"
    makes the hinges so that the shape says so. Bodies are boxes of 1 to 100 kg; everything turns and moves.
    """

    def make(shape, seed, kinds=("revolute", "prismatic")):
        random, (parents, elastic) = np.random.default_rng(seed), SHAPES[shape]
        bodies = []
        for row, parent in enumerate((None, *parents)):
            hinge = None
            if row:
                free = "elastic" in kinds and row in elastic
                kind = "elastic" if free else str(random.choice([kind for kind in kinds if kind != "elastic"]))
                hinge = _random_hinge(random, 100 + row, kind, bodies[parent].name)
            mass, sides = 10.0 ** random.uniform(0.0, 2.0), random.uniform(0.3, 1.2, 3)
            turn = Rotation.random(rng=random).as_matrix()
            inertia = turn @ np.diag(mass / 12.0 * (np.sum(sides**2) - sides**2)) @ turn.T
            bodies.append(Body(1 + row, f"b{row}", mass, 0.2 * random.normal(size=3), inertia, hinge))
        n, state = len(bodies), rest_state(bodies)
        free = len(state.position)
        # near rest, so that elastic hinges stay near their undeformed place; then turned as a whole
        turn = Rotation.random(rng=random)
        attitude = turn * Rotation.from_rotvec(0.3 * random.normal(size=(free, 3)))
        state = TreeState(
            position=turn.apply(state.position + 0.05 * random.normal(size=(free, 3))) + random.normal(size=3),
            attitude=attitude.as_quat(scalar_first=True),
            velocity=random.normal(size=(free, 3)),
            angular_velocity=random.normal(size=(free, 3)),
            hinge=0.3 * random.normal(size=n),
            hinge_rate=random.normal(size=n),
        )
        driven = [body.hinge is not None and body.hinge.prescribed for body in bodies]
        loads = Loads(
            force=100.0 * random.normal(size=(n, 3)),
            moment=100.0 * random.normal(size=(n, 3)),
            torque=100.0 * random.normal(size=n),
            acceleration=np.where(driven, 10.0 * random.normal(size=n), 0.0),
        )
        return bodies, state, loads

    return make


@pytest.fixture(scope="session")
def pinocchio():
    """A function `pinocchio(bodies, state, loads, gravity)` that returns `Accelerations`: ABA and RNEA of Pinocchio.

    Tables of free revolute and prismatic hinges only.
    """
    return _pinocchio


@pytest.fixture(scope="session", params=[form_a, form_x, accelerations], ids=["A", "X", "Riccati"])
def form(request):
    """The forms in turn: a function of (bodies, state, loads, gravity) that returns `Accelerations`."""
    return request.param


@pytest.fixture(scope="session")
def relative():
    """A function `relative(value, reference)`: largest difference over the largest entry of the reference."""

    def error(value, reference):
        return np.max(np.abs(np.subtract(value, reference))) / np.max(np.abs(reference))

    return error


def _random_table(seed, bodies, kinds=("revolute", "prismatic")):
    random = np.random.default_rng(seed)
    chain = random.uniform()  # how often a body hangs on the one before it
    table = []
    for row in range(bodies):
        mass, sides = 10.0 ** random.uniform(0.0, 2.0), random.uniform(0.3, 1.2, 3)
        turn = _any_turn(random).as_matrix()
        inertia = turn @ np.diag(mass / 12.0 * (np.sum(sides**2) - sides**2)) @ turn.T
        hinge = None
        if row:
            parent = row - 1 if random.uniform() < chain else random.integers(row)
            hinge = _random_hinge(random, 101 + row, str(random.choice(kinds)), table[parent].name)
        table.append(Body(1 + row, f"b{row}", mass, 0.2 * random.normal(size=3), inertia, hinge))
    check_table(table)
    size = 100.0
    loads = Loads(*(size * random.normal(size=shape) for shape in ((bodies, 3), (bodies, 3), bodies)),
                  10.0 * random.normal(size=bodies))  # fmt: skip
    return table, _random_state(random, table), loads


def _random_hinge(random, number, kind, parent):
    place, axis = 0.4 * random.normal(size=3), random.normal(size=3)
    if kind == "prescribed":
        return Hinge(number, str(random.choice(["revolute", "prismatic"])), parent, place, axis, prescribed=True)
    if kind == "elastic":
        return Hinge(number, kind, parent, place, stiffness=random.uniform(100.0, 1e4, 6),
                     damping=random.uniform(10.0, 100.0, 6))  # fmt: skip
    return Hinge(number, kind, parent, place, axis)


def _any_turn(random):
    return Rotation.from_quat(random.normal(size=4))


def _random_state(random, table):
    """Everything turns and moves; bodies behind elastic hinges stay near their parents."""
    n, state, free = len(table), rest_state(table), free_bodies(table)
    hinge, rate = random.normal(size=n), random.normal(size=n)
    for row, body in enumerate(table):
        if body.hinge is not None and body.hinge.kind == "prismatic":
            hinge[row] *= 0.3
    state = TreeState(*state[:4], hinge, rate)
    state.position[0], state.velocity[0], state.angular_velocity[0] = random.normal(size=(3, 3))
    state.attitude[0] = _any_turn(random).as_quat(scalar_first=True)
    for k, row in enumerate(free[1:], 1):
        p, at = parent_rows(table)[row], place_bodies(table, state)
        near = Rotation.from_rotvec(0.1 * random.normal(size=3))
        state.position[k] = at.hinge_point[row] + 0.02 * random.normal(size=3)
        state.attitude[k] = (Rotation.from_matrix(at.rotation[p]) * near).as_quat(scalar_first=True)
        state.velocity[k] = at.velocity[p] + np.cross(at.angular_velocity[p], state.position[k] - at.origin[p])
        state.velocity[k] += 0.1 * random.normal(size=3)
        state.angular_velocity[k] = at.angular_velocity[p] + 0.1 * random.normal(size=3)
    return state


def _pinocchio(bodies, state, loads, gravity=GRAVITY):
    model, joints, _ = pinocchio_model(bodies, gravity)
    data, n, parents = model.createData(), len(bodies), parent_rows(bodies)
    q, v, tau = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
    attitude = state.attitude[0] / np.linalg.norm(state.attitude[0])
    to_global = pin.Quaternion(*attitude).matrix()
    q[:7] = *state.position[0], *attitude[1:], attitude[0]
    v[:6] = *(to_global.T @ state.velocity[0]), *(to_global.T @ state.angular_velocity[0])
    for row in range(1, n):
        joint = model.joints[joints[row]]
        q[joint.idx_q], v[joint.idx_v], tau[joint.idx_v] = state.hinge[row], state.hinge_rate[row], loads.torque[row]
    pin.forwardKinematics(model, data, q, v)
    external = [pin.Force.Zero() for _ in range(model.njoints)]
    for row in range(n):
        to_local = data.oMi[joints[row]].rotation.T
        external[joints[row]] = pin.Force(to_local @ loads.force[row], to_local @ loads.moment[row])
    a = pin.aba(model, data, q, v, tau, external).copy()
    pin.rnea(model, data, q, v, a, external)
    wrench = np.zeros((n, 6))
    for row in range(1, n):
        # of the parent on the child, in the child's frame; wanted: child on parent, about the point on the parent
        place, parent = data.oMi[joints[row]], data.oMi[joints[parents[row]]]
        on_parent, force = data.f[joints[row]], -place.rotation @ data.f[joints[row]].linear
        point = parent.translation + parent.rotation @ np.asarray(bodies[row].hinge.place, dtype=float)
        moment = -place.rotation @ on_parent.angular + np.cross(place.translation - point, force)
        wrench[row] = *force, *moment
    pin.forwardKinematics(model, data, q, v, a)
    frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    linear = [pin.getClassicalAcceleration(model, data, joint, frame).linear for joint in joints]
    angular = [pin.getAcceleration(model, data, joint, frame).angular for joint in joints]
    hinge = [0.0] + [a[model.joints[joint].idx_v] for joint in joints[1:]]
    return Accelerations(np.array(linear), np.array(angular), np.array(hinge), wrench)
