"""Static wrenches of a tree at rest and the matrices of its elements for small motions about that state.

Small motion of a body point: x = [X; Th], displacement [m] and rotation [rad]; wrench of the tip's side on the root's
side of a cut: f = [Q; M], as variation of its static value [q0; m0]. Global axes. The linear transfer matrix method is
that of [Rui2020]; the terms static load times rotation ("geometric stiffness") are derived in docs/method.md.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..reference.elements import cross_matrix
from ..reference.placement import parent_rows, place_bodies
from .model import settled


class Bushing(NamedTuple):
    """Elastic hinge: f at the child's origin = (child + s child_rate) x_child + (parent + s parent_rate) x_P."""

    child: np.ndarray  # (6, 6)
    parent: np.ndarray  # (6, 6) x_P of the hinge point, fixed on the parent
    child_rate: np.ndarray  # (6, 6)
    parent_rate: np.ndarray  # (6, 6)


class LinearTree(NamedTuple):
    """A linearised tree, one row a body. P is the hinge point on the parent, Q the body's origin, e the axis."""

    parent: list  # rows
    kind: list  # "root", "moving", "rigid" (locked or prescribed), "elastic"
    lever: np.ndarray  # (n, 3) from the parent's origin to P, m
    offset: np.ndarray  # (n, 3) from P to Q, m
    axis: np.ndarray  # (n, 6) D = [0; e] or [e; 0]
    inertia: np.ndarray  # (n, 6, 6) about Q
    stiffness: np.ndarray  # (n, 6, 6) of springs to the ground and of static loads, about Q
    damping: np.ndarray  # (n, 6, 6)
    hinge_stiffness: np.ndarray  # (n,) of springs and mounts, along the coordinate
    hinge_damping: np.ndarray  # (n,)
    static: np.ndarray  # (n, 6) q0, m0 about P
    shift: (
        np.ndarray
    )  # (n, 3, 3) rotation -> moment about P by the static force of a prismatic one that is out, N m/rad
    axis_turn: np.ndarray  # (n, 6) change of the axis load with the rotation at P
    lever_load: np.ndarray  # (n, 6) change of the wrench at P with the prismatic hinge's coordinate
    bushings: dict  # row: Bushing
    unbalanced: np.ndarray  # (n, 6) static wrench left over on root and bodies behind elastic hinges, about Q
    unbalanced_torque: np.ndarray  # (n,) left over on hinges, along the coordinate
    fixed_root: bool


def move(r):
    """Return X(r) (6, 6): takes x by r [m]; its transpose takes a wrench back by r."""
    X = np.eye(6)
    X[:3, 3:] = -cross_matrix(r)
    return X


def centre_of_mass(inertia):
    """Return the centre of mass (3,) [m] from the point that an inertia (6, 6) is about."""
    c = inertia[3:, :3] / inertia[0, 0]
    return np.array([c[2, 1], c[0, 2], c[1, 0]])


def linearise(model):
    """Return the `LinearTree` of a `LinearModel`, whether it is in equilibrium or not (`check_equilibrium` tells)."""
    model = settled(model)
    bodies, where, parent = model.bodies, place_bodies(model.bodies, model.state), parent_rows(model.bodies)
    n = len(bodies)
    rows = {body.name: row for row, body in enumerate(bodies)}
    kind = [_kind(body.hinge) for body in bodies]
    lever, offset = np.zeros((n, 3)), np.zeros((n, 3))
    for row in range(1, n):
        lever[row] = where.hinge_point[row] - where.origin[parent[row]]
        offset[row] = where.origin[row] - where.hinge_point[row]
    axis, inertia, stiffness, damping = np.zeros((n, 6)), *(np.zeros((n, 6, 6)) for _ in range(3))
    load = np.zeros((n, 6))  # known static wrench on every body about its origin
    load[:, :3], load[:, 3:] = model.loads.force, model.loads.moment
    for row, body in enumerate(bodies):
        directions = slice(0, 3) if body.hinge is not None and body.hinge.kind == "prismatic" else slice(3, 6)
        axis[row, directions] = where.axis[row]
        centre = where.rotation[row] @ body.centre
        inertia[row] = _inertia(body, where.rotation[row], centre)
        _add_point_force(load[row], stiffness[row], np.multiply(body.mass, model.gravity), centre)
    for spring in model.springs:
        row = rows[spring.body]
        r = where.rotation[row] @ spring.point
        wrench, size = spring.force_at(None), len(spring.stiffness)
        _add_point_force(load[row], stiffness[row], wrench[:3], r)
        load[row, 3:] += wrench[3:]
        X = move(r)[:size]
        stiffness[row] += X.T @ spring.stiffness @ X
        damping[row] += X.T @ spring.damping @ X
    tree = LinearTree(
        parent, kind, lever, offset, axis, inertia, stiffness, damping, model.stiffness.copy(), model.damping.copy(),
        np.zeros((n, 6)), np.zeros((n, 3, 3)), np.zeros((n, 6)), np.zeros((n, 6)), {}, np.zeros((n, 6)), np.zeros(n),
        model.fixed_root,
    )  # fmt: skip
    links = _links(model, where, rows)
    for row in reversed(range(1, n)):
        _pass_static_load(tree, row, load, model.loads.torque[row], links[row])
    tree.unbalanced[0] = 0.0 if model.fixed_root else load[0]
    return tree


def _kind(hinge):
    if hinge is None:
        return "root"
    if hinge.kind == "locked" or hinge.prescribed:
        return "rigid"
    return "elastic" if hinge.kind == "elastic" else "moving"


def _inertia(body, rotation, centre):
    X = move(centre)
    at_centre = np.zeros((6, 6))
    at_centre[:3, :3] = body.mass * np.eye(3)
    at_centre[3:, 3:] = rotation @ body.inertia @ rotation.T
    return X.T @ at_centre @ X


def _add_point_force(load, stiffness, force, r):
    """Add a force of constant direction that acts at a body-fixed point r from the origin."""
    load[:3] += force
    load[3:] += np.cross(r, force)
    stiffness[3:, 3:] -= cross_matrix(force) @ cross_matrix(r)


class _Link(NamedTuple):
    """A force between child and parent at a point of the child; the elastic hinge itself also has moments."""

    point: np.ndarray  # (3,) from the child's origin, m
    wrench: np.ndarray  # (6,) on the parent, m about the point
    stiffness: np.ndarray  # (6, 6) global axes
    damping: np.ndarray  # (6, 6)


def _links(model, where, rows):
    """Return a list of `_Link` for every body: its mounts and, if its hinge is elastic, that."""
    links = [[] for _ in model.bodies]
    for mount in model.mounts:
        row = rows[mount.body]
        A = where.rotation[rows[model.bodies[row].hinge.parent]]
        wrench, stiffness, damping = np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))
        wrench[:3] = -A @ mount.force_at(None)
        stiffness[:3, :3], damping[:3, :3] = A @ mount.stiffness @ A.T, A @ mount.damping @ A.T
        links[row].append(_Link(where.rotation[row] @ mount.point, wrench, stiffness, damping))
    for row, body in enumerate(model.bodies):
        if _kind(body.hinge) != "elastic":
            continue
        A = where.rotation[rows[body.hinge.parent]]
        both = np.kron(np.eye(2), A)
        turned = Rotation.from_matrix(A.T @ where.rotation[row]).as_rotvec()
        deflection = np.concatenate((A.T @ (where.origin[row] - where.hinge_point[row]), turned))
        K, C = np.asarray(body.hinge.stiffness), np.asarray(body.hinge.damping)
        change = np.eye(6)
        change[3:, 3:] = _vector_by_rotation(turned)
        stiffness = both @ np.diag(K) @ change @ both.T
        links[row].append(_Link(np.zeros(3), both @ (K * deflection), stiffness, both @ np.diag(C) @ both.T))
    return links


def _vector_by_rotation(v):
    """Return (3, 3): change of the rotation vector v with a small rotation added in fixed axes."""
    angle, V = np.linalg.norm(v), cross_matrix(v)
    factor = 1.0 / 12.0 if angle < 1e-3 else 1.0 / angle**2 - 0.5 / (angle * np.tan(0.5 * angle))
    return np.eye(3) - 0.5 * V + factor * V @ V


def _pass_static_load(tree, row, load, torque, links):
    """Take the static wrench over one hinge to the parent and fill in what depends on it."""
    D, parent, offset = tree.axis[row], tree.parent[row], tree.offset[row]
    if tree.kind[row] == "elastic":
        wrench = sum(move(link.point).T @ link.wrench for link in links)
        tree.unbalanced[row] = load[row] - wrench
        tree.bushings[row] = _bushing(links, offset)
    else:
        wrench = load[row]
    q0 = wrench[:3]
    tree.static[row] = move(offset).T @ wrench
    tree.shift[row] = cross_matrix(q0) @ cross_matrix(offset)
    if tree.kind[row] == "moving":
        prismatic, e = D[:3].any(), D[:3] + D[3:]
        m0 = tree.static[row, 3:]
        tree.axis_turn[row, 3:] = np.cross(e, q0 if prismatic else m0)
        if prismatic:
            tree.lever_load[row] = tree.axis_turn[row]
        for link in links:
            j = e if prismatic else np.cross(e, link.point)
            torque = torque - D @ (move(link.point + offset).T @ link.wrench)
            tree.hinge_stiffness[row] += j @ link.stiffness[:3, :3] @ j
            tree.hinge_damping[row] += j @ link.damping[:3, :3] @ j
            if not prismatic:
                tree.hinge_stiffness[row] += e @ np.cross(j, link.wrench[:3])
        tree.unbalanced_torque[row] = D @ tree.static[row] + torque
    load[parent] += move(tree.lever[row]).T @ tree.static[row]
    tree.stiffness[parent, 3:, 3:] -= cross_matrix(q0) @ cross_matrix(tree.lever[row])


def _bushing(links, offset):
    """Return the `Bushing` of forces that turn with the parent and act at points of the child."""
    child, parent, child_rate, parent_rate = (np.zeros((6, 6)) for _ in range(4))
    for link in links:
        at_child, at_parent = move(link.point), move(link.point + offset)
        child += at_child.T @ link.stiffness @ at_child
        parent -= at_child.T @ link.stiffness @ at_parent
        child_rate += at_child.T @ link.damping @ at_child
        parent_rate -= at_child.T @ link.damping @ at_parent
        turning = np.zeros((6, 6))  # the static wrench turns with the parent
        turning[:3, 3:], turning[3:, 3:] = -cross_matrix(link.wrench[:3]), -cross_matrix(link.wrench[3:])
        parent += at_child.T @ turning
        child[3:, 3:] += cross_matrix(link.wrench[:3]) @ cross_matrix(link.point)
    return Bushing(child, parent, child_rate, parent_rate)
