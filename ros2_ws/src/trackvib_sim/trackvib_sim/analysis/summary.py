"""The headline numbers of one run."""

from typing import NamedTuple

import numpy as np

from .vibration import band, band_limited, rms

AXES = ("x", "y", "z")
SENSORS = ("chassis", "powertrain")
NANO = 1_000_000_000
SHORTEST_SETTLING = 2.0  # s
VEHICLE_BEHIND = 2.5  # m from the hull's origin to where the rear wheels stand


class TooShort(ValueError):
    """A run too short for vibration measures."""


class Prepared(NamedTuple):
    """Accelerations of both sensors, ready to be measured."""

    time: np.ndarray  # (k,) s
    raw: dict  # sensor -> (k, 3) specific force as recorded, m/s^2
    limited: dict  # sensor -> (k, 3) the same, band-limited
    rate: float  # Hz
    settled: np.ndarray  # (k,) bool, False while the run settles


def prepare(drive, settle):
    """Return what the measures work on; the first `settle` seconds count as settling.

    Raises
    ------
    TooShort
        Less than one second is left.
    """
    stamp = drive.chassis.stamp
    if len(stamp) < 2 or (stamp[-1] - stamp[0]) / NANO < settle + 1.0:
        raise TooShort(
            f"the run is {(stamp[-1] - stamp[0]) / NANO if len(stamp) else 0.0:.3f} s long, RMS values need more than "
            f"{settle + 1.0:g} s ({settle:g} s of settling and 1 s to measure)"
        )
    rate = NANO / float(np.median(np.diff(stamp)))
    raw = {sensor: getattr(drive, sensor).specific_force for sensor in SENSORS}
    time = stamp / NANO
    limited = {sensor: band_limited(values, rate) for sensor, values in raw.items()}
    return Prepared(time, raw, limited, rate, time > time[0] + settle)


def settling_time(provenance):
    """Return how long the run of a bag settles [s]: until the rear wheels are on the full roughness, at least 2 s.

    Distances and speed are those of the recorded parameters of the road and simulator nodes.
    """
    road = _parameters(provenance, "road_excitation")
    speed = float(_parameters(provenance, "simulator").get("speed", 0.0))
    if not road or speed <= 0.0:
        return SHORTEST_SETTLING
    full_roughness = float(road["level_until"]) + float(road["fade"])
    return max(SHORTEST_SETTLING, (full_roughness + VEHICLE_BEHIND) / speed)


def _parameters(provenance, node):
    return next((values for name, values in provenance.items() if name.endswith("/" + node)), {})


def losses(drive):
    """Count, from stamps alone, the samples and answers that are missing between the first and the last sample."""
    stamp = drive.chassis.stamp
    period = int(np.median(np.diff(stamp)))
    expected = np.arange(period, stamp[-1] + period, period)
    return {
        "samples": len(expected),
        "lost_chassis": int(np.setdiff1d(expected, stamp).size),
        "lost_powertrain": int(np.setdiff1d(expected, drive.powertrain.stamp).size),
        "unanswered": int(np.setdiff1d(expected, drive.answered).size),
        "answered_twice": int(len(drive.answered) - np.unique(drive.answered).size),
    }


def summarise(drive, prepared, settle):
    """Return the summary of a run as a dict of plain values, ready for JSON."""
    low, high = band(prepared.rate)
    return {
        "band_hz": [low, high],
        "settled_after_s": settle,
        "rms_mps2": {
            sensor: dict(zip(AXES, rms(prepared.limited[sensor][prepared.settled]).tolist(), strict=True))
            for sensor in SENSORS
        },
        "loop": {**losses(drive), **drive.diagnostics},
        "messages": dict(sorted(drive.counts.items())),
    }
