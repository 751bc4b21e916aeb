"""Closed chains by cut pins: against dense algebra with all closure equations, closed forms and conserved energy."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import null_space
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.closed_chain import closed_accelerations, closure_error
from trackvib_sim.rui.cut_pin import CutPin
from trackvib_sim.rui.placement import parent_rows, place_bodies
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import Loads, TreeState, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

GRAVITY = np.array([0.0, 0.0, -9.81])
FRAME = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
ROUNDING = 1e-9  # of the largest; the longest chains leave some 1e-11
DENSE = 1e-8  # the same for long chains by a dense mass matrix, which is ill-conditioned and leaves some 1e-9


class _Dense:
    """All equations of a closed chain in Pinocchio's coordinates: mass matrix, bias, five equations for every pin."""

    def __init__(self, bodies, pins, state, gravity=GRAVITY):
        self.bodies, self.model, n = bodies, pin.Model(), len(bodies)
        self.model.gravity.linear = np.asarray(gravity, dtype=float)
        parents, self.joints = parent_rows(bodies), [0] * n
        self._add(0, parents)
        self.data, self.q, self.v = self.model.createData(), pin.neutral(self.model), np.zeros(self.model.nv)
        w, *xyz = state.attitude[0]
        self.to_global = Rotation.from_quat(state.attitude[0], scalar_first=True).as_matrix()
        self.q[:7] = *state.position[0], *xyz, w
        self.v[:6] = *(self.to_global.T @ state.velocity[0]), *(self.to_global.T @ state.rate[0])
        for row in range(1, n):
            joint = self.model.joints[self.joints[row]]
            self.q[joint.idx_q], self.v[joint.idx_v] = state.hinge[row], state.hinge_rate[row]
        self.jacobian, self.bias = self._closure(pins)

    def _add(self, row, parents):
        body, parent, place, joint = self.bodies[row], 0, np.zeros(3), pin.JointModelFreeFlyer()
        if row:
            parent, place = self.joints[parents[row]], np.asarray(body.hinge.place, dtype=float)
            kind = {"revolute": pin.JointModelRevoluteUnaligned, "slide": pin.JointModelPrismaticUnaligned}
            joint = kind[body.hinge.kind](np.asarray(body.hinge.axis) / np.linalg.norm(body.hinge.axis))
        self.joints[row] = self.model.addJoint(parent, joint, pin.SE3(np.eye(3), place), body.name)
        inertia = pin.Inertia(body.mass, np.asarray(body.centre, dtype=float), np.asarray(body.inertia))
        self.model.appendBodyToJoint(self.joints[row], inertia, pin.SE3.Identity())
        for child in [child for child, p in enumerate(parents) if p == row]:
            self._add(child, parents)

    def _closure(self, pins):
        """Jacobian and bias of B's point less A's and of the turning across the axis; T alone is turned by body a."""
        model, data, ends = self.model, self.data, []
        rows = {body.name: row for row, body in enumerate(self.bodies)}
        for k, each in enumerate(pins):
            ends.append([
                model.addFrame(pin.Frame(f"{k}{name}", self.joints[rows[name]], 0,
                                         pin.SE3(np.eye(3), np.array(place, float)), pin.FrameType.OP_FRAME))
                for name, place in ((each.body_a, each.point_a), (each.body_b, each.point_b))
            ])  # fmt: skip
        self.data = data = model.createData()
        pin.computeJointJacobians(model, data, self.q)
        pin.forwardKinematics(model, data, self.q, self.v, np.zeros(model.nv))
        pin.updateFramePlacements(model, data)
        jacobians, biases = [], []
        for each, (a, b) in zip(pins, ends, strict=True):
            across = data.oMf[a].rotation @ null_space(np.array([each.axis], dtype=float))
            J = pin.getFrameJacobian(model, data, b, FRAME) - pin.getFrameJacobian(model, data, a, FRAME)
            bias = [
                getattr(pin.getFrameClassicalAcceleration(model, data, b, FRAME), part)
                - getattr(pin.getFrameClassicalAcceleration(model, data, a, FRAME), part)
                for part in ("linear", "angular")
            ]
            rate_a = pin.getFrameVelocity(model, data, a, FRAME).angular
            relative = J[3:] @ self.v  # along the axis, with which it turns
            jacobians += [J[:3], across.T @ J[3:]]
            biases += [bias[0], across.T @ (bias[1] - np.cross(rate_a, relative))]
        return np.vstack(jacobians), np.concatenate(biases)

    def project(self, state, speeds):
        """Return the state with those of the speeds that the closure allows."""
        free = null_space(self.jacobian, rcond=1e-10)
        return self._with_speeds(state, free @ (free.T @ speeds))

    def _with_speeds(self, state, v):
        return state._replace(velocity=(self.to_global @ v[:3])[None], rate=(self.to_global @ v[3:6])[None],
                              hinge_rate=self._hinges(v))  # fmt: skip

    def _hinges(self, v):
        return np.array([0.0, *(v[self.model.joints[joint].idx_v] for joint in self.joints[1:])])

    def accelerations(self, loads):
        """Return linear, angular and hinge accelerations; a = particular + free y, of M a = f projected on free."""
        model, data = self.model, self.data
        free = null_space(self.jacobian, rcond=1e-10)
        particular = -np.linalg.pinv(self.jacobian, rcond=1e-10) @ self.bias
        force = self._force(loads) - pin.nonLinearEffects(model, data, self.q, self.v)
        mass = pin.crba(model, data, self.q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        y = np.linalg.solve(free.T @ mass @ free, free.T @ (force - mass @ particular))
        a = particular + free @ y
        pin.forwardKinematics(model, data, self.q, self.v, a)
        linear = [pin.getClassicalAcceleration(model, data, joint, FRAME).linear for joint in self.joints]
        angular = [pin.getAcceleration(model, data, joint, FRAME).angular for joint in self.joints]
        return np.array(linear), np.array(angular), self._hinges(a)

    def hinges_by_inverse(self, loads, axis):
        """Return hinge accelerations from O(n) parts and the closure equations across a global axis: more accurate."""
        model, data, across = self.model, self.data, null_space(axis[None])
        J, bias = across.T @ self.jacobian[:3], across.T @ self.bias[:3]
        a = pin.aba(model, data, self.q, self.v, self._force(loads)).copy()
        inverse = pin.computeMinverse(model, data, self.q)
        inverse = np.triu(inverse) + np.triu(inverse, 1).T
        return self._hinges(a - inverse @ J.T @ np.linalg.solve(J @ inverse @ J.T, J @ a + bias))

    def _force(self, loads):
        model, data = self.model, self.data
        force = np.zeros(model.nv)
        pin.computeJointJacobians(model, data, self.q)
        for row, joint in enumerate(self.joints):
            wrench = np.concatenate((loads.force[row], loads.moment[row]))
            force += pin.getJointJacobian(model, data, joint, FRAME).T @ wrench
            if row:
                force[model.joints[joint].idx_v] += loads.torque[row]
        return force


def _random_body(random, number, name, turn, length, hinge):
    mass, sides = random.uniform(5.0, 20.0), length * np.array([1.0, *random.uniform(0.2, 0.6, 2)])
    axes = turn @ Rotation.from_rotvec(0.2 * random.normal(size=3)).as_matrix()
    inertia = axes @ np.diag(mass / 12.0 * (np.sum(sides**2) - sides**2)) @ axes.T
    return Body(number, name, mass, turn @ (0.5 * length, 0.1 * length, 0.05 * length), inertia, hinge)


def _polygon(seed, links, axis=None):
    """An irregular closed polygon of links, in planes across any axis: table, cut pin, state, random loads.

    The links' points are not in one plane but in parallel ones. Free, turning and moving as the closure allows.
    """
    random = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(random.normal(size=3)).as_matrix()  # plane of the polygon -> body axes
    angle = 2.0 * np.pi * (np.arange(links) + random.uniform(-0.2, 0.2, links)) / links
    corner = random.uniform(0.9, 1.1, links)[:, None] * np.array([np.cos(angle), np.sin(angle)]).T
    side = np.roll(corner, -1, axis=0) - corner
    length, heading = np.linalg.norm(side, axis=1), np.arctan2(side[:, 1], side[:, 0])
    height = np.append(0.1 * random.normal(size=links - 1), 0.0)
    height[-1] = -np.sum(height)
    bodies, end = [], None
    for k in range(links):
        hinge = Hinge(k, "revolute", f"link {k - 1}", end, 2.0 * turn[:, 2]) if k else None
        bodies.append(_random_body(random, k, f"link {k}", turn, length[k], hinge))
        end = turn @ (length[k], 0.0, height[k])
    cut = CutPin(f"link {links - 1}", end, "link 0", (0.0, 0.0, 0.0), turn[:, 2])
    state = rest_state(bodies)._replace(hinge=np.append(0.0, np.diff(heading)))
    state.position[0] = random.normal(size=3)
    state.attitude[0] = Rotation.from_rotvec(random.normal(size=3)).as_quat(scalar_first=True)
    state = _Dense(bodies, [cut], state).project(state, random.normal(size=links + 5))
    loads = Loads(*(100.0 * random.normal(size=shape) for shape in ((links, 3), (links, 3), links)), np.zeros(links))
    return bodies, cut, state, loads


def _ladders(seed, loops):
    """A bush: from one root, pairs of branches of two bodies (one slides) joined by a pin, each pair with its axis."""
    random = np.random.default_rng(seed)
    bodies, pins = [_random_body(random, 0, "root", np.eye(3), 1.0, None)], []
    hinges = [0.0]
    for k in range(loops):
        turn = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
        foot = random.normal(size=3)
        # triangle of feet (0, 0) and (1, 0), tip near (0.4, 0.8); the left leg turns and slides, the right has a knee
        tip, knee = np.array([0.4, 0.8, 0.0]) + [*random.uniform(-0.1, 0.1, 2), 0.0], np.array([1.3, 0.6, 0.0])
        for name, parent, kind, place, axis in (
            (f"left {k}", "root", "revolute", foot, turn[:, 2]),
            (f"rod {k}", f"left {k}", "slide", turn @ (0.1, 0.1, 0.0), turn @ (0.4, 0.8, 0.0)),
            (f"right {k}", "root", "revolute", foot + turn[:, 0], turn[:, 2]),
            (f"shin {k}", f"right {k}", "revolute", turn @ (knee - (1.0, 0.0, 0.0)), turn[:, 2]),
        ):
            number = len(bodies)
            bodies.append(_random_body(random, number, name, turn, 0.8, Hinge(number, kind, parent, place, axis)))
            hinges.append(0.0)
        pins.append(CutPin(f"rod {k}", turn @ (tip - (0.1, 0.1, 0.0)), f"shin {k}", turn @ (tip - knee), turn[:, 2]))
    state, n = rest_state(bodies)._replace(hinge=np.array(hinges)), len(bodies)
    state.attitude[0] = Rotation.from_rotvec(random.normal(size=3)).as_quat(scalar_first=True)
    state = _Dense(bodies, pins, state).project(state, random.normal(size=n + 5))
    loads = Loads(*(100.0 * random.normal(size=shape) for shape in ((n, 3), (n, 3), n)), np.zeros(n))
    return bodies, pins, state, loads


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
    bodies, cut, state, loads = _polygon(10 * links + seed, links)
    miss = closure_error(bodies, [cut], state)
    assert np.abs(miss.position).max() < 1e-13 * links
    assert np.abs(miss.velocity).max() < 1e-13 * links
    found, _ = closed_accelerations(bodies, [cut], state, loads, GRAVITY)
    dense = _Dense(bodies, [cut], state)
    reference, hinges = dense.accelerations(loads), dense.hinges_by_inverse(loads, place_bodies(bodies, state).axis[1])
    assert _differ(found, reference) < (ROUNDING if links < 80 else DENSE)
    assert_allclose(found.hinge, hinges, rtol=0, atol=0.2 * ROUNDING * np.abs(hinges).max())
    # the pin is what does it
    assert _differ(accelerations(bodies, state, loads, GRAVITY), reference) > 1e-3


@pytest.mark.cross_engine
@pytest.mark.parametrize("loops", [1, 2, 3, 24])
def test_several_loops_on_one_body(loops):
    """Loops with a slide and with axes of their own, closed by as many pins, and those in lanes side by side."""
    bodies, pins, state, loads = _ladders(loops, loops)
    found, force = closed_accelerations(bodies, pins, state, loads, GRAVITY)
    assert force.shape == (loops, 3)
    assert _differ(found, _Dense(bodies, pins, state).accelerations(loads)) < ROUNDING


@pytest.mark.analytic
@pytest.mark.parametrize("links", [4, 40, 120])
def test_newton_and_euler_of_a_link(links):
    """Wrenches in the hinges and the force in the pin are what accelerates each link about its mass centre."""
    bodies, cut, state, loads = _polygon(links, links)
    found, force = closed_accelerations(bodies, [cut], state, loads, GRAVITY)
    at, size = place_bodies(bodies, state), np.abs(found.wrench).max()
    end = at.rotation[0] @ cut.point_b + at.origin[0]
    assert np.abs(np.cross(force[0], at.axis[1]) @ at.axis[1]) < ROUNDING * size
    assert np.abs(force[0] @ at.axis[1]) < ROUNDING * size
    for row, body in enumerate(bodies):
        A, om, al = at.rotation[row], at.rate[row], found.angular[row]
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
    bodies, cut, state, loads = _polygon(7, 12)
    other = CutPin(cut.body_b, cut.point_b, cut.body_a, cut.point_a, -3.0 * np.array(cut.axis))
    found, force = closed_accelerations(bodies, [cut], state, loads)
    turned, opposite = closed_accelerations(bodies, [other], state, loads)
    assert _differ(turned, found) < ROUNDING
    assert_allclose(opposite, -force, rtol=0, atol=ROUNDING * np.abs(force).max())


@pytest.mark.property
def test_without_pins_it_is_the_tree():
    """No pin, no force."""
    bodies, _, state, loads = _polygon(8, 5)
    found, force = closed_accelerations(bodies, [], state, loads)
    assert force.shape == (0, 3)
    for value, reference in zip(found, accelerations(bodies, state, loads), strict=True):
        assert np.array_equal(value, reference)


def _parallelogram(angle, rate, rod=3.0):
    """Two equal cranks, one rod, on a body too heavy to move; axes y, cranks down at angle 0."""
    length, gap, heavy = 0.8, 1.5, 1e12
    bodies = [
        Body(0, "base", heavy, (0, 0, 0), heavy * np.eye(3)),
        Body(1, "left", 2.0, (0, 0, -0.3), 0.2 * np.eye(3), Hinge(1, "revolute", "base", (0, 0, 0), (0, 1, 0))),
        Body(2, "rod", rod, (0.7, 0, 0.1), 0.4 * np.eye(3),
             Hinge(2, "revolute", "left", (0, 0, -length), (0, 1, 0))),
        Body(3, "right", 1.0, (0, 0, -0.5), 0.1 * np.eye(3), Hinge(3, "revolute", "base", (gap, 0, 0), (0, 1, 0))),
    ]  # fmt: skip
    cut = CutPin("rod", (gap, 0, 0), "right", (0, 0, -length), (0, 1, 0))
    state, loads = rest_state(bodies), no_loads(bodies)
    state.hinge[1:], state.hinge_rate[1:] = (angle, -angle, angle), (rate, -rate, rate)
    loads.force[0, 2] = heavy * 9.81
    return bodies, cut, state, loads


@pytest.mark.analytic
@pytest.mark.parametrize("angle", [0.3, 1.2, -2.0])
def test_four_bar_linkage(angle):
    """A parallelogram swings like a pendulum: J thdd = -g S sin(th), J = sum J_crank + m_rod l^2."""
    bodies, cut, state, loads = _parallelogram(angle, 1.7)
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


def _step(bodies, pins, state, loads, h, gravity):
    """One step of the classical Runge-Kutta method."""

    def slope(s):
        a, _ = closed_accelerations(bodies, pins, s, loads, gravity)
        w, *v = s.attitude[0]
        turning = 0.5 * np.array([-s.rate[0] @ v, *(w * s.rate[0] + np.cross(s.rate[0], v))])
        return TreeState(s.velocity, turning[None], a.linear[:1], a.angular[:1], s.hinge_rate, a.hinge)

    def after(s, ds, dt):
        moved = TreeState(*(x + dt * dx for x, dx in zip(s, ds, strict=True)))
        return moved._replace(attitude=moved.attitude / np.linalg.norm(moved.attitude))

    k1 = slope(state)
    k2 = slope(after(state, k1, 0.5 * h))
    k3 = slope(after(state, k2, 0.5 * h))
    k4 = slope(after(state, k3, h))
    mean = TreeState(*((a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)))
    return after(state, mean, h)


def _energy(bodies, state, gravity):
    at, total = place_bodies(bodies, state), 0.0
    for row, body in enumerate(bodies):
        A, om = at.rotation[row], at.rate[row]
        c = A @ body.centre
        v = at.velocity[row] + np.cross(om, c)
        total += 0.5 * body.mass * v @ v + 0.5 * om @ A @ body.inertia @ A.T @ om
        total -= body.mass * (at.origin[row] + c) @ gravity
    return total


@pytest.mark.analytic
@pytest.mark.parametrize("links", [5, 20])
def test_energy_of_a_swinging_chain(links):
    """A closed chain, tumbling in gravity, keeps its energy and stays closed but for the step's error of order 4."""
    bodies, cut, start, _ = _polygon(links, links)
    start = start._replace(velocity=start.velocity + (1.0, 2.0, 3.0))
    loads, energy, drifts = no_loads(bodies), _energy(bodies, start, GRAVITY), []
    kinetic = _energy(bodies, start, np.zeros(3))
    for steps in (50, 100):
        state = start
        for _ in range(steps):
            state = _step(bodies, [cut], state, loads, 0.1 / steps, GRAVITY)
        drifts.append(abs(_energy(bodies, state, GRAVITY) - energy) / kinetic)
        assert np.abs(state.hinge - start.hinge).max() > 0.03
        assert np.abs(closure_error(bodies, [cut], state).position).max() < 1e-6
    assert drifts[1] < 1e-8
    assert drifts[1] < drifts[0] / 8.0


@pytest.mark.analytic
@pytest.mark.parametrize("seed", range(3))
def test_baumgarte_draws_the_ends_together(seed):
    """From any state the ends accelerate apart by -2 alpha of their speed and -beta^2 of their distance."""
    bodies, cut, state, loads = _polygon(seed, 6)
    random = np.random.default_rng(seed)
    cut = replace(cut, alpha=3.0, beta=7.0)
    state = state._replace(hinge=state.hinge + 0.01 * random.normal(size=6),
                           hinge_rate=state.hinge_rate + random.normal(size=6))  # fmt: skip
    found, _ = closed_accelerations(bodies, [cut], state, loads)
    at, ends = place_bodies(bodies, state), []
    for row, point in ((5, cut.point_a), (0, cut.point_b)):
        arm, om = at.rotation[row] @ point, at.rate[row]
        ends.append(found.linear[row] + np.cross(found.angular[row], arm) + np.cross(om, np.cross(om, arm)))
    miss = closure_error(bodies, [cut], state)
    across = null_space((at.rotation[5] @ cut.axis)[None])
    wanted = -6.0 * miss.velocity[0] - 49.0 * miss.position[0]
    assert_allclose((ends[1] - ends[0]) @ across, wanted @ across, rtol=0, atol=ROUNDING * np.abs(ends).max())


@pytest.mark.analytic
def test_closure_error_decays():
    """In the plane, with alpha = beta, an error e at rest becomes e (1 + alpha t) exp(-alpha t); with 0 it stays."""
    bodies, cut, start, loads = _parallelogram(0.4, 0.0)
    bodies[0] = replace(bodies[0], mass=50.0, inertia=np.eye(3))
    start.hinge[1:] += 1e-3, -2e-3, 1.5e-3
    before = closure_error(bodies, [cut], start).position[0]
    loads.force[0] = 0.0
    for alpha, left in ((0.0, 1.0), (20.0, 9.0 * np.exp(-8.0))):
        pins, state = [replace(cut, alpha=alpha, beta=alpha)], start
        for _ in range(200):
            state = _step(bodies, pins, state, loads, 2e-3, GRAVITY)
        after = closure_error(bodies, pins, state)
        assert_allclose(after.position[0], left * before, rtol=0, atol=1e-7 * np.abs(before).max())


def _refused(match, **changes):
    bodies, cut, state, loads = _parallelogram(0.3, 0.0)
    for call in (lambda p: closed_accelerations(bodies, p, state, loads), lambda p: closure_error(bodies, p, state)):
        with pytest.raises(ValueError, match=match):
            call([replace(cut, **changes)])


@pytest.mark.analytic
@pytest.mark.parametrize(
    "match, changes",
    [
        ("between 'rod' and 'crank': there is no body 'crank'; known are base, left, rod, right", {"body_b": "crank"}),
        ("must join two different bodies", {"body_b": "rod"}),
        ("point_a is .*, must be 3 finite numbers", {"point_a": (0.0, np.nan, 0.0)}),
        ("point_b is .*, must be 3 finite numbers", {"point_b": (0.0, 1.0)}),
        ("axis is .*, must not be zero", {"axis": (0, 0, 0)}),
        ("alpha is -1.0 1/s, must be finite and >= 0", {"alpha": -1.0}),
        ("beta is inf 1/s, must be finite and >= 0", {"beta": np.inf}),
        ("hinge 3 of body 'right' is revolute with axis .*accepted are revolute parallel", {"axis": (0, 1, 1e-3)}),
        (r"points are 0\.2\d* m apart along \(0, 1, 0\), must be 0 m", {"point_a": (1.5, 0.2, 0)}),
    ],
)
def test_impossible_pins(match, changes):
    """A pin that is not possible is refused by name, with what is accepted."""
    _refused(match, **changes)


@pytest.mark.analytic
@pytest.mark.parametrize("kind, axis", [("slide", (0, 1, 0)), ("elastic", (0, 1, 0)), ("revolute", (1, 0, 0))])
def test_loops_that_leave_their_planes(kind, axis):
    """Hinges in the loop that would let it leave its planes are refused; outside of the loop they are not."""
    bodies, cut, state, loads = _parallelogram(0.3, 0.0)
    bodies[2] = replace(bodies[2], hinge=replace(bodies[2].hinge, kind=kind, axis=axis))
    if kind == "elastic":
        state = rest_state(bodies)
    with pytest.raises(ValueError, match=f"in its loop, hinge 2 of body 'rod' is {kind}"):
        closed_accelerations(bodies, [cut], state, loads)
    bodies, cut, state, loads = _parallelogram(0.3, 0.0)
    bodies.append(Body(4, "flag", 1.0, (0, 0, 0.1), np.eye(3), Hinge(4, kind, "rod", (0, 0, 0), axis)))
    state = rest_state(bodies)._replace(hinge=np.append(state.hinge, 0.0))
    found, _ = closed_accelerations(bodies, [cut], state, no_loads(bodies))
    assert np.all(np.isfinite(found.linear))


@pytest.mark.analytic
def test_dependent_closure_equations():
    """A loop of two bodies, one stretched out, and two pins for one loop are refused with the pins' names."""
    bodies, cut, state, loads = _parallelogram(0.3, 0.0)
    cases = [
        # on the hinge that is there already
        ([CutPin("left", (0, 0, -0.8), "rod", (0, 0, 0), (0, 1, 0))], state),
        ([CutPin("base", (1.0, 0, 0), "left", (0.3, 0, 0.1), (0, 1, 0))], state),
        ([cut, cut], state),
    ]
    for pins, at in cases:
        with pytest.raises(ValueError, match=f"cut pin between '{pins[0].body_a}'.*depend on each other"):
            closed_accelerations(bodies, pins, at, loads)
    bodies, cut, state, loads = _parallelogram(np.pi / 2.0, 0.0)
    with pytest.raises(ValueError, match="depend on each other"):
        closed_accelerations(bodies, [cut], state, loads)
