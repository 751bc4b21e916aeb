"""Static equilibrium on a level road, and the state of a vehicle that rolls over it at constant speed."""

import numpy as np
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from ..road.store import Road
from ..rui.compiled import kernel
from ..rui.kinematics import update_motion
from ..rui.loads import clear_loads
from ..rui.riccati import solve_accelerations
from .hinge_springs import add_hinge_springs
from .mr_mounts import add_mounts
from .running_gear.wheels_on_road import add_wheels_on_road, radial_force
from .suspension import add_suspension
from .system import new_state, new_work

TOLERANCE = 1e-8  # m/s^2 and rad/s^2 left over
LEVEL = Road(-200, 0.1, np.zeros((2, 401)))


class NoEquilibrium(ValueError):
    """The vehicle's parameters have no static equilibrium near ride height."""


@kernel
def _static_accelerations(system, state, road, work):
    """Fill `work.sweep` with the accelerations that a standing vehicle would have with its engine off."""
    update_motion(system.tree, state.tree, work.motion)
    clear_loads(work.loads)
    add_hinge_springs(system.springs, state.tree, work.loads)
    add_suspension(system.suspension, state.tree, work.loads)
    add_mounts(system.mounts, work.motion, work.loads, state.currents, 0.0, 0.0)
    add_wheels_on_road(system.wheels, state.brushes, road, work.motion, work.loads, 0.0)
    solve_accelerations(system.tree, state.tree, work.motion, work.loads, work.sweep)


def static_equilibrium(system, current):
    """Return the state at rest on a level road at height zero with `current` [A] in both coils.

    The unknowns are height, roll and pitch of the hull and every hinge that a spring or the ground holds; wheels,
    rollers, sprockets and idlers may stand at any angle and stay at zero.

    Raises
    ------
    NoEquilibrium
        The accelerations cannot be brought below `TOLERANCE`.
    """
    state, work = new_state(system), new_work(system)
    state.currents[:] = current
    sprung = np.union1d(np.flatnonzero(system.springs.stiffness), system.mounts.powertrain)
    held = np.concatenate((sprung, system.suspension.row))

    def residual(unknowns):
        state.tree.position[2] = unknowns[0]
        state.tree.attitude[:] = np.roll(Rotation.from_euler("xy", unknowns[1:3]).as_quat(), 1)  # scalar first
        state.tree.hinge[held] = unknowns[3:]
        _static_accelerations(system, state, LEVEL, work)
        sweep = work.sweep
        return np.concatenate(([sweep.linear[0, 2]], sweep.angular[0, :2], sweep.hinge_acceleration[held]))

    guess = np.zeros(3 + len(held))
    guess[0] = -system.wheels.static_depth  # wheels must touch, or the residual does not feel the road
    found = root(residual, guess, method="hybr", options={"xtol": 1e-14, "eps": 1e-8})
    residual(found.x)
    sweep = work.sweep
    # all of them: what nothing holds must not move either
    left_over = max(np.abs(part).max() for part in (sweep.linear[0], sweep.angular[0], sweep.hinge_acceleration))
    if not left_over < TOLERANCE:
        raise NoEquilibrium(
            f"no static equilibrium: the best place found still accelerates by {left_over:.3g} m/s^2 (or rad/s^2), "
            f"accepted is < {TOLERANCE:g}; check masses and spring rates of the vehicle file"
        )
    return state


def rolling_state(system, current):
    """Return the equilibrium state set in motion: hull at the wanted speed, wheels rolling without slip.

    The driver already pulls with what the rubber's damping resists.
    """
    state = static_equilibrium(system, current)
    work = new_work(system)
    update_motion(system.tree, state.tree, work.motion)
    speed = system.driver.speed
    state.tree.velocity[0] = speed
    for side, row in zip(system.wheels.side, system.wheels.row, strict=True):
        hub = tuple(work.motion.origin[row])
        force, depth = radial_force(system.wheels, LEVEL, side, hub, (speed, 0.0, 0.0), (1.0, 0.0, 0.0))
        along = force[2] / np.linalg.norm(force)  # of the speed, at the contact that the rubber's damping tilts
        state.tree.hinge_rate[row] = speed * along / (system.wheels.radius - depth)
        state.speed_integral[0] -= force[0]
    return state
