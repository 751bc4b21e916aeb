"""Linear springs and dampers in the hinges: gun drives, recuperator, rubber mounts of the powertrain, bearings."""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined
from .body_tree import bodies_on_hinges, running_gear_kind


class HingeSprings(NamedTuple):
    """Those that are there, in the units of their hinges."""

    row: np.ndarray  # (m,) row of the child in the tree
    stiffness: np.ndarray  # (m,) N m/rad or N/m
    damping: np.ndarray  # (m,) N m s/rad or N s/m


def build_hinge_springs(vehicle, rows):
    """Return the record for the vehicle; `rows` maps body names to rows of the tree."""
    springs = [
        (rows[name], body.stiffness, body.damping)
        for name, body in bodies_on_hinges(vehicle).items()
        if body.hinge in ("revolute", "prismatic")
    ]
    bearings = {
        "wheel": vehicle.road_wheels,
        "sprocket": vehicle.sprockets,
        "roller": vehicle.carrier_rollers,
        "idler": vehicle.idlers,
    }
    for kind, section in bearings.items():
        if section is not None and section.bearing_damping > 0.0:
            springs += [(rows[name], 0.0, section.bearing_damping) for name in rows if running_gear_kind(name) == kind]
    row, stiffness, damping = zip(*springs, strict=True) if springs else ((), (), ())
    return HingeSprings(np.array(row, dtype=np.int64), np.array(stiffness, float), np.array(damping, float))


@inlined
def add_hinge_springs(springs, state, torques):
    """Add the spring and damper torques to the hinges."""
    for k in range(springs.row.size):
        b = springs.row[k]
        torques[b] -= springs.stiffness[k] * state.hinge[b] + springs.damping[k] * state.hinge_rate[b]
