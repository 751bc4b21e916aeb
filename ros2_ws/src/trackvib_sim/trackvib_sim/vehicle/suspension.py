"""Torsion bars, shock absorbers and bump stops between hull and swing arms."""

from math import asin, cos, radians, sin
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined
from .body_tree import SIDES, arm_name
from .running_gear_parameters import at_stations


class Suspension(NamedTuple):
    """All swing arms, a arms; angles are jounce positive and zero at static ride height."""

    row: np.ndarray  # (a,) row of the arm in the tree
    reach: float  # m, of an arm along x at angle zero: how far a wheel rises for each radian there
    bar_stiffness: np.ndarray  # (a,) N m/rad
    preload: np.ndarray  # (a,) N m that the bar holds at angle zero
    friction: np.ndarray  # (a,) N m s/rad
    shock_damping: np.ndarray  # (a,) N s/m at the wheel; zero without a shock absorber
    blow_off_force: np.ndarray  # (a,) N
    blow_off_damping: np.ndarray  # (a,) N s/m beyond the blow-off force
    stop_angle: np.ndarray  # (a,) rad
    stop_stiffness: np.ndarray  # (a,) N m/rad
    stop_damping: np.ndarray  # (a,) N m s/rad


def build_suspension(vehicle, rows, load):
    """Return the record for the vehicle.

    `load` [N] is what all bars carry in equal shares at angle zero, unless the file gives their preload.
    """
    arms, shocks = vehicle.swing_arms, vehicle.shock_absorbers
    stations, angle = arms.stations, radians(arms.static_angle)
    reach = arms.length * cos(angle)

    def both_sides(values, factor=1.0):
        return np.tile(factor * at_stations(values, stations), len(SIDES))

    share = load / (len(SIDES) * stations)
    stop = [angle - asin(sin(angle) - travel / arms.length) for travel in arms.bump_travel]
    return Suspension(
        row=np.array([rows[arm_name(side, station)] for side in SIDES for station in range(stations)]),
        reach=reach,
        bar_stiffness=both_sides(arms.wheel_rate, reach**2),
        preload=both_sides(arms.preload or [share * reach]),
        friction=both_sides(arms.friction, reach**2),
        shock_damping=both_sides(shocks.damping),
        blow_off_force=both_sides(shocks.blow_off_force),
        blow_off_damping=both_sides(shocks.blow_off_damping),
        stop_angle=both_sides(stop),
        stop_stiffness=both_sides(arms.bump_stiffness, reach**2),
        stop_damping=both_sides(arms.bump_damping, reach**2),
    )


@inlined
def shock_force(suspension, i, speed):
    """Return the force of arm i's shock absorber against a wheel speed [m/s]: linear up to the blow-off force."""
    damping, blow_off = suspension.shock_damping[i], suspension.blow_off_force[i]
    force = damping * abs(speed)
    if force > blow_off:
        force = blow_off + suspension.blow_off_damping[i] * (abs(speed) - blow_off / damping)
    return force if speed >= 0.0 else -force


@inlined
def add_suspension(suspension, state, torques):
    """Add the torques of bars, friction, shock absorbers and bump stops to the arms' hinges."""
    s = suspension
    for i in range(s.row.size):
        b = s.row[i]
        angle, rate = state.hinge[b], state.hinge_rate[b]
        torque = -s.preload[i] - s.bar_stiffness[i] * angle - s.friction[i] * rate
        torque -= s.reach * shock_force(s, i, s.reach * rate)
        if angle > s.stop_angle[i]:
            # a stop only pushes
            torque += min(0.0, -s.stop_stiffness[i] * (angle - s.stop_angle[i]) - s.stop_damping[i] * rate)
        torques[b] += torque
