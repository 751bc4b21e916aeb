"""The segments of a recording that are measured: without a gap in either sensor, after the run has settled."""

from math import isfinite
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base import topics

from ..bags.provenance import parameters_with
from ..numerics.units import NANO
from .numbers import SENSORS
from .settling import SHORTEST_MEASURING, SHORTEST_SETTLING, VEHICLE_BEHIND, settling_time
from .stamp_numbers import Timing
from .stamps import start_of, timing

SLOWEST = 10.0  # Hz, of a further sensor: half of it is a band in which levels mean something
_IMUS = (topics.CHASSIS_IMU, topics.POWERTRAIN_IMU)


class TooShort(ValueError):
    """A run too short for vibration measures."""


class Segment(NamedTuple):
    """Samples of both sensors, at the same stamps, each one period after the one before."""

    chassis: int  # index of the first
    powertrain: int
    size: int
    measured: int  # how many of them are passed before the rest counts


class Segments(NamedTuple):
    """What of a recording is measured, and the time base of all its numbers."""

    begin: int  # start of the bag, ns
    last: int  # last stamp of both sensors, ns
    settle: float  # s from the start that do not count
    rate: float  # of the sensors, Hz
    segments: list  # of `Segment`
    timing: dict  # end of topic -> `Timing`

    @property
    def settled(self):
        """Stamp [ns] after which samples count."""
        return self.begin + round(self.settle * NANO)

    @property
    def measured(self):
        """Time that counts [s]."""
        return sum(segment.size - segment.measured for segment in self.segments) / self.rate


def find_segments(recording, settle=None):
    """Return the `Segments` of a `bags.recording.Recording`.

    `settle` is the time from the start that does not count, `SHORTEST_SETTLING` or more [s]; by default `settling_of`.

    Raises
    ------
    TooShort
        No segment without gaps leaves a second to be measured.
    ValueError
        The settling time is too short, the sensors differ in their rates, or their stamps cannot be a time base.
    """
    settle = settling_of(recording) if settle is None else settle
    if not settle >= SHORTEST_SETTLING:  # nan is refused, too
        raise ValueError(f"settle is {settle:g} s, must be {SHORTEST_SETTLING:g} s or more")
    begin = start_of(recording)
    timings = {end: timing(columns[0], begin) for end, columns in recording.streams.items()}
    period = _period(*(timings[end][0] for end in _IMUS))
    stamps = [getattr(recording, sensor).stamp for sensor in SENSORS]
    breaks = [timings[end][1] for end in _IMUS]
    found = common_segments(stamps, breaks, period, begin, settle, SHORTEST_SETTLING, SHORTEST_MEASURING)
    last = int(min(stamp[-1] for stamp in stamps))
    if not found:
        raise TooShort(_why_none(stamps, timings, begin, last, settle))
    return Segments(begin, last, settle, NANO / period, found, {end: each for end, (each, _) in timings.items()})


def _why_none(stamps, timings, begin, last, settle):
    """Say why no segment of two sensors with stamps is long enough to be measured."""
    needed = settle + SHORTEST_MEASURING
    parts = f"{settle:g} s of settling and {SHORTEST_MEASURING:g} s to measure without a gap in either sensor"
    first = int(max(stamp[0] for stamp in stamps))
    if first > last:
        spans = (
            f"{end} from {stamp[0] / NANO:.3f} to {stamp[-1] / NANO:.3f} s"
            for end, stamp in zip(_IMUS, stamps, strict=True)
        )
        return f"the sensors were recorded at different times by their stamps: {', '.join(spans)}"
    run = f"the run is {(last - begin) / NANO:g} s long"
    if last - begin < needed * NANO:
        return f"{run}, RMS values need {needed:g} s ({parts})"
    gaps = (f"{timings[end][0].gap_count} in {end} ({timings[end][0].missing} samples missing)" for end in _IMUS)
    return f"{run}, but no part of it has the {needed:g} s that RMS values need ({parts}); gaps: {', '.join(gaps)}"


def segments_of(stamp, segments):
    """Return the rate [Hz] of a further sensor with stamps (k,) [ns] and its own `Segment`s, as of a pair of it.

    A sensor slower than `SLOWEST` has none. What counts after the start of the bag is as in the `Segments` of chassis
    and powertrain.
    """
    timed, breaks = timing(stamp, segments.begin) if len(stamp) > 1 else (None, ())
    if timed is None or not 0.0 < timed.period <= 1.0 / SLOWEST:
        return 0.0, []
    period = timed.period * NANO
    twice = (stamp, stamp), (breaks, breaks)
    least = SHORTEST_SETTLING, SHORTEST_MEASURING
    return NANO / period, common_segments(*twice, period, segments.begin, segments.settle, *least)


def settling_of(recording):
    """Return the time [s] that the recorded run settles, by the parameters of its nodes; the shortest if unknown."""
    known = known_settling(recording)
    return SHORTEST_SETTLING if known is None else known


def known_settling(recording):
    """Return the time [s] that the recorded run settles, by the parameters of its nodes; None if these do not tell it.

    Where the speed followed a drive file or commands it is when the vehicle was on the full roughness.
    """
    road, simulator = (parameters_with(recording.provenance, name)[1] for name in ("level_until", "engine_speed"))
    try:
        # bags of before do not say where a road begins; it was then one of a class
        full = float(road["begins"] if "begins" in road else float(road["level_until"]) + float(road["fade"]))
        if recording.drive is not None and (recording.drive_file or recording.commands is not None):
            drive = recording.drive
            there = drive.stamp[np.abs(drive.distance) >= full + VEHICLE_BEHIND]
            arrived = (int(there[0]) - start_of(recording)) / NANO if len(there) else 0.0
            return max(arrived, SHORTEST_SETTLING)
        found = settling_time(float(simulator["speed"]), full)
    except (KeyError, ValueError):
        return None
    return found if isfinite(found) else SHORTEST_SETTLING


def _period(chassis: Timing, powertrain: Timing):
    """Return the common period of both sensors [ns]."""
    if abs(chassis.period - powertrain.period) > 1e-3 * chassis.period:
        raise ValueError(
            f"chassis/imu comes every {chassis.period:g} s and powertrain/imu every {powertrain.period:g} s, "
            "must be the same"
        )
    return chassis.period * NANO


def common_segments(stamps, breaks, period, begin, settle, lead, shortest):
    """Return the `Segment`s of two sensors that are long enough to be measured, until time goes back.

    Parameters
    ----------
    stamps : pair of (k,) int
        Of chassis and powertrain, ns.
    breaks : pair of (b,) int
        As `timing` returns them.
    period : float
        ns
    begin : int
        Start of the bag, ns.
    settle : float
        Time after the start that does not count, s.
    lead : float
        Time after the begin of each segment that does not count, s.
    shortest : float
        Least time to be measured of a segment, s.
    """
    chassis, powertrain = (
        _ends(stamp, each, (lead + shortest) * NANO) for stamp, each in zip(stamps, breaks, strict=True)
    )
    found, i, j = [], 0, 0
    while i < len(chassis) and j < len(powertrain):
        (a, a_end), (b, b_end) = chassis[i], powertrain[j]
        offset = round((stamps[0][a] - stamps[1][b]) / period)  # by how many samples the chassis begins later
        a, b = a + max(-offset, 0), b + max(offset, 0)
        size = min(a_end - a, b_end - b)
        if size > 0:
            first = int(stamps[0][a])
            # samples count from the first whose stamp is beyond both; the thousandth is for what rounding leaves
            passed = max(lead * NANO, begin + settle * NANO - first + period)
            measured = max(int(passed / period + 1e-3), 0)
            if size - measured + 1e-3 >= shortest * NANO / period:
                found.append(Segment(a, b, size, measured))
        if stamps[0][a_end - 1] < stamps[1][b_end - 1]:
            i += 1
        else:
            j += 1
    return found


def _ends(stamp, breaks, shortest):
    """Return first index and end of the segments that last `shortest` [ns] at least, until one lies before another."""
    ends = np.column_stack((np.append(0, breaks), np.append(breaks, len(stamp))))
    first, last = stamp[ends[:, 0]], stamp[ends[:, 1] - 1]
    long = last - first >= 0.99 * shortest
    ends, first, last = ends[long], first[long], last[long]
    back = np.flatnonzero(first[1:] <= last[:-1])
    return ends[: back[0] + 1 if back.size else None].tolist()
