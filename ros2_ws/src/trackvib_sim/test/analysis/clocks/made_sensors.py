"""Sensors with clocks of their own upon one known motion, which they measure at the true times of their samples."""

from collections import Counter
from pathlib import Path

import numpy as np
from mr_mount_controller.mounting import PAIR
from trackvib_sim.bags.recording import Inertial, LoopCounts, Recording

EPOCH = 1_750_000_000_000_000_000  # ns
TONES = np.array([20.0, 50.0])  # Hz
AMPLITUDES = np.array([2.0, 1.0])  # m/s^2, vertical; along x there is a tone of 8 Hz
RMS_Z = np.sqrt(np.sum(AMPLITUDES**2) / 2.0)


def times(rate, seconds, start=0.0):
    """Return the true times [s] of evenly taken samples, the first one period after the start."""
    return start + np.arange(1, int(rate * seconds) + 1) / rate


def motion(time, highest=0.0):
    """Return specific forces (k, 3) at times [s]; along y, up to `highest` Hz, a hundred tones of equal strength."""
    z = 9.81 + np.sin(2.0 * np.pi * np.outer(time, TONES)) @ AMPLITUDES
    x = 0.5 * np.sin(2.0 * np.pi * 8.0 * time)
    random = np.random.default_rng(3)
    y = np.zeros(len(time))
    if highest:
        for frequency, phase in zip(np.linspace(2.0, highest, 100), 2.0 * np.pi * random.random(100), strict=True):
            y += 0.2 * np.sin(2.0 * np.pi * frequency * time + phase)
    return np.column_stack((x, y, z))


def nanoseconds(time):
    """Return times [s] since the epoch as stamps [ns]."""
    return EPOCH + np.round(np.asarray(time) * 1e9).astype(np.int64)


def sensor(time, gain=1.0, told=None, logged=True, highest=0.0, kept=slice(None), **columns):
    """Return an `Inertial` that sampled at true times (k,) [s].

    Parameters
    ----------
    time : (k,) array
    gain : float
        Of the motion, gravity aside.
    told : (k,) array, optional
        What the stamps say, s; by default the truth.
    logged : bool or (k,) array
        When messages were recorded [s]; True for the true times, False for a bag whose recorder took the stamps.
    highest : float
        Of the tones along y, Hz.
    kept : index
        Of the samples that are in the bag, in their order there.
    columns : arrays
        In place of those made here.
    """
    force = motion(time, highest)
    force = gain * (force - [0.0, 0.0, 9.81]) + [0.0, 0.0, 9.81]
    stamp = nanoseconds(time if told is None else told)
    recorded = stamp if logged is False else nanoseconds(time if logged is True else logged)
    zero = np.zeros(len(time))
    made = Inertial(stamp, force, np.zeros((len(time), 3)), recorded, zero)._replace(**columns)
    return made.at(kept)


def recorded(chassis, powertrain):
    """Return a `Recording` of two sensors and of nothing else."""
    nothing = dict.fromkeys(("mounts", "answers", "odometry", "drive", "commands", "vehicle", "drive_file"))
    return Recording(
        path=Path("drive"),
        topics={end: f"/{end}" for end in ("chassis/imu", "powertrain/imu")},
        chassis=chassis,
        powertrain=powertrain,
        sensors={},
        mounting=PAIR,
        road=[],
        loop_counts=LoopCounts(*np.zeros((3, 0), np.int64)),
        diagnostics={},
        provenance={},
        counts=Counter(),
        complete=True,
        **nothing,
    )


def both(time, told=None, **how):
    """Return a `Recording` of two sensors with the same samples, the powertrain moving half as much."""
    return recorded(sensor(time, told=told, **how), sensor(time, 0.5, told, **how))
