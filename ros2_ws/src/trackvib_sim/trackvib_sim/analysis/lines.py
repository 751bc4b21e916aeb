"""Lines of the spectrum with a known cause: links entering the sprockets, orders of the engine."""

from math import isnan, nan

import numpy as np

from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle
from .numbers import AXES, SENSORS, Line

HALF_WIDTH = 2.0  # Hz, to either side of a line: what a Hann window spreads a sine over, rounded up
HARMONICS = 3  # of link passing
SHARED = 0.25  # of the band of a line that moved, in which other lines may be


def read_causes(recording):
    """Return the pitch of the tracks [m] and the engine's orders by the vehicle file in a bag, and notes.

    Without a vehicle file that can be read the pitch is nan and there are no orders.
    """
    try:
        vehicle = parse_vehicle(recording.vehicle or "", "vehicle description in the recording")
    except VehicleFileError as error:
        reason = str(error).splitlines()[0] if recording.vehicle else "no vehicle description in the recording"
        return nan, (), [f"{reason}: no levels of link passing and engine orders"]
    return vehicle.tracks.pitch, vehicle.engine.orders, []


def missing_causes(recording, motion):
    """Return notes on what of a `motion.MeanMotion` is missing, and what cannot be had without."""
    notes = []
    if isnan(motion.speed):
        where = "in the recording" if recording.odometry is None else "after the settling time"
        notes.append(f"no odometry {where}: no speed, nothing by speed, no levels of link passing")
    if isnan(motion.engine_speed):
        notes.append("no engine speed in the recording: no levels of its orders")
    return notes


def known_lines(spectra, motion, pitch, orders):
    """Return the `Line`s of links entering the sprockets and of the engine that lie within the spectra, and notes.

    The band of a line reaches over the frequencies that it had at the speeds driven. A line that moved is left out, and
    a note says so, where other lines were in more than `SHARED` of its band: no level could be attributed to it.

    Parameters
    ----------
    spectra : Spectra
    motion : motion.MeanMotion
    pitch : float
        Of the tracks, m.
    orders : sequence of float
        Of the engine, cycles a revolution.
    """
    passing = [(f"link passing {n}", n / pitch) for n in range(1, HARMONICS + 1)]
    turning = [(f"engine order {order:g}", order / 60.0) for order in orders]
    top = spectra.frequency[-1]
    lines, notes = [], []
    for names, mean, ends in (
        (passing, motion.speed, motion.speed_range),
        (turning, motion.engine_speed, motion.engine_speed_range),
    ):
        for name, slope in names:
            frequency, (lowest, highest) = abs(slope * mean), sorted(abs(slope * end) for end in ends)
            lowest = 0.0 if ends[0] < 0.0 < ends[1] else lowest
            if HALF_WIDTH < frequency <= top - HALF_WIDTH:  # false for nan
                band = max(lowest - HALF_WIDTH, 0.0), min(highest + HALF_WIDTH, top)
                lines.append(Line(name, frequency, lowest, highest, *band, _in_band(spectra, *band)))
    inside = np.array([_inside(spectra, line.low, line.high) for line in lines])
    several = inside.sum(axis=0) > 1
    lost = [line for line, own in zip(lines, inside, strict=True) if line.sweeps and several[own].mean() > SHARED]
    if lost:
        numbers = {}
        for line in lost:
            kind, _, number = line.name.rpartition(" ")
            numbers.setdefault(kind, []).append(number)
        names = " and of ".join(f"{kind} {', '.join(each)}" for kind, each in numbers.items())
        notes.append(f"the speed varies, so the frequencies of {names} overlap, and their levels cannot be told apart")
    return tuple(line for line in lines if line not in lost), notes


def _inside(spectra, low, high):
    return (spectra.frequency >= low) & (spectra.frequency <= high)


def _in_band(spectra, low, high):
    inside, resolution = _inside(spectra, low, high), spectra.frequency[1]
    return {
        sensor: dict(zip(AXES, np.sqrt(spectra.psd[sensor][inside].sum(axis=0) * resolution).tolist(), strict=True))
        for sensor in SENSORS
    }
