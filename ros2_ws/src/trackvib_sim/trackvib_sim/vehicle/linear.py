"""The standing vehicle as a linear model about its equilibrium, for modes and frequency responses."""

import numpy as np

from ..rui.cells import columns
from ..rui.kinematics import ORIGIN, ROTATION, update_motion
from ..rui.linear_model import GroundSpring, LinearModel, Mount
from ..rui.state import no_loads
from ..rui.tree import new_rows, to_table
from .body_tree import body_table
from .equilibrium import LEVEL, static_equilibrium
from .hinge_springs import add_hinge_springs
from .mr_mounts import mount_characteristics, mount_deflection, mount_force
from .running_gear.wheels_on_road import radial_force
from .suspension import add_suspension
from .system import new_work

SMALL = 1e-7  # m and m/s, for the slopes of the tyres' force
AHEAD = (1.0, 0.0, 0.0)


def linear_vehicle(vehicle, system, current):
    """Return the `rui.linear_model.LinearModel` of a vehicle at rest on level road.

    The wheels stand: their tangential brushes hold like springs. Shock absorbers have the slope of small speeds, the MR
    mounts k(I) and c(I) of a constant current [A], the same in both coils.

    Raises
    ------
    NoEquilibrium
        The vehicle cannot stand.
    """
    bodies = tuple(body_table(vehicle))
    state = static_equilibrium(system, current)
    work = new_work(system)
    update_motion(system.tree, state.tree, work.motion)
    stiffness, damping, torque = new_rows(system.tree), new_rows(system.tree), new_rows(system.tree)
    add_hinge_springs(system.springs, state.tree, torque)
    add_suspension(system.suspension, state.tree, torque)
    np.add.at(stiffness, system.springs.row, system.springs.stiffness)
    np.add.at(damping, system.springs.row, system.springs.damping)
    s = system.suspension
    stiffness[s.row] += s.bar_stiffness
    damping[s.row] += s.friction + s.has_shock * s.shock_damping * s.length**2
    row = system.tree.row
    return LinearModel(
        bodies=bodies,
        state=to_table(system.tree, state.tree),
        gravity=tuple(system.tree.gravity),
        stiffness=stiffness[row],
        damping=damping[row],
        springs=tuple(_ground(system, bodies, work.motion)),
        mounts=tuple(_mounts(system, work.motion, current)),
        loads=no_loads(bodies)._replace(torque=torque[row]),
    )


def _mounts(system, motion, current):
    mounts = system.mounts
    k, c = mount_characteristics(mounts, current)
    for index in range(2):
        _, deflection, _ = mount_deflection(mounts, motion, index, 0.0, 0.0)
        force, _ = mount_force(mounts, current, deflection, (0.0, 0.0, 0.0))
        k_axes, c_axes = np.diag(k * mounts.stiffness_ratio), np.diag(c * mounts.damping_ratio)
        yield Mount("powertrain", mounts.upper[index], k_axes, c_axes, np.array(force))


def _ground(system, bodies, motion):
    """Two springs a wheel: the radial ones push on the hub and do not turn with the wheel, the brush does."""
    wheels = system.wheels
    name = {row: body.name for body, row in zip(bodies, system.tree.row.tolist(), strict=True)}
    origin, rotation = columns(motion, ORIGIN, 3), columns(motion, ROTATION, 9).reshape(-1, 3, 3)
    brush = [np.diag([wheels.longitudinal[i], wheels.lateral[i], 0.0]) for i in range(2)]
    for row, side in zip(wheels.row.tolist(), wheels.side, strict=True):
        force, depth, stiffness, damping = _radial(wheels, side, tuple(origin[row]))
        yield GroundSpring(name[row], np.zeros(3), stiffness, damping, np.array([0.0, 0.0, force]))
        below = np.array([0.0, 0.0, depth - wheels.radius])  # of the hub, global axes
        yield GroundSpring(name[row], rotation[row].T @ below, *brush)


def _radial(wheels, side, hub):
    """Vertical force [N], depth [m], and by differences the force's slopes (3, 3) with place [N/m] and speed [N s/m].

    On level road the force does not depend on where along it the wheel stands, and the oblique springs damp forward
    motion, too.
    """

    def force(height, forward, upward):
        place = (hub[0], hub[1], hub[2] + height)
        return radial_force(wheels, LEVEL, side, place, (forward, 0.0, upward), AHEAD)

    now, depth = force(0.0, 0.0, 0.0)
    slopes = [
        (force(*-step)[0][axis] - force(*step)[0][axis]) / (2.0 * SMALL)
        for step, axis in zip(SMALL * np.eye(3), (2, 0, 2), strict=True)
    ]
    return now[2], depth, np.diag([0.0, 0.0, slopes[0]]), np.diag([slopes[1], 0.0, slopes[2]])
