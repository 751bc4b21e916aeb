"""Static equilibrium of the standing vehicle on a level road, its tracks taken as springs."""

import numpy as np
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from ..numerics.compiled import kernel
from ..rui.sweeps.articulated import open_cuts
from ..rui.sweeps.cells import columns
from ..rui.sweeps.elastic import apply_elastic_hinges
from ..rui.sweeps.kinematics import update_motion
from ..rui.sweeps.riccati import ResponseOffset, solve_accelerations
from .coil import settle_coils
from .hinge_springs import add_hinge_springs
from .mounts import add_mounts
from .supports import add_supports
from .suspension import add_suspension
from .system import new_state, new_work

TOLERANCE = 1e-8  # m/s^2 and rad/s^2 left over


class NoEquilibrium(ValueError):
    """The vehicle's parameters have no static equilibrium near ride height."""


@kernel
def _static_accelerations(system, state, work):
    """Fill `work.response` with the accelerations that a standing vehicle would have with its engine off."""
    work.torques[:] = 0.0
    add_hinge_springs(system.springs, state.tree, work.torques)
    add_suspension(system.suspension, state.tree, work.torques)
    update_motion(system.tree, state.tree, work.motion)
    open_cuts(system.tree, work.motion, work.torques, work.cuts)
    apply_elastic_hinges(system.tree, work.motion, work.cuts)
    add_mounts(system.mounts, work.motion, work.cuts, state.coils.field, 0.0, 0.0)
    add_supports(system.supports, work.motion, work.cuts)
    solve_accelerations(system.tree, work.motion, work.cuts, work.response)


def static_equilibrium(system, current):
    """Return the state at rest on a level road at height zero with `current` [A] in all coils.

    The unknowns are place and attitude of the hull and of every body on mounts or an elastic hinge, and every hinge
    that a spring or the ground holds; wheels, rollers, sprockets and idlers may stand at any angle and stay at zero.
    The tracks are not laid.

    Raises
    ------
    NoEquilibrium
        The accelerations cannot be brought below `TOLERANCE`.
    """
    state, work = new_state(system), new_work(system)
    settle_coils(system.coil, state.coils, current)
    springs, tree, origin = system.springs, system.tree, state.tree.position.copy()
    mounted = np.intersect1d(system.mounts.body, tree.row[tree.moves])
    sprung = np.union1d(springs.row[springs.stiffness > 0.0], mounted)
    held = np.concatenate((sprung, system.suspension.row)).astype(np.int64)
    free = 6 * len(origin)

    def residual(unknowns):
        state.tree.position[:] = origin + unknowns[:free].reshape(-1, 6)[:, :3]
        turned = Rotation.from_euler("xyz", unknowns[:free].reshape(-1, 6)[:, 3:])
        state.tree.attitude[:] = np.roll(turned.as_quat(), 1, axis=-1)  # scalar first
        state.tree.hinge[held] = unknowns[free:]
        _static_accelerations(system, state, work)
        linear, angular, hinges = accelerations(system, work)
        return np.concatenate((np.hstack((linear, angular)).ravel(), hinges[held]))

    found = root(residual, np.zeros(free + len(held)), method="hybr", options={"xtol": 1e-14, "eps": 1e-8})
    residual(found.x)
    # all of them: what nothing holds must not move either
    left_over = max(np.abs(part).max() for part in accelerations(system, work))
    if not left_over < TOLERANCE:
        raise NoEquilibrium(
            f"no static equilibrium: the best place found still accelerates by {left_over:.3g} m/s^2 (or rad/s^2), "
            f"accepted is < {TOLERANCE:g}; check masses and spring rates of the vehicle file"
        )
    return state


def accelerations(system, work):
    """Return linear and angular acceleration (r, 3) of the free bodies, the hull first, and of the hinges (rows,)."""
    found = columns(work.response, ResponseOffset.LINEAR, ResponseOffset.SIZE)
    free = found[[system.tree.row[0], *system.tree.elastic.child]]
    return free[:, :3] + system.tree.gravity, free[:, 3:6], found[:, ResponseOffset.HINGE]
