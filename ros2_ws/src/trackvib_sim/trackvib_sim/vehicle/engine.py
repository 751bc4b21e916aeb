"""Excitation of the powertrain by the engine, order by order.

By default each order brings a force and a moment on the powertrain body, growing with speed squared as inertia forces
do. As an option the paper's excitation: a second-order displacement of 0.2 mm imposed across the mounts [Tao2025].

In a run-up speed grows linearly in time. Then speed squared grows linearly with the crank angle, so that the angle,
counted from where the run-up begins, says all.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import load3, rotate, scale
from ..numerics.units import RPM
from ..rui.sweeps.articulated import apply_force, apply_wrench
from ..rui.sweeps.kinematics import point_place, rotation

IMPOSED_ORDER = 2.0


@dataclass(frozen=True)
class RunUp:
    """A linear growth of the engine's speed, from that of the operation on."""

    begin: float  # s from the start of the run
    rate: float  # r/min a second, > 0
    end: float  # r/min at which it ends


class Engine(NamedTuple):
    """Amplitudes at the speed before any run-up, powertrain axes."""

    powertrain: int  # row in the tree
    speed: float  # rad/s of the crankshaft, before any run-up
    growth: float  # of speed squared during a run-up, by crank angle, relative to that before it, 1/rad
    highest: float  # (speed / that before it)^2 at which it ends
    place: np.ndarray  # (1, 3) where the forces act, in the powertrain, m
    orders: np.ndarray  # (m,) cycles a revolution
    force: np.ndarray  # (m, 3) N
    moment: np.ndarray  # (m, 3) N m
    phase: np.ndarray  # (m,) rad
    imposed_amplitude: float  # m; zero where forces excite


def build_engine(vehicle, rows, speed, imposed_displacement, run_up=None):
    """Return the record for an engine speed [r/min] and one of the two kinds of excitation.

    A `RunUp` starts where the crank angle passes zero upwards, see `angle_before`; it needs a running engine.
    """
    e = vehicle.engine
    growth = 0.0 if imposed_displacement else (speed / e.rated_speed) ** 2
    running = speed > 0.0
    return Engine(
        powertrain=rows["powertrain"],
        speed=speed * RPM,
        growth=2.0 * run_up.rate / (speed**2 * RPM) if run_up else 0.0,
        highest=(run_up.end / speed) ** 2 if run_up else 1.0,
        place=np.array([e.place]),
        orders=np.array(e.orders),
        force=growth * np.array(e.force),
        moment=growth * np.array(e.moment),
        phase=np.array(e.phase),
        imposed_amplitude=e.imposed_amplitude if imposed_displacement and running else 0.0,
    )


def angle_before(engine, time):
    """Return the crank angle [rad] a time [s] before a run-up begins."""
    return -engine.speed * time


@kernel
def speed_growth(engine, angle):
    """Return (speed / that before any run-up)^2 at a crank angle [rad]."""
    return min(1.0 + engine.growth * max(angle, 0.0), engine.highest)


@kernel
def turn_crank(engine, angle, dt):
    """Return the crank angle [rad] a time dt [s] later, exactly; without run-up within one cycle of all orders."""
    if engine.growth == 0.0:
        return (angle + dt * engine.speed) % (4.0 * np.pi)
    growth = speed_growth(engine, angle)
    running_up = angle >= 0.0 and growth < engine.highest
    acceleration = 0.5 * engine.growth * engine.speed**2 if running_up else 0.0
    return angle + dt * engine.speed * np.sqrt(growth) + 0.5 * dt**2 * acceleration


@kernel
def add_engine(engine, angle, motion, cuts):
    """Add the engine's forces and moments at a crank angle [rad] to the powertrain."""
    body = engine.powertrain
    turn = rotation(motion, body)
    place = point_place(motion, body, load3(engine.place, 0))
    growth = speed_growth(engine, angle)
    for i in range(engine.orders.size):
        wave = growth * np.sin(engine.orders[i] * angle + engine.phase[i])
        apply_force(cuts, motion, body, place, rotate(turn, scale(wave, load3(engine.force, i))))
        apply_wrench(cuts, body, (0.0, 0.0, 0.0), rotate(turn, scale(wave, load3(engine.moment, i))))


@kernel
def imposed_displacement(engine, angle):
    """Return the displacement imposed across the mounts [m] and its rate [m/s]."""
    phase = IMPOSED_ORDER * angle
    speed = engine.speed * np.sqrt(speed_growth(engine, angle))
    rate = engine.imposed_amplitude * IMPOSED_ORDER * speed * np.cos(phase)
    return engine.imposed_amplitude * np.sin(phase), rate
