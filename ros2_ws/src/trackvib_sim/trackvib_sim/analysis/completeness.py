"""Whether a bag holds all of a run that replay needs: what its simulator counted against what was recorded."""

import numpy as np
from mr_mount_controller.node_base import topics

from ..numerics.units import NANO
from ..vehicle.sensors import sensors_of
from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle
from .stamps import period_of

_ENDS = ("finished", "stopped")  # states in which a simulator speaks its last word
_HEARD = ("accepted", "late", "duplicate", "early", "not_finite")  # one for each answer that came to the simulator


def missing(recording):
    """Return in words what a `bags.recording.Recording` of a run in lock-step lacks, one text for each part.

    Empty if it has every sample of the vehicle's sensors, mount state and answer that the simulator counted, the road
    under them, the vehicle, and the simulator's final diagnostics itself.
    """
    counts = recording.diagnostics
    if counts.get("state") not in _ENDS:
        return ["the simulator's final diagnostics"]
    period = period_of(recording.chassis.stamp)
    stamps = period * np.arange(1, round(float(counts["time"]) * NANO / period) + 1)
    try:
        sensors = sensors_of(parse_vehicle(recording.vehicle or "", topics.VEHICLE_DESCRIPTION))
    except VehicleFileError:
        return [topics.VEHICLE_DESCRIPTION]
    divisors = {topics.imu_topic(sensor.name): sensor.divisor for sensor in sensors} | {topics.MOUNT_STATE: 1}
    streams = {end: columns.stamp for end, columns in recording.streams.items() if end in divisors}
    lacking = [
        _samples(end, stamps[divisor - 1 :: divisor], streams.get(end, np.empty(0, np.int64)))
        for end, divisor in divisors.items()
    ]
    return list(filter(None, (*lacking, _answers(recording.answers, stamps, counts), _road(recording))))


def _samples(end, stamps, recorded):
    absent = stamps[~np.isin(stamps, recorded)]
    return f"{len(absent)} of {len(stamps)} {end}{_first(absent)}" if len(absent) else ""


def _answers(answers, stamps, diagnostics):
    """Compare by samples, and by number: where the controller was silent a late answer may stand for one in time."""
    recorded = np.empty(0, np.int64) if answers is None else answers.sample_stamp
    absent = stamps[~np.isin(stamps, recorded)]
    counts = {outcome: int(diagnostics.get(outcome, 0)) for outcome in _HEARD}
    heard = sum(counts.values())
    lost = max(counts["accepted"] + len(absent) - len(stamps), heard - len(recorded))
    return f"{lost} of {heard} {topics.COIL_CURRENT}{_first(absent)}" if lost > 0 else ""


def _road(recording):
    if recording.odometry is None:
        return ""
    way = recording.odometry.position[:, 0] if recording.drive is None else recording.drive.distance
    reached, end = way[[0, -1]]
    for start, spacing, left, _ in sorted(recording.road, key=lambda patch: patch[0]):
        if start > reached + 0.5 * spacing:
            break
        reached = max(reached, start + len(left) * spacing)
    return f"{topics.ROAD_PROFILE} from {reached:.1f} m on" if reached < end else ""


def _first(absent):
    return f" (first at t = {absent[0] / NANO:.3f} s)" if len(absent) else ""
