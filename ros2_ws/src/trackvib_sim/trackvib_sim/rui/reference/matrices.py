"""The transfer matrices of all elements of a table, and their products along paths by the paper's element numbers."""

from dataclasses import dataclass

import numpy as np

from .elements import (
    elastic_hinge,
    further_input,
    geometric_rows,
    locked_hinge,
    prescribed_hinge,
    prismatic_hinge,
    revolute_hinge,
    rigid_body,
)
from .placement import Placement, parent_rows, place_bodies


@dataclass(frozen=True)
class TableMatrices:
    """Every element of a table of n bodies, in one state and under its loads; lists have one entry a body.

    A body's output is its origin. Its inputs are the hinge points of its children in the order of the table (elastic
    hinges are none: they cut the table into trees). A body without inputs is a tip, its mass centre serves as free end.
    """

    bodies: tuple
    placement: Placement
    inputs: list  # rows of the children that feed the body, the first one is I1
    body: list  # matrices (13, 13) of the body, one an input (a tip has one): U_I1, U_I2, ...
    geometry: list  # H_1k (6, 13), one for each input after the first
    hinge: list  # HingeMatrices; None for the root of each tree
    bushing: np.ndarray  # (n, 6) wrench q, m of elastic hinges, child on parent, about the hinge point on the parent
    prescribed: np.ndarray  # (n,) known hinge accelerations, zero elsewhere

    @property
    def roots(self):
        """Rows of the bodies that end a tree: the table's root and each body behind an elastic hinge."""
        return [row for row, hinge in enumerate(self.hinge) if hinge is None]

    @property
    def tips(self):
        """Rows of the bodies without inputs, whose free ends are the boundaries of the overall equation."""
        return [row for row, rows in enumerate(self.inputs) if not rows]

    @property
    def free_hinges(self):
        """Rows of the hinges with unknown acceleration."""
        return [row for row, hinge in enumerate(self.hinge) if hinge is not None and hinge.b is not None]

    def path(self, out, tip):
        """Return the numbers of the elements from body `out` to body `tip`, in the order of the product T.

        Examples
        --------
        With the recoil part as root, ``path(1, 64)`` is ``[1, 2, 3, 4, 5, 6, 7, 10, 64]``.
        """
        numbers = []
        for row in self._rows(out, tip):
            hinge = self.bodies[row].hinge
            numbers += [self.bodies[row].number] if not numbers else [hinge.number, self.bodies[row].number]
        return numbers

    def U(self, number, hinge=None):
        """Return the (13, 13) matrix of a body or hinge by its element number.

        A body with several inputs has a matrix for each: `hinge` is the number of the hinge that feeds the input
        (U_Ik in the paper); without it, the first input is meant.
        """
        bodies = [row for row, body in enumerate(self.bodies) if body.number == number]
        hinges = [row for row, body in enumerate(self.bodies) if self.hinge[row] and body.hinge.number == number]
        if len(bodies) + len(hinges) != 1:
            raise ValueError(f"element number {number} stands for {len(bodies)} bodies and {len(hinges)} passed hinges")
        if hinges:
            return self.hinge[hinges[0]].U
        row = bodies[0]
        return self.body[row][0 if hinge is None else self._input(row, hinge)]

    def T(self, out, tip):
        """Return T(out <- tip) (13, 13): the product of all matrices from the free end of `tip` to the end of `out`.

        Body numbers. For the recoil part as root, T(1, 64) is the paper's U1 U2 U3 U4 U5 U6 U7 U10 U64.
        """
        return self._product(self._rows(out, tip))

    def G(self, hinge, tip):
        """Return the geometric block G (6, 13) of the further input fed by `hinge` and the free end of body `tip`.

        The geometric equation of input k, H_1k z_I1 - [a; al]_Ik = 0, in terms of the free ends behind I1 and Ik.
        """
        row = self._hinge_row(hinge)
        parent = parent_rows(self.bodies)[row]
        k = self._input(parent, hinge)
        if k == 0:
            raise ValueError(f"hinge {hinge} feeds a first input, which has no geometric equation")
        chain = self._rows(None, tip)
        if row in chain:
            return -(self.hinge[row].U @ self._product(chain[chain.index(row) :]))[:6]
        first = self.inputs[parent][0]
        if first in chain:
            return self.geometry[parent][k - 1] @ self.hinge[first].U @ self._product(chain[chain.index(first) :])
        return np.zeros((6, 13))

    def _product(self, rows):
        """Multiply the matrices from body rows[0] down to body rows[-1], the hinges between them included."""
        product = np.eye(13)
        for row, child in zip(rows, rows[1:], strict=False):
            product = product @ self.body[row][self.inputs[row].index(child)] @ self.hinge[child].U
        return product @ self.body[rows[-1]][0]

    def _rows(self, out, tip):
        """Return the rows of the bodies from number `out` (None: the root of the tree) to number `tip`."""
        parents = parent_rows(self.bodies)
        row = self._body_row(tip)
        if self.inputs[row]:
            raise ValueError(f"body {tip} has children, a path starts at a tip")
        rows = [row]
        while self.hinge[rows[0]] is not None and self.bodies[rows[0]].number != out:
            rows.insert(0, parents[rows[0]])
        if out is not None and self.bodies[rows[0]].number != out:
            raise ValueError(f"body {out} is not on the way from body {tip} to the root of its tree")
        return rows

    def _body_row(self, number):
        return _only([row for row, body in enumerate(self.bodies) if body.number == number], f"body {number}")

    def _hinge_row(self, number):
        found = [row for row, body in enumerate(self.bodies) if self.hinge[row] and body.hinge.number == number]
        return _only(found, f"passed hinge {number}")

    def _input(self, row, hinge):
        for k, child in enumerate(self.inputs[row]):
            if self.bodies[child].hinge.number == hinge:
                return k
        raise ValueError(f"hinge {hinge} does not feed body {self.bodies[row].number}")


def _only(found, what):
    if len(found) != 1:
        raise ValueError(f"{what}: the table has {len(found)} of this number, must have one")
    return found[0]


def table_matrices(bodies, state, loads, gravity):
    """Return the `TableMatrices` of a checked table.

    Parameters
    ----------
    bodies : sequence of Body
    state : TreeState
    loads : Loads
    gravity : (3,) array
        g, global axes [m/s^2].
    """
    at = place_bodies(bodies, state)
    parents = parent_rows(bodies)
    inputs = [[] for _ in bodies]
    hinges, prescribed = [], np.zeros(len(bodies))
    for row, body in enumerate(bodies):
        hinges.append(_hinge_matrices(body, at, row, state, loads))
        if hinges[row] is not None:
            inputs[parents[row]].append(row)
            if body.hinge.prescribed:
                prescribed[row] = loads.acceleration[row]
    force, moment, bushing = _with_bushings(bodies, parents, at, loads)
    matrices, geometry = [], []
    for row, body in enumerate(bodies):
        points = [at.hinge_point[child] for child in inputs[row]]
        U, H = _body_matrices(body, at, row, points, force[row], moment[row], np.asarray(gravity, dtype=float))
        matrices.append(U)
        geometry.append(H)
    return TableMatrices(tuple(bodies), at, inputs, matrices, geometry, hinges, bushing, prescribed)


def _hinge_matrices(body, at, row, state, loads):
    hinge = body.hinge
    if hinge is None or hinge.kind == "elastic":
        return None
    if hinge.kind == "locked":
        return locked_hinge()
    axis, rate, speed, torque = at.axis[row], at.angular_velocity[row], state.hinge_rate[row], loads.torque[row]
    if hinge.kind == "revolute":
        matrices = revolute_hinge(axis, rate, speed, torque)
    else:
        matrices = prismatic_hinge(axis, rate, state.hinge[row], speed, torque)
    return prescribed_hinge(matrices, loads.acceleration[row]) if hinge.prescribed else matrices


def _body_matrices(body, at, row, points, force, moment, gravity):
    """Return the matrices of a body with inputs at `points`, and its geometric rows; loads about the origin."""
    A, output = at.rotation[row], at.origin[row]
    centre = output + A @ np.asarray(body.centre, dtype=float)
    first = points[0] if points else centre
    U = rigid_body(
        body.mass,
        A @ np.asarray(body.inertia, dtype=float) @ A.T,
        at.angular_velocity[row],
        output - first,
        centre - first,
        force + body.mass * gravity,
        moment + np.cross(output - centre, force),
    )
    others = [further_input(output - point) for point in points[1:]]
    return [U, *others], [geometric_rows(at.angular_velocity[row], point - first) for point in points[1:]]


def _with_bushings(bodies, parents, at, loads):
    """Return forces and moments about the origins with those of the elastic hinges, and their wrenches."""
    force, moment = np.array(loads.force, dtype=float), np.array(loads.moment, dtype=float)
    wrench = np.zeros((len(bodies), 6))
    for row, body in enumerate(bodies):
        hinge, p = body.hinge, parents[row]
        if hinge is None or hinge.kind != "elastic":
            continue
        displacement, lever = at.origin[row] - at.hinge_point[row], at.origin[row] - at.origin[p]
        velocity = at.velocity[row] - at.velocity[p] - np.cross(at.angular_velocity[p], lever)
        axes = at.rotation[p], at.rotation[row]
        q, m = elastic_hinge(
            hinge.stiffness,
            hinge.damping,
            *axes,
            displacement,
            velocity,
            at.angular_velocity[row] - at.angular_velocity[p],
        )
        force[row] -= q
        moment[row] -= m
        force[p] += q
        moment[p] += m + np.cross(lever, q)
        wrench[row] = *q, *(m + np.cross(displacement, q))
    return force, moment, wrench
