"""Overall transfer matrix U_all of the classical (frequency domain) transfer matrix method, for small tables.

State vector of a cut: z = [x; f] (12), motion and wrench as in `linear_tree`. Element matrices are 12 x 12, with one
unknown coordinate and one axis equation for every hinge, and geometric equations for bodies with several inputs, as
the overall equation of motion has them [Rui2020; derived in docs/method.md]. For verification: det U_all vanishes at
every natural frequency. The sweep (`linear_sweep`) does the same work without large matrices.
"""

import numpy as np

from .tree import centre_of_mass, move

X, F = slice(0, 6), slice(6, 12)  # places of motion and wrench in the state vector


def body_matrix(tree, row, s_squared, r, s=0.0):
    """Return U (12, 12) of a body from an input I, at r = r_OI [m] from its output O (its origin), to O."""
    U = np.zeros((12, 12), dtype=np.result_type(s_squared, s, float))
    U[X, X] = move(-r)
    U[F, F] = move(r).T
    U[F, X] = -(s_squared * tree.inertia[row] + s * tree.damping[row] + tree.stiffness[row]) @ move(-r)
    return U


def hinge_matrices(tree, row, s=0.0):
    """Return U (12, 12), b (12,) and E (12,), stiffness of a hinge: z_O = U z_I + b th, E z_I = stiffness th.

    Input I is the child's origin, output O the hinge point on the parent. Not for elastic hinges.
    """
    offset, D = tree.offset[row], tree.axis[row]
    load = np.zeros((6, 6))
    load[3:, 3:] = tree.shift[row]
    U, b = np.zeros((12, 12)), np.zeros(12)
    U[X, X], U[F, F] = move(-offset), move(offset).T
    U[F, X] = load @ U[X, X]
    b[X], b[F] = -D, tree.lever_load[row]
    E = D @ U[F] + tree.axis_turn[row] @ U[X]
    return U, b, E, tree.hinge_stiffness[row] + s * tree.hinge_damping[row]


def overall_matrix(tree, s_squared, s=0.0):
    """Return U_all (N, N) of a tree; U_all times the unknowns is zero in free motion.

    Unknowns: motion of the free end of every tip (6 each), coordinate of every moving hinge (1), motion of the hinge
    point on the parent of every elastic hinge (6). Equations: 6 geometric ones for every further input of a body, 1
    for the axis of every moving hinge, 6 for the law of every elastic hinge, 6 for the free (or fixed) root.

    Parameters
    ----------
    tree : LinearTree
    s_squared : float or complex
        -omega^2 for undamped motion [1/s^2].
    s : complex
        What damping is multiplied with [1/s]; 0 leaves it out.
    """
    n = len(tree.parent)
    children = [[child for child in range(1, n) if tree.parent[child] == row] for row in range(n)]
    sizes = [6 * (not children[row]) + {"moving": 1, "elastic": 6}.get(tree.kind[row], 0) for row in range(n)]
    unknowns = sum(sizes)
    first = np.r_[0, np.cumsum(sizes)]
    identity, equations = np.eye(unknowns), []
    kind = np.result_type(s_squared, s, float)
    at_parent = {}  # (12, unknowns) state vector at the output of every hinge

    for row in reversed(range(n)):
        own = identity[first[row] : first[row + 1]]
        if children[row]:
            inputs = [(tree.lever[child], at_parent[child]) for child in children[row]]
            r1, z1 = inputs[0]
            z = body_matrix(tree, row, s_squared, r1, s) @ z1
            for r, z_input in inputs[1:]:
                z[F] += move(r).T @ z_input[F]
                equations.append(move(r - r1) @ z1[X] - z_input[X])
        else:
            centre = centre_of_mass(tree.inertia[row])  # a tip's free end is any point of it
            free_end = np.zeros((12, unknowns), dtype=kind)
            free_end[X], own = own[:6], own[6:]
            z = body_matrix(tree, row, s_squared, centre, s) @ free_end
        if row == 0:
            equations.append(z[X] if tree.fixed_root else z[F])
        elif tree.kind[row] == "elastic":
            bushing = tree.bushings[row]
            law = (bushing.child + s * bushing.child_rate) @ z[X] + (bushing.parent + s * bushing.parent_rate) @ own
            equations.append(z[F] - law)
            wrench = move(tree.offset[row]).T @ z[F]
            wrench[3:] -= np.cross(tree.static[row, :3], (z[X] - own)[:3], axisb=0).T
            at_parent[row] = np.vstack((own, wrench))
        else:
            U, b, E, stiffness = hinge_matrices(tree, row, s)
            at_parent[row] = U @ z
            if tree.kind[row] == "moving":
                at_parent[row] = at_parent[row] + np.outer(b, own[0])
                equations.append((E @ z - stiffness * own[0])[None])
    return np.vstack(equations)


def smallest_singular_value(matrix, rounds=20):
    """Return the smallest over the largest singular value of a matrix after scaling rows and columns to size one."""
    scaled = np.array(matrix)
    for _ in range(rounds):
        scaled = scaled / np.sqrt(np.abs(scaled).max(axis=1, keepdims=True))
        scaled = scaled / np.sqrt(np.abs(scaled).max(axis=0, keepdims=True))
    values = np.linalg.svd(scaled, compute_uv=False)
    return values[-1] / values[0]
