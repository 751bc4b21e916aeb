"""The vehicle at rest on a level road: how it stands, and what wheels and mounts carry."""

from typing import NamedTuple

import numpy as np

from ..rui.sweeps.cells import columns
from ..rui.sweeps.kinematics import MotionOffset, update_motion
from .coil import usable_current
from .equilibrium import static_equilibrium
from .mount_law import mount_force
from .mounts import mount_deflection, mounts_in_order
from .system import Operation, build_system, new_work


class Standing(NamedTuple):
    """Where hull and wheels are at rest, and what they carry."""

    wheel: np.ndarray  # (2, stations) of the shoes on each road wheel upwards, left and right, front first, N
    mount: dict  # name -> load (3,) on its body, mount's axes, N
    current: float  # in all coils, A
    sag: float  # of the hull below static ride height, m
    pitch: float  # of the hull, nose up, rad
    rise: np.ndarray  # (2, stations) of the wheels above static ride height, as seen from the hull, m
    deflection: np.ndarray  # (2, stations) of the torsion bars, as a rise of the wheel from where they are unloaded, m

    def share(self, bump_travel):
        """Return what share (2, stations) of its way from unloaded bar to bump stop each wheel has gone.

        `bump_travel` (stations,) or (1,) [m] is that from static ride height to the stop.
        """
        return self.deflection / (self.deflection + np.asarray(bump_travel) - self.rise)


def standing(vehicle):
    """Return the `Standing` of a vehicle with the middle of the usable currents in its coils.

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
    s, w, x, y, z = system.suspension, *state.tree.attitude[0]
    rise = s.reach * state.tree.hinge[s.row]
    return Standing(
        wheel.reshape(2, -1),
        loads,
        current,
        sag=-float(state.tree.position[0, 2]),
        pitch=-float(np.arcsin(2.0 * (w * y - x * z))),
        rise=rise.reshape(2, -1),
        deflection=(rise + s.preload * s.reach / s.bar_stiffness).reshape(2, -1),
    )
