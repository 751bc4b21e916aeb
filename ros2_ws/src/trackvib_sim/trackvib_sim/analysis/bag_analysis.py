"""From a recording to its `Analysis`."""

from math import hypot, isfinite, isnan

import numpy as np
from mr_mount_controller.node_base import topics

from ..bags.provenance import parameters_with
from ..numerics.units import NANO
from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle
from .iso2631 import LEAST_RATE
from .levels import Levels, bins
from .mean_spectra import MeanSpectra, known_lines
from .mount_numbers import bin_means, currents, moments, mount_numbers
from .numbers import Analysis, History
from .segments import BLOCK, blocks, common_segments, timing
from .settling import SHORTEST_SETTLING, settling_time
from .summary import AXES, SENSORS, SHORTEST_MEASURING, TooShort, loop_health, mount_energy, start_of
from .vibration import band

TOPICS = dict(  # by part of a recording
    chassis=topics.CHASSIS_IMU,
    powertrain=topics.POWERTRAIN_IMU,
    mounts=topics.MOUNT_STATE,
    answers=topics.COIL_CURRENT,
    odometry=topics.ODOMETRY,
)
_WITHOUT = {  # what cannot be had of a bag without these topics
    "mounts": "no numbers of the mounts",
    "answers": "no demanded currents, and nobody knows which samples were answered",
}


def settling_of(recording):
    """Return the time [s] that the recorded run settles, by the parameters of its nodes; the shortest if not told."""
    road, simulator = _told(recording, "level_until"), _told(recording, "engine_speed")
    try:
        found = settling_time(float(simulator["speed"]), float(road["level_until"]) + float(road["fade"]))
    except (KeyError, ValueError):
        return SHORTEST_SETTLING
    return found if isfinite(found) else SHORTEST_SETTLING


def _told(recording, parameter):
    return parameters_with(recording.provenance, parameter)[1]


def analyse(recording, settle=None, on_progress=lambda done, total: None):
    """Return the `Analysis` of a `bags.recording.Recording`.

    Parameters
    ----------
    recording : Recording
    settle : float, optional
        Time from the start that does not count, `SHORTEST_SETTLING` or more, s; by default `settling_of`.
    on_progress : callable
        Is told now and then how many samples of how many have been looked at.

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
    begin, loop = start_of(recording), loop_health(recording)
    timings = {
        end: timing(getattr(recording, part)[0], begin)  # the first column of each is its stamps
        for part, end in TOPICS.items()
        if getattr(recording, part) is not None
    }
    segments, period = _segments(recording, timings, begin, settle)
    rate = NANO / period
    last = int(min(recording.chassis.stamp[-1], recording.powertrain.stamp[-1]))
    parts = bins(begin, last)
    sensors, spectra, levels = _measure(recording, segments, rate, parts, on_progress)
    settled = begin + round(settle * NANO)
    speed = _speed(recording, settled)
    engine_speed, lines, why = _lines(recording, spectra, speed)
    return Analysis(
        bag=str(recording.path),
        begin=begin,
        duration=(last - begin) / NANO,
        settle=settle,
        measured=sum(segment.size - segment.measured for segment in segments) / rate,
        rate=rate,
        band=band(rate),
        speed=float(speed.mean[0]),
        speed_deviation=float(speed.deviation[0]),
        engine_speed=engine_speed,
        sensors=sensors,
        total_weighted={
            sensor: hypot(*(numbers.rms_weighted for numbers in axes.values())) for sensor, axes in sensors.items()
        },
        lines=lines,
        mounts={} if recording.mounts is None else mount_numbers(recording.mounts, settled),
        demand={} if recording.answers is None else currents(*recording.answers, settled),
        mount_energy=None if (told := mount_energy(recording)) is None else told._asdict(),
        loop=loop,
        messages=dict(sorted(recording.counts.items())),
        timing={end: found for end, (found, _) in timings.items()},
        spectra=spectra,
        history=_history(recording, parts, levels),
        notes=(*_notes(recording, timings, rate), *why),
    )


def _segments(recording, timings, begin, settle):
    """Return the `Segment`s that count and the sensors' period [ns]."""
    stamps = [getattr(recording, sensor).stamp for sensor in SENSORS]
    chassis, powertrain = (timings[TOPICS[sensor]] for sensor in SENSORS)
    if abs(chassis[0].period - powertrain[0].period) > 1e-3 * chassis[0].period:
        raise ValueError(
            f"chassis/imu comes every {chassis[0].period:g} s and powertrain/imu every {powertrain[0].period:g} s, "
            "must be the same"
        )
    period = chassis[0].period * NANO
    breaks = (chassis[1], powertrain[1])
    found = common_segments(stamps, breaks, period, begin, settle, SHORTEST_SETTLING, SHORTEST_MEASURING)
    if not found:
        length = min(stamp[-1] for stamp in stamps) - begin
        needed = f"{settle:g} s of settling and {SHORTEST_MEASURING:g} s to measure without a gap in either sensor"
        raise TooShort(
            f"the run is {length / NANO:g} s long, RMS values need {settle + SHORTEST_MEASURING:g} s ({needed})"
        )
    return found, period


def _measure(recording, segments, rate, parts, on_progress):
    """Return the numbers of both sensors, the `Spectra`, and the `Levels` by sensor."""
    levels, spectra = {sensor: Levels(rate, parts) for sensor in SENSORS}, MeanSpectra(rate)
    total, done = len(SENSORS) * sum(segment.size for segment in segments), 0
    for segment in segments:
        counting = []
        for sensor, first in zip(SENSORS, segment[:2], strict=True):
            of_sensor = getattr(recording, sensor)
            stamp, acceleration, _ = (column[first : first + segment.size] for column in of_sensor)
            for looked_at in levels[sensor].add(stamp, acceleration, segment.measured):
                on_progress(done + looked_at, total)
            done += segment.size
            counting.append(acceleration[segment.measured :])
        spectra.add(*counting)
    sensors = {sensor: dict(zip(AXES, levels[sensor].numbers(), strict=True)) for sensor in SENSORS}
    return sensors, spectra.spectra(), levels


def _speed(recording, settled):
    odometry = recording.odometry
    if odometry is None:
        return moments(np.empty(0), np.empty((0, 1)), settled)
    return moments(odometry.stamp, odometry.speed[:, None], settled)


def _lines(recording, spectra, speed):
    """Return the engine's speed [r/min], the `Line`s, and why there are fewer."""
    why, engine_speed = [], _told(recording, "engine_speed").get("engine_speed", "nan")
    engine_speed, mean, deviation = float(engine_speed), float(speed.mean[0]), float(speed.deviation[0])
    if isnan(mean):
        where = "in the bag" if recording.odometry is None else "after the settling time"
        why.append(f"no odometry {where}: no speed, no levels of link passing")
    if isnan(engine_speed):
        why.append("the bag does not tell the engine's speed: no levels of its orders")
    try:
        vehicle = parse_vehicle(recording.vehicle or "", "vehicle description in the bag")
    except VehicleFileError as error:
        reason = str(error).splitlines()[0] if recording.vehicle else "no vehicle description in the bag"
        return engine_speed, (), [*why, f"{reason}: no levels of link passing and engine orders"]
    lines = known_lines(spectra, mean, deviation, vehicle.tracks.pitch, engine_speed, vehicle.engine.orders)
    return engine_speed, lines, why


def _history(recording, parts, levels):
    """Return the `History` over some bins."""
    rms, weighted = zip(*(levels[sensor].history() for sensor in SENSORS), strict=True)
    mounts, odometry = recording.mounts, recording.odometry
    nothing = np.full((parts.count, 2), np.nan)
    current, power, travel, speed = nothing, nothing, nothing, nothing[:, 0]
    if mounts is not None:
        current, power = (bin_means(parts, mounts.stamp, each)[0] for each in (mounts.current, mounts.dissipated_power))
        travel = bin_means(parts, mounts.stamp, mounts.deflection[:, :, 2])[1]
    if odometry is not None:
        speed = bin_means(parts, odometry.stamp, odometry.speed[:, None])[0][:, 0]
    by_sensor = (dict(zip(SENSORS, each, strict=True)) for each in (rms, weighted))
    return History(parts.middle, *by_sensor, speed, current, power, travel)


def _notes(recording, timings, rate):
    """Return what was found wrong, in sentences."""
    notes = []
    if not recording.complete:
        notes.append("the bag was cut short; what there is of it counts (`trackvib bag repair` completes it)")
    odd = {end: _not_finite(getattr(recording, part)) for part, end in TOPICS.items() if end in timings}
    for end, (found, _) in timings.items():
        missing = "1 sample is" if found.missing == 1 else f"{found.missing} samples are"
        counts = {
            f"gaps: {found.gap_count}, in which {missing} missing": found.gap_count,
            f"samples within half a period of the one before: {found.repeated}": found.repeated,
            f"samples older than the one before: {found.backward}": found.backward,
            f"samples that are no numbers: {odd[end]}": odd[end],
        }
        notes += [f"{end}: {text}" for text, count in counts.items() if count]
    if rate < LEAST_RATE:
        notes.append(f"sampling rate is {rate:g} Hz, below {LEAST_RATE:g} Hz: no weighted values of ISO 2631-1")
    lacking = (part for part in _WITHOUT if getattr(recording, part) is None)
    return notes + [f"no {TOPICS[part]} in the bag: {_WITHOUT[part]}" for part in lacking]


def _not_finite(columns):
    """Count the samples of some columns, the stamps first, with a value that is not finite."""
    count = 0
    for block in blocks(len(columns[0]), BLOCK):
        parts = (column[block].reshape(len(column[block]), -1) for column in columns[1:])
        count += int(np.count_nonzero(~np.logical_and.reduce([np.isfinite(part).all(axis=1) for part in parts])))
    return count
