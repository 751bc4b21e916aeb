"""What stands on the powertrain's mounts, reduced to a plane for control laws, and what one MR mount does."""

from math import hypot

import numpy as np
from mr_mount_controller.mount import PUBLISHED, MountCurve
from mr_mount_controller.mounting import Carried

from .body_tree import SIDES, bodies_on_hinges, build_body_table, sprung_bodies
from .mounts import KN_PER_MM, mounts_in_order
from .parameters import POWERTRAIN
from .running_gear_parameters import at_stations
from .sensors import sensors_of

_LEAST_LEVER = 1e-3  # m, of mounts from the pivot; nearer ones cannot hold the powertrain from turning


def carried_by_mounts(vehicle):
    """Return the `Carried` of a vehicle.

    The powertrain's pivot is its hinge if that turns about the y axis, otherwise its centre of mass.
    """
    powertrain = bodies_on_hinges(vehicle)[POWERTRAIN]
    masses = {body.name: body.mass for body in build_body_table(vehicle)}
    sprung = sum(masses[name] for name in sprung_bodies(vehicle)) - powertrain.mass
    hinged = powertrain.hinge == "revolute" and abs(powertrain.axis[1]) == max(map(abs, powertrain.axis))
    pivot = np.zeros(3) if hinged else np.array(powertrain.centre)
    centre = np.array(powertrain.centre) - pivot
    inertia = powertrain.inertia[1] + powertrain.mass * hypot(centre[0], centre[2]) ** 2
    mounts = [mount for _, mount in mounts_in_order(vehicle) if mount.body == POWERTRAIN]
    mr = [mount for mount in mounts if vehicle.mount_types[mount.type].kind == "mr"]
    rubber = [mount for mount in mounts if mount not in mr]
    _, sensor, *_ = sensors_of(vehicle)
    lever = float(np.mean([mount.place[0] for mount in mr]) - pivot[0]) if mr else 0.0
    turns = hinged and abs(lever) > _LEAST_LEVER
    other = sum(
        vehicle.mount_types[mount.type].stiffness[2] * (((mount.place[0] - pivot[0]) / lever) ** 2 if turns else 1.0)
        for mount in rubber
    )
    return Carried(
        hull_mass=_rounded(sprung),
        suspension_stiffness=_vertical(vehicle, vehicle.swing_arms.wheel_rate),
        suspension_damping=_vertical(vehicle, vehicle.swing_arms.friction)
        + _vertical(vehicle, vehicle.shock_absorbers.damping),
        powertrain_mass=_rounded(powertrain.mass),
        pivot_inertia=_rounded(inertia),
        centre=(_rounded(centre[0]), _rounded(centre[2])),
        sensor=(_rounded(sensor.place[0] - pivot[0]), _rounded(sensor.place[2] - pivot[2])),
        coupling=_rounded(centre[0] / lever) if turns else 1.0,
        mount_mass=_rounded(inertia / lever**2 if turns else powertrain.mass),
        other_stiffness=_rounded(other + (powertrain.stiffness / lever**2 if turns else 0.0)),
    )


def curve_of(vehicle):
    """Return the `MountCurve` of the first MR mount of a vehicle, which stands for all; the published one if none."""
    kinds = [vehicle.mount_types[mount.type] for _, mount in mounts_in_order(vehicle)]
    mr = [kind for kind in kinds if kind.kind == "mr"]
    if not mr:
        return PUBLISHED
    coil = vehicle.coil
    return MountCurve(
        stiffness_fit=tuple(KN_PER_MM * coefficient for coefficient in mr[0].stiffness_fit),
        damping_ratio_fit=tuple(mr[0].damping_ratio_fit),
        carried_mass=mr[0].carried_mass,
        rubber_damping_ratio=mr[0].rubber_damping_ratio,
        lowest=mr[0].current_range[0],
        highest=mr[0].current_range[1],
        coil_lag=coil.time_constant if coil.model == "lag" else coil.loop_time_constant,
    )


def _vertical(vehicle, at_wheels):
    """Return the sum over all wheels of what there is at each station."""
    return _rounded(len(SIDES) * np.sum(at_stations(at_wheels, vehicle.swing_arms.stations)))


def _rounded(value):
    """Return a number to nine digits: what is told must not differ in its last bits from one machine to the next."""
    return float(f"{value:.9g}")
