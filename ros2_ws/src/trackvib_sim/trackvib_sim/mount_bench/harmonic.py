"""A mount shaken along its own z axis at constant current: force over displacement and velocity."""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..vehicle.mount_law import lay_fields, mount_force, new_field_state, switch_field

SAMPLES = 1000  # a cycle
SETTLING = 3  # cycles before the one that is kept


class Loop(NamedTuple):
    """One cycle, `n` samples; the force is the one that the bench needs, without the load at rest."""

    current: float  # A
    frequency: float  # Hz
    amplitude: float  # m
    displacement: np.ndarray  # (n,) m
    velocity: np.ndarray  # (n,) m/s
    force: np.ndarray  # (n,) N


class LoopNumbers(NamedTuple):
    """What is read off a loop (ISO 10846-1: dynamic stiffness and loss factor at the frequency of excitation)."""

    stiffness: float  # N/m, in phase
    loss_stiffness: float  # N/m, a quarter of a period ahead
    damping: float  # N s/m, the viscous one that takes as much
    heat: float  # J per cycle
    largest_force: float  # N


def shake(mounts, index, current, amplitude, frequency):
    """Return the settled `Loop` of one mount.

    Parameters
    ----------
    mounts : vehicle.mounts.Mounts
    index : int
        Which of them.
    current, amplitude, frequency : float
        A, m, Hz.
    """
    angle = 2.0 * np.pi * np.arange((SETTLING + 1) * SAMPLES) / SAMPLES
    displacement = amplitude * np.sin(angle)
    velocity = amplitude * 2.0 * np.pi * frequency * np.cos(angle)
    force, fields = np.zeros(len(angle)), new_field_state(len(mounts.body))
    lay_fields(mounts, np.full(mounts.coils, float(current)), fields)
    _lead(mounts, fields, index, float(current), displacement, velocity, force)
    kept = (part[-SAMPLES:] for part in (displacement, velocity, force))
    return Loop(current, frequency, amplitude, *kept)


@kernel
def _lead(mounts, fields, index, current, displacement, velocity, force):
    unloaded = mounts.unloaded[index]
    for i in range(len(force)):
        l = (0.0, 0.0, unloaded + displacement[i])
        if index < mounts.coils:
            switch_field(mounts, fields, index, current, l)
        against, _ = mount_force(mounts, fields, index, current, l, (0.0, 0.0, velocity[i]))
        force[i] = mounts.load[index, 2] - against[2]


def loop_numbers(loop):
    """Return the `LoopNumbers` of a `Loop`."""
    omega = 2.0 * np.pi * loop.frequency
    in_phase = 2.0 * (loop.force * loop.displacement).mean() / loop.amplitude**2
    ahead = 2.0 * (loop.force * loop.velocity).mean() / (loop.amplitude**2 * omega)
    return LoopNumbers(in_phase, ahead, ahead / omega, np.pi * ahead * loop.amplitude**2, np.abs(loop.force).max())
