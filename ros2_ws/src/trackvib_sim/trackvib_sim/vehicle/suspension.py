"""Torsion bars, shock absorbers and bump stops between hull and swing arms."""

from math import asin, cos, radians, sin
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from .body_tree import SIDES, STATIONS, arm_name


class Suspension(NamedTuple):
    """The twelve swing arms; angles are jounce positive and zero at static ride height."""

    row: np.ndarray  # (12,) row of the arm in the tree
    has_shock: np.ndarray  # (12,) 1.0 or 0.0
    length: float  # m
    bar_stiffness: float  # N m/rad
    preload: float  # N m that the bar holds at angle zero
    friction: float  # N m s/rad
    shock_damping: float  # N s/m at the wheel
    blow_off_force: float  # N
    blow_off_damping: float  # N s/m beyond the blow-off force
    stop_angle: float  # rad
    stop_stiffness: float  # N m/rad
    stop_damping: float  # N m s/rad


def build_suspension(vehicle, rows, load):
    """Return the record for the vehicle; `load` [N] is what the twelve bars carry in equal shares at angle zero."""
    arms, shocks = vehicle.swing_arms, vehicle.shock_absorbers
    angle = radians(arms.static_angle)
    reach = arms.length * cos(angle)
    share = load / (len(SIDES) * STATIONS)
    carriers = {int(station) - 1 for station in shocks.stations}
    return Suspension(
        row=np.array([rows[arm_name(side, station)] for side in SIDES for station in range(STATIONS)]),
        has_shock=np.array([float(station in carriers) for _ in SIDES for station in range(STATIONS)]),
        length=arms.length,
        bar_stiffness=arms.wheel_rate * reach**2,
        preload=share * reach,
        friction=arms.friction * arms.length**2,
        shock_damping=shocks.damping,
        blow_off_force=shocks.blow_off_force,
        blow_off_damping=shocks.blow_off_damping,
        stop_angle=angle - asin(sin(angle) - arms.bump_travel / arms.length),
        stop_stiffness=arms.bump_stiffness * arms.length**2,
        stop_damping=arms.bump_damping * arms.length**2,
    )


@kernel
def shock_force(suspension, speed):
    """Return the force of a shock absorber against a wheel speed [m/s]: linear up to the blow-off force."""
    force = suspension.shock_damping * abs(speed)
    if force > suspension.blow_off_force:
        beyond = abs(speed) - suspension.blow_off_force / suspension.shock_damping
        force = suspension.blow_off_force + suspension.blow_off_damping * beyond
    return force if speed >= 0.0 else -force


@kernel
def add_suspension(suspension, state, torques):
    """Add the torques of bars, friction, shock absorbers and bump stops to the arms' hinges."""
    s = suspension
    for i in range(s.row.size):
        b = s.row[i]
        angle, rate = state.hinge[b], state.hinge_rate[b]
        torque = -s.preload - s.bar_stiffness * angle - s.friction * rate
        torque -= s.has_shock[i] * s.length * shock_force(s, s.length * rate)
        if angle > s.stop_angle:
            # a stop only pushes
            torque += min(0.0, -s.stop_stiffness * (angle - s.stop_angle) - s.stop_damping * rate)
        torques[b] += torque
