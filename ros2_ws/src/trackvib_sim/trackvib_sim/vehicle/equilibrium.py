"""Static equilibrium of the standing vehicle on a level road, its tracks taken as springs."""

import numpy as np
from mr_mount_controller.node_base.plain_text import number
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from ..numerics.compiled import kernel
from ..rui.sweeps.articulated import open_cuts
from ..rui.sweeps.cells import columns
from ..rui.sweeps.elastic import apply_elastic_hinges
from ..rui.sweeps.kinematics import MotionOffset, update_motion
from ..rui.sweeps.response import ResponseOffset
from ..rui.sweeps.riccati import solve_accelerations
from .coil import settle_coils
from .hinge_springs import add_hinge_springs
from .mount_law import lay_fields
from .mounts import add_mounts
from .supports import add_supports
from .suspension import add_suspension
from .system import new_state, new_work

TOLERANCE = 1e-8  # m/s^2 and rad/s^2 left over
_LOAD_STEPS = 50  # of gravity
_NEWTON_STEPS = 12  # of each; where stops come and go, half a dozen are needed
_DIFFERENCE = 1e-7  # m or rad


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
    add_mounts(system.mounts, state.fields, work.motion, work.cuts, state.coils.field, 0.0, 0.0)
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
        The accelerations cannot be brought below `TOLERANCE`, or the weight acts beside the wheels.
    """
    state, work = new_state(system), new_work(system)
    settle_coils(system.coil, state.coils, current)
    lay_fields(system.mounts, state.coils.field, state.fields)
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

    def left_over(unknowns):
        residual(unknowns)
        # of all bodies: what nothing holds must not move either
        return max(np.abs(part).max() for part in accelerations(system, work))

    found = root(residual, np.zeros(free + len(held)), method="hybr", options={"xtol": 1e-14, "eps": 1e-8}).x
    left = left_over(found)
    if not left < TOLERANCE:
        left = min(left, left_over(_in_load_steps(residual, len(found), tree.gravity)))
    if not left < TOLERANCE:
        raise NoEquilibrium(
            f"no static equilibrium: the best place found still accelerates by {left:.3g} m/s^2 (or rad/s^2), "
            f"accepted: below {number(TOLERANCE)}; check masses and spring rates of the vehicle file"
        )
    _refuse_toppling(system.supports, columns(work.motion, MotionOffset.ORIGIN, 3))
    return state


def _refuse_toppling(supports, places):
    """The supports' springs would pull as well as push: where the weight acts must lie between the wheels."""
    hubs = places[supports.wheel]
    load = supports.vertical[0] * (supports.radius - hubs[:, 2])
    for axis, at, hub in zip("xy", load @ hubs / load.sum(), hubs.T, strict=False):
        if not hub.min() <= at <= hub.max():
            raise NoEquilibrium(
                f"no static equilibrium, it topples: the weight acts at {axis} = {at:.3f} m, accepted: between the "
                f"wheels, {hub.min():.3f} to {hub.max():.3f} m; check masses and their centres in the vehicle file"
            )


def _in_load_steps(residual, size, gravity):
    """Return the best zero of a residual (size,) that Newton's method finds while gravity grows to its value.

    A stop that comes into contact bends the residual. Updated Jacobians, as of Powell's method, do not get past that;
    new ones do, from a place that is near.
    """
    whole, place = gravity.copy(), np.zeros(size)
    shifts = _DIFFERENCE * np.eye(size)
    for share in np.arange(1, _LOAD_STEPS + 1) / _LOAD_STEPS:
        gravity[:] = share * whole
        for _ in range(_NEWTON_STEPS):
            left = residual(place)
            if not np.isfinite(left).all() or np.abs(left).max() < 0.1 * TOLERANCE:
                break
            slope = np.array([residual(place + shift) - residual(place - shift) for shift in shifts]).T
            if not np.isfinite(slope).all():
                break
            place = place - np.linalg.lstsq(slope / (2.0 * _DIFFERENCE), left)[0]
    gravity[:] = whole
    return place


def accelerations(system, work):
    """Return linear and angular acceleration (r, 3) of the free bodies, the hull first, and of the hinges (rows,)."""
    found = columns(work.response, ResponseOffset.LINEAR, ResponseOffset.SIZE)
    free = found[[system.tree.row[0], *system.tree.elastic.child]]
    return free[:, :3] + system.tree.gravity, free[:, 3:6], found[:, ResponseOffset.HINGE]
