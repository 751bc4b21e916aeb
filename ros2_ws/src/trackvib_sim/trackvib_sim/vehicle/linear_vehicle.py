"""The standing vehicle as a linear model about its equilibrium, for modes and frequency responses."""

import numpy as np

from ..rui.linear.model import GroundSpring, LinearModel, Mount
from ..rui.state import no_loads
from ..rui.sweeps.cells import columns
from ..rui.sweeps.kinematics import MotionOffset, point_place, update_motion
from ..rui.sweeps.tree import new_rows, to_table
from .body_tree import SIDES, build_body_table
from .equilibrium import static_equilibrium
from .hinge_springs import add_hinge_springs
from .mount_law import mount_axes, mount_force
from .mounts import mount_deflection
from .supports import pulls
from .suspension import add_suspension
from .system import new_work


def build_linear_vehicle(vehicle, system, current):
    """Return the `rui.linear_model.LinearModel` of a vehicle at rest on level road.

    The tracks are springs and the sprockets braked (`supports`). Shock absorbers have the slope of small speeds, the MR
    mounts k(I) and c(I) of a constant current [A], the same in all coils.

    Raises
    ------
    NoEquilibrium
        The vehicle cannot stand.
    """
    bodies = tuple(build_body_table(vehicle))
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
    damping[s.row] += s.friction + s.shock_damping * s.reach**2
    row = system.tree.row
    return LinearModel(
        bodies=bodies,
        state=to_table(system.tree, state.tree),
        gravity=tuple(system.tree.gravity),
        stiffness=stiffness[row],
        damping=damping[row],
        springs=tuple(_ground(system, bodies, work.motion)),
        mounts=tuple(_mounts(system, bodies, work.motion, state.fields, current)),
        loads=no_loads(bodies)._replace(torque=torque[row]),
    )


def _mounts(system, bodies, motion, fields, current):
    mounts = system.mounts
    name = {row: body.name for body, row in zip(bodies, system.tree.row.tolist(), strict=True)}
    for index, body in enumerate(mounts.body.tolist()):
        turn = mounts.axes[index].reshape(3, 3)
        k, c = (turn @ np.diag(along) @ turn.T for along in mount_axes(mounts, index, current))
        _, deflection, _ = mount_deflection(mounts, motion, index, 0.0, 0.0)
        force, _ = mount_force(mounts, fields, index, current, deflection, (0.0, 0.0, 0.0))
        yield Mount(name[body], mounts.upper[index], k, c, turn @ force)


def _ground(system, bodies, motion):
    """Springs push on the hubs, which do not turn with the wheels, and hold the hull where the sprockets are."""
    supports = system.supports
    name = {row: body.name for body, row in zip(bodies, system.tree.row.tolist(), strict=True)}
    hub = columns(motion, MotionOffset.ORIGIN, 3)
    wheel = [np.diag([0.0, supports.lateral[i], supports.vertical[i]]) for i in range(2)]
    sides = np.repeat(list(SIDES.values()), len(supports.wheel) // len(SIDES))
    for row, side in zip(supports.wheel.tolist(), sides, strict=True):
        away = np.array([0.0, side * supports.brake[0, 1], supports.radius]) - hub[row]
        yield GroundSpring(name[row], np.zeros(3), *wheel, wheel[0] @ away)
    brake = [np.diag([supports.longitudinal[i], 0.0, 0.0]) for i in range(2)]
    for place in supports.brake:
        held = point_place(motion, supports.hull, tuple(place))
        yield GroundSpring(name[supports.hull], place, *brake, brake[0] @ (place - held))
    for row, point, force in pulls(supports):
        yield GroundSpring(name[row], point, force=force)
