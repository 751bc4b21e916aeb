"""Excitation of the powertrain by the engine, order by order.

By default each order brings a force and a moment on the powertrain body, growing with speed squared as inertia forces
do. As an option the paper's excitation: a second-order displacement of 0.2 mm imposed across the mounts [Tao2025].
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...numerics.spatial import load3, rotate, scale
from ...numerics.units import RPM
from ...rui.sweeps.articulated import apply_force, apply_wrench
from ...rui.sweeps.kinematics import point_place, rotation

IMPOSED_ORDER = 2.0
CYCLE = 4.0 * np.pi  # rad, two revolutions: what all orders repeat after


class Engine(NamedTuple):
    """Amplitudes at rated speed, powertrain axes."""

    powertrain: int  # row in the tree
    rated: float  # rad/s of the crankshaft
    place: np.ndarray  # (1, 3) where the forces act, in the powertrain, m
    orders: np.ndarray  # (m,) cycles a revolution
    force: np.ndarray  # (m, 3) N; zero where a displacement excites
    moment: np.ndarray  # (m, 3) N m, likewise
    phase: np.ndarray  # (m,) rad
    imposed_amplitude: float  # m; zero where forces excite


class Crank(NamedTuple):
    """State of the crankshaft, changed in place."""

    angle: np.ndarray  # (1,) rad, within one cycle
    speed: np.ndarray  # (1,) rad/s


def build_engine(vehicle, rows, imposed_displacement):
    """Return the record for one of the two kinds of excitation."""
    e = vehicle.engine
    forces = 0.0 if imposed_displacement else 1.0
    return Engine(
        powertrain=rows["powertrain"],
        rated=e.rated_speed * RPM,
        place=np.array([e.place]),
        orders=np.array(e.orders),
        force=forces * np.array(e.force),
        moment=forces * np.array(e.moment),
        phase=np.array(e.phase),
        imposed_amplitude=e.imposed_amplitude if imposed_displacement else 0.0,
    )


@inlined
def turn_crank(crank, speed, dt):
    """Advance the crankshaft by dt to a speed [rad/s], exactly where speed changes linearly in time."""
    crank.angle[0] = (crank.angle[0] + 0.5 * dt * (crank.speed[0] + speed)) % CYCLE
    crank.speed[0] = speed


@inlined
def add_engine(engine, crank, motion, cuts):
    """Add the engine's forces and moments to the powertrain."""
    body = engine.powertrain
    turn = rotation(motion, body)
    place = point_place(motion, body, load3(engine.place, 0))
    for i in range(engine.orders.size):
        wave = order_wave(engine, crank, i)
        apply_force(cuts, motion, body, place, rotate(turn, scale(wave, load3(engine.force, i))))
        apply_wrench(cuts, body, (0.0, 0.0, 0.0), rotate(turn, scale(wave, load3(engine.moment, i))))


@inlined
def order_wave(engine, crank, i):
    """Return by how much an order's amplitudes at rated speed act now."""
    growth = (crank.speed[0] / engine.rated) ** 2
    return growth * np.sin(engine.orders[i] * crank.angle[0] + engine.phase[i])


@inlined
def imposed_displacement(engine, crank):
    """Return the displacement imposed across the mounts [m] and its rate [m/s], nothing by an engine that stands."""
    if crank.speed[0] == 0.0:
        return 0.0, 0.0
    phase = IMPOSED_ORDER * crank.angle[0]
    rate = engine.imposed_amplitude * IMPOSED_ORDER * crank.speed[0] * np.cos(phase)
    return engine.imposed_amplitude * np.sin(phase), rate
