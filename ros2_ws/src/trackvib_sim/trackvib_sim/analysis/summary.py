"""The headline numbers of one run."""

from typing import NamedTuple

import numpy as np

from ..simulation.settings import NANO
from ..vehicle.mount_audit import MountEnergy
from .vibration import band, band_limited, rms

AXES = ("x", "y", "z")
SENSORS = ("chassis", "powertrain")
SHORTEST_SETTLING = 2.0  # s
SHORTEST_MEASURING = 1.0  # s
MOUNTS = tuple(f"mount_{part}_J" for part in MountEnergy._fields)  # in the simulator's diagnostics
VEHICLE_BEHIND = 2.5  # m from the hull's origin to beyond the rear wheels


class TooShort(ValueError):
    """A run too short for vibration measures."""


class Prepared(NamedTuple):
    """Accelerations of both sensors, ready to be measured."""

    time: np.ndarray  # (k,) s
    raw: dict  # sensor -> (k, 3) specific force as recorded, m/s^2
    limited: dict  # sensor -> (k, 3) the same, band-limited
    rate: float  # Hz
    settled: np.ndarray  # (k,) bool, False while the run settles


def prepare(recording, settle):
    """Return what the measures work on; the first `settle` seconds count as settling.

    Raises
    ------
    TooShort
        Less than one second is left.
    """
    stamp = recording.chassis.stamp
    length = stamp[-1] / NANO
    if length < settle + SHORTEST_MEASURING:
        raise TooShort(
            f"the run is {length:g} s long, RMS values need {settle + SHORTEST_MEASURING:g} s "
            f"({settle:g} s of settling and {SHORTEST_MEASURING:g} s to measure)"
        )
    rate = NANO / float(np.median(np.diff(stamp)))
    raw = {sensor: getattr(recording, sensor).specific_force for sensor in SENSORS}
    time = stamp / NANO
    limited = {sensor: band_limited(values, rate) for sensor, values in raw.items()}
    return Prepared(time, raw, limited, rate, time > settle)


def settling_time(speed, full_roughness):
    """Return how long a run settles [s]: until the rear wheels are on the full roughness, at least 2 s.

    `speed` [m/s] is that of the vehicle, `full_roughness` [m] the distance from which the road has all of it.
    """
    return max(SHORTEST_SETTLING, (full_roughness + VEHICLE_BEHIND) / speed) if speed > 0.0 else SHORTEST_SETTLING


def losses(recording):
    """Count, from stamps alone, what is missing between the start and the last sample that anything speaks of."""
    stamp = recording.chassis.stamp
    period = int(np.median(np.diff(stamp)))
    told = round(float(recording.diagnostics.get("time", 0.0)) * NANO)  # by the simulator at its end
    last = max(told, stamp[-1], recording.powertrain.stamp[-1], recording.answers.sample_stamp.max())
    expected = np.arange(period, last + period, period)
    return {
        "samples": len(expected),
        "lost_chassis": int(np.setdiff1d(expected, stamp).size),
        "lost_powertrain": int(np.setdiff1d(expected, recording.powertrain.stamp).size),
        "unanswered": int(np.setdiff1d(expected, recording.answers.sample_stamp).size),
        "answered_twice": int(len(recording.answers.sample_stamp) - np.unique(recording.answers.sample_stamp).size),
    }


def mount_energy(recording):
    """Return where the work on the mounts went, as the simulator told at its end: a `MountEnergy`."""
    return MountEnergy(*(float(recording.diagnostics[key]) for key in MOUNTS))


def summarise(recording, prepared, settle):
    """Return the summary of a run as a dict of plain values, ready for JSON."""
    low, high = band(prepared.rate)
    return {
        "band_hz": [low, high],
        "settled_after_s": settle,
        "rms_mps2": {
            sensor: dict(zip(AXES, rms(prepared.limited[sensor][prepared.settled]).tolist(), strict=True))
            for sensor in SENSORS
        },
        "mounts_J": mount_energy(recording)._asdict(),
        "loop": losses(recording) | {key: told for key, told in recording.diagnostics.items() if key not in MOUNTS},
        "messages": dict(sorted(recording.counts.items())),
    }
