"""Gearbox, final drives and shafts: engine speed follows the sprockets' through the gear, torque goes the other way.

All is counted at the sprockets: an engine of inertia J in a gear of ratio i (crankshaft over sprocket) turns there as
J i^2 with the speed of the crankshaft over i. A spring and damper, the shafts, join it to the mean of both sprockets,
so that the ripple of the engine's torque reaches them as far as their stiffness lets it.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import kernel
from ...numerics.table import interpolate
from ...numerics.units import RPM


class Driveline(NamedTuple):
    """Properties; without gears the engine keeps a speed of its own, and the driver turns the sprockets directly."""

    ratio: np.ndarray  # (g,) crankshaft over sprocket, from the first gear on; empty without gears
    shift_up: float  # rad/s of the crankshaft
    shift_down: float  # rad/s
    idle: float  # rad/s, below which the torque converter slips
    curve_speed: np.ndarray  # (n,) rad/s
    curve_torque: np.ndarray  # (n,) at full load, N m
    efficiency: float
    inertia: float  # kg m^2 of engine and flywheel
    stiffness: float  # N m/rad of both shafts, at the sprockets
    damping: float  # N m s/rad
    ripple: np.ndarray  # (m,) of the torque by engine order, at rated speed, N m


class Shaft(NamedTuple):
    """State of the driveline, changed in place."""

    gear: np.ndarray  # (1,) from 1 on; 0 without gears
    rate: np.ndarray  # (1,) of the engine's end, at the sprockets, rad/s
    twist: np.ndarray  # (1,) of it against the mean of both sprockets, rad


def build_driveline(vehicle, gears):
    """Return the record for a vehicle, with its gears or without.

    Raises
    ------
    ValueError
        The vehicle has no gears.
    """
    d, m = vehicle.driveline, len(vehicle.engine.orders)
    if not gears:
        return Driveline(np.zeros(0), 0.0, 0.0, 0.0, np.zeros(1), np.zeros(1), 1.0, 1.0, 0.0, 0.0, np.zeros(m))
    if d is None:
        raise ValueError(f"gears are requested, but vehicle {vehicle.name!r} has no section driveline")
    return Driveline(
        ratio=np.array(d.ratios),
        shift_up=d.shift_up * RPM,
        shift_down=d.shift_down * RPM,
        idle=vehicle.engine.speed_range[0] * RPM,
        curve_speed=np.array(d.curve_speed) * RPM,
        curve_torque=np.array(d.curve_torque),
        efficiency=d.efficiency,
        inertia=d.inertia,
        stiffness=d.stiffness,
        damping=d.damping,
        ripple=np.array(d.ripple),
    )


def new_shaft(driveline, rate):
    """Return the state at a speed of the sprockets [rad/s], in the gear that a driver would have there."""
    shaft = Shaft(np.zeros(1, np.int64), np.full(1, float(rate)), np.zeros(1))
    if driveline.ratio.size:
        shaft.gear[0] = (
            1
            + np.flatnonzero(
                (driveline.ratio * abs(rate) <= driveline.shift_up) | (driveline.ratio == driveline.ratio[-1])
            )[0]
        )
    return shaft


@kernel
def crank_speed(driveline, shaft):
    """Return the speed [rad/s] of the crankshaft in the gear."""
    return max(driveline.ratio[shaft.gear[0] - 1] * abs(shaft.rate[0]), driveline.idle)


@kernel
def full_load(driveline, shaft):
    """Return the torque [N m] on both sprockets that the engine gives in the gear at full load."""
    speed = crank_speed(driveline, shaft)
    torque = interpolate(driveline.curve_speed, driveline.curve_torque, speed)
    # the governor cuts off within a tenth beyond the curve's end
    over = (speed - driveline.curve_speed[-1]) / (0.1 * driveline.curve_speed[-1])
    return torque * min(max(1.0 - over, 0.0), 1.0) * driveline.efficiency * driveline.ratio[shaft.gear[0] - 1]


@kernel
def turn_shaft(driveline, shaft, torque, ripple, sprockets, dt):
    """Advance the shafts by dt, with the engine's torque and its ripple [N m] at the sprockets; shift where it is time.

    `sprockets` is the mean of their speeds [rad/s]. Returns the torque [N m] on both sprockets.
    """
    ratio = driveline.ratio[shaft.gear[0] - 1]
    passed = driveline.stiffness * shaft.twist[0] + driveline.damping * (shaft.rate[0] - sprockets)
    shaft.rate[0] += dt * (torque + ripple - passed) / (driveline.inertia * ratio * ratio)
    shaft.twist[0] += dt * (shaft.rate[0] - sprockets)
    speed = crank_speed(driveline, shaft)
    if speed > driveline.shift_up and shaft.gear[0] < driveline.ratio.size:
        shaft.gear[0] += 1
    elif speed < driveline.shift_down and shaft.gear[0] > 1:
        shaft.gear[0] -= 1
    return passed
