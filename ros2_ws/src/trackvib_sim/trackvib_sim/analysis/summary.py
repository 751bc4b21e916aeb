"""The headline numbers of one run, its start, and its losses."""

from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from ..vehicle.mount_energy import MountEnergy
from .segments import BLOCK, blocks, period_of
from .vibration import band_limited

AXES = ("x", "y", "z")
SENSORS = ("chassis", "powertrain")
SHORTEST_MEASURING = 1.0  # s
MOUNTS = tuple(f"mount_{part}_J" for part in MountEnergy._fields)  # in the simulator's diagnostics
MOST_LOST = 1000  # times the samples that are there


class TooShort(ValueError):
    """A run too short for vibration measures."""


class Prepared(NamedTuple):
    """Accelerations of both sensors, ready to be drawn."""

    time: np.ndarray  # (k,) s from the start
    raw: dict  # sensor -> (k, 3) specific force as recorded, m/s^2
    limited: dict  # sensor -> (k, 3) the same, band-limited
    rate: float  # Hz
    settled: np.ndarray  # (k,) bool, False while the run settles


def prepare(recording, settle):
    """Return what pictures show: samples that both sensors have; the first `settle` seconds count as settling."""
    sensors = [getattr(recording, sensor) for sensor in SENSORS]
    rate = NANO / period_of(sensors[0].stamp)
    stamp, *there = np.intersect1d(*(sensor.stamp for sensor in sensors), return_indices=True)
    raw = {name: sensor.specific_force[index] for name, sensor, index in zip(SENSORS, sensors, there, strict=True)}
    time = (stamp - start_of(recording)) / NANO
    limited = {sensor: band_limited(values, rate) for sensor, values in raw.items()}
    return Prepared(time, raw, limited, rate, time > settle)


def start_of(recording):
    """Return the time [ns] at which a recording starts: 0 of a whole run, else one period before its first sample.

    Raises
    ------
    ValueError
        The stamps of the chassis do not go on.
    """
    odometry, chassis = recording.odometry, recording.chassis.stamp
    period = period_of(chassis)
    if not period > 0.0:
        raise ValueError(f"stamps of chassis/imu go on by {period:g} ns from sample to sample, must be above 0")
    if odometry is not None and odometry.stamp[0] == 0:  # of the vehicle before the first period
        return 0
    return int(min(chassis[0], recording.powertrain.stamp[0])) - round(period)


def losses(recording):
    """Count, from stamps alone, what is missing between the start and the last sample that anything speaks of.

    Of answers that are not in the bag nothing is counted: None.

    Raises
    ------
    ValueError
        The stamps are no time base: they reach over much more time than samples can fill.
    """
    chassis, powertrain = recording.chassis.stamp, recording.powertrain.stamp
    nobody = recording.answers is None
    answered = np.empty(0, np.int64) if nobody else recording.answers.sample_stamp
    begin, period = start_of(recording), period_of(chassis)
    told = round(float(recording.diagnostics.get("time", 0.0)) * NANO)  # by the simulator at its end
    last = max(told, *(int(stamp.max()) for stamp in (chassis, powertrain, answered) if stamp.size))
    expected = round((last - begin) / period)
    if not 0 < expected <= MOST_LOST * len(chassis):
        reach = f"{(last - begin) / NANO:g} s in steps of {period / NANO:g} s"
        raise ValueError(f"stamps reach over {reach}, which {len(chassis)} samples of chassis/imu cannot fill")
    counted = {}
    for name, stamp in (("chassis", chassis), ("powertrain", powertrain), ("answered", answered)):
        seen, inside = np.zeros(expected, bool), 0
        for block in blocks(len(stamp), BLOCK):
            index = np.round((stamp[block] - begin) / period).astype(np.int64) - 1
            index = index[(index >= 0) & (index < expected)]
            seen[index] = True
            inside += len(index)
        counted[name] = int(np.count_nonzero(seen))
    return {
        "samples": expected,
        "lost_chassis": expected - counted["chassis"],
        "lost_powertrain": expected - counted["powertrain"],
        "unanswered": None if nobody else expected - counted["answered"],
        "answered_twice": None if nobody else inside - counted["answered"],  # of answers, which come last
    }


def loop_health(recording):
    """Return the `losses`, and what the simulator told last as text, but for the work on the mounts."""
    return losses(recording) | {key: told for key, told in recording.diagnostics.items() if key not in MOUNTS}


def mount_energy(recording):
    """Return where the work on the mounts went, as the simulator told at its end: a `MountEnergy`, or None."""
    told = [recording.diagnostics.get(key) for key in MOUNTS]
    return None if None in told else MountEnergy(*map(float, told))


def summarise(analysis):
    """Return the summary of a run, of its `bag_numbers.Analysis`, as a dict of plain values, ready for JSON."""
    return {
        "band_hz": list(analysis.band),
        "settled_after_s": analysis.settle,
        "rms_mps2": {
            sensor: {axis: numbers.rms for axis, numbers in axes.items()} for sensor, axes in analysis.sensors.items()
        },
        "mounts_J": analysis.mount_energy,
        "loop": analysis.loop,
        "messages": analysis.messages,
    }
