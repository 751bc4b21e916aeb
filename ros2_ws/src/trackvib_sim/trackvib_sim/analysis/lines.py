"""Lines of the spectrum with a known cause: links entering the sprockets, orders of the engine."""

from math import isnan, nan

import numpy as np

from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle
from .numbers import AXES, SENSORS, Line

HALF_WIDTH = 2.0  # Hz, to either side of a line: what a Hann window spreads a sine over, rounded up
HARMONICS = 3  # of link passing


def read_causes(recording):
    """Return the pitch of the tracks [m] and the engine's orders by the vehicle file in a bag, and notes.

    Without a vehicle file that can be read the pitch is nan and there are no orders.
    """
    try:
        vehicle = parse_vehicle(recording.vehicle or "", "vehicle description in the bag")
    except VehicleFileError as error:
        reason = str(error).splitlines()[0] if recording.vehicle else "no vehicle description in the bag"
        return nan, (), [f"{reason}: no levels of link passing and engine orders"]
    return vehicle.tracks.pitch, vehicle.engine.orders, []


def missing_causes(recording, motion):
    """Return notes on what of a `motion.MeanMotion` is missing, and what cannot be had without."""
    notes = []
    if isnan(motion.speed):
        where = "in the bag" if recording.odometry is None else "after the settling time"
        notes.append(f"no odometry {where}: no speed, nothing by speed, no levels of link passing")
    if isnan(motion.engine_speed):
        notes.append("no engine speed in the bag: no levels of its orders")
    return notes


def known_lines(spectra, motion, pitch, orders):
    """Return the `Line`s of links entering the sprockets and of the engine that lie within the spectra.

    Parameters
    ----------
    spectra : Spectra
    motion : motion.MeanMotion
        The band about a line is wider by two deviations of the speed that it goes with.
    pitch : float
        Of the tracks, m.
    orders : sequence of float
        Of the engine, cycles a revolution.
    """
    passing, passing_deviation = abs(motion.speed) / pitch, motion.speed_deviation / pitch
    turning, turning_deviation = motion.engine_speed / 60.0, motion.engine_speed_deviation / 60.0
    wanted = [(f"link passing {n}", n * passing, n * passing_deviation) for n in range(1, HARMONICS + 1)]
    wanted += [(f"engine order {order:g}", order * turning, order * turning_deviation) for order in orders]
    bands = [(name, frequency, HALF_WIDTH + 2.0 * deviation) for name, frequency, deviation in wanted]
    highest = spectra.frequency[-1]
    return tuple(
        Line(name, frequency, max(frequency - half, 0.0), frequency + half, _in_band(spectra, frequency, half))
        for name, frequency, half in bands
        if HALF_WIDTH < frequency <= highest - HALF_WIDTH  # false for nan
    )


def _in_band(spectra, frequency, half):
    inside = np.abs(spectra.frequency - frequency) <= half
    resolution = spectra.frequency[1]
    return {
        sensor: dict(zip(AXES, np.sqrt(spectra.psd[sensor][inside].sum(axis=0) * resolution).tolist(), strict=True))
        for sensor in SENSORS
    }
