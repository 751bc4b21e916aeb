"""Linear springs and dampers in the hinges: gun drives, recuperator, rubber mounts of the powertrain, bearings."""

from typing import NamedTuple

import numpy as np

from ..rui.compiled import kernel


class HingeSprings(NamedTuple):
    """One row a body of the tree, in the units of its hinge."""

    stiffness: np.ndarray  # (n,) N m/rad or N/m
    damping: np.ndarray  # (n,) N m s/rad or N s/m


def hinge_springs(vehicle, rows):
    """Return the record for the vehicle; `rows` maps body names to rows of the tree."""
    springs = HingeSprings(np.zeros(len(rows)), np.zeros(len(rows)))
    for name in ("turret", "gun_mount", "recoil_part", "powertrain"):
        section = getattr(vehicle, name)
        springs.stiffness[rows[name]] = section.stiffness
        springs.damping[rows[name]] = section.damping
    bearings = {
        "wheel_": vehicle.road_wheels,
        "sprocket_": vehicle.sprockets,
        "roller_": vehicle.carrier_rollers,
        "idler_": vehicle.idlers,
    }
    for prefix, section in bearings.items():
        for name, row in rows.items():
            if name.startswith(prefix):
                springs.damping[row] = section.bearing_damping
    return springs


@kernel
def add_hinge_springs(springs, state, loads):
    """Add the spring and damper torques to the hinges."""
    for b in range(1, springs.stiffness.size):
        loads.torque[b] -= springs.stiffness[b] * state.hinge[b] + springs.damping[b] * state.hinge_rate[b]
