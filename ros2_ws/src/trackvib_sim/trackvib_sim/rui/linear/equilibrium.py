"""State of rest of a tree under its springs and static loads, and the check that a given state is one."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..state import free_bodies
from .model import LinearModel, anchored, settled
from .sweep import count_below, forced_motion, inertia_only, tips_to_root, unbalanced_accelerations
from .tree import linearise

SOFT = 1e-6  # rad^2/s^2, stiffness per inertia added against free motion, far below that of any spring
LARGEST_STEP = 0.3  # rad and m
SMALLEST_STEP = 1e-14  # rad and m, rounding


def find_equilibrium(model: LinearModel, tolerance: float = 1e-9, steps: int = 200) -> LinearModel:
    """Return `model` in a state of rest, its laws referred to that state.

    Newton steps with the stiffness of the sweeps, kept downhill in potential energy, so that a stable equilibrium is
    found (unless the start is an unstable one). Hinges without a spring or a load that depends on their coordinate keep
    their position, and so do prescribed hinges.

    Parameters
    ----------
    model : LinearModel
        Starting state included. Ground springs and mounts with a `place` and hinges with `free` coordinates pull
        towards those. Ground springs with a (6, 6) stiffness are refused: they have no law for large rotations.
    tolerance : float
        Largest acceleration left over [m/s^2, rad/s^2].
    steps : int
        Largest number of Newton steps.

    Raises
    ------
    ValueError
        No state of rest was found (names the body or hinge with the largest acceleration left), or a spring is refused.

    Examples
    --------
    A pendulum that starts at 1 rad comes to hang straight down.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> state = rui.rest_state(bodies)
    >>> state.hinge[1] = 1.0
    >>> at_rest = rui.find_equilibrium(rui.LinearModel(bodies, state, fixed_root=True))
    >>> bool(abs(at_rest.state.hinge[1]) < 1e-9)
    True
    """
    for spring in model.springs:
        if len(spring.stiffness) == 6:
            raise ValueError(f"spring on {spring.body!r}: only springs without rotation can be settled")
    model = anchored(model)
    tree = linearise(model)
    for _ in range(steps):
        if _largest(unbalanced_accelerations(tree)) <= tolerance:
            break
        x, coordinate = _newton_step(tree)
        largest = max(np.abs(x[free_bodies(model.bodies)]).max(), np.abs(coordinate).max())
        if largest < SMALLEST_STEP:
            break
        size, work = min(1.0, LARGEST_STEP / largest), _work(tree, x, coordinate)
        while True:
            tried = replace(model, state=_moved(model, size * x, size * coordinate))
            tried_tree = linearise(tried)
            # too far where the loads left over pull back more than half as hard as they pulled before
            if _work(tried_tree, x, coordinate) >= -0.5 * work or size < 1e-3:
                break
            size *= 0.5
        model, tree = tried, tried_tree
    result = settled(model)
    check_equilibrium(result, max(tolerance, 1e-6))
    return result


def check_equilibrium(model, tolerance=1e-6):
    """Return the `LinearTree` of a model; refuse it if the state is not at rest.

    Parameters
    ----------
    model : LinearModel
    tolerance : float
        Largest acceleration left over [m/s^2, rad/s^2].

    Raises
    ------
    ValueError
        Names the body or hinge with the largest acceleration, its value, and the tolerance.
    """
    tree = linearise(model)
    x, coordinate = unbalanced_accelerations(tree)
    if _largest((x, coordinate)) <= tolerance:
        return tree
    hinge_row, body_row = int(np.argmax(np.abs(coordinate))), int(np.argmax(np.abs(x).max(axis=1)))
    if np.abs(coordinate[hinge_row]) > 0.5 * np.abs(x[body_row]).max():
        body = model.bodies[hinge_row]
        what, value = f"hinge {body.hinge.number} of body {body.name!r}", coordinate[hinge_row]
    else:
        what, value = f"body {model.bodies[body_row].name!r}", x[body_row][np.argmax(np.abs(x[body_row]))]
    raise ValueError(
        f"{what}: acceleration is {value:.3g} m/s^2 or rad/s^2 in the given state, must be below {tolerance:g}: "
        "not a state of rest (find_equilibrium looks for one)"
    )


def _largest(accelerations):
    return max(np.abs(part).max() for part in accelerations)


def _work(tree, x, coordinate):
    """Work of the unbalanced loads along a motion."""
    return np.sum(tree.unbalanced * x) + tree.unbalanced_torque @ coordinate


def _newton_step(tree):
    """Return the motion x (n, 6) and of the hinges (n,) that takes away the unbalanced loads to first order.

    Where the stiffness has negative eigenvalues, as much inertia is added as makes it positive: then the step goes
    downhill in potential energy.
    """
    soft = tips_to_root(tree, np.array([SOFT]))
    inertia = tips_to_root(inertia_only(tree), np.array([SOFT]))
    loose = [_is_loose(tree, row, soft, inertia) for row in range(len(tree.kind))]
    tree = tree._replace(kind=["rigid" if loose[row] else kind for row, kind in enumerate(tree.kind)])
    added = SOFT
    while count_below(tree, [-added])[0] > 0 and added < 1e30:
        added = max(1.0, 2.0 * added)
    sweep = tips_to_root(tree, np.array([added]))
    x, coordinate = forced_motion(sweep, tree.unbalanced[None, :, :, None], tree.unbalanced_torque[None, :, None])
    return x[0, :, :, 0], coordinate[0, :, 0]


def _is_loose(tree, row, soft, inertia):
    """Whether nothing holds a hinge and nothing drives it."""
    if tree.kind[row] != "moving":
        return False
    turned = np.abs(inertia.pivot[row][0])
    return np.abs(soft.pivot[row][0]) < 10.0 * turned and np.abs(tree.unbalanced_torque[row]) * SOFT < 1e-9 * turned


def _moved(model, x, coordinate):
    """Return the state after a motion x (n, 6) of the free bodies and of the hinges (n,)."""
    rows = free_bodies(model.bodies)
    turned = Rotation.from_rotvec(x[rows, 3:]) * Rotation.from_quat(model.state.attitude, scalar_first=True)
    return model.state._replace(
        position=model.state.position + x[rows, :3],
        attitude=turned.as_quat(scalar_first=True),
        hinge=model.state.hinge + coordinate,
    )
