"""What wheels and mounts carry in the vehicle at rest on a level road."""

from typing import NamedTuple

import numpy as np

from ..rui.sweeps.cells import columns
from ..rui.sweeps.kinematics import MotionOffset, update_motion
from ..vehicle.coil import usable_current
from ..vehicle.equilibrium import static_equilibrium
from ..vehicle.mount_law import mount_force
from ..vehicle.mounts import mount_deflection, mounts_in_order
from ..vehicle.system import Operation, build_system, new_work


class StandingLoads(NamedTuple):
    """Loads at rest."""

    wheel: np.ndarray  # (2, stations) of the shoes on each road wheel upwards, left and right, front first, N
    mount: dict  # name -> load (3,) on its body, mount's axes, N
    current: float  # in all coils, A


def standing_loads(vehicle):
    """Return the `StandingLoads` of a vehicle with the middle of the usable currents in its coils.

    Raises
    ------
    NoEquilibrium
        The vehicle cannot stand.
    TrackDoesNotFit
        The links do not close round the running gear.
    """
    current = float(np.mean(usable_current(vehicle)))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    state, motion = static_equilibrium(system, current), new_work(system).motion
    update_motion(system.tree, state.tree, motion)
    supports = system.supports
    height = columns(motion, MotionOffset.ORIGIN, 3)[supports.wheel, 2]
    loads = {}
    for index, (name, _) in enumerate(mounts_in_order(vehicle)):
        _, deflection, _ = mount_deflection(system.mounts, motion, index, 0.0, 0.0)
        force, _ = mount_force(system.mounts, state.fields, index, current, deflection, (0.0, 0.0, 0.0))
        loads[name] = np.array(force)
    wheel = supports.vertical[0] * (supports.radius - height)
    return StandingLoads(wheel.reshape(2, -1), loads, current)
