"""Excitation of the powertrain by the engine, order by order.

By default each order brings a force and a moment on the powertrain body, growing with speed squared as inertia forces
do. As an option the paper's excitation: a second-order displacement of 0.2 mm imposed across the mounts [Tao2025].
"""

from math import pi
from typing import NamedTuple

import numpy as np

from ..rui.compiled import kernel
from ..rui.cuts import apply_force, apply_wrench
from ..rui.kinematics import point_place, rotation
from ..rui.spatial import load3, rotate, scale

IMPOSED_ORDER = 2.0


class Engine(NamedTuple):
    """Amplitudes at the running speed, powertrain axes."""

    powertrain: int  # row in the tree
    speed: float  # rad/s of the crankshaft
    place: np.ndarray  # (1, 3) where the forces act, in the powertrain, m
    orders: np.ndarray  # (m,) cycles a revolution
    force: np.ndarray  # (m, 3) N
    moment: np.ndarray  # (m, 3) N m
    phase: np.ndarray  # (m,) rad
    imposed_amplitude: float  # m; zero where forces excite


def engine(vehicle, rows, speed, imposed_displacement):
    """Return the record for an engine speed [r/min] and one of the two kinds of excitation."""
    e = vehicle.engine
    growth = 0.0 if imposed_displacement else (speed / e.rated_speed) ** 2
    running = speed > 0.0
    return Engine(
        powertrain=rows["powertrain"],
        speed=speed * 2.0 * pi / 60.0,
        place=np.array([e.place]),
        orders=np.array(e.orders),
        force=growth * np.array(e.force),
        moment=growth * np.array(e.moment),
        phase=np.array(e.phase),
        imposed_amplitude=e.imposed_amplitude if imposed_displacement and running else 0.0,
    )


@kernel
def add_engine(engine, angle, motion, cuts):
    """Add the engine's forces and moments at a crank angle [rad] to the powertrain."""
    body = engine.powertrain
    turn = rotation(motion, body)
    place = point_place(motion, body, load3(engine.place, 0))
    for i in range(engine.orders.size):
        wave = np.sin(engine.orders[i] * angle + engine.phase[i])
        apply_force(cuts, motion, body, place, rotate(turn, scale(wave, load3(engine.force, i))))
        apply_wrench(cuts, body, (0.0, 0.0, 0.0), rotate(turn, scale(wave, load3(engine.moment, i))))


@kernel
def imposed_displacement(engine, angle):
    """Return the displacement imposed across the mounts [m] and its rate [m/s]."""
    phase = IMPOSED_ORDER * angle
    rate = engine.imposed_amplitude * IMPOSED_ORDER * engine.speed * np.cos(phase)
    return engine.imposed_amplitude * np.sin(phase), rate
