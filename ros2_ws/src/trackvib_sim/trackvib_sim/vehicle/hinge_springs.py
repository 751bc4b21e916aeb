"""Linear springs and dampers in the hinges: gun drives, recuperator, rubber mounts of the powertrain, bearings."""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel


class HingeSprings(NamedTuple):
    """Those that are there, in the units of their hinges."""

    row: np.ndarray  # (m,) row of the child in the tree
    stiffness: np.ndarray  # (m,) N m/rad or N/m
    damping: np.ndarray  # (m,) N m s/rad or N s/m


def build_hinge_springs(vehicle, rows):
    """Return the record for the vehicle; `rows` maps body names to rows of the tree."""
    springs = [
        (rows[name], section.stiffness, section.damping)
        for name in ("turret", "gun_mount", "recoil_part", "powertrain")
        for section in (getattr(vehicle, name),)
    ]
    bearings = {
        "wheel_": vehicle.road_wheels,
        "sprocket_": vehicle.sprockets,
        "roller_": vehicle.carrier_rollers,
        "idler_": vehicle.idlers,
    }
    for prefix, section in bearings.items():
        if section.bearing_damping > 0.0:
            springs += [(row, 0.0, section.bearing_damping) for name, row in rows.items() if name.startswith(prefix)]
    row, stiffness, damping = zip(*springs, strict=True)
    return HingeSprings(np.array(row), np.array(stiffness), np.array(damping))


@kernel
def add_hinge_springs(springs, state, torques):
    """Add the spring and damper torques to the hinges."""
    for k in range(springs.row.size):
        b = springs.row[k]
        torques[b] -= springs.stiffness[k] * state.hinge[b] + springs.damping[k] * state.hinge_rate[b]
