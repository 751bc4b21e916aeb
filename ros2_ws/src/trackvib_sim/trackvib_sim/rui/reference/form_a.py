"""Overall transfer equation U_all z_all = 0 of a table, in its augmented form (Form A).

Every state vector of the table is a linear function of z_all: the state vectors of all free ends, [a; al; 0; 0; 1], and
the unknown acceleration of each hinge. The equations between them are

    main        of each tree:        -z_root + sum over tips of T(root <- tip) z_tip + sum over hinges of t_h thdd_h = 0
    geometry    of each input k > 1: H_1k z_I1 - [a; al]_Ik = 0
    axis        of each hinge:       E_h z_I = 0

as [Tao2025] writes them for its vehicle, with the method of [Rui2020]. Keeping the hinge accelerations as unknowns and
the axis rows as equations makes the equation regular for every physical table (derived in docs/method.md). This is the
reference form: dense, slow and easy to look at.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from ..state import Accelerations, Loads, TreeState
from ..table import Body
from .elements import AL, ONE, A, M, Q
from .matrices import TableMatrices, table_matrices


class StateVectors(NamedTuple):
    """State vectors of all elements, one row a body."""

    output: np.ndarray  # (n, 13) at the body's output, which is the input of its hinge
    hinge: np.ndarray  # (n, 13) at the output of its hinge, which is an input of its parent; zero at a tree's root
    end: np.ndarray  # (n, 13) at the free input of a tip; zero elsewhere


@dataclass(frozen=True)
class OverallTransfer(TableMatrices):
    """The overall transfer equation of a table with its blocks by name.

    `unknowns` and `equations` give the columns and rows of blocks of `U_all` (slices) by names that end on element
    numbers: ("root", body), ("tip", body) and ("hinge", hinge) have 13, 13 and 1 columns, ("main", body),
    ("geometry", hinge) and ("axis", hinge) have 13, 6 and 1 rows.
    """

    U_all: np.ndarray
    unknowns: dict
    equations: dict
    output: np.ndarray  # (n, 13, columns) what z_all makes of the state vector at each body's output
    output_of_hinge: np.ndarray  # (n, 13, columns) the same at each hinge's output

    def block(self, equation, unknown):
        """Return one block of U_all, e.g. ``block(("geometry", 11), ("tip", 64))``, the paper's G_11,64."""
        return self.U_all[self.equations[equation], self.unknowns[unknown]]

    def with_boundary_conditions(self, keep_root=False):
        """Return the square system (matrix, right side, columns of z_all) that the free ends (m = q = 0) leave.

        The accelerations of a tree's root stand in its main equation through -I only. They and their rows are dropped
        unless `keep_root`.
        """
        rows = np.ones(len(self.U_all), dtype=bool)
        columns = np.zeros(self.U_all.shape[1], dtype=bool)
        for (kind, _), place in self.unknowns.items():
            if kind == "hinge":
                columns[place] = True
            elif kind == "tip" or keep_root:
                columns[place.start : place.start + 6] = True
        for (kind, _), place in self.equations.items():
            if kind == "main":
                rows[place.start + ONE] = False  # 1 = 1
                rows[place.start : place.start + 6] = keep_root
        return self.U_all[np.ix_(rows, columns)], -(self.U_all @ self.known())[rows], np.flatnonzero(columns)

    def known(self):
        """Return z_all with what is known without solving: the ones of the free ends."""
        z_all = np.zeros(self.U_all.shape[1])
        for (kind, _), place in self.unknowns.items():
            if kind != "hinge":
                z_all[place.start + ONE] = 1.0
        return z_all

    def solve(self):
        """Return z_all."""
        matrix, right, columns = self.with_boundary_conditions()
        z_all = self.known()
        z_all[columns] = solve_equilibrated(matrix, right)
        return self.with_root(z_all)

    def with_root(self, z_all):
        """Return z_all with the accelerations of the roots filled in from everything else."""
        for row in self.roots:
            place = self.unknowns["root", self.bodies[row].number]
            z_all[place.start : place.start + 6] = (self.output[row] @ z_all)[:6]
        return z_all

    def states(self, z_all):
        """Return the `StateVectors` of every element for a solution z_all."""
        end = np.zeros((len(self.bodies), 13))
        for row in self.tips:
            end[row] = z_all[self.unknowns["tip", self.bodies[row].number]]
        return StateVectors(self.output @ z_all, self.output_of_hinge @ z_all, end)

    def accelerations(self, z_all):
        """Return the `Accelerations` for a solution z_all."""
        states = self.states(z_all)
        hinge = self.prescribed.copy()
        for row in self.free_hinges:
            hinge[row] = z_all[self.unknowns["hinge", self.bodies[row].hinge.number]][0]
        wrench = self.bushing + np.hstack((states.hinge[:, Q], states.hinge[:, M]))
        return Accelerations(states.output[:, A], states.output[:, AL], hinge, wrench)


def overall_transfer(bodies, state, loads, gravity=(0.0, 0.0, -9.81)):
    """Return the `OverallTransfer` of a table of n bodies.

    Parameters
    ----------
    bodies : sequence of Body
        A checked table; body numbers must differ from each other, and so must hinge numbers.
    state : TreeState
    loads : Loads
        Known loads, weight excluded.
    gravity : (3,) array
        g, global axes [m/s^2].
    """
    table = table_matrices(bodies, state, loads, gravity)
    unknowns = _unknowns(table)
    size = max(place.stop for place in unknowns.values())
    output, output_of_hinge, inputs = _state_maps(table, unknowns, size)
    blocks = {}
    for row in table.roots:
        minus_end = np.zeros((13, size))
        minus_end[:, unknowns["root", table.bodies[row].number]] = -np.eye(13)
        blocks["main", table.bodies[row].number] = minus_end + output[row]
    for row, children in enumerate(table.inputs):
        for H, child, z in zip(table.geometry[row], children[1:], inputs[row][1:], strict=True):
            blocks["geometry", table.bodies[child].hinge.number] = H @ inputs[row][0] - z[:6]
    for row in table.free_hinges:
        blocks["axis", table.bodies[row].hinge.number] = table.hinge[row].E[None] @ output[row]
    equations = _slices((name, len(block)) for name, block in blocks.items())
    U_all = np.vstack(list(blocks.values()))
    return OverallTransfer(**vars(table), U_all=U_all, unknowns=unknowns, equations=equations, output=output,
                           output_of_hinge=output_of_hinge)  # fmt: skip


def form_a(
    bodies: Sequence[Body], state: TreeState, loads: Loads, gravity: Sequence[float] = (0.0, 0.0, -9.81)
) -> Accelerations:
    """Return the `Accelerations` of a table by Form A; parameters as of `overall_transfer`.

    Examples
    --------
    A torque of 5 N m turns an arm that hangs in free fall.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> loads = rui.no_loads(bodies)
    >>> loads.torque[1] = 5.0
    >>> found = rui.form_a(bodies, rui.rest_state(bodies), loads)
    >>> round(float(found.hinge[1]), 6)  # rad/s^2
    23.75
    """
    transfer = overall_transfer(bodies, state, loads, gravity)
    return transfer.accelerations(transfer.solve())


def hinge_torques(transfer, accelerations):
    """Return (n,) torque (prismatic: force) of parent on child along each axis: what drives prescribed hinges."""
    q, m = accelerations.wrench[:, :3], accelerations.wrench[:, 3:]
    prismatic = np.array([body.hinge is not None and body.hinge.kind == "prismatic" for body in transfer.bodies])
    return -np.sum(transfer.placement.axis * np.where(prismatic[:, None], q, m), axis=1)


def solve_equilibrated(matrix, right):
    """Solve a dense square system by LU with rows and columns scaled to a largest entry near one.

    The unknowns mix m/s^2 and rad/s^2, the equations N, N m and accelerations: unscaled, the pivoting would compare
    what cannot be compared. The scales are powers of two, so scaling rounds nothing.
    """
    rows, columns = np.ones(len(right)), np.ones(len(right))
    for _ in range(3):
        scaled = np.abs(rows[:, None] * matrix * columns)
        rows /= 2.0 ** np.rint(0.5 * np.log2(scaled.max(axis=1)))
        columns /= 2.0 ** np.rint(0.5 * np.log2(scaled.max(axis=0)))
    return columns * lu_solve(lu_factor(rows[:, None] * matrix * columns), rows * right)


def _unknowns(table):
    """Name the columns of U_all: the roots' ends, the tips' ends, the hinge accelerations."""
    bodies = table.bodies
    for numbers in ([body.number for body in bodies], [body.hinge.number for body in bodies if body.hinge]):
        if len(set(numbers)) < len(numbers):
            raise ValueError(f"numbers {sorted(numbers)} of the bodies or of the hinges must differ from each other")
    names = [(("root", bodies[row].number), 13) for row in table.roots]
    names += [(("tip", bodies[row].number), 13) for row in table.tips]
    return _slices(names + [(("hinge", bodies[row].hinge.number), 1) for row in table.free_hinges])


def _slices(named_sizes):
    slices, start = {}, 0
    for name, size in named_sizes:
        slices[name] = slice(start, start + size)
        start += size
    return slices


def _state_maps(table, unknowns, size):
    """Express every state vector by z_all, tips first: outputs of bodies, outputs of hinges, inputs of bodies."""
    n = len(table.bodies)
    output, output_of_hinge, inputs = np.zeros((n, 13, size)), np.zeros((n, 13, size)), [[] for _ in range(n)]
    for row in reversed(range(n)):
        body = table.bodies[row]
        inputs[row] = [output_of_hinge[child] for child in table.inputs[row]]
        if not inputs[row]:
            end = np.zeros((13, size))
            end[:, unknowns["tip", body.number]] = np.eye(13)
            inputs[row] = [end]
        output[row] = sum(U @ z for U, z in zip(table.body[row], inputs[row], strict=True))
        if table.hinge[row] is not None:
            output_of_hinge[row] = table.hinge[row].U @ output[row]
        if row in table.free_hinges:
            output_of_hinge[row][:, unknowns["hinge", body.hinge.number]] += table.hinge[row].b[:, None]
    return output, output_of_hinge, inputs
